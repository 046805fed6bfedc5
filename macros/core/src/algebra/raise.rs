//! From normal forms back to expressions. They are shown or emitted as remainders of a failed check, and as equations
//! whose short form only the algebra finds.

use super::Algebra;
use super::factor::{Factor, Source, Word};
use super::monomial::{Atom, Monomial};
use super::poly::{Poly, Term};
use super::rational::Rational;
use crate::expr::shape::Dim;
use crate::expr::{self, Expr};

impl Algebra<'_> {
    /// The polynomial as an expression, terms in canonical order.
    pub fn raise(&self, a: &Poly) -> Expr {
        let terms = a.terms.iter().map(|(t, c)| {
            let mut factors = vec![expr::number(*c)];
            let (monomial, adjugate) = self.adjugate_in(t);
            for (atom, exponent) in &monomial {
                factors.push(expr::power(self.raise_atom(atom), *exponent));
            }
            if t.word.is_empty() {
                if !a.shape.is_scalar() {
                    factors.push(expr::identity(a.shape.rows));
                }
            } else if let Some((i, adjugate)) = adjugate {
                let (before, after) = (&t.word[..i], &t.word[i + 1..]);
                let parts =
                    [before, after].map(|w| (!w.is_empty()).then(|| self.raise_word(&w.to_vec())));
                let [before, after] = parts;
                factors.extend(before.into_iter().chain([adjugate]).chain(after));
            } else {
                factors.push(self.raise_word(&t.word));
            }
            expr::product(factors)
        });
        expr::sum(terms.collect::<Vec<_>>(), a.shape)
    }

    /// The first inverse in a word whose determinant also occurs: together they form an adjugate, which is defined
    /// even if the determinant vanishes. Gives the rest of the monomial.
    fn adjugate_in(&self, t: &Term) -> (Monomial, Option<(usize, Expr)>) {
        for (i, f) in t.word.iter().enumerate() {
            let Factor::Letter {
                source,
                transposed,
                inverted: true,
            } = f
            else {
                continue;
            };
            let wanted = match source {
                Source::Letter(_) | Source::Rotation(_) | Source::Translation(_) => {
                    Atom::Det(*source)
                }
                Source::Opaque(n) => Atom::OpaqueDet(*n),
            };
            let Some(at) = t
                .monomial
                .iter()
                .position(|(atom, e)| *atom == wanted && e.as_integer().is_some_and(|n| n > 0))
            else {
                continue;
            };
            let mut rest = t.monomial.clone();
            let Some(lower) = rest[at].1.plus(Rational::MINUS_ONE) else {
                continue;
            };
            if lower.is_zero() {
                rest.remove(at);
            } else {
                rest[at].1 = lower;
            }
            let adjugate = expr::adjugate(self.symbols, &self.raise_source(*source));
            let adjugate = if *transposed {
                expr::transpose(self.symbols, adjugate)
            } else {
                adjugate
            };
            return (rest, Some((i, adjugate)));
        }
        (t.monomial.clone(), None)
    }

    fn raise_word(&self, word: &Word) -> Expr {
        // hat(u) w is written u x w if w is a vector.
        let is_hat = |f: &Factor| match f {
            Factor::Hat(v) => !matches!(v.as_slice(), [Factor::Axial { .. }]),
            _ => false,
        };
        if let Some(k) = word.iter().position(is_hat)
            && let Factor::Hat(u) = &word[k]
            && let Some(last) = word.last()
            && k + 1 < word.len()
            && self.shape_of(last).cols == Dim::Fixed(1)
        {
            let tail = &word[k + 1..];
            // u x G vee(S) is written -G S G^T u.
            if let Some((
                Factor::Axial {
                    source,
                    transposed: false,
                },
                frame,
            )) = tail.split_last()
                && frame.iter().all(|f| self.is_orthogonal(f))
            {
                let skew = Factor::Letter {
                    source: *source,
                    transposed: false,
                    inverted: false,
                };
                let (_, back) = self.transposed_word(frame);
                let turned = word[..k].iter().chain(frame).chain([&skew]);
                let turned = turned.chain(&back).chain(u).cloned();
                return expr::neg(self.raise_word(&self.cancelled(turned.collect())));
            }
            let product = expr::cross(self.raise_word(u), self.raise_word(&tail.to_vec()));
            let front = word[..k].iter().map(|f| self.raise_factor(f));
            return expr::product(front.chain([product]).collect::<Vec<_>>());
        }
        expr::product(
            word.iter()
                .map(|f| self.raise_factor(f))
                .collect::<Vec<_>>(),
        )
    }

    fn raise_factor(&self, f: &Factor) -> Expr {
        let (base, transposed) = match f {
            Factor::Letter {
                source,
                transposed,
                inverted,
            } => {
                let base = self.raise_source(*source);
                let base = if *inverted {
                    expr::inverse(self.symbols, base)
                } else {
                    base
                };
                (base, *transposed)
            }
            Factor::Unit {
                dim,
                axis,
                transposed,
            } => (expr::unit(*dim, *axis), *transposed),
            Factor::Inclusion {
                shape,
                at,
                transposed,
            } => (expr::inclusion(shape.rows, shape.cols, *at), *transposed),
            Factor::Pure(v) => (expr::pure(self.raise_word(v)), false),
            Factor::Imaginary { word, transposed } => {
                (expr::imaginary(self.raise_word(word)), *transposed)
            }
            Factor::Hat(v) => match v.as_slice() {
                [Factor::Axial { source, .. }] => (self.raise_source(*source), false),
                _ => (expr::hat(self.raise_word(v)), false),
            },
            Factor::Axial { source, transposed } => {
                (expr::vee(self.raise_source(*source)), *transposed)
            }
            Factor::Vee { word, transposed } => {
                let inner = if word.is_empty() {
                    expr::identity(Dim::Fixed(3))
                } else {
                    self.raise_word(word)
                };
                (expr::vee(inner), *transposed)
            }
        };
        if transposed {
            expr::transpose(self.symbols, base)
        } else {
            base
        }
    }

    fn raise_source(&self, source: Source) -> Expr {
        match source {
            Source::Letter(at) => expr::letter(self.symbols, at.symbol, at.shift),
            Source::Opaque(i) => self.matrices.borrow()[i as usize].meaning.clone(),
            Source::Rotation(at) => {
                let letter = expr::letter(self.symbols, at.symbol, at.shift);
                expr::rotation(self.symbols, letter)
            }
            Source::Translation(at) => {
                let letter = expr::letter(self.symbols, at.symbol, at.shift);
                expr::column(self.symbols, &letter)
            }
        }
    }

    pub(super) fn raise_atom(&self, atom: &Atom) -> Expr {
        let number = |i: u32| self.numbers.borrow()[i as usize].meaning.clone();
        match atom {
            Atom::Letter(at) => expr::letter(self.symbols, at.symbol, at.shift),
            Atom::Constant(c) => expr::constant(*c),
            Atom::Dimension(i) => expr::trace(expr::identity(Dim::Named(*i))),
            Atom::Trace(word) => expr::trace(self.raise_word(word)),
            Atom::Bracket(word) => {
                let (row, rest) = word.split_at(1);
                let left = expr::transpose(self.symbols, self.raise_factor(&row[0]));
                expr::dot(left, self.raise_word(&rest.to_vec()))
            }
            Atom::Det(source) => expr::det(self.raise_source(*source)),
            Atom::OpaqueDet(i) => expr::det(self.matrices.borrow()[*i as usize].meaning.clone()),
            Atom::Base(i) | Atom::Given(i) => number(*i),
            Atom::Call(function, i) => expr::call(*function, number(*i)),
        }
    }
}
