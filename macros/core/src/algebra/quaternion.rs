//! Words with quaternions. The left multiplication by a vector moves to the front through elements of SU(2), two such
//! multiplications are multiplied out, and the imaginary part of a conjugate is a rotated imaginary part. Exact
//! evaluation decides products beyond these rules.

use super::Algebra;
use super::factor::{Factor, Source, Word};
use super::monomial::Monomial;
use super::poly::Poly;
use super::rational::Rational;
use crate::expr::Letter;
use crate::expr::shape::{Dim, Shape, Structure};

/// The rotation of a quaternion or a rigid motion, or its inverse.
pub(super) fn rotation_of(at: Letter, inverted: bool) -> Factor {
    Factor::Letter {
        source: Source::Rotation(at),
        transposed: inverted,
        inverted: false,
    }
}

impl Algebra<'_> {
    /// The letter of SU(2) in a factor, and whether it is inverted.
    fn unit_quaternion(&self, f: &Factor) -> Option<(Letter, bool)> {
        match f {
            Factor::Letter {
                source: Source::Letter(at),
                transposed,
                ..
            } if self.symbols.get(at.symbol).structure == Structure::UnitQuaternion => {
                Some((*at, *transposed))
            }
            _ => None,
        }
    }

    /// Whether every factor is a quaternion.
    fn is_quaternion(&self, word: &[Factor]) -> bool {
        word.iter()
            .all(|f| matches!(f, Factor::Pure(_)) || self.unit_quaternion(f).is_some())
    }

    /// The left multiplication by a vector word.
    pub(super) fn pure_word(&self, word: &[Factor]) -> Poly {
        let mut out = Poly::zero(Shape::square(Dim::Fixed(4)));
        let none = Monomial::new();
        // pure(im(A)) = (A - A^T)/2 for a quaternion A.
        if let [Factor::Imaginary { word: a, .. }] = word
            && self.is_quaternion(a)
        {
            let (minus, back) = self.transposed_word(a);
            let half = Rational::HALF;
            self.push_reduced(&mut out, half, &none, a.clone());
            let opposite = if minus { half } else { half.negated() };
            self.push_reduced(&mut out, opposite, &none, back);
            return out;
        }
        let factor = Factor::Pure(word.to_vec());
        self.push_reduced(&mut out, Rational::ONE, &none, vec![factor]);
        out
    }

    /// The imaginary part of a 4 x 4 word.
    pub(super) fn imaginary_word(&self, word: &[Factor]) -> Poly {
        let mut out = Poly::zero(Shape::vector(Dim::Fixed(3)));
        let none = Monomial::new();
        match word {
            [] => return out,
            [Factor::Pure(v)] => {
                self.push_reduced(&mut out, Rational::ONE, &none, v.clone());
                return out;
            }
            // im(g X g^T) = R(g) im(X) for every X.
            [first, middle @ .., last] if self.cancel(last, first) => {
                if let Some((at, inverted)) = self.unit_quaternion(first) {
                    for (t, c) in &self.imaginary_word(middle).terms {
                        let turned = [&[rotation_of(at, inverted)][..], &t.word].concat();
                        self.push_reduced(&mut out, *c, &t.monomial, turned);
                    }
                    return out;
                }
            }
            _ => {}
        }
        let (mut sign, mut least) = (Rational::ONE, word.to_vec());
        let (minus, back) = self.transposed_word(word);
        if back < least {
            // im(A^T) = -im(A).
            sign = if minus {
                Rational::ONE
            } else {
                Rational::MINUS_ONE
            };
            least = back;
        } else if back == least && !minus {
            return out;
        }
        let factor = Factor::Imaginary {
            word: least,
            transposed: false,
        };
        self.push_reduced(&mut out, sign, &none, vec![factor]);
        out
    }

    /// Moves a vector to the front: `g pure(v) = pure(R(g) v) g`. `None` if no vector can move.
    pub(super) fn pure_in_front(&self, word: &[Factor]) -> Option<Word> {
        let i = word.windows(2).position(
            |pair| matches!(pair, [g, Factor::Pure(_)] if self.unit_quaternion(g).is_some()),
        )?;
        let (at, inverted) = self.unit_quaternion(&word[i])?;
        let Factor::Pure(v) = &word[i + 1] else {
            return None;
        };
        let turned = self.cancelled([&[rotation_of(at, inverted)][..], v].concat());
        let pair = [Factor::Pure(turned), word[i].clone()];
        Some([&word[..i], &pair, &word[i + 2..]].concat())
    }

    /// `pure(u) pure(v) = -(u.v) + pure(u x v)`: expands the first such pair into words with coefficients and
    /// scalars. `None` if the word contains no such pair.
    pub(super) fn pure_product(&self, word: &[Factor]) -> Option<Vec<(Rational, Monomial, Word)>> {
        let i = word
            .windows(2)
            .position(|pair| matches!(pair, [Factor::Pure(_), Factor::Pure(_)]))?;
        let (Factor::Pure(u), Factor::Pure(v)) = (&word[i], &word[i + 1]) else {
            return None;
        };
        let around = |middle: &[Factor]| [&word[..i], middle, &word[i + 2..]].concat();
        let mut out = Vec::new();
        let (minus, row) = self.transposed_word(u);
        let scalar = self.bracket(&[&row[..], v].concat());
        for (t, c) in &scalar.terms {
            let c = if minus { *c } else { c.negated() };
            out.push((c, t.monomial.clone(), around(&[])));
        }
        let mut cross = Poly::zero(Shape::vector(Dim::Fixed(3)));
        for (t, c) in &self.hat_word(u).terms {
            self.push_reduced(&mut cross, *c, &t.monomial, [&t.word[..], v].concat());
        }
        for (t, c) in cross.terms {
            out.push((c, t.monomial, around(&[Factor::Pure(t.word)])));
        }
        Some(out)
    }
}
