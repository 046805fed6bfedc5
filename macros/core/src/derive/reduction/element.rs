//! Elements of the groups as factors of words: as themselves, as the rotation of an element of SU(2)
//! or SE(3), and as the translation of one of SE(3), which is written by the whole motion. Takes
//! factors; gives which element stands there, in which mode, and the side that must be absorbed.

use super::terms::Reducer;
use crate::algebra::{Factor, Source, Word};
use crate::check::spec::{Configuration, Side};
use crate::expr::Letter;
use crate::expr::shape::{Dim, Shape};

/// An element at its place in a word.
#[derive(Clone, Copy)]
pub(super) struct Occurrence<'a> {
    pub(super) configuration: &'a Configuration,
    /// Whether it is the rotation of the element that stands there.
    pub(super) rotation: bool,
    pub(super) transposed: bool,
    pub(super) inverted: bool,
}

/// On which side of an element the index lies that must not be left.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Open {
    Left,
    Right,
}

impl Occurrence<'_> {
    /// Whether it is the inverse that stands there.
    pub(super) fn is_inverse(&self) -> bool {
        let orthogonal = self.rotation || self.configuration.group.structure().is_orthogonal();
        match orthogonal {
            true => self.transposed,
            false => self.inverted && !self.transposed,
        }
    }

    /// Whether it is the element itself.
    pub(super) fn is_plain(&self) -> bool {
        !self.transposed && !self.inverted
    }

    fn open(&self) -> Open {
        let outward = self.transposed == self.inverted;
        match (self.configuration.side, outward) {
            (Side::Body, true) | (Side::Spatial, false) => Open::Left,
            (Side::Body, false) | (Side::Spatial, true) => Open::Right,
        }
    }
}

/// The inclusion of space in homogeneous coordinates, 4 x 3, or its transpose.
fn inclusion(transposed: bool) -> Factor {
    Factor::Inclusion {
        shape: Shape {
            rows: Dim::Fixed(4),
            cols: Dim::Fixed(3),
        },
        at: 0,
        transposed,
    }
}

/// The last unit vector of homogeneous coordinates.
fn last(transposed: bool) -> Factor {
    Factor::Unit {
        dim: Dim::Fixed(4),
        axis: 3,
        transposed,
    }
}

fn motion(at: Letter, transposed: bool, inverted: bool) -> Factor {
    Factor::Letter {
        source: Source::Letter(at),
        transposed,
        inverted,
    }
}

impl<'a> Reducer<'a> {
    /// The element that a factor is.
    pub(super) fn occurrence(&self, f: &Factor) -> Option<Occurrence<'a>> {
        let Factor::Letter {
            source,
            transposed,
            inverted,
        } = f
        else {
            return None;
        };
        let (letter, rotation) = match source {
            Source::Letter(l) => (l, false),
            Source::Rotation(l) => (l, true),
            Source::Opaque(_) | Source::Translation(_) => return None,
        };
        Some(Occurrence {
            configuration: self.configuration(letter.symbol)?,
            rotation,
            transposed: *transposed,
            inverted: *inverted,
        })
    }

    /// For an element: where the index lies that must be absorbed. On the body side `Λ` has it on
    /// its left (space), on the spatial side on its right (the reference).
    pub(super) fn open(&self, f: &Factor) -> Option<Open> {
        self.occurrence(f).map(|o| o.open())
    }

    /// The word with translations of elements by whole motions: `x = ι^T G e`, and on the body side
    /// `R^T x = -ι^T G^-1 e`, with the inclusion `ι` of space and the last unit vector `e`. `true`
    /// for a minus sign.
    pub(super) fn in_motions(&self, word: &[Factor]) -> (bool, Word) {
        let mut minus = false;
        let mut out = Word::with_capacity(word.len());
        let mut rest = word;
        while let Some((f, after)) = rest.split_first() {
            rest = after;
            let Some((at, transposed)) = self.translation(f) else {
                out.push(f.clone());
                continue;
            };
            let side = self.configuration(at.symbol).map(|c| c.side);
            let beside = match transposed {
                false => out.last(),
                true => rest.first(),
            };
            let turned = matches!(beside, Some(Factor::Letter { source: Source::Rotation(l), transposed: t, .. }) if *l == at && *t != transposed);
            let back = turned && side == Some(Side::Body);
            if back {
                minus = !minus;
                match transposed {
                    false => drop(out.pop()),
                    true => rest = &rest[1..],
                }
            }
            let middle = motion(at, transposed, back);
            out.extend(match transposed {
                false => [inclusion(true), middle, last(false)],
                true => [last(true), middle, inclusion(false)],
            });
        }
        (minus, out)
    }

    fn translation(&self, f: &Factor) -> Option<(Letter, bool)> {
        match f {
            Factor::Letter {
                source: Source::Translation(l),
                transposed,
                ..
            } if self.configuration(l.symbol).is_some() => Some((*l, *transposed)),
            _ => None,
        }
    }

    /// Whether a word is a plane seen from a body, `G^T ι z`, of which `R^T z` is a part.
    pub(super) fn is_plane(&self, word: &[Factor]) -> bool {
        matches!(word, [first, second, _, ..] if *second == inclusion(false)
            && self.occurrence(first).is_some_and(|o| o.transposed && !o.inverted && !o.rotation))
    }

    /// For `R^T z`: the plane `G^T ι z` of which it is a part.
    pub(super) fn plane_of(&self, word: &[Factor]) -> Option<Word> {
        let (first, rest) = word.split_first()?;
        let o = self.occurrence(first)?;
        let Factor::Letter {
            source: Source::Rotation(at),
            transposed: true,
            ..
        } = first
        else {
            return None;
        };
        let of_motion = o.configuration.group.is_rigid();
        (of_motion && o.configuration.side == Side::Body)
            .then(|| [&[motion(*at, true, false), inclusion(false)][..], rest].concat())
    }

    /// Whether a factor takes up an index: constants do, inclusions only hand it on.
    pub(super) fn absorbs(&self, f: &Factor) -> bool {
        self.is_constant(f) && !matches!(f, Factor::Inclusion { .. })
    }
}
