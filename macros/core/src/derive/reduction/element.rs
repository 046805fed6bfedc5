//! Elements of the groups as factors of words: the element itself, the rotation of a quaternion or a rigid motion,
//! and the translation of a rigid motion, which is expressed by the whole motion. Takes factors; gives the element of
//! a factor, its mode, and the side that must be absorbed.

use super::terms::Reducer;
use crate::algebra::{Factor, Source, Word, inclusion_of_space, last_unit};
use crate::check::spec::{Configuration, Side};
use crate::expr::Letter;

/// An element at a position in a word.
#[derive(Clone, Copy)]
pub(super) struct Occurrence<'a> {
    pub(super) configuration: &'a Configuration,
    /// Whether the factor is the rotation of the element.
    pub(super) rotation: bool,
    pub(super) transposed: bool,
    pub(super) inverted: bool,
}

/// The side of an element that must be absorbed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Open {
    Left,
    Right,
}

impl Occurrence<'_> {
    /// Whether the factor is the inverse of the element.
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
        match self.configuration.side.is_body() == outward {
            true => Open::Left,
            false => Open::Right,
        }
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
    /// The element of a factor, if it is one.
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

    /// For an element: the side of the index that must be absorbed. On the body side this index of `Λ` is on its left
    /// (space), on the spatial side on its right (the reference).
    pub(super) fn open(&self, f: &Factor) -> Option<Open> {
        self.occurrence(f).map(|o| o.open())
    }

    /// The word with translations of elements expressed by whole motions: `x = ι^T G e`, and on the body side `R^T x
    /// = -ι^T G^-1 e`, with the inclusion `ι` of space and the last unit vector `e`. `true` for a minus sign.
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
            let back = turned && side.is_some_and(Side::is_body);
            if back {
                minus = !minus;
                match transposed {
                    false => drop(out.pop()),
                    true => rest = &rest[1..],
                }
            }
            let middle = motion(at, transposed, back);
            let rows = self.symbols.get(at.symbol).shape.rows;
            let (first, last) = (
                inclusion_of_space(rows, !transposed),
                last_unit(rows, transposed),
            );
            out.extend(match transposed {
                false => [first, middle, last],
                true => [last, middle, first],
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

    /// Whether a word is a plane in the body frame, `G^T ι z`, of which `R^T z` is a part.
    pub(super) fn is_plane(&self, word: &[Factor]) -> bool {
        matches!(word, [first, second, _, ..] if self.occurrence(first).is_some_and(|o| {
            let rows = o.configuration.group.size();
            let plane = o.transposed && !o.inverted && !o.rotation;
            plane && *second == inclusion_of_space(rows, false)
        }))
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
        let of_motion = o.configuration.group.rigid().is_some();
        (of_motion && o.configuration.side.is_body()).then(|| {
            let first = inclusion_of_space(o.configuration.group.size(), false);
            [&[motion(*at, true, false), first][..], rest].concat()
        })
    }

    /// Whether a factor absorbs an index: constants do, inclusions pass it on.
    pub(super) fn absorbs(&self, f: &Factor) -> bool {
        self.is_constant(f) && !matches!(f, Factor::Inclusion { .. })
    }
}
