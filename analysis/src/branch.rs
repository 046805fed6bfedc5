//! Steps along a branch of critical points, by pseudo-arclength.
//!
//! A step predicts along the tangent of the branch. Newton's method corrects the prediction orthogonally to the tangent
//! (Keller, in *Applications of Bifurcation Theory*, 1977). The parameter is an unknown like the others, so that folds
//! need no special care.

use crate::equilibrium::EquilibriumError;
use crate::flow::Energy;
use crate::kkt::{Kkt, Point};
use crate::newton::{Equations, Search};
use crate::root::bracketed;
use crate::singular::Singular;
use crate::track::BranchPoint;
use crate::variation::{Variation, variation};
use nalgebra::{DMatrix, DVector};

/// Newton's iterations of a correction, after which the step is too long.
const CORRECTIONS: usize = 10;

/// The value at a located zero, relative to the values at both ends, is at most this.
const CONTINUOUS: f64 = 1e-6;

/// The least cosine of the angle between the tangents before and after a step.
const COSINE: f64 = 0.9;

/// A point of a branch with its tangent and second variation.
#[derive(Clone)]
pub(crate) struct Place<S> {
    pub point: Point<S>,
    /// The unit tangent: state, multipliers, parameter.
    pub tangent: DVector<f64>,
    pub variation: Variation,
    pub residual: f64,
    pub iterations: usize,
}

impl<S> Place<S> {
    /// The derivative of the parameter along the branch.
    pub fn slope(&self) -> f64 {
        self.tangent.as_slice().last().copied().unwrap_or(0.0)
    }
}

pub(crate) struct Stepper<'a, E> {
    pub kkt: Kkt<'a, E>,
    pub search: Search,
}

type Result<T, E> = std::result::Result<T, EquilibriumError<<E as Energy>::Error>>;

impl<E: Energy> Stepper<'_, E> {
    /// The equations, and their derivative bordered by the row `along`.
    fn bordered(
        &self,
        at: &Point<E::State>,
        along: &DVector<f64>,
    ) -> Result<(DVector<f64>, DMatrix<f64>), E> {
        let (residual, derivative) = self.kkt.linearised(at)?;
        let size = self.kkt.size();
        let mut bordered = DMatrix::zeros(size + 1, size + 1);
        bordered
            .view_mut((0, 0), (size, size))
            .copy_from(&derivative);
        bordered
            .view_mut((0, size), (size, 1))
            .copy_from(&self.kkt.in_parameter(at)?);
        bordered.set_row(size, &along.transpose());
        Ok((residual, bordered))
    }

    /// The place at a solution, with the tangent on the side of `along`.
    pub fn place(
        &self,
        point: Point<E::State>,
        along: &DVector<f64>,
        iterations: usize,
    ) -> Result<Place<E::State>, E> {
        let (residual, bordered) = self.bordered(&point, along)?;
        let size = self.kkt.size();
        let mut unit = DVector::zeros(size + 1);
        unit[size] = 1.0;
        let tangent = Singular::new(&bordered).solve(&unit, self.search.rank, 0.0);
        let norm = tangent.norm();
        let tangent = if norm > 0.0 && norm.is_finite() {
            tangent / norm
        } else {
            along.clone()
        };
        let variation = variation(&self.kkt, &point)?;
        Ok(Place {
            point,
            tangent,
            variation,
            residual: residual.norm(),
            iterations,
        })
    }

    /// A place as users see it.
    pub fn branch_point(&self, of: &Place<E::State>) -> BranchPoint<E::State> {
        BranchPoint {
            p: of.point.p,
            state: of.point.state.clone(),
            multipliers: self.kkt.multipliers(&of.point),
            residual: of.residual,
            slope: of.slope(),
            variation: of.variation.clone(),
        }
    }

    /// The place at distance `s` along the branch, None if the step is too long.
    pub fn step(&self, from: &Place<E::State>, s: f64) -> Option<Place<E::State>> {
        let mut point = self.kkt.moved(&from.point, &(s * &from.tangent));
        let size = self.kkt.size();
        let mut before = f64::INFINITY;
        for iterations in 0..CORRECTIONS {
            let (residual, bordered) = self.bordered(&point, &from.tangent).ok()?;
            let norm = residual.norm();
            let done = norm <= self.search.tolerance;
            if norm == 0.0 || (done && norm > 0.1 * before) {
                let place = self.place(point, &from.tangent, iterations).ok()?;
                return (place.tangent.dot(&from.tangent) >= COSINE).then_some(place);
            }
            if !done && norm > 2.0 * before {
                return None;
            }
            before = norm;
            let correction = -Singular::new(&bordered).solve(
                &residual.insert_row(size, 0.0),
                self.search.rank,
                0.0,
            );
            // A correction longer than the step leads to another branch.
            if correction.norm() > s.abs().max(self.search.tolerance) {
                return None;
            }
            point = self.kkt.moved(&point, &correction);
        }
        None
    }

    /// The place between two places where `function` is zero, and whether it was located to rounding. Steps near other
    /// branches may fail; the place is then the best one before. None if `function` keeps its sign.
    pub fn zero(
        &self,
        from: &Place<E::State>,
        s: f64,
        to: &Place<E::State>,
        function: impl Fn(&Place<E::State>) -> Option<f64>,
    ) -> Option<(Place<E::State>, bool)> {
        let (start, end) = (function(from)?, function(to)?);
        if start * end > 0.0 || (start * end).is_nan() {
            return None;
        }
        let mut best = if start.abs() < end.abs() {
            (start.abs(), from.clone())
        } else {
            (end.abs(), to.clone())
        };
        let value = |theta: f64| {
            let place = self.step(from, theta * s).ok_or(())?;
            let value = function(&place).ok_or(())?;
            if value.abs() < best.0 {
                best = (value.abs(), place);
            }
            Ok::<_, ()>(value)
        };
        let ended = bracketed(value, (0.0, start), (1.0, end)).is_ok();
        // A jump to another branch changes the sign without a zero.
        let located = ended && best.0 <= CONTINUOUS * (start.abs() + end.abs());
        Some((best.1, located))
    }
}
