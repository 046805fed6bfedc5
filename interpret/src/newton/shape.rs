//! The groups of the velocities that a search solves for. An element is the concatenation of all their numbers.

use super::kind::{Kind, moved, read, write};
use crate::value::Value;
use clebsch::groups::{Coordinate, Part};
use clebsch::linalg::Reals;
use clebsch::solvers::newton::{Chart, Parts};
use clebsch::{Real, RigidMotion};

/// The groups of the velocities that are found together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shape {
    /// The groups, in order.
    kinds: Vec<Kind>,
    /// The number of numbers in an element of each group.
    counts: Vec<usize>,
    parts: Parts,
}

impl Shape {
    /// The shape of these groups.
    pub fn new(kinds: Vec<Kind>) -> Self {
        let mut parts = Parts {
            of: Vec::new(),
            pure: Vec::new(),
            open: Vec::new(),
        };
        for kind in &kinds {
            let before = parts.pure.len();
            let own = (0..kind.dimension()).map(|i| before + kind.part_of(i));
            parts.of.extend(own);
            let all = 0..kind.parts();
            parts.pure.extend(all.clone().map(|i| kind.is_pure(i)));
            parts.open.extend(all.map(|_| kind.is_open()));
        }
        Shape {
            counts: kinds.iter().map(|kind| kind.count()).collect(),
            kinds,
            parts,
        }
    }

    /// How many numbers an element has.
    pub fn count(&self) -> usize {
        self.counts.iter().sum()
    }

    /// The indices of the coordinates of this shape among all coordinates of `whole`.
    pub fn within(&self, whole: &Shape) -> Vec<usize> {
        let (mut first, mut all) = (0, Vec::new());
        for (own, kind) in self.kinds.iter().zip(&whole.kinds) {
            all.extend(first..first + own.dimension());
            first += kind.dimension();
        }
        all
    }

    /// An element as values, one value per group.
    pub fn value(&self, element: &[f64]) -> Value<f64> {
        let each = self.split(element);
        Value::List(each.map(|(kind, own)| kind.value(own)).collect())
    }

    /// The unknown part of an element as values, for any scalar.
    pub fn part_of<T: Real>(&self, whole: &[Value<T>]) -> Vec<Value<T>> {
        let pairs = self.kinds.iter().zip(whole);
        pairs
            .map(|(kind, value)| match (kind, value) {
                (Kind::Rotation, Value::Motion(g)) => Value::Rotation(g.rotation),
                _ => value.clone(),
            })
            .collect()
    }

    /// Elements moved by coordinates, for any scalar. Returns nothing for values of other groups.
    pub fn moved<T: Real>(
        &self,
        elements: &[Value<T>],
        xi: &[T],
        from_left: bool,
    ) -> Option<Vec<Value<T>>> {
        let mut rest = xi;
        let pairs = self.kinds.iter().zip(elements);
        let each = pairs.map(|(kind, element)| {
            let (own, others) = rest.split_at_checked(kind.dimension())?;
            rest = others;
            moved(element, own, from_left)
        });
        each.collect()
    }

    /// The numbers of each group.
    fn split<'a>(&'a self, element: &'a [f64]) -> impl Iterator<Item = (Kind, &'a [f64])> {
        each(self.kinds.iter().zip(&self.counts), element)
    }

    /// The coordinates of each group.
    fn coordinates<'a>(&'a self, xi: &'a [f64]) -> impl Iterator<Item = &'a [f64]> {
        let sizes = self.kinds.iter().map(|kind| kind.dimension());
        let mut rest = xi;
        sizes.map(move |size| cut(&mut rest, size))
    }

    /// The lengths of each group.
    fn lengths<'a>(&'a self, radii: &'a [f64]) -> impl Iterator<Item = &'a [f64]> {
        let mut rest = radii;
        self.kinds
            .iter()
            .map(move |kind| cut(&mut rest, kind.parts()))
    }

    /// Calls `done` with the numbers and the results of each group.
    fn with_each<R>(
        &self,
        of: &[f64],
        out: &mut [R],
        mut done: impl FnMut(Kind, &[f64], &mut [R]),
    ) {
        let mut rest = out;
        for (kind, own) in self.split(of) {
            let (results, others) = rest.split_at_mut(kind.parts().min(rest.len()));
            done(kind, own, results);
            rest = others;
        }
    }
}

/// Splits a list after the given count.
fn cut<'a>(rest: &mut &'a [f64], count: usize) -> &'a [f64] {
    let (own, others) = rest.split_at(count.min(rest.len()));
    *rest = others;
    own
}

fn each<'a>(
    kinds: impl Iterator<Item = (&'a Kind, &'a usize)>,
    element: &'a [f64],
) -> impl Iterator<Item = (Kind, &'a [f64])> {
    let mut rest = element;
    kinds.map(move |(kind, count)| (*kind, cut(&mut rest, *count)))
}

impl Chart for Shape {
    type Element = Reals;

    fn parts(&self) -> &Parts {
        &self.parts
    }

    fn part(&self, of: &Self, whole: &Reals) -> Reals {
        let mut part = Reals::with_capacity(self.count());
        for (kind, (whole, own)) in self.kinds.iter().zip(of.split(whole)) {
            match (kind, whole) {
                (Kind::Rotation, Kind::Motion) => {
                    write(&read::<RigidMotion<f64>>(own).rotation, &mut part);
                }
                _ => part.extend_from_slice(own),
            }
        }
        part
    }

    fn coordinate(&self, index: usize) -> Coordinate {
        let mut rest = index;
        for (i, kind) in self.kinds.iter().enumerate() {
            if rest < kind.dimension() {
                return kind.coordinate(rest).in_factor(i);
            }
            rest -= kind.dimension();
        }
        Coordinate::of(Part::axis(index))
    }

    fn identity(&self) -> Reals {
        let mut out = Reals::with_capacity(self.count());
        self.kinds.iter().for_each(|kind| kind.identity(&mut out));
        out
    }

    fn retract(&self, at: &Reals, xi: &[f64], out: &mut Reals) {
        out.clear();
        for ((kind, own), xi) in self.split(at).zip(self.coordinates(xi)) {
            kind.retract(own, xi, out);
        }
    }

    fn retract_from_left(&self, at: &Reals, xi: &[f64], out: &mut Reals) {
        out.clear();
        for ((kind, own), xi) in self.split(at).zip(self.coordinates(xi)) {
            kind.retract_from_left(own, xi, out);
        }
    }

    fn combined(&self, weights: &[f64], past: &[Reals], out: &mut Reals) {
        out.clear();
        let mut first = 0;
        for (kind, count) in self.kinds.iter().zip(&self.counts) {
            let own = |i: usize| {
                let all = past.get(i).map_or(&[][..], Reals::as_slice);
                all.get(first..first + count).unwrap_or_default()
            };
            kind.combined(weights, &own, out);
            first += count;
        }
    }

    fn between(&self, from: &Reals, to: &Reals) -> Reals {
        let mut out = Reals::with_capacity(to.len());
        for ((kind, from), (_, to)) in self.split(from).zip(self.split(to)) {
            kind.between(from, to, &mut out);
        }
        out
    }

    fn compared(&self, of: &Reals, xi: &[f64], out: &mut [[f64; 2]]) {
        let mut coordinates = self.coordinates(xi);
        self.with_each(of, out, |kind, own, results| {
            kind.compared(own, coordinates.next().unwrap_or_default(), results);
        });
    }

    fn is_within(&self, of: &Reals, reach: &[f64]) -> bool {
        let all = self.split(of).zip(self.lengths(reach));
        all.fold(true, |all, ((kind, own), reach)| {
            all & kind.is_within(own, reach)
        })
    }
}
