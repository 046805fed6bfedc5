//! Combines like terms of sums, regardless of the order of their factors: the gradient of a symmetric form contains
//! each term twice. Takes an expression; gives an equal one.

use crate::algebra::Rational;
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr, Hashed, Node};

/// The expressions with like terms combined.
pub fn collected(symbols: &Symbols, results: &[Expr]) -> Vec<Expr> {
    let mut like = LikeTerms {
        symbols,
        numbers: Hashed::default(),
        done: Hashed::default(),
    };
    results.iter().map(|e| like.collect(e)).collect()
}

/// A term: a rational times scalars times a word of matrices.
struct Term {
    times: Rational,
    scalars: Vec<Expr>,
    word: Vec<Expr>,
}

struct LikeTerms<'a> {
    symbols: &'a Symbols,
    /// A number per factor, in order of occurrence.
    numbers: Hashed<usize>,
    done: Hashed<Expr>,
}

impl LikeTerms<'_> {
    fn collect(&mut self, e: &Expr) -> Expr {
        if let Some(known) = self.done.get(e) {
            return known.clone();
        }
        let inner = super::increment_form::rebuilt(self.symbols, e, &mut |c| self.collect(c));
        let out = match inner.node() {
            Node::Sum(terms) => self.sum(&inner, terms),
            _ => inner,
        };
        self.done.insert(e.clone(), out.clone());
        out
    }

    fn sum(&mut self, e: &Expr, terms: &[Expr]) -> Expr {
        let mut list: Vec<(Vec<usize>, Term)> = Vec::new();
        for t in terms {
            let mut term = Term {
                times: Rational::integer(1),
                scalars: Vec::new(),
                word: Vec::new(),
            };
            if !take(t, &mut term) {
                return e.clone();
            }
            let mut key: Vec<usize> = term.scalars.iter().map(|x| self.number(x)).collect();
            key.sort_unstable();
            // No factor has this number, so it separates the scalars from the word.
            key.push(usize::MAX);
            key.extend(term.word.iter().map(|x| self.number(x)));
            match list.iter_mut().find(|(known, _)| *known == key) {
                Some((_, first)) => match first.times.plus(term.times) {
                    Some(times) => first.times = times,
                    None => return e.clone(),
                },
                None => list.push((key, term)),
            }
        }
        if list.len() == terms.len() {
            return e.clone();
        }
        let added = list.into_iter().map(|(_, t)| {
            let rest = expr::product(t.scalars.into_iter().chain(t.word));
            expr::scale(t.times, rest)
        });
        expr::sum(added.collect::<Vec<_>>(), e.shape())
    }

    fn number(&mut self, e: &Expr) -> usize {
        let next = self.numbers.len();
        *self.numbers.entry(e.clone()).or_insert(next)
    }
}

/// Splits a term into its parts; `false` if its rational cannot be represented.
fn take(e: &Expr, into: &mut Term) -> bool {
    match e.node() {
        Node::Neg(a) => {
            let times = into.times.times(Rational::MINUS_ONE);
            times.is_some_and(|times| {
                into.times = times;
                take(a, into)
            })
        }
        Node::Number(q) => into.times.times(*q).is_some_and(|times| {
            into.times = times;
            true
        }),
        Node::Product(factors) => factors.iter().all(|f| take(f, into)),
        _ if e.shape().is_scalar() => {
            into.scalars.push(e.clone());
            true
        }
        _ => {
            into.word.push(e.clone());
            true
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::shape::{Dim, Shape, Structure};
    use crate::expr::symbol::Role;

    #[test]
    fn like_terms_are_added_whatever_the_order_of_their_numbers() {
        let mut symbols = Symbols::default();
        let mut letter = |name: &str, shape| {
            let id = symbols.add(name, shape, Structure::General, Role::Derived);
            expr::here(&symbols, id)
        };
        let (a, h) = (letter("a", Shape::SCALAR), letter("h", Shape::SCALAR));
        let three = Shape::square(Dim::Fixed(3));
        let (x, y) = (letter("X", three), letter("Y", three));
        let half = |list: [&Expr; 3]| {
            expr::scale(Rational::HALF, expr::product(list.into_iter().cloned()))
        };
        let sum = |list: &[Expr]| expr::sum(list.iter().cloned(), three);
        let twice = sum(&[half([&a, &h, &x]), y.clone(), half([&h, &a, &x])]);
        let once = sum(&[expr::product([a.clone(), h.clone(), x.clone()]), y.clone()]);
        assert_eq!(collected(&symbols, &[twice]), [once]);
        let opposite = sum(&[half([&a, &h, &x]), y.clone(), expr::neg(half([&h, &a, &x]))]);
        assert_eq!(collected(&symbols, &[opposite]), std::slice::from_ref(&y));
        // Matrices do not commute, and an unchanged expression keeps its form.
        let products = sum(&[expr::mul(x.clone(), y.clone()), expr::mul(y, x)]);
        assert_eq!(
            collected(&symbols, std::slice::from_ref(&products)),
            [products]
        );
    }
}
