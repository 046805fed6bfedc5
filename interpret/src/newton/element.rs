//! Velocities of any groups together, as one type for all of them. Every operation is that of the runtime's
//! own group, factor by factor.

use super::shape::{Kind, factor_of, factor_of_part, kinds, of_kind};
use crate::dense::Dense;
use crate::value::{Kept, Value};
use clebsch::OfScalars;
use clebsch::groups::{Coordinate, Group, Part};
use nalgebra::SMatrix;

/// Most numbers of one element: a matrix of five rows.
const MOST: usize = 25;

/// An element of one group, by its numbers.
#[derive(Clone, Copy, Debug)]
struct Factor {
    kind: Kind,
    numbers: [f64; MOST],
}

impl Factor {
    fn of<G>(kind: Kind, g: &G) -> Self
    where
        G: OfScalars<Scalar = f64, Over<f64> = G>,
    {
        let (mut numbers, mut at) = ([0.0; MOST], 0);
        let _ = g.over(&mut |x: f64| {
            if let Some(place) = numbers.get_mut(at) {
                *place = x;
            }
            at += 1;
            x
        });
        Factor { kind, numbers }
    }

    fn get<G>(&self) -> G
    where
        G: Group<f64> + OfScalars<Scalar = f64, Over<f64> = G>,
    {
        let mut all = self.numbers.iter();
        G::identity().over(&mut |x: f64| all.next().copied().unwrap_or(x))
    }

    fn identity(kind: Kind) -> Self {
        let none = Factor {
            kind,
            numbers: [0.0; MOST],
        };
        of_kind!(
            kind,
            G,
            R,
            K,
            Self::of(kind, &<G as Group<f64>>::identity()),
            none
        )
    }

    /// The value that emitted code has for it.
    fn value(&self) -> Value<f64> {
        let array = |a| Value::Element(Kept::Field, a);
        let of = |kept, a| Value::Element(kept, a);
        match self.kind {
            Kind::Rotation => Value::Rotation(self.get()),
            Kind::Quaternion => Value::Quaternion(self.get()),
            Kind::Motion => Value::Motion(Box::new(self.get())),
            Kind::Plane => Value::Plane(Box::new(self.get())),
            Kind::Linear(n) => of(Kept::Linear, self.matrix(n, n)),
            Kind::Orthogonal(n) => of(Kept::Orthogonal, self.matrix(n, n)),
            Kind::Field(rows, cols) => array(self.matrix(rows, cols)),
        }
    }

    /// The numbers of a group kept as its matrix are the entries, column after column.
    fn matrix(&self, rows: usize, cols: usize) -> Dense<f64> {
        let data = self.numbers.iter().copied().take(rows * cols).collect();
        Dense { rows, cols, data }
    }

    fn from_value(kind: Kind, value: &Value<f64>) -> Option<Self> {
        Some(match value {
            Value::Rotation(g) => Self::of(kind, g),
            Value::Quaternion(g) => Self::of(kind, g),
            Value::Motion(g) => Self::of(kind, &**g),
            Value::Plane(g) => Self::of(kind, &**g),
            Value::Element(_, a) => {
                let mut numbers = [0.0; MOST];
                for (place, x) in numbers.iter_mut().zip(&a.data) {
                    *place = *x;
                }
                Factor { kind, numbers }
            }
            _ => return None,
        })
    }
}

/// Velocities with `D` coordinates together.
#[derive(Clone, Copy, Debug)]
pub struct Element<const D: usize> {
    factors: [Factor; D],
}

impl<const D: usize> Element<D> {
    /// Every factor by what makes it; unused places hold what is never looked at.
    fn each(make: impl Fn(usize, Kind) -> Factor) -> Self {
        let unused = Factor {
            kind: Kind::Field(0, 0),
            numbers: [0.0; MOST],
        };
        let mut factors = [unused; D];
        for (i, (place, kind)) in factors.iter_mut().zip(kinds()).enumerate() {
            *place = make(i, *kind);
        }
        Element { factors }
    }

    fn at(&self, i: usize) -> &Factor {
        let last = D.saturating_sub(1);
        &self.factors[i.min(last)]
    }

    /// The element of the runtime with this index.
    pub fn factor<G>(&self, i: usize) -> G
    where
        G: Group<f64> + OfScalars<Scalar = f64, Over<f64> = G>,
    {
        self.at(i).get()
    }

    /// As emitted code has it: a list.
    pub fn value(&self) -> Value<f64> {
        let count = kinds().len();
        Value::List(self.factors.iter().take(count).map(Factor::value).collect())
    }

    /// From such a list.
    pub fn from_value(value: &Value<f64>) -> Option<Self> {
        let Value::List(list) = value else {
            return None;
        };
        if list.len() != kinds().len() {
            return None;
        }
        let made = |i: usize, kind| list.get(i).and_then(|v| Factor::from_value(kind, v));
        let all: Option<Vec<Factor>> = kinds()
            .iter()
            .enumerate()
            .map(|(i, kind)| made(i, *kind))
            .collect();
        let all = all?;
        Some(Self::each(|i, kind| {
            all.get(i)
                .copied()
                .unwrap_or_else(|| Factor::identity(kind))
        }))
    }
}

/// The same coordinates, each factor with its own.
fn own_coordinates(xi: &[f64], i: usize) -> &[f64] {
    let before: usize = kinds().iter().take(i).filter_map(|k| k.dimension()).sum();
    let own = kinds().get(i).and_then(|k| k.dimension()).unwrap_or(0);
    let from = before.min(xi.len());
    xi.get(from..(from + own).min(xi.len())).unwrap_or(&[])
}

impl<const D: usize> Group<f64> for Element<D> {
    const DIMENSION: usize = D;

    // Of those that are not used nothing is ever in one.
    const PARTS: usize = D;

    fn identity() -> Self {
        Self::each(|_, kind| Factor::identity(kind))
    }

    fn compose(&self, other: &Self) -> Self {
        Self::each(|i, kind| {
            let (a, b) = (self.at(i), other.at(i));
            of_kind!(
                kind,
                G,
                R,
                K,
                Factor::of(kind, &a.get::<G>().compose(&b.get::<G>())),
                *a
            )
        })
    }

    fn inverse(&self) -> Self {
        Self::each(|i, kind| {
            let a = self.at(i);
            of_kind!(
                kind,
                G,
                R,
                K,
                Factor::of(kind, &Group::inverse(&a.get::<G>())),
                *a
            )
        })
    }

    fn retract(&self, xi: &[f64]) -> Self {
        Self::each(|i, kind| {
            let (a, own) = (self.at(i), own_coordinates(xi, i));
            of_kind!(
                kind,
                G,
                R,
                K,
                Factor::of(kind, &a.get::<G>().retract(own)),
                *a
            )
        })
    }

    fn retract_from_left(&self, xi: &[f64]) -> Self {
        Self::each(|i, kind| {
            let (a, own) = (self.at(i), own_coordinates(xi, i));
            of_kind!(
                kind,
                G,
                R,
                K,
                Factor::of(kind, &a.get::<G>().retract_from_left(own)),
                *a
            )
        })
    }

    fn combined(weights: &[f64], element: impl Fn(usize) -> Self) -> Self {
        Self::each(|i, kind| {
            let one = |k: usize| *element(k).at(i);
            of_kind!(
                kind,
                G,
                R,
                K,
                Factor::of(kind, &G::combined(weights, |k| one(k).get::<G>())),
                one(0)
            )
        })
    }

    fn coordinate(index: usize) -> Coordinate {
        let alone = Coordinate::of(Part::axis(index));
        let Some((factor, kind, own)) = factor_of(index) else {
            return alone;
        };
        let own = of_kind!(kind, G, R, K, <G as Group<f64>>::coordinate(own), alone);
        own.in_factor(factor)
    }

    fn distance_from_group(&self) -> f64 {
        let each = kinds().iter().enumerate().map(|(i, kind)| {
            let a = self.at(i);
            of_kind!(*kind, G, R, K, a.get::<G>().distance_from_group(), 0.0)
        });
        // NaN is not passed over.
        each.fold(0.0, |most: f64, x| if x <= most { most } else { x })
    }

    fn part_of(index: usize) -> usize {
        let Some((factor, kind, own)) = factor_of(index) else {
            return D.saturating_sub(1);
        };
        let before: usize = kinds().iter().take(factor).map(|k| k.parts()).sum();
        before + of_kind!(kind, G, R, K, <G as Group<f64>>::part_of(own), 0)
    }

    fn is_pure(part: usize) -> bool {
        factor_of_part(part).is_none_or(|(kind, own)| {
            of_kind!(kind, G, R, K, <G as Group<f64>>::is_pure(own), true)
        })
    }

    fn extents(&self, out: &mut [f64]) {
        let mut from = 0;
        for (i, kind) in kinds().iter().enumerate() {
            let own = out.get_mut(from..).unwrap_or_default();
            let a = self.at(i);
            of_kind!(*kind, G, R, K, a.get::<G>().extents(own), ());
            from += kind.parts();
        }
    }

    fn is_within(&self, reach: &[f64]) -> bool {
        let (mut all, mut from) = (true, 0);
        for (i, kind) in kinds().iter().enumerate() {
            let own = reach.get(from..).unwrap_or(&[]);
            let a = self.at(i);
            all &= of_kind!(*kind, G, R, K, a.get::<G>().is_within(own), false);
            from += kind.parts();
        }
        all
    }
}

/// A vector of so many coordinates.
pub fn vector<const D: usize>(value: &Value<f64>) -> Option<SMatrix<f64, D, 1>> {
    let a = match value {
        Value::Real(x) => return Some(SMatrix::repeat(*x)).filter(|_| D == 1),
        other => other.dense()?,
    };
    (a.rows >= D && a.cols == 1).then(|| a.fixed())
}

/// A matrix of so many rows and columns.
pub fn matrix<T: clebsch::Real, const D: usize>(value: &Value<T>) -> Option<SMatrix<T, D, D>> {
    let a = value.dense()?;
    (a.rows >= D && a.cols >= D).then(|| a.fixed())
}
