//! The configurations of a model with their momenta: disturbs and compares them.
//! Takes initial values and observations in the order of a card; gives small changes of configurations as lists.

use crate::Rotation;
use crate::card::{Card, Field, Kind};
use crate::groups::so3::hamilton;
use crate::scalar::largest;
use nalgebra::{DMatrix, DVector, Vector3};
use std::ops::Range;

/// A configuration and its momentum among the initial values and among the observables.
pub(super) struct Moves {
    pub(super) initial: usize,
    pub(super) behind: usize,
    pub(super) kind: Kind,
    pub(super) spatial: bool,
    pub(super) place: Range<usize>,
    pub(super) momentum: Range<usize>,
    /// The entries of the momentum that are degrees of freedom; for a skew matrix, the entries below its diagonal.
    freedoms: Vec<usize>,
    /// Rows of the momentum of a rotation that is not one of space: a skew matrix.
    skew: Option<usize>,
}

impl Moves {
    /// All configurations of a card; `None` if a configuration is of an unsupported kind.
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
        let is_rotation = place.kind == Kind::Rotation && momentum.kind != Kind::FieldMomentum;
        let skew = (is_rotation && place.count() == momentum.count()).then_some(place.rows);
        let known = match (place.kind, momentum.kind) {
            (_, Kind::FieldMomentum) => place.count() == momentum.count(),
            (Kind::Rotation, Kind::BodyMomentum | Kind::SpatialMomentum) => {
                skew.is_some() || matches!((place.count(), momentum.count()), (9, 3) | (4, 1))
            }
            (Kind::UnitQuaternion, Kind::BodyMomentum | Kind::SpatialMomentum) => {
                momentum.count() == 3
            }
            (Kind::RigidMotion, Kind::BodyMomentum | Kind::SpatialMomentum) => {
                matches!((place.count(), momentum.count()), (16, 6) | (9, 3))
            }
            // Linear maps, with a momentum of their shape.
            (_, Kind::BodyMomentum | Kind::SpatialMomentum) => {
                place.rows == place.cols && place.count() == momentum.count()
            }
            _ => false,
        };
        let own = Self {
            initial: at,
            behind,
            kind: match momentum.kind {
                Kind::FieldMomentum => Kind::FieldMomentum,
                _ => match place.kind {
                    Kind::Rotation | Kind::UnitQuaternion | Kind::RigidMotion => place.kind,
                    _ => Kind::Matrix,
                },
            },
            spatial: momentum.kind == Kind::SpatialMomentum,
            place: columns(card, place)?,
            momentum: columns(card, momentum)?,
            freedoms: match skew {
                Some(n) => below_diagonal(n).map(|(i, j)| n * i + j).collect(),
                None => (0..momentum.count()).collect(),
            },
            skew,
        };
        known.then_some(own)
    }

    /// Its freedoms.
    pub(super) fn count(&self) -> usize {
        self.freedoms.len()
    }

    /// The degrees of freedom of its momentum among the observables.
    pub(super) fn momenta<'o>(&'o self, observed: &'o [f64]) -> impl Iterator<Item = f64> + 'o {
        let own = &observed[self.momentum.clone()];
        self.freedoms.iter().map(|k| own[*k])
    }

    /// The degrees of freedom of its momentum in a state.
    pub(super) fn given<'o>(&'o self, state: &'o [Vec<f64>]) -> impl Iterator<Item = f64> + 'o {
        let own = &state[self.behind];
        self.freedoms.iter().map(|k| own[*k])
    }

    /// The momentum with these degrees of freedom, in the form of an initial value.
    pub(super) fn momentum_with(&self, freedoms: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut all = vec![0.0; self.momentum.len()];
        for (k, x) in self.freedoms.iter().zip(freedoms) {
            all[*k] = x;
            if let Some(n) = self.skew {
                all[n * (k % n) + k / n] = -x;
            }
        }
        all
    }
}

/// Rows and columns of the entries below the diagonal of a matrix.
fn below_diagonal(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(|i| (0..i).map(move |j| (i, j)))
}

fn is_momentum(field: &Field) -> bool {
    matches!(
        field.kind,
        Kind::BodyMomentum | Kind::SpatialMomentum | Kind::FieldMomentum
    )
}

/// Which initial value is the momentum of a configuration: the one with its name, or the only one.
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

/// The unit of disturbances of each degree of freedom: one for angles and linear maps. The unit for fields and
/// translations is the largest distance between their values at all sites or, if that is zero, the largest value, at
/// most one.
pub(super) fn units(moves: &[Moves], initial: &[Vec<f64>]) -> Vec<f64> {
    let places = moves.iter().filter_map(|m| {
        let value = initial.get(m.initial)?;
        match m.kind {
            Kind::FieldMomentum => Some(value.clone()),
            Kind::RigidMotion => Some(rigid(value).1.as_slice().to_vec()),
            _ => None,
        }
    });
    let all: Vec<f64> = places.flatten().collect();
    let first = all.first().copied().unwrap_or(0.0);
    let apart = largest(all.iter().map(|x| x - first));
    let sizes = [apart, largest(all.iter().copied()).min(1.0), 1.0];
    let unit = sizes.into_iter().find(|x| *x > 0.0).unwrap_or(1.0);
    let each = moves.iter().flat_map(|m| {
        let own = |i: usize| match m.kind {
            Kind::FieldMomentum => unit,
            Kind::RigidMotion if i >= angles(m.count()) => unit,
            _ => 1.0,
        };
        (0..m.count()).map(own).collect::<Vec<f64>>()
    });
    each.collect()
}

/// The number of angles among the components of a rigid motion's velocity, in the plane or in space.
fn angles(count: usize) -> usize {
    match count {
        3 => 1,
        _ => 3,
    }
}

/// Attitude and position of a rigid motion, from its homogeneous matrix, row-major.
fn rigid(value: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
    let all = square(value);
    let n = all.nrows();
    let attitude = all.view((0, 0), (n - 1, n - 1)).into_owned();
    let place = all.view((0, n - 1), (n - 1, 1)).column(0).into_owned();
    (attitude, place)
}

/// The small rotation by an angle in the plane, by three angles about the axes of space, or by an angle for each
/// plane of two axes. If `is_whole` is false, it is the skew matrix of the rotation, its first-order term.
fn turn_by(angles: &[f64], is_whole: bool) -> DMatrix<f64> {
    match *angles {
        [angle] if is_whole => {
            let (sin, cos) = angle.sin_cos();
            DMatrix::from_row_slice(2, 2, &[cos, -sin, sin, cos])
        }
        [a, b, c] => {
            let about = Vector3::new(a, b, c);
            let turn = match is_whole {
                true => Rotation::exp(&about).matrix(),
                false => about.cross_matrix(),
            };
            DMatrix::from_row_slice(3, 3, turn.transpose().as_slice())
        }
        _ => {
            let n = (8 * angles.len() + 1).isqrt().div_ceil(2);
            let mut rate = DMatrix::zeros(n, n);
            for ((i, j), angle) in below_diagonal(n).zip(angles) {
                rate[(i, j)] = *angle;
                rate[(j, i)] = -angle;
            }
            match is_whole {
                // Cayley's transform is a rotation, by these angles to second order.
                true => {
                    let (one, half) = (DMatrix::identity(n, n), rate * 0.5);
                    let back = (&one - &half).try_inverse();
                    back.map_or(one.clone(), |back| back * (one + half))
                }
                false => rate,
            }
        }
    }
}

/// An attitude, of the plane or of space, turned by small angles in the frame of the momentum.
fn turned(attitude: DMatrix<f64>, spatial: bool, angles: &[f64]) -> DMatrix<f64> {
    let turn = turn_by(angles, true);
    match spatial {
        true => turn * attitude,
        false => attitude * turn,
    }
}

/// The small angles from one attitude to another.
fn turn_between(from: &DMatrix<f64>, to: &DMatrix<f64>, spatial: bool) -> Vec<f64> {
    let turn = match spatial {
        true => to * from.transpose(),
        false => from.transpose() * to,
    };
    let half = |i: usize, j: usize| 0.5 * (turn[(i, j)] - turn[(j, i)]);
    match turn.nrows() {
        3 => vec![half(2, 1), half(0, 2), half(1, 0)],
        n => below_diagonal(n).map(|(i, j)| half(i, j)).collect(),
    }
}

/// The square matrix of these numbers, row-major.
fn square(numbers: &[f64]) -> DMatrix<f64> {
    let n = numbers.len().isqrt();
    DMatrix::from_row_slice(n, n, numbers)
}

/// The numbers of a matrix, row-major.
fn row_major(matrix: &DMatrix<f64>) -> Vec<f64> {
    matrix.transpose().as_slice().to_vec()
}

/// A rigid motion moved by a small velocity, angular then linear, in the frame of the momentum.
fn rigid_moved(value: &[f64], spatial: bool, by: &[f64]) -> Vec<f64> {
    let (attitude, place) = rigid(value);
    let (turn, along) = by.split_at(angles(by.len()));
    let along = DVector::from_column_slice(along);
    let moved = match spatial {
        true => turn_by(turn, false) * &place + &place + along,
        false => &attitude * along + place,
    };
    let next = turned(attitude, spatial, turn);
    let n = moved.len();
    let mut all = DMatrix::identity(n + 1, n + 1);
    all.view_mut((0, 0), (n, n)).copy_from(&next);
    all.view_mut((0, n), (n, 1)).copy_from(&moved);
    row_major(&all)
}

/// The small velocity from one rigid motion to another.
fn rigid_difference(a: &[f64], b: &[f64], spatial: bool) -> Vec<f64> {
    let ((from, here), (to, there)) = (rigid(a), rigid(b));
    let mut all = turn_between(&from, &to, spatial);
    let moved = there - &here;
    let along = match spatial {
        true => moved - turn_by(&all, false) * here,
        false => from.tr_mul(&moved),
    };
    all.extend_from_slice(along.as_slice());
    all
}

/// Moves a configuration by a small change: a sum for a field, a rotation in the frame of the momentum for an
/// attitude.
pub(super) fn disturb(value: &mut Vec<f64>, body: &Moves, by: &[f64]) -> Option<()> {
    match body.kind {
        Kind::FieldMomentum => value.iter_mut().zip(by).for_each(|(x, by)| *x += by),
        Kind::Rotation => *value = row_major(&turned(square(value), body.spatial, by)),
        Kind::RigidMotion => *value = rigid_moved(value, body.spatial, by),
        Kind::Matrix => {
            let [own, by] = [value.as_slice(), by].map(square);
            let change = if body.spatial { by * &own } else { &own * by };
            *value = row_major(&(own + change));
        }
        _ => {
            let turn = Rotation::exp(&Vector3::new(by[0], by[1], by[2]));
            let [a, b] = [value.as_slice().try_into().ok()?, turn.quaternion()];
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
        Kind::Rotation => turn_between(&square(a), &square(b), body.spatial),
        Kind::RigidMotion => rigid_difference(a, b, body.spatial),
        Kind::Matrix => {
            let [a, b] = [a, b].map(square);
            let moved = b - &a;
            let Some(inverse) = a.try_inverse() else {
                return vec![f64::NAN; moved.len()];
            };
            row_major(&match body.spatial {
                true => moved * inverse,
                false => inverse * moved,
            })
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
