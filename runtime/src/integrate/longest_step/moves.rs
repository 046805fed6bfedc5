//! What moves of a model: configurations with their momenta, disturbed and compared.
//! Takes initial values and observations in the order of a card; gives small changes of configurations as lists.

use crate::Rotation;
use crate::card::{Card, Field, Kind};
use crate::groups::so3::hamilton;
use crate::scalar::largest;
use nalgebra::{Matrix3, Vector3};
use std::ops::Range;

/// A configuration and its momentum among the initial values and among what is observed.
pub(super) struct Moves {
    pub(super) initial: usize,
    pub(super) behind: usize,
    pub(super) kind: Kind,
    pub(super) spatial: bool,
    pub(super) place: Range<usize>,
    pub(super) momentum: Range<usize>,
}

impl Moves {
    /// All of a card; `None` where one is of another kind.
    pub(super) fn all(card: &Card) -> Option<Vec<Self>> {
        let places = card.initial.iter().enumerate();
        let places = places.filter(|(_, place)| !is_momentum(place));
        places
            .map(|(at, place)| Self::of(card, at, place))
            .collect()
    }

    fn of(card: &Card, at: usize, place: &Field) -> Option<Self> {
        let behind = momentum_of(card, place)?;
        let momentum = card.initial.get(behind)?;
        let known = match (place.kind, momentum.kind) {
            (_, Kind::FieldMomentum) => place.count() == momentum.count(),
            (Kind::Rotation | Kind::UnitQuaternion, Kind::BodyMomentum | Kind::SpatialMomentum) => {
                momentum.count() == 3
            }
            _ => false,
        };
        let own = Self {
            initial: at,
            behind,
            kind: match momentum.kind {
                Kind::FieldMomentum => Kind::FieldMomentum,
                _ => place.kind,
            },
            spatial: momentum.kind == Kind::SpatialMomentum,
            place: columns(card, place)?,
            momentum: columns(card, momentum)?,
        };
        known.then_some(own)
    }

    /// Its freedoms.
    pub(super) fn count(&self) -> usize {
        self.momentum.len()
    }
}

fn is_momentum(field: &Field) -> bool {
    matches!(
        field.kind,
        Kind::BodyMomentum | Kind::SpatialMomentum | Kind::FieldMomentum
    )
}

/// Which initial value is the momentum of a configuration: that with its name, or the only one.
fn momentum_of(card: &Card, place: &Field) -> Option<usize> {
    let behind = format!("momentum_{}", place.ascii);
    let mut all = card
        .initial
        .iter()
        .enumerate()
        .filter(|(_, f)| is_momentum(f));
    let named = all.clone().find(|(_, f)| f.ascii.ends_with(&behind));
    let (at, _) = named.or_else(|| all.next().filter(|_| card.initial.len() == 2))?;
    Some(at)
}

/// The columns of an initial value among the observables.
fn columns(card: &Card, wanted: &Field) -> Option<Range<usize>> {
    let mut from = 0;
    for field in card.observables {
        let own = from..from + field.count();
        if field.ascii == wanted.ascii {
            return (own.len() == wanted.count()).then_some(own);
        }
        from = own.end;
    }
    None
}

/// Of an angle one; of a field how far its values at all sites lie apart, if they do not the size of its values, at most one.
pub(super) fn units(moves: &[Moves], initial: &[Vec<f64>]) -> Vec<f64> {
    let fields = moves.iter().filter(|m| m.kind == Kind::FieldMomentum);
    let all = fields.flat_map(|m| initial.get(m.initial).into_iter().flatten());
    let all: Vec<f64> = all.copied().collect();
    let first = all.first().copied().unwrap_or(0.0);
    let apart = largest(all.iter().map(|x| x - first));
    let sizes = [apart, largest(all.iter().copied()).min(1.0), 1.0];
    let unit = sizes.into_iter().find(|x| *x > 0.0).unwrap_or(1.0);
    let each = moves.iter().flat_map(|m| {
        let own = if m.kind == Kind::FieldMomentum {
            unit
        } else {
            1.0
        };
        vec![own; m.count()]
    });
    each.collect()
}

/// Moves a configuration by a small change: added to a field, a turn in the frame of the momentum for an attitude.
pub(super) fn disturb(value: &mut Vec<f64>, body: &Moves, by: &[f64]) -> Option<()> {
    let turn = || Rotation::exp(&Vector3::new(by[0], by[1], by[2]));
    match body.kind {
        Kind::FieldMomentum => value.iter_mut().zip(by).for_each(|(x, by)| *x += by),
        Kind::Rotation => {
            let own = Matrix3::from_row_slice(value.get(..9)?);
            let turn = turn().matrix();
            let next = if body.spatial { turn * own } else { own * turn };
            *value = next.transpose().as_slice().to_vec();
        }
        _ => {
            let [a, b] = [value.as_slice().try_into().ok()?, turn().quaternion()];
            let next = if body.spatial {
                hamilton(b, a)
            } else {
                hamilton(a, b)
            };
            *value = next.to_vec();
        }
    }
    Some(())
}

/// The small change between two configurations.
pub(super) fn difference(body: &Moves, a: &[f64], b: &[f64]) -> Vec<f64> {
    match body.kind {
        Kind::FieldMomentum => a.iter().zip(b).map(|(a, b)| b - a).collect(),
        Kind::Rotation => {
            let [a, b] = [a, b].map(Matrix3::from_row_slice);
            let turn = if body.spatial {
                b * a.transpose()
            } else {
                a.transpose() * b
            };
            let half = |i: usize, j: usize| 0.5 * (turn[(i, j)] - turn[(j, i)]);
            vec![half(2, 1), half(0, 2), half(1, 0)]
        }
        _ => {
            let of = |q: &[f64]| [q[0], q[1], q[2], q[3]];
            let (a, b) = (of(a), of(b));
            let back = [a[0], -a[1], -a[2], -a[3]];
            let turn = if body.spatial {
                hamilton(b, back)
            } else {
                hamilton(back, b)
            };
            turn[1..].iter().map(|x| 2.0 * x).collect()
        }
    }
}
