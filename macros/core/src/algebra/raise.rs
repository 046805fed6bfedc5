//! From normal forms back to expressions, for what must be shown or emitted in reduced form:
//! left-over terms of a failed check, and equations whose short form only the algebra finds.

use super::Algebra;
use super::factor::{Factor, Source, Word};
use super::monomial::Atom;
use super::poly::Poly;
use crate::expr::shape::Dim;
use crate::expr::{self, Expr, Function};

impl Algebra<'_> {
    /// The polynomial as an expression, terms in canonical order.
    pub fn raise(&self, a: &Poly) -> Expr {
        let terms = a.terms.iter().map(|(t, c)| {
            let mut factors = vec![expr::number(*c)];
            for (atom, exponent) in &t.monomial {
                factors.push(expr::power(self.raise_atom(atom), *exponent));
            }
            if t.word.is_empty() {
                if !a.shape.is_scalar() {
                    factors.push(expr::identity(a.shape.rows));
                }
            } else {
                factors.push(self.raise_word(&t.word));
            }
            expr::product(factors)
        });
        expr::sum(terms.collect::<Vec<_>>(), a.shape)
    }

    fn raise_word(&self, word: &Word) -> Expr {
        // hat(u) w reads as u x w when w is a vector.
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
            // u x G vee(S) reads as -G S G^T u.
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
        }
    }

    fn raise_atom(&self, atom: &Atom) -> Expr {
        let number = |i: u32| self.numbers.borrow()[i as usize].meaning.clone();
        match atom {
            Atom::Letter(at) => expr::letter(self.symbols, at.symbol, at.shift),
            Atom::Dimension(i) => expr::trace(expr::identity(Dim::Named(*i))),
            Atom::Trace(word) => expr::trace(self.raise_word(word)),
            Atom::Bracket(word) => {
                let (row, rest) = word.split_at(1);
                let left = expr::transpose(self.symbols, self.raise_factor(&row[0]));
                expr::dot(left, self.raise_word(&rest.to_vec()))
            }
            Atom::Det(source) => expr::det(self.raise_source(*source)),
            Atom::OpaqueDet(i) => expr::det(self.matrices.borrow()[*i as usize].meaning.clone()),
            Atom::Base(i) => number(*i),
            Atom::Exp(i) => expr::call(Function::Exp, number(*i)),
            Atom::Log(i) => expr::call(Function::Log, number(*i)),
        }
    }
}
