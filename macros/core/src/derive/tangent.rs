//! Linear expressions as matrices: an expression that is linear in a vector `η` becomes `M η`. This gives Newton's
//! tangent in closed form; a basis of directions would cost one evaluation per column. Takes an expression and the
//! letter; gives the matrix, or None if no rule applies.

use crate::algebra::Rational;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Node, Shift};

/// A vector of three components and its letter.
#[derive(Clone, Copy)]
pub struct Direction<'a> {
    /// The symbols.
    pub symbols: &'a Symbols,
    /// The letter `η`, a vector of three components.
    pub letter: SymbolId,
}

const THREE: Dim = Dim::Fixed(3);

impl Direction<'_> {
    fn occurs(&self, e: &Expr) -> bool {
        let shift = Shift::HERE;
        let symbol = self.letter;
        expr::contains(e, Letter { symbol, shift })
    }

    fn transpose(&self, e: Expr) -> Expr {
        expr::transpose(self.symbols, e)
    }

    /// The matrix of a vector that is linear in `η`.
    pub fn matrix(&self, e: &Expr) -> Option<Expr> {
        let shape = Shape {
            rows: e.shape().rows,
            cols: THREE,
        };
        if !self.occurs(e) {
            // Linear and free of the letter, so it is zero.
            return Some(expr::zero(shape));
        }
        Some(match e.node() {
            Node::Letter(_) => expr::identity(THREE),
            Node::Neg(a) => expr::neg(self.matrix(a)?),
            Node::Sum(terms) => {
                let terms: Option<Vec<Expr>> = terms.iter().map(|t| self.matrix(t)).collect();
                expr::sum(terms?, shape)
            }
            Node::Quotient(a, b) if !self.occurs(b) => expr::quotient(self.matrix(a)?, b.clone()),
            Node::Cross(a, b) => match (self.occurs(a), self.occurs(b)) {
                (true, false) => expr::neg(expr::mul(expr::hat(b.clone()), self.matrix(a)?)),
                (false, true) => expr::mul(expr::hat(a.clone()), self.matrix(b)?),
                _ => return None,
            },
            Node::Vee(a) => match (a.node(), expr::axial_of_outer(self.symbols, a)) {
                (Node::Sum(terms), _) => {
                    let terms: Option<Vec<Expr>> = terms
                        .iter()
                        .map(|t| self.matrix(&expr::vee(t.clone())))
                        .collect();
                    expr::sum(terms?, shape)
                }
                (_, Some(product)) => self.matrix(&product)?,
                _ => expr::scale(Rational::HALF, self.axial(a)?),
            },
            Node::Product(factors) => self.product(factors)?,
            _ => return None,
        })
    }

    /// One factor is linear in `η`, the others are free of it.
    fn product(&self, factors: &[Expr]) -> Option<Expr> {
        let mut with = (0..factors.len()).filter(|i| self.occurs(&factors[*i]));
        let (i, None) = (with.next()?, with.next()) else {
            return None;
        };
        let (before, linear, after) = (&factors[..i], &factors[i], &factors[i + 1..]);
        if linear.shape().is_scalar() {
            let mut rest = before.to_vec();
            rest.extend_from_slice(after);
            let row = self.transpose(self.gradient(linear)?);
            return Some(expr::mul(expr::product(rest), row));
        }
        let mut word = before.to_vec();
        word.push(match after {
            [] => self.matrix(linear)?,
            _ => self.applied(linear, expr::product(after.to_vec()))?,
        });
        Some(expr::product(word))
    }

    /// The matrix of `X v`, where the matrix `X` is linear in `η`.
    fn applied(&self, x: &Expr, v: Expr) -> Option<Expr> {
        if !v.shape().is_vector() {
            return None;
        }
        Some(match x.node() {
            Node::Hat(u) => expr::neg(expr::mul(expr::hat(v), self.matrix(u)?)),
            Node::Neg(a) => expr::neg(self.applied(a, v)?),
            Node::Sum(terms) => {
                let parts: Option<Vec<Expr>> = terms
                    .iter()
                    .map(|t| match self.occurs(t) {
                        true => self.applied(t, v.clone()),
                        false => None,
                    })
                    .collect();
                expr::sum(
                    parts?,
                    Shape {
                        rows: x.shape().rows,
                        cols: THREE,
                    },
                )
            }
            Node::Product(factors) => {
                let mut word = factors.clone();
                word.push(v);
                self.product(&word)?
            }
            _ => return None,
        })
    }

    /// The matrix of the axial vector of `X - X^T`, that is `2 vee(X)`, where `X` is linear in `η`.
    fn axial(&self, x: &Expr) -> Option<Expr> {
        Some(match x.node() {
            Node::Hat(u) => expr::scale(Rational::integer(2), self.matrix(u)?),
            Node::Neg(a) => expr::neg(self.axial(a)?),
            Node::Sum(terms) => {
                let terms: Option<Vec<Expr>> = terms.iter().map(|t| self.axial(t)).collect();
                expr::sum(terms?, Shape::square(THREE))
            }
            Node::Quotient(a, b) if !self.occurs(b) => expr::quotient(self.axial(a)?, b.clone()),
            Node::Product(factors) => {
                let mut with = (0..factors.len()).filter(|i| self.occurs(&factors[*i]));
                let (i, None) = (with.next()?, with.next()) else {
                    return None;
                };
                let (numbers, before): (Vec<Expr>, Vec<Expr>) = factors[..i]
                    .iter()
                    .cloned()
                    .partition(|f| f.shape().is_scalar());
                let after = factors[i + 1..].to_vec();
                if factors[i].shape().is_scalar() {
                    let row = self.transpose(self.gradient(&factors[i])?);
                    let mut word = numbers;
                    word.push(expr::scale(
                        Rational::integer(2),
                        expr::vee(expr::product(after)),
                    ));
                    word.push(row);
                    return Some(expr::product(word));
                }
                let core = self.axial_between(&before, &factors[i], &after)?;
                let mut word = numbers;
                word.push(core);
                expr::product(word)
            }
            _ => return None,
        })
    }

    /// The matrix for `A hat(u) B`: `(tr(C) - C^T) B^T u` with `C = A B` if `B` is a rotation, and `(tr(C) - C) A u`
    /// if `A` is one. If both are, the form with fewer rotations is used.
    fn axial_between(&self, a: &[Expr], linear: &Expr, b: &[Expr]) -> Option<Expr> {
        let Node::Hat(u) = linear.node() else {
            let Node::Sum(terms) = linear.node() else {
                return None;
            };
            let parts: Option<Vec<Expr>> = terms
                .iter()
                .map(|t| {
                    let word = [a, std::slice::from_ref(t), b].concat();
                    let own = self.matrix(&expr::vee(expr::product(word)))?;
                    Some(expr::scale(Rational::integer(2), own))
                })
                .collect();
            return Some(expr::sum(parts?, Shape::square(THREE)));
        };
        let c = match a.len() + b.len() {
            0 => expr::identity(THREE),
            _ => expr::product([a, b].concat()),
        };
        let turn = |word: &[Expr]| match word {
            [] => expr::identity(THREE),
            _ => expr::product(word.to_vec()),
        };
        let spur = expr::mul(expr::trace(c.clone()), expr::identity(THREE));
        let [before, after] = [a, b].map(|word| word.iter().all(|f| self.is_rotation(f)));
        let (core, turned) = if after && !(before && a.len() < b.len()) {
            (expr::sub(spur, self.transpose(c)), self.transpose(turn(b)))
        } else if before {
            (expr::sub(spur, c), turn(a))
        } else {
            return None;
        };
        Some(expr::product([core, turned, self.matrix(u)?]))
    }

    /// Whether its inverse is its transpose and its determinant is 1.
    fn is_rotation(&self, e: &Expr) -> bool {
        match e.node() {
            Node::Letter(at) => self.symbols.get(at.symbol).structure == Structure::Orthogonal,
            Node::Transpose(a) => self.is_rotation(a),
            _ => false,
        }
    }

    /// The vector `g` of a scalar `g . η`.
    fn gradient(&self, e: &Expr) -> Option<Expr> {
        if !self.occurs(e) {
            return Some(expr::zero(Shape::vector(THREE)));
        }
        let adjoint = |m: Expr, v: &Expr| expr::mul(self.transpose(m), v.clone());
        Some(match e.node() {
            Node::Neg(a) => expr::neg(self.gradient(a)?),
            Node::Sum(terms) => {
                let terms: Option<Vec<Expr>> = terms.iter().map(|t| self.gradient(t)).collect();
                expr::sum(terms?, Shape::vector(THREE))
            }
            Node::Quotient(a, b) if !self.occurs(b) => expr::quotient(self.gradient(a)?, b.clone()),
            Node::Dot(a, b) => match (self.occurs(a), self.occurs(b)) {
                (true, false) => adjoint(self.matrix(a)?, b),
                (false, true) => adjoint(self.matrix(b)?, a),
                _ => return None,
            },
            Node::Product(factors) if factors.iter().all(|f| f.shape().is_scalar()) => {
                let mut with = (0..factors.len()).filter(|i| self.occurs(&factors[*i]));
                let (i, None) = (with.next()?, with.next()) else {
                    return None;
                };
                let mut word = factors.to_vec();
                word[i] = self.gradient(&factors[i])?;
                expr::product(word)
            }
            Node::Trace(a) => {
                // tr(A hat(u) B) = -2 vee(B A) . u.
                let Node::Product(factors) = a.node() else {
                    return None;
                };
                let i = factors.iter().position(|f| self.occurs(f))?;
                let Node::Hat(u) = factors[i].node() else {
                    return None;
                };
                let around = [&factors[i + 1..], &factors[..i]].concat();
                if around.iter().any(|f| self.occurs(f)) {
                    return None;
                }
                let vector = expr::vee(expr::product(around));
                let pulled = expr::mul(self.transpose(self.matrix(u)?), vector);
                expr::scale(Rational::integer(-2), pulled)
            }
            _ => return None,
        })
    }
}
