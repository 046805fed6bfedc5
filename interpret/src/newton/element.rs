//! Velocities of any groups together, as one type for all of them. Every operation is that of the runtime's
//! own group, factor by factor.

use super::bound::{Bound, VARIABLES};
use super::region::Seen;
use super::shape::{Kind, factor_of, factor_of_part, kinds, of_kind};
use crate::dense::Dense;
use crate::value::{Kept, Value};
use clebsch::OfScalars;
use clebsch::groups::{Coordinate, Group, Part};
use clebsch::solvers::newton::Region;
use nalgebra::SMatrix;

/// Most numbers of one element: a matrix of five rows.
const MOST: usize = 25;

/// An element of one group, by its numbers.
#[derive(Clone, Copy, Debug)]
pub struct Factor {
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

    /// The factor with this index.
    pub fn at(&self, i: usize) -> &Factor {
        let last = D.saturating_sub(1);
        &self.factors[i.min(last)]
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

/// What each group does, compiled once.
impl Factor {
    fn compose(&self, other: &Self) -> Self {
        let kind = self.kind;
        of_kind!(
            kind,
            G,
            R,
            K,
            Self::of(kind, &self.get::<G>().compose(&other.get::<G>())),
            *self
        )
    }

    fn inverse(&self) -> Self {
        let kind = self.kind;
        of_kind!(
            kind,
            G,
            R,
            K,
            Self::of(kind, &Group::inverse(&self.get::<G>())),
            *self
        )
    }

    fn retract(&self, xi: &[f64]) -> Self {
        let kind = self.kind;
        of_kind!(
            kind,
            G,
            R,
            K,
            Self::of(kind, &self.get::<G>().retract(xi)),
            *self
        )
    }

    fn retract_from_left(&self, xi: &[f64]) -> Self {
        let kind = self.kind;
        of_kind!(
            kind,
            G,
            R,
            K,
            Self::of(kind, &self.get::<G>().retract_from_left(xi)),
            *self
        )
    }

    fn combined(kind: Kind, weights: &[f64], one: &dyn Fn(usize) -> Self) -> Self {
        let made = |k: usize| one(k);
        of_kind!(
            kind,
            G,
            R,
            K,
            Self::of(kind, &G::combined(weights, |k| made(k).get::<G>())),
            one(0)
        )
    }

    fn distance_from_group(&self) -> f64 {
        of_kind!(
            self.kind,
            G,
            R,
            K,
            self.get::<G>().distance_from_group(),
            0.0
        )
    }

    fn extents(&self, out: &mut [f64]) {
        of_kind!(self.kind, G, R, K, self.get::<G>().extents(out), ());
    }

    fn is_within(&self, reach: &[f64]) -> bool {
        of_kind!(self.kind, G, R, K, self.get::<G>().is_within(reach), false)
    }

    /// All elements near it, as a value.
    pub fn around(&self, radii: &[f64], first: usize) -> Value<Bound> {
        of_kind!(
            self.kind,
            G,
            R,
            K,
            R::<VARIABLES>::around(&self.get::<G>(), radii, first).seen(),
            Value::None
        )
    }
}

impl<const D: usize> Group<f64> for Element<D> {
    const DIMENSION: usize = D;

    // Of those that are not used nothing is ever in one.
    const PARTS: usize = D;

    fn identity() -> Self {
        Self::each(|_, kind| Factor::identity(kind))
    }

    fn compose(&self, other: &Self) -> Self {
        Self::each(|i, _| self.at(i).compose(other.at(i)))
    }

    fn inverse(&self) -> Self {
        Self::each(|i, _| self.at(i).inverse())
    }

    fn retract(&self, xi: &[f64]) -> Self {
        Self::each(|i, _| self.at(i).retract(own_coordinates(xi, i)))
    }

    fn retract_from_left(&self, xi: &[f64]) -> Self {
        Self::each(|i, _| self.at(i).retract_from_left(own_coordinates(xi, i)))
    }

    fn combined(weights: &[f64], element: impl Fn(usize) -> Self) -> Self {
        Self::each(|i, kind| Factor::combined(kind, weights, &|k| *element(k).at(i)))
    }

    fn coordinate(index: usize) -> Coordinate {
        let alone = Coordinate::of(Part::axis(index));
        let Some((factor, kind, own)) = factor_of(index) else {
            return alone;
        };
        kind.coordinate(own).unwrap_or(alone).in_factor(factor)
    }

    fn distance_from_group(&self) -> f64 {
        let each = (0..kinds().len()).map(|i| self.at(i).distance_from_group());
        // NaN is not passed over.
        each.fold(0.0, |most: f64, x| if x <= most { most } else { x })
    }

    fn part_of(index: usize) -> usize {
        let Some((factor, kind, own)) = factor_of(index) else {
            return D.saturating_sub(1);
        };
        let before: usize = kinds().iter().take(factor).map(|k| k.parts()).sum();
        before + kind.part_of(own)
    }

    fn is_pure(part: usize) -> bool {
        factor_of_part(part).is_none_or(|(kind, own)| kind.is_pure(own))
    }

    fn extents(&self, out: &mut [f64]) {
        let mut from = 0;
        for (i, kind) in kinds().iter().enumerate() {
            self.at(i).extents(out.get_mut(from..).unwrap_or_default());
            from += kind.parts();
        }
    }

    fn is_within(&self, reach: &[f64]) -> bool {
        let (mut all, mut from) = (true, 0);
        for (i, kind) in kinds().iter().enumerate() {
            all &= self.at(i).is_within(reach.get(from..).unwrap_or(&[]));
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
