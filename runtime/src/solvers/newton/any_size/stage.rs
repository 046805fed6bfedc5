//! One stage on the way to the principal root: from a point of the curve to another, within a region
//! that holds both.
//! Takes the equations, a point and the tangent there; gives how far the velocity moves, and the
//! point at the end.

use super::curve::{Curve, Parts, Point};
use super::region::Strain;
use crate::linalg::Dense;
use crate::solvers::newton::node::Spread;
use crate::solvers::newton::stage::of_multiplier;

/// Corrections by which a stage is solved.
const MOST_CORRECTIONS: usize = 12;

/// A stage is solved when its last correction is this part of the region, at most: that is
/// quadratic in what is left. Close to a fold rounding permits no less.
const SOLVED: f64 = 1e-6;

/// How much larger than what is needed a region is tried.
pub(super) const MARGIN: f64 = 1.6;

/// The beginning of a stage: a point of the curve.
#[derive(Clone, Debug)]
pub(super) struct Stage {
    element: Point,
    pub(super) residual: Vec<f64>,
    tangent: Dense<f64>,
    inverse: Dense<f64>,
}

impl Stage {
    /// `None` where the tangent is singular or not finite.
    pub(super) fn at(curve: &dyn Curve, element: Point, residual: Vec<f64>) -> Option<Self> {
        let tangent = curve.tangent(element);
        let inverse = scaled_inverse(&tangent)?;
        Some(Self {
            element,
            residual,
            tangent,
            inverse,
        })
    }

    /// The inverse of the tangent.
    pub(super) fn inverse(&self) -> &Dense<f64> {
        &self.inverse
    }

    /// `B` times what the residual changes by on the way to `goal`.
    pub(super) fn toward(&self, goal: &[f64]) -> Vec<f64> {
        let change = goal.iter().zip(&self.residual).map(|(x, y)| x - y);
        self.seen(change.collect())
    }

    fn seen(&self, change: Vec<f64>) -> Vec<f64> {
        self.inverse.times(&Dense::column_of(change)).data
    }

    /// What a length of each part is measured by: 1 for pure numbers; for translations the radius
    /// that makes them weigh as much as the angles of the same element.
    pub(super) fn units(&self, parts: &Parts) -> Vec<f64> {
        let block = |b: usize| {
            let own = parts.own(b);
            own.fold(0.0, |most: f64, k| most.max(self.tangent.at(k, k).abs()))
        };
        let unit = |(b, pure): (usize, &bool)| {
            if *pure {
                return 1.0;
            }
            let unit = (block(b.saturating_sub(1)) / block(b)).sqrt();
            if unit.is_finite() { unit } else { 0.0 }
        };
        let units: Vec<f64> = parts.pure.iter().enumerate().map(unit).collect();
        let unit_of = |k: usize| units.get(parts.part_of(k)).copied().unwrap_or(1.0);
        let entry = |i: usize, j: usize| self.tangent.at(i, j);
        let size = (0..units.len()).map(|b| parts.own(b).count()).sum();
        let all = parts.pure.iter().zip(&units).enumerate();
        all.map(|(b, (pure, unit))| match *pure || block(b) != 0.0 {
            true => *unit,
            false => of_multiplier(parts.own(b), size, &entry, &unit_of),
        })
        .collect()
    }

    /// A bound of how far the velocity moves, part by part, where the equations move by `own`
    /// seen through `B`; holds if it does not exceed the radii. The strain besides.
    pub(super) fn move_within(
        &self,
        curve: &dyn Curve,
        radii: &[f64],
        own: &[f64],
    ) -> (Option<Vec<f64>>, f64) {
        let whole = self.strain(curve, radii);
        let moved = whole.spread(own).and_then(|moved| {
            if fits(&moved, radii) {
                return Some(moved);
            }
            let half: Vec<f64> = radii.iter().map(|r| 0.5 * r).collect();
            whole.mean(&self.strain(curve, &half)).spread(own)
        });
        (moved, whole.largest(radii))
    }

    /// The same with the tangent at one point in place of all of them.
    pub(super) fn move_foreseen(
        &self,
        curve: &dyn Curve,
        toward: &[f64],
        radii: &[f64],
        own: &[f64],
    ) -> (Option<Vec<f64>>, f64) {
        let farther: Vec<f64> = toward.iter().map(|x| x * MARGIN).collect();
        let whole = self.strain_at(curve, &farther);
        let regular = whole.spread(own).is_some();
        let moved = whole.mean(&Strain::none(curve.parts())).spread(own);
        (moved.filter(|_| regular), whole.largest(radii))
    }

    /// The strain at one point.
    pub(super) fn strain_at(&self, curve: &dyn Curve, toward: &[f64]) -> Strain {
        let there = curve.retract(self.element, toward);
        let moved = self.inverse.times(&curve.tangent(there));
        Strain::of(curve.parts(), &moved)
    }

    /// The strain over the region around this point.
    fn strain(&self, curve: &dyn Curve, radii: &[f64]) -> Strain {
        let tangent = curve.enclosed(Spread::HERE, self.element, radii);
        Strain::over(curve.parts(), &self.inverse, &tangent)
    }

    /// The only point of the region where the residual is `goal`.
    pub(super) fn solve(
        &self,
        curve: &dyn Curve,
        first: &[f64],
        goal: &[f64],
        radii: &[f64],
    ) -> Option<Point> {
        let mut at = curve.retract(self.element, first);
        for _ in 0..MOST_CORRECTIONS {
            let inverse = scaled_inverse(&curve.tangent(at))?;
            let residual = curve.residual(at);
            let change = goal.iter().zip(&residual).map(|(x, y)| x - y);
            let step = inverse.times(&Dense::column_of(change.collect())).data;
            at = curve.retract(at, &step);
            let own = curve.parts().lengths(&step);
            let mut parts = own.iter().zip(radii);
            // Also refuses NaN.
            if parts.all(|(x, r)| *x <= SOLVED * r) {
                let from = curve.extents(Some(self.element), at);
                return fits(&from, radii).then_some(at);
            }
        }
        None
    }
}

/// Whether no part exceeds its bound; false for NaN.
pub(super) fn fits(lengths: &[f64], bounds: &[f64]) -> bool {
    lengths.iter().zip(bounds).all(|(x, r)| x <= r)
}

/// The inverse, rows and columns brought to one size by powers of two: the choice of pivots then does not
/// depend on units.
fn scaled_inverse(a: &Dense<f64>) -> Option<Dense<f64>> {
    a.balanced_inverse().filter(Dense::is_finite)
}
