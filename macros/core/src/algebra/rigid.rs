//! Letters of SE(3) in blocks: `G = P R P^T + P x e^T + e e^T` with the inclusion `P` of space, the
//! last unit vector `e`, the rotation `R` and the translation `x`. In this form products of rigid
//! motions reduce by the rules of three dimensions; it decides, and is never shown.

use super::Algebra;
use super::factor::{Factor, Source};
use super::monomial::Monomial;
use super::poly::Poly;
use super::quaternion::rotation_of;
use super::rational::Rational;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::{Expr, Letter};

const THREE: Dim = Dim::Fixed(3);
const FOUR: Dim = Dim::Fixed(4);

fn inclusion(transposed: bool) -> Factor {
    Factor::Inclusion {
        shape: Shape {
            rows: FOUR,
            cols: THREE,
        },
        at: 0,
        transposed,
    }
}

fn last(transposed: bool) -> Factor {
    Factor::Unit {
        dim: FOUR,
        axis: 3,
        transposed,
    }
}

/// The translation of a letter of SE(3).
pub(super) fn translation_of(at: Letter) -> Factor {
    Factor::Letter {
        source: Source::Translation(at),
        transposed: false,
        inverted: false,
    }
}

impl Algebra<'_> {
    /// `P hat(ω) P^T + P v e^T` of a vector `(ω, v)`.
    pub(super) fn twist(&self, x: &Poly) -> Poly {
        let part = |at| Factor::Inclusion {
            shape: Shape {
                rows: Dim::Fixed(6),
                cols: THREE,
            },
            at,
            transposed: true,
        };
        let mut out = Poly::zero(Shape::square(FOUR));
        for (t, c) in &x.terms {
            let of = |at| [&[part(at)][..], &t.word].concat();
            for (t2, c2) in &self.hat_word(&self.cancelled(of(0))).terms {
                let word = [&[inclusion(false)][..], &t2.word, &[inclusion(true)]].concat();
                match (
                    super::monomial::times(&t.monomial, &t2.monomial),
                    c.times(*c2),
                ) {
                    (Some(m), Some(c)) => self.push_reduced(&mut out, c, &m, word),
                    _ => self.exhaust(),
                }
            }
            let word = [&[inclusion(false)][..], &of(3), &[last(true)]].concat();
            self.push_reduced(&mut out, *c, &t.monomial, word);
        }
        out
    }

    /// Whether the letter is to be written in blocks.
    pub(super) fn in_blocks(&self, at: Letter) -> bool {
        self.blocks.get() && self.symbols.get(at.symbol).structure == Structure::RigidMotion
    }

    /// A letter of SE(3), or its inverse `[R^T -R^T x; 0 1]`, in blocks.
    pub(super) fn rigid_motion(&self, at: Letter, inverted: bool) -> Poly {
        let translation = translation_of(at);
        let r = rotation_of(at, inverted);
        let moved = match inverted {
            true => vec![inclusion(false), r.clone(), translation, last(true)],
            false => vec![inclusion(false), translation, last(true)],
        };
        let sign = match inverted {
            true => Rational::MINUS_ONE,
            false => Rational::ONE,
        };
        let mut out = Poly::zero(Shape::square(FOUR));
        let none = Monomial::new();
        let turned = vec![inclusion(false), r, inclusion(true)];
        self.push_reduced(&mut out, Rational::ONE, &none, turned);
        self.push_reduced(&mut out, sign, &none, moved);
        self.push_reduced(
            &mut out,
            Rational::ONE,
            &none,
            vec![last(false), last(true)],
        );
        out
    }

    /// The normal form with letters of SE(3) in blocks, if there are any.
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

    /// The smallest expression that the normal forms give.
    pub fn shortest(&self, e: &Expr) -> Expr {
        let whole = self.raise(&self.lower(e));
        let blocks = self.lower_in_blocks(e).map(|p| self.raise(&p));
        match blocks {
            Some(blocks) if blocks.size() < whole.size() => blocks,
            _ => whole,
        }
    }

    /// What two adjacent constant factors make: nothing to say, a shorter word, or zero.
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
            // The last row of a rigid motion is that of the identity.
            (
                Factor::Unit {
                    axis: 3,
                    transposed: true,
                    ..
                },
                Factor::Letter {
                    source,
                    transposed: false,
                    ..
                },
            ) if self.structure(*source) == Structure::RigidMotion => Some(Some(vec![a.clone()])),
            (
                Factor::Letter {
                    source,
                    transposed: true,
                    ..
                },
                Factor::Unit {
                    axis: 3,
                    transposed: false,
                    ..
                },
            ) if self.structure(*source) == Structure::RigidMotion => Some(Some(vec![b.clone()])),
            _ => None,
        }
    }
}

/// The unit vector seen through an inclusion.
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
