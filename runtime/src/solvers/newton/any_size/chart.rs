//! Groups that are described by a value, for models whose groups and sizes are known only at run time. Takes elements
//! and coordinates; gives elements, and the equations of one lane on the group.

use crate::groups::Coordinate;
use crate::linalg::{Dense, Reals};
use crate::solvers::newton::Parts;
use crate::solvers::newton::parts::Squares;
use crate::solvers::newton::principal::Curve;
use core::fmt::Debug;

/// A group described by a value, as [`Group`](crate::groups::Group) describes it by a type.
pub trait Chart {
    /// The type of the group's elements.
    type Element: Clone + Debug + Default;

    /// The coordinates and their parts.
    fn parts(&self) -> &Parts;

    /// The unknowns that Newton's method finds, extracted from an element `whole` of the group `of` of all unknowns.
    fn part(&self, of: &Self, whole: &Self::Element) -> Self::Element;

    /// The meaning of a coordinate.
    fn coordinate(&self, index: usize) -> Coordinate;

    /// The neutral element.
    fn identity(&self) -> Self::Element;

    /// See [`Group::retract`](crate::groups::Group::retract).
    fn retract(&self, at: &Self::Element, xi: &[f64], out: &mut Self::Element);

    /// See [`Group::retract_from_left`](crate::groups::Group::retract_from_left).
    fn retract_from_left(&self, at: &Self::Element, xi: &[f64], out: &mut Self::Element);

    /// See [`Group::combined`](crate::groups::Group::combined).
    fn combined(&self, weights: &[f64], past: &[Self::Element], out: &mut Self::Element);

    /// `from^-1 . to`.
    fn between(&self, from: &Self::Element, to: &Self::Element) -> Self::Element;

    /// See [`Group::compared`](crate::groups::Group::compared).
    fn compared(&self, of: &Self::Element, xi: &[f64], out: &mut [[f64; 2]]);

    /// The square of the length of each part of a velocity, twice.
    fn squares(&self, of: &Self::Element) -> Squares {
        let mut squares = Squares::from_elem([0.0; 2], self.parts().count());
        self.compared(of, &[], &mut squares);
        squares
    }

    /// The length of each part of a velocity.
    fn lengths(&self, of: &Self::Element) -> Reals {
        let squares = self.squares(of);
        squares.iter().map(|[square, _]| square.sqrt()).collect()
    }

    /// See [`Group::is_within`](crate::groups::Group::is_within).
    fn is_within(&self, of: &Self::Element, reach: &[f64]) -> bool;
}

/// The equations of one lane on a group described by a value.
pub struct Lane<'a, C: Chart> {
    /// The group.
    pub chart: &'a C,
    /// The residual `P(v) - m`.
    pub residual: &'a dyn Fn(&C::Element) -> Reals,
    /// The derivative of `P` along the algebra.
    pub tangent: &'a dyn Fn(&C::Element) -> Dense<f64>,
}

/// A lane together with the rounding errors of lengths.
pub(super) struct WithNoise<'a, 'b, C: Chart> {
    lane: &'b Lane<'a, C>,
    noise: &'b [f64],
}

impl<'a, C: Chart> Lane<'a, C> {
    pub(super) fn with_noise<'b>(&'b self, noise: &'b [f64]) -> WithNoise<'a, 'b, C> {
        WithNoise { lane: self, noise }
    }
}

impl<C: Chart> Curve for WithNoise<'_, '_, C> {
    type Velocity = C::Element;

    fn parts(&self) -> &Parts {
        self.lane.chart.parts()
    }

    fn noise(&self, part: usize) -> f64 {
        self.noise.get(part).copied().unwrap_or(0.0)
    }

    fn rest(&self) -> C::Element {
        self.lane.chart.identity()
    }

    fn moved(&self, from: &C::Element, coordinates: &[f64]) -> C::Element {
        let mut moved = C::Element::default();
        self.lane.chart.retract(from, coordinates, &mut moved);
        moved
    }

    fn lengths(&self, from: &C::Element, to: &C::Element) -> Reals {
        let chart = self.lane.chart;
        chart.lengths(&chart.between(from, to))
    }

    fn residual(&self, at: &C::Element) -> Reals {
        (self.lane.residual)(at)
    }

    fn tangent(&self, at: &C::Element) -> Dense<f64> {
        (self.lane.tangent)(at)
    }
}
