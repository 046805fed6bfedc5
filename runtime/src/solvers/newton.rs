//! Newton's method on a Lie group, for implicit steps without a closed form.
//! Takes a guess, the residual and its tangent; gives a converged element or an error.

use crate::groups::Group;
use crate::linalg;
use crate::scalar::Real;
use core::fmt;
use nalgebra::{SMatrix, SVector};

/// Iterations after which the method gives up; quadratic convergence needs fewer than ten.
const MOST_ITERATIONS: usize = 50;

/// A residual this many roundings of its terms is zero: the residual of a matrix equation is a sum
/// of about sixteen rounded products of the size `scale`.
const CONVERGED_ROUNDINGS: f64 = 16.0;

/// Below this the residual is nothing but rounding, and a further step would only change it.
const POLISHED_ROUNDINGS: f64 = 4.0;

/// Ill-conditioned terms may keep the residual above [`CONVERGED_ROUNDINGS`]; when it stops falling
/// below this many roundings, rounding is the reason.
const STAGNATED_ROUNDINGS: f64 = 1e3;

/// A converged solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solved<G> {
    /// The group element that solves the equation.
    pub element: G,
    /// Newton steps made, the polishing one included.
    pub iterations: usize,
    /// The largest residual component before the last step, over all lanes.
    pub residual: f64,
}

/// Why Newton's method failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NewtonError {
    /// The residual is still too large.
    NotConverged {
        /// Steps made.
        iterations: usize,
        /// The largest residual component.
        residual: f64,
        /// What it should have come below.
        tolerance: f64,
    },
    /// The tangent matrix has no inverse.
    SingularTangent {
        /// The step at which it happened.
        iteration: usize,
        /// The largest residual component there.
        residual: f64,
    },
    /// The residual became NaN or infinite.
    NotFinite {
        /// The step at which it happened.
        iteration: usize,
    },
}

impl fmt::Display for NewtonError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotConverged {
                iterations,
                residual,
                tolerance,
            } => write!(
                f,
                "Newton's method did not converge in {iterations} iterations: residual \
                 {residual:.3e}, needed {tolerance:.3e}; reduce the step size"
            ),
            Self::SingularTangent {
                iteration,
                residual,
            } => write!(
                f,
                "the tangent is singular at Newton iteration {iteration} (residual \
                 {residual:.3e}); reduce the step size"
            ),
            Self::NotFinite { iteration } => write!(
                f,
                "the residual is NaN or infinite at Newton iteration {iteration}; reduce the step \
                 size or check the values"
            ),
        }
    }
}

impl std::error::Error for NewtonError {}

/// Solves `residual(g) = 0` from the guess `g`.
///
/// Of the `D` components the first [`Group::DIMENSION`] are looked at, so that one `D` can serve
/// several sizes of a group.
///
/// `tangent(g)` is the derivative of the residual with respect to the coordinates of
/// [`Group::retract`] at 0. `scale` is the natural size of the residual's terms (positive): the
/// solution is accepted when the residual is below `16 EPSILON scale`, or has stopped falling below
/// `1e3 EPSILON scale`. The size of the residual is that of its real parts, in every lane: from a
/// real solution one more step makes the first derivatives exact whatever they were, so that step
/// follows for dual numbers, and for plain ones unless the residual is rounding already.
///
/// # Errors
/// [`NewtonError`]; an unconverged element is never returned.
#[inline]
pub fn solve<T: Real, G: Group<T>, const D: usize>(
    guess: G,
    scale: f64,
    mut residual: impl FnMut(&G) -> SVector<T, D>,
    mut tangent: impl FnMut(&G) -> SMatrix<T, D, D>,
) -> Result<Solved<G>, NewtonError> {
    let tolerance = CONVERGED_ROUNDINGS * T::EPSILON * scale;
    let stagnation = STAGNATED_ROUNDINGS * T::EPSILON * scale;
    let mut element = guess;
    let mut previous = f64::INFINITY;
    let mut size = f64::NAN;
    for iteration in 0..MOST_ITERATIONS {
        let value = residual(&element);
        if !value.iter().all(|x| x.is_finite()) {
            return Err(NewtonError::NotFinite { iteration });
        }
        size = largest(&value);
        if T::ORDER == 0 && size <= POLISHED_ROUNDINGS * T::EPSILON * scale {
            return Ok(Solved {
                element,
                iterations: iteration,
                residual: size,
            });
        }
        let done = size <= tolerance || (size <= stagnation && size >= 0.5 * previous);
        let Some(correction) = linalg::solve_leading(&tangent(&element), &value, G::DIMENSION)
        else {
            return Err(NewtonError::SingularTangent {
                iteration,
                residual: size,
            });
        };
        let step = -correction;
        let moved = element.retract(step.as_slice());
        if done {
            return Ok(Solved {
                element: moved,
                iterations: iteration + 1,
                residual: size,
            });
        }
        element = moved;
        previous = size;
    }
    Err(NewtonError::NotConverged {
        iterations: MOST_ITERATIONS,
        residual: size,
        tolerance,
    })
}

/// The largest absolute real part over components and lanes.
#[inline(always)]
fn largest<T: Real, const D: usize>(v: &SVector<T, D>) -> f64 {
    v.iter().fold(0.0, |largest: f64, x| {
        largest.max(x.greatest()).max(-x.least())
    })
}
