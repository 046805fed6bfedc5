//! Rigid motions in blocks: `G = P R P^T + P x e^T + e e^T` with the inclusion `P` of space, the last unit vector
//! `e`, the rotation `R` and the translation `x`. In this form, products of rigid motions reduce by the rules of the
//! space itself. This form is used for decisions and never shown.

use super::Algebra;
use super::factor::{Factor, Source};
use super::monomial::Monomial;
use super::poly::{Poly, Term};
use super::quaternion::rotation_of;
use super::rational::Rational;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::{Expr, Letter, last_axis, within};

const TWO: Dim = Dim::Fixed(2);

/// The inclusion of space in homogeneous coordinates with `rows` rows, or its transpose.
pub(crate) fn inclusion_of_space(rows: Dim, transposed: bool) -> Factor {
    Factor::Inclusion {
        shape: Shape {
            rows,
            cols: within(rows),
        },
        at: 0,
        transposed,
    }
}

/// The last unit vector of homogeneous coordinates, or its transpose.
pub(crate) fn last_unit(rows: Dim, transposed: bool) -> Factor {
    Factor::Unit {
        dim: rows,
        axis: last_axis(rows),
        transposed,
    }
}

fn axis(dim: Dim, axis: u8, transposed: bool) -> Factor {
    Factor::Unit {
        dim,
        axis,
        transposed,
    }
}

/// The translation of a rigid motion.
pub(super) fn translation_of(at: Letter) -> Factor {
    Factor::Letter {
        source: Source::Translation(at),
        transposed: false,
        inverted: false,
    }
}

impl Algebra<'_> {
    /// `P hat(ω) P^T + P v e^T` of a vector `(ω, v)`.
    pub(super) fn twist(&self, x: &Poly, rows: Dim) -> Poly {
        let space = within(rows);
        let first = |transposed| inclusion_of_space(rows, transposed);
        let last = |transposed| last_unit(rows, transposed);
        let part = |at| Factor::Inclusion {
            shape: Shape {
                rows: x.shape.rows,
                cols: space,
            },
            at,
            transposed: true,
        };
        let mut out = Poly::zero(Shape::square(rows));
        for (t, c) in &x.terms {
            let of = |f: Factor| [&[f][..], &t.word].concat();
            match space {
                TWO => {
                    let angle = self.bracket(&of(axis(x.shape.rows, 0, true)));
                    for (i, j, sign) in [(1, 0, Rational::ONE), (0, 1, Rational::MINUS_ONE)] {
                        let word = vec![axis(rows, i, false), axis(rows, j, true)];
                        let turn = Term {
                            monomial: t.monomial.clone(),
                            word,
                        };
                        self.push_times(&mut out, &turn, c.times(sign), &angle);
                    }
                }
                _ => {
                    for (t2, c2) in &self.hat_word(&self.cancelled(of(part(0)))).terms {
                        let word = [&[first(false)][..], &t2.word, &[first(true)]].concat();
                        match (
                            super::monomial::times(&t.monomial, &t2.monomial),
                            c.times(*c2),
                        ) {
                            (Some(m), Some(c)) => self.push_reduced(&mut out, c, &m, word),
                            _ => self.exhaust(),
                        }
                    }
                }
            }
            let linear = if space == TWO { 1 } else { 3 };
            let word = [&[first(false)][..], &of(part(linear)), &[last(true)]].concat();
            self.push_reduced(&mut out, *c, &t.monomial, word);
        }
        out
    }

    /// A term times a number.
    fn push_times(&self, out: &mut Poly, term: &Term, c: Option<Rational>, number: &Poly) {
        for (t, factor) in &number.terms {
            let monomial = super::monomial::times(&term.monomial, &t.monomial);
            match (monomial, c.and_then(|c| c.times(*factor))) {
                (Some(m), Some(c)) => self.push_reduced(out, c, &m, term.word.clone()),
                _ => self.exhaust(),
            }
        }
    }

    /// Whether the letter is expressed in blocks.
    pub(super) fn in_blocks(&self, at: Letter) -> bool {
        self.blocks.get() && self.symbols.get(at.symbol).structure == Structure::RigidMotion
    }

    /// A rigid motion, or its inverse `[R^T -R^T x; 0 1]`, in blocks.
    pub(super) fn rigid_motion(&self, at: Letter, inverted: bool) -> Poly {
        let shape = self.symbols.get(at.symbol).shape;
        let first = |transposed| inclusion_of_space(shape.rows, transposed);
        let last = |transposed| last_unit(shape.rows, transposed);
        let translation = translation_of(at);
        let r = rotation_of(at, inverted);
        let moved = match inverted {
            true => vec![first(false), r.clone(), translation, last(true)],
            false => vec![first(false), translation, last(true)],
        };
        let sign = match inverted {
            true => Rational::MINUS_ONE,
            false => Rational::ONE,
        };
        let mut out = Poly::zero(shape);
        let none = Monomial::new();
        let turned = vec![first(false), r, first(true)];
        self.push_reduced(&mut out, Rational::ONE, &none, turned);
        self.push_reduced(&mut out, sign, &none, moved);
        let corner = vec![last(false), last(true)];
        self.push_reduced(&mut out, Rational::ONE, &none, corner);
        out
    }

    /// The normal form with rigid motions in blocks. None if there are no rigid motions.
    pub fn lower_in_blocks(&self, e: &Expr) -> Option<Poly> {
        let rigid = |l: &Letter| self.symbols.get(l.symbol).structure == Structure::RigidMotion;
        if !crate::expr::letters(e).iter().any(rigid) {
            return None;
        }
        self.blocks.set(true);
        let normal = self.lower(e);
        self.blocks.set(false);
        Some(normal)
    }

    /// The smallest expression from the normal forms. If a form has another value at a random point, the derivation
    /// ends.
    pub fn shortest(&self, e: &Expr) -> Expr {
        let whole = self.raise(&self.lower(e));
        let blocks = self.lower_in_blocks(e).map(|p| self.raise(&p));
        let found = match blocks {
            Some(blocks) if blocks.size() < whole.size() => blocks,
            _ => whole,
        };
        let difference = crate::expr::sub(e.clone(), found.clone());
        if !self.exhausted() && super::exact::differs_from_zero(self.symbols, &difference) {
            self.contradicted();
        }
        found
    }

    /// The product of two adjacent constant factors: no rule, a shorter word, or zero.
    pub(super) fn constant_pair(&self, a: &Factor, b: &Factor) -> Option<Option<Vec<Factor>>> {
        match (a, b) {
            (
                Factor::Inclusion {
                    shape,
                    at,
                    transposed: true,
                },
                Factor::Inclusion {
                    shape: shape2,
                    at: at2,
                    transposed: false,
                },
            ) => {
                if shape == shape2 && at == at2 {
                    return Some(Some(Vec::new()));
                }
                let rows = |s: &Shape| match s.cols {
                    Dim::Fixed(n) => n,
                    Dim::Named(_) => 0,
                };
                let (start, start2) = (u32::from(*at), u32::from(*at2));
                let apart = start + rows(shape) <= start2 || start2 + rows(shape2) <= start;
                apart.then_some(None)
            }
            (
                Factor::Inclusion {
                    shape,
                    at,
                    transposed: true,
                },
                Factor::Unit {
                    axis,
                    transposed: false,
                    ..
                },
            ) => Some(taken(*shape, *at, *axis, false)),
            (
                Factor::Unit {
                    axis,
                    transposed: true,
                    ..
                },
                Factor::Inclusion {
                    shape,
                    at,
                    transposed: false,
                },
            ) => Some(taken(*shape, *at, *axis, true)),
            // The last row of a rigid motion is the last row of the identity.
            (
                Factor::Unit {
                    dim,
                    axis,
                    transposed: true,
                },
                Factor::Letter {
                    source,
                    transposed: false,
                    ..
                },
            ) if self.is_last_row(*source, *dim, *axis) => Some(Some(vec![a.clone()])),
            (
                Factor::Letter {
                    source,
                    transposed: true,
                    ..
                },
                Factor::Unit {
                    dim,
                    axis,
                    transposed: false,
                },
            ) if self.is_last_row(*source, *dim, *axis) => Some(Some(vec![b.clone()])),
            _ => None,
        }
    }

    /// Whether an axis belongs to the last row of a rigid motion.
    fn is_last_row(&self, source: Source, dim: Dim, axis: u8) -> bool {
        self.structure(source) == Structure::RigidMotion && axis == last_axis(dim)
    }
}

/// The unit vector, projected by an inclusion.
fn taken(shape: Shape, at: u8, axis: u8, transposed: bool) -> Option<Vec<Factor>> {
    let Dim::Fixed(n) = shape.cols else {
        return None;
    };
    let inside = axis.checked_sub(at).filter(|i| u32::from(*i) < n)?;
    Some(vec![Factor::Unit {
        dim: shape.cols,
        axis: inside,
        transposed,
    }])
}
