//! Sums over sites: each summand under the name of its sum, with at most one change.

use super::change::Change;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::{NamedValue, Source};
use clebsch_oracle::oracle::square::Square;
use std::array::from_fn;

/// The type of a configuration at a site.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    Rotation,
    /// A rotation with spatial velocity.
    Spatial,
    Vector(usize),
    Number,
}

impl Kind {
    /// The number of entries.
    pub fn entries(self) -> usize {
        match self {
            Kind::Rotation | Kind::Spatial => 9,
            Kind::Vector(n) => n,
            Kind::Number => 1,
        }
    }

    /// The number of directions of variation.
    pub fn directions(self) -> usize {
        match self {
            Kind::Rotation | Kind::Spatial => 3,
            Kind::Vector(n) => n,
            Kind::Number => 1,
        }
    }
}

/// A configuration at a site: the name of its copy, and the index of its first entry.
#[derive(Clone, Debug)]
pub struct Body {
    pub name: String,
    pub kind: Kind,
    pub at: usize,
}

/// All configurations, concatenated.
#[derive(Clone, Default, Debug)]
pub struct Bodies(pub Vec<Body>);

impl Bodies {
    /// Appends a configuration and returns the index of its first entry.
    pub fn add(&mut self, name: &str, site: Option<usize>, kind: Kind) -> usize {
        let at = self.entries();
        let name = match site {
            Some(site) => format!("{name}_{site}"),
            None => name.to_owned(),
        };
        self.0.push(Body { name, kind, at });
        at
    }

    pub fn entries(&self) -> usize {
        self.0.last().map_or(0, |b| b.at + b.kind.entries())
    }
}

/// A model with a hand-written action of one step.
pub trait Typed {
    fn bodies(&self) -> &Bodies;

    /// Random rotations, and random positions and numbers in (-1, 1).
    fn draw(&self, source: &mut Source) -> Vec<f64> {
        let mut drawn = |body: &Body| match body.kind {
            Kind::Rotation | Kind::Spatial => source.orthogonal::<3>().0.concat(),
            kind => (0..kind.entries())
                .map(|_| source.between(-1.0, 1.0))
                .collect(),
        };
        self.bodies().0.iter().flat_map(&mut drawn).collect()
    }

    /// Values of parameters and of the step size.
    fn parameters(&self) -> Vec<NamedValue>;

    /// Values of advected quantities at this time level.
    fn advected(&self, _shift: i8, _x: &[f64]) -> Vec<NamedValue> {
        Vec::new()
    }

    /// The summands of the action of one step.
    fn action<T: Number>(&self, tail: &[T], head: &[T], sum: &mut Sum<T>);
}

/// The summands of an action.
pub struct Sum<T> {
    pub summands: Vec<T>,
    /// The names of the sums, in order.
    pub sums: Vec<&'static str>,
    change: Change,
}

impl<T: Number> Sum<T> {
    pub fn new(change: Change) -> Self {
        Sum {
            summands: Vec::new(),
            sums: Vec::new(),
            change,
        }
    }

    /// The sites `from .. to` of the sum with this name.
    pub fn over(&mut self, sum: &'static str, from: usize, to: usize) -> Vec<isize> {
        let number = |n: usize| isize::try_from(n).unwrap();
        let (mut from, mut to) = (number(from), number(to));
        if let Change::Range(which, first, last) = self.change
            && which == self.sums.len()
        {
            from += first;
            to += last;
        }
        self.sums.push(sum);
        (from..to).collect()
    }

    /// A summand of the edge.
    pub fn edge(&mut self, value: T) {
        let flipped = self.change == Change::Sign(self.summands.len());
        self.summands.push(if flipped { -value } else { value });
    }

    /// A nodal summand: half at either end of the edge.
    pub fn node(&mut self, at_tail: T, at_head: T) {
        self.edge((at_tail + at_head) * T::constant(0.5));
    }
}

/// The index of a site in a ring of `count` sites. On an open chain it equals the site, unless a range was changed.
pub fn around(site: isize, count: usize) -> usize {
    usize::try_from(site.rem_euclid(isize::try_from(count).unwrap())).unwrap()
}

pub fn number<T: Number>(value: f64) -> T {
    T::constant(value)
}

pub fn turn<T: Number>(x: &[T], at: usize) -> Square<T, 3> {
    Square::from_entries(|i, j| x[at + 3 * i + j])
}

pub fn column<T: Number, const N: usize>(x: &[T], at: usize) -> [T; N] {
    from_fn(|i| x[at + i])
}

pub fn fixed<T: Number, const N: usize>(v: &[f64; N]) -> [T; N] {
    from_fn(|i| T::constant(v[i]))
}

pub fn minus<T: Number, const N: usize>(a: &[T; N], b: &[T; N]) -> [T; N] {
    from_fn(|i| a[i] - b[i])
}
