//! The curve to the principal root as what follows it sees it: the equations of one lane, of any group and
//! any number of unknowns. What follows it is compiled once, not for every group and size.
//! Takes a chart of a group and the equations; gives residuals, tangents and bounds of them.

use crate::groups::Coordinate;
use crate::linalg::Dense;
use crate::scalar::{Affine, Bounded, UNIT, spread_of_product, swing_of};
use crate::solvers::newton::node::Spread;
use core::cell::RefCell;
use core::fmt::Debug;

/// The coordinates of a velocity and the parts that they belong to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parts {
    /// The part of each coordinate.
    pub of: Vec<usize>,
    /// Whether the coordinates of each part are pure numbers.
    pub pure: Vec<bool>,
}

impl Parts {
    /// How many coordinates there are.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.of.len()
    }

    /// How many parts.
    #[must_use]
    pub fn count(&self) -> usize {
        self.pure.len()
    }

    /// The part that a coordinate belongs to.
    #[must_use]
    pub fn part_of(&self, coordinate: usize) -> usize {
        self.of.get(coordinate).copied().unwrap_or(0)
    }

    /// The coordinates of a part.
    pub(super) fn own(&self, part: usize) -> impl Iterator<Item = usize> {
        (0..self.of.len()).filter(move |i| self.part_of(*i) == part)
    }

    /// The lengths of the parts.
    pub(super) fn lengths(&self, x: &[f64]) -> Vec<f64> {
        let mut squares = vec![0.0; self.count()];
        for (part, x) in self.of.iter().zip(x) {
            if let Some(square) = squares.get_mut(*part) {
                *square += x * x;
            }
        }
        squares.iter().map(|x| x.sqrt()).collect()
    }
}

/// A group by what a value says of it, as [`Group`](crate::groups::Group) says it by a type.
pub trait Chart {
    /// Its elements.
    type Element: Clone + Debug;

    /// Its coordinates.
    fn parts(&self) -> &Parts;

    /// The part of an element that is searched for, where the rest follows from it.
    fn part(&self, whole: &Self::Element) -> Self::Element;

    /// What a coordinate stands for.
    fn coordinate(&self, index: usize) -> Coordinate;

    /// The neutral element.
    fn identity(&self) -> Self::Element;

    /// See [`Group::retract`](crate::groups::Group::retract).
    fn retract(&self, at: &Self::Element, xi: &[f64]) -> Self::Element;

    /// See [`Group::retract_from_left`](crate::groups::Group::retract_from_left).
    fn retract_from_left(&self, at: &Self::Element, xi: &[f64]) -> Self::Element;

    /// See [`Group::combined`](crate::groups::Group::combined).
    fn combined(&self, weights: &[f64], past: &[Self::Element]) -> Self::Element;

    /// `from^-1 . to`.
    fn between(&self, from: &Self::Element, to: &Self::Element) -> Self::Element;

    /// See [`Group::extents`](crate::groups::Group::extents).
    fn extents(&self, of: &Self::Element, out: &mut [f64]);

    /// See [`Group::is_within`](crate::groups::Group::is_within).
    fn is_within(&self, of: &Self::Element, reach: &[f64]) -> bool;
}

/// The tangent of the equations at all elements of a region, and the derivative of the chart there: numbers
/// in bounds that share their variables, each a row of middle, what is not known, remainder, and how far it
/// moves with each variable.
#[derive(Clone, Debug)]
pub struct Enclosed {
    variables: usize,
    dimension: usize,
    /// Entry (i, j) is the `i * dimension + j`-th.
    tangent: Vec<f64>,
    /// The entries of the chart's derivative that do not vanish.
    places: Vec<(usize, usize)>,
    chart: Vec<f64>,
}

/// How many numbers stand before those of the variables.
const BEFORE: usize = 3;

fn write<L: Affine>(x: &Bounded<L>, variables: usize, out: &mut Vec<f64>) {
    out.extend([x.middle(), x.still(), x.rest()]);
    out.extend((0..variables).map(|k| x.along(k)));
}

impl Enclosed {
    /// The tangent, by its entries.
    pub fn new<L: Affine>(
        variables: usize,
        dimension: usize,
        entry: impl Fn(usize, usize) -> Bounded<L>,
    ) -> Self {
        let mut tangent = Vec::with_capacity(dimension * dimension * (BEFORE + variables));
        for i in 0..dimension {
            for j in 0..dimension {
                write(&entry(i, j), variables, &mut tangent);
            }
        }
        Self {
            variables,
            dimension,
            tangent,
            places: Vec::new(),
            chart: Vec::new(),
        }
    }

    /// Puts an entry of the chart's derivative; nothing happens outside.
    pub fn put<L: Affine>(&mut self, i: usize, j: usize, x: &Bounded<L>) {
        if i < self.dimension && j < self.dimension {
            self.places.push((i, j));
            write(x, self.variables, &mut self.chart);
        }
    }

    pub(super) fn dimension(&self) -> usize {
        self.dimension
    }

    pub(super) fn variables(&self) -> usize {
        self.variables
    }

    pub(super) fn width(&self) -> usize {
        BEFORE + self.variables
    }

    pub(super) fn tangent(&self, i: usize, j: usize) -> &[f64] {
        let from = (i * self.dimension + j) * self.width();
        self.tangent.get(from..from + self.width()).unwrap_or(&[])
    }

    pub(super) fn chart(&self) -> impl Iterator<Item = ((usize, usize), &[f64])> {
        let places = self.places.iter().copied();
        places.zip(self.chart.chunks(self.width()))
    }
}

/// How far a number in bounds moves with the variables.
pub(super) fn moved(x: &[f64]) -> f64 {
    match x {
        [_, _, rest, along @ ..] => swing_of(along) + rest,
        _ => f64::NAN,
    }
}

/// Adds the product of two numbers of which it is known how far the variables move them.
#[inline]
pub(super) fn add_product(sum: &mut [f64], [x, y]: [&[f64]; 2], [x_moved, y_moved]: [f64; 2]) {
    let (
        [middle, sum_still, sum_rest, along @ ..],
        [a, still, rest, x @ ..],
        [b, other_still, other_rest, y @ ..],
    ) = (sum, x, y)
    else {
        return;
    };
    *middle += a * b;
    for (sum, (x, y)) in along.iter_mut().zip(x.iter().zip(y)) {
        *sum += x * b + y * a;
    }
    let [still, rest] = spread_of_product(
        [*a, *still, *rest, x_moved],
        [*b, *other_still, *other_rest, y_moved],
    );
    *sum_still += still;
    *sum_rest += rest + UNIT * middle.abs();
}

/// Adds a number times an exact one.
#[inline]
pub(super) fn add_times(sum: &mut [f64], x: &[f64], factor: f64) {
    let ([middle, sum_still, sum_rest, along @ ..], [a, still, rest, x @ ..]) = (sum, x) else {
        return;
    };
    let term = a * factor;
    *middle += term;
    for (sum, x) in along.iter_mut().zip(x) {
        *sum += x * factor;
    }
    let size = factor.abs();
    *sum_still += still * size;
    *sum_rest += rest * size + UNIT * (term.abs() + middle.abs());
}

/// Takes one from a number.
pub(super) fn less_one(x: &mut [f64]) {
    if let [middle, _, rest, ..] = x {
        *middle -= 1.0;
        *rest += UNIT * middle.abs();
    }
}

/// An element that a [`Curve`] keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Point(usize);

/// The equations of one lane. It keeps the elements that it is asked for.
pub(super) trait Curve {
    /// The coordinates.
    fn parts(&self) -> &Parts;

    /// The neutral element.
    fn rest(&self) -> Point;

    /// An element moved by coordinates.
    fn retract(&self, at: Point, xi: &[f64]) -> Point;

    /// The lengths of the coordinates of `to` seen from `from`.
    fn extents(&self, from: Option<Point>, to: Point) -> Vec<f64>;

    /// Whether `to` is as near to `from` as that.
    fn is_within(&self, from: Point, to: Point, reach: &[f64]) -> bool;

    /// The residual `T(Ω) - m`.
    fn residual(&self, at: Point) -> Vec<f64>;

    /// The tangent of `T` along the algebra.
    fn tangent(&self, at: Point) -> Dense<f64>;

    /// The tangent in bounds over a region about an element, for all nodes as near as that.
    fn enclosed(&self, spread: Spread, centre: Point, radii: &[f64]) -> Enclosed;
}

/// The tangent in bounds over a region about an element, by its radii.
pub type Bounds<'a, Element> = dyn Fn(Spread, &Element, &[f64]) -> Enclosed + 'a;

/// The equations of one lane on a group that a value describes.
pub struct Lane<'a, C: Chart> {
    /// The group.
    pub chart: &'a C,
    /// The residual `T(Ω) - m`.
    pub residual: &'a dyn Fn(&C::Element) -> Vec<f64>,
    /// The tangent of `T` along the algebra.
    pub tangent: &'a dyn Fn(&C::Element) -> Dense<f64>,
    /// The tangent in bounds, at all elements whose coordinates, seen from one, do not exceed radii.
    pub enclosed: &'a Bounds<'a, C::Element>,
}

/// The same with the elements met.
pub(super) struct Met<'a, 'b, C: Chart> {
    pub(super) equations: &'b Lane<'a, C>,
    pub(super) elements: RefCell<Vec<C::Element>>,
}

impl<'a, 'b, C: Chart> Met<'a, 'b, C> {
    pub(super) fn new(equations: &'b Lane<'a, C>) -> Self {
        Self {
            equations,
            elements: RefCell::new(Vec::new()),
        }
    }

    pub(super) fn keep(&self, element: C::Element) -> Point {
        let mut all = self.elements.borrow_mut();
        all.push(element);
        Point(all.len() - 1)
    }

    pub(super) fn get(&self, point: Point) -> C::Element {
        let all = self.elements.borrow();
        let known = all.get(point.0).cloned();
        known.unwrap_or_else(|| self.equations.chart.identity())
    }
}

impl<C: Chart> Curve for Met<'_, '_, C> {
    fn parts(&self) -> &Parts {
        self.equations.chart.parts()
    }

    fn rest(&self) -> Point {
        self.keep(self.equations.chart.identity())
    }

    fn retract(&self, at: Point, xi: &[f64]) -> Point {
        self.keep(self.equations.chart.retract(&self.get(at), xi))
    }

    fn extents(&self, from: Option<Point>, to: Point) -> Vec<f64> {
        let (chart, to) = (self.equations.chart, self.get(to));
        let seen = match from {
            Some(from) => chart.between(&self.get(from), &to),
            None => to,
        };
        let mut out = vec![0.0; chart.parts().count()];
        chart.extents(&seen, &mut out);
        out
    }

    fn is_within(&self, from: Point, to: Point, reach: &[f64]) -> bool {
        let chart = self.equations.chart;
        let seen = chart.between(&self.get(from), &self.get(to));
        chart.is_within(&seen, reach)
    }

    fn residual(&self, at: Point) -> Vec<f64> {
        (self.equations.residual)(&self.get(at))
    }

    fn tangent(&self, at: Point) -> Dense<f64> {
        (self.equations.tangent)(&self.get(at))
    }

    fn enclosed(&self, spread: Spread, centre: Point, radii: &[f64]) -> Enclosed {
        (self.equations.enclosed)(spread, &self.get(centre), radii)
    }
}
