//! The error of a failed solve of the Moser-Veselov equation, with its numbers.

use crate::groups::Part;
use crate::number_format::{Times, in_lane, instead};
use crate::solvers::Method;
use crate::solvers::largest_step::largest_step;
use core::fmt;

/// The kind of failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Refusal {
    /// The momentum is beyond the exact bound of the principal solution.
    BeyondBound,
    /// The iteration did not converge although the momentum is within the bound.
    NotConverged,
    /// The solver found a solution, but not the principal one.
    NotPrincipal,
    /// The requested solver does not support this size, factor or scalar.
    DoesNotApply,
    /// The momentum is NaN or infinite.
    NotFinite,
}

/// The error of a step for which the solver of a left factor fails.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unsolved {
    /// The solver.
    pub method: Method,
    /// The kind of failure.
    pub refusal: Refusal,
    /// The scaled momentum over its exact bound, in the worst lane. Above 1 the principal solution
    /// does not exist.
    pub ratio: f64,
    /// The component, or the plane in the frame of the factor, in which a short step rotates fastest: it has the
    /// largest ratio of momentum to moment of inertia.
    pub fastest: Part,
    /// The lane of the worst ratio; 0 for types without lanes.
    pub lane: u8,
    /// The largest entry of `Omega C^T - C Omega^T - h N` when the solver stopped; NaN if it found no candidate.
    pub residual: f64,
    /// The step size that failed, if the caller knows it.
    pub h: Option<f64>,
    /// The largest step size that succeeds from the same state, if it is known.
    pub largest_step: Option<f64>,
}

impl Unsolved {
    /// This error with the failed step size and the largest step size that succeeds: the largest
    /// trial step for which `ratio` gives at most 1.
    #[cold]
    #[must_use]
    pub fn with_searched_step(self, h: f64, ratio: impl Fn(f64) -> Option<f64>) -> Self {
        Self {
            h: Some(h),
            largest_step: Some(largest_step(h, ratio)),
            ..self
        }
    }
}

impl fmt::Display for Unsolved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        in_lane(f, self.lane)?;
        match self.refusal {
            Refusal::BeyondBound => write!(
                f,
                "step too large: the momentum exceeds the solvability bound of the Moser-Veselov \
                 equation by a factor {} ({} is the largest)",
                Times(self.ratio),
                self.fastest
            )?,
            Refusal::NotConverged => write!(
                f,
                "solver {} did not converge: the residual is {:.3e}, and the momentum {:.9} of its bound",
                self.method, self.residual, self.ratio
            )?,
            Refusal::NotPrincipal => write!(
                f,
                "solver {} found a solution that is not the principal one: the momentum is {:.9} of \
                 its bound",
                self.method, self.ratio
            )?,
            Refusal::DoesNotApply => {
                return write!(
                    f,
                    "solver {} does not support this size, factor or scalar; use lie-newton",
                    self.method
                );
            }
            Refusal::NotFinite => {
                return write!(f, "the momentum is NaN or infinite ({})", self.fastest);
            }
        }
        match (self.h, self.largest_step) {
            (Some(h), Some(largest)) if largest.abs() < h.abs() => instead(f, h, largest),
            _ => write!(f, "; reduce the step size"),
        }
    }
}

impl std::error::Error for Unsolved {}
