//! If the adjugate of a matrix is computed too, its inverse is the adjugate over the determinant. This occurs for
//! matrix fields whose energy contains a logarithm and a power of the determinant. Takes expressions that are
//! computed together; gives equal ones.

use crate::algebra::Rational;
use crate::expr::shape::Shape;
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr, Exprs, Hashed, Node};

/// The expressions without inverses of matrices whose adjugates occur.
pub fn by_adjugates(symbols: &Symbols, results: &[Expr]) -> Vec<Expr> {
    let mut adjugates = Exprs::default();
    let mut seen = Exprs::default();
    results
        .iter()
        .for_each(|e| collect(e, &mut adjugates, &mut seen));
    if adjugates.is_empty() {
        return results.to_vec();
    }
    let mut all = Adjugates {
        symbols,
        adjugates,
        done: Hashed::default(),
    };
    results.iter().map(|e| all.rewrite(e)).collect()
}

/// Collects the arguments of adjugates.
fn collect(e: &Expr, all: &mut Exprs, seen: &mut Exprs) {
    if !seen.insert(e.clone()) {
        return;
    }
    if let Node::Adjugate(a) = e.node() {
        all.insert(a.clone());
    }
    for child in e.children() {
        collect(child, all, seen);
    }
}

struct Adjugates<'a> {
    symbols: &'a Symbols,
    adjugates: Exprs,
    done: Hashed<Expr>,
}

impl Adjugates<'_> {
    fn rewrite(&mut self, e: &Expr) -> Expr {
        if let Some(known) = self.done.get(e) {
            return known.clone();
        }
        let s = self.symbols;
        let inner = super::increment_form::rebuilt(s, e, &mut |c| self.rewrite(c));
        let adjugate = match inner.node() {
            Node::Inverse(a) => self.adjugate_of(a).map(|found| (a.clone(), found)),
            _ => None,
        };
        let out = match adjugate {
            Some((a, adjugate)) => {
                expr::product([expr::power(expr::det(a), Rational::integer(-1)), adjugate])
            }
            None => match inner.node() {
                Node::Sum(terms) => self.sum(&inner, terms),
                _ => inner,
            },
        };
        self.done.insert(e.clone(), out.clone());
        out
    }

    /// The sum, with the scalar coefficients of one adjugate added.
    fn sum(&self, e: &Expr, terms: &[Expr]) -> Expr {
        let mut list: Vec<(Option<Expr>, Vec<Expr>)> = Vec::new();
        for term in terms {
            match multiple(term) {
                Some((adjugate, times)) => {
                    let known = list
                        .iter_mut()
                        .find(|(of, _)| of.as_ref() == Some(&adjugate));
                    match known {
                        Some((_, all)) => all.push(times),
                        None => list.push((Some(adjugate), vec![times])),
                    }
                }
                None => list.push((None, vec![term.clone()])),
            }
        }
        if list.len() == terms.len() {
            return e.clone();
        }
        let added = list.into_iter().flat_map(|(of, all)| match of {
            Some(adjugate) => {
                let times = expr::sum(all, Shape::SCALAR);
                vec![expr::product([times, adjugate])]
            }
            None => all,
        });
        expr::sum(added.collect::<Vec<_>>(), e.shape())
    }

    /// The adjugate of a matrix, if it or its transpose is known.
    fn adjugate_of(&self, a: &Expr) -> Option<Expr> {
        let s = self.symbols;
        let turned = expr::transpose(s, a.clone());
        if self.adjugates.contains(a) {
            return Some(expr::adjugate(s, a));
        }
        let known = self.adjugates.contains(&turned);
        known.then(|| expr::transpose(s, expr::adjugate(s, &turned)))
    }
}

/// An adjugate and its scalar coefficient.
fn multiple(e: &Expr) -> Option<(Expr, Expr)> {
    let is_adjugate = |e: &Expr| match e.node() {
        Node::Adjugate(_) => true,
        Node::Transpose(a) => matches!(a.node(), Node::Adjugate(_)),
        _ => false,
    };
    match e.node() {
        Node::Neg(a) => multiple(a).map(|(adjugate, times)| (adjugate, expr::neg(times))),
        Node::Product(factors) => {
            let (words, numbers): (Vec<Expr>, Vec<Expr>) = factors
                .iter()
                .cloned()
                .partition(|f| !f.shape().is_scalar());
            match words.as_slice() {
                [one] if is_adjugate(one) => Some((one.clone(), expr::product(numbers))),
                _ => None,
            }
        }
        _ => is_adjugate(e).then(|| (e.clone(), expr::integer(1))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::shape::{Dim, Structure};
    use crate::expr::symbol::Role;

    #[test]
    fn an_inverse_beside_an_adjugate_is_made_from_it() {
        let mut s = Symbols::default();
        let mut letter = |name: &str, shape| {
            let id = s.add(name, shape, Structure::General, Role::Derived);
            expr::here(&s, id)
        };
        let (a, b) = (letter("a", Shape::SCALAR), letter("b", Shape::SCALAR));
        let q = letter("Q", Shape::square(Dim::Fixed(3)));
        let inverse = expr::transpose(&s, expr::inverse(&s, q.clone()));
        let adjugate = expr::adjugate(&s, &expr::transpose(&s, q.clone()));
        let over = expr::power(expr::det(q.clone()), Rational::integer(-1));
        let of = |times: &Expr, m: &Expr| expr::product([times.clone(), m.clone()]);
        let three = inverse.shape();
        let both = expr::sum([of(&a, &adjugate), expr::neg(of(&b, &inverse))], three);
        let times = expr::sub(a.clone(), expr::product([b.clone(), over.clone()]));
        assert_eq!(by_adjugates(&s, &[both]), [of(&times, &adjugate)]);
        // In another expression that is computed together with this one.
        let apart = [adjugate.clone(), of(&b, &inverse)];
        let expected = [
            adjugate.clone(),
            of(&expr::product([b.clone(), over]), &adjugate),
        ];
        assert_eq!(by_adjugates(&s, &apart), expected);
        // An inverse without an adjugate is unchanged.
        let alone = [of(&b, &inverse)];
        assert_eq!(by_adjugates(&s, &alone), alone);
    }
}
