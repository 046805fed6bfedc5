//! Why Newton's method failed: the last residual, the worst equation, and the largest step that is
//! possible from the same state.
//! Takes the last residual and a way to try other steps; gives the error.

use super::{Fold, Found, LAST_ATTEMPT, MOST_ITERATIONS, Newton, Progress, Search};
use crate::groups::{Coordinate, Group};
use crate::number_format::{AtMost, Plain, Times, in_lane, instead};
use crate::scalar::Real;
use crate::solvers::largest_step::confirmed_step;
use crate::{StepCause, StepError};
use core::cell::Cell;
use core::fmt;

/// The kind of failure.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum NewtonFailure {
    /// The residual is still too large.
    NotConverged,
    /// The tangent matrix is singular.
    SingularTangent,
    /// The residual became NaN or infinite.
    NotFinite,
    /// The principal root does not exist: between rest and the momenta of the node, the tangent becomes singular or the
    /// equations become undefined.
    Fold {
        /// The fraction of the path that could be followed.
        share: f32,
    },
}

/// The error of a step whose equations Newton's method did not solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonError {
    /// The kind of failure.
    pub failure: NewtonFailure,
    /// The number of corrections.
    pub iterations: u8,
    /// The largest residual relative to the terms of its equation, over all lanes; NaN if any residual is NaN.
    pub residual: f64,
    /// The tolerance that the residual exceeds.
    pub tolerance: f64,
    /// The step size that failed, if the caller knows it.
    pub h: Option<f64>,
    /// The largest step that succeeds with a new workspace from the same state, with the sign of `h`,
    /// found by bisection. It is 0 if no step above `h / 2^380` succeeds.
    pub largest_step: Option<f64>,
    /// The equation of the largest residual: a component of the momentum of a configuration, in
    /// the frame of the model. If a largest step was found, the equation comes from the shortest
    /// step that failed.
    pub worst: Coordinate,
    /// The lane of the largest residual; 0 for types without lanes.
    pub lane: u8,
    /// The configurations of the model, in their order.
    pub(crate) configurations: &'static &'static [&'static str],
    /// Whether this was a trial step.
    pub(crate) tried: bool,
}

/// The configurations if their names are unknown.
const NO_NAMES: &[&str] = &[];

impl NewtonError {
    /// The failure with this residual.
    #[cold]
    #[inline(never)]
    pub(super) fn of<T: Real>(
        failure: NewtonFailure,
        iterations: usize,
        residual: &[T],
        weights: &[T],
        coordinate: &dyn Fn(usize) -> Coordinate,
    ) -> Self {
        let (mut size, mut index, mut lane) = (0.0, 0, 0);
        let (mut worst, mut weight) = (0.0, f64::NAN);
        for (i, (x, w)) in residual.iter().zip(weights).enumerate() {
            for at in 0..T::LANES {
                let (x, w) = (x.lane(at).abs(), w.lane(at));
                if w * x > size || (x.is_nan() && !f64::is_nan(size)) {
                    (size, index, lane) = (w * x, i, at);
                    (worst, weight) = (x, w);
                }
            }
        }
        Self {
            failure,
            iterations: u8::try_from(iterations).unwrap_or(u8::MAX),
            residual: worst,
            tolerance: super::CONVERGED_ROUNDINGS * T::EPSILON / weight,
            h: None,
            largest_step: None,
            worst: coordinate(index),
            lane: u8::try_from(lane).unwrap_or(u8::MAX),
            configurations: &NO_NAMES,
            tried: false,
        }
    }

    /// The failure of the principal root to exist.
    #[cold]
    #[inline(never)]
    pub(super) fn at_fold(fold: Fold, worst: Coordinate) -> Self {
        Self {
            failure: NewtonFailure::Fold {
                share: fold.share as f32,
            },
            iterations: 0,
            residual: 0.0,
            tolerance: 0.0,
            h: None,
            largest_step: None,
            worst,
            lane: u8::try_from(fold.lane).unwrap_or(u8::MAX),
            configurations: &NO_NAMES,
            tried: false,
        }
    }

    /// The configuration of the worst equation, if it is known.
    #[must_use]
    pub fn configuration(&self) -> Option<&'static str> {
        let factor = usize::from(self.worst.factor);
        self.configurations.get(factor).copied()
    }

    /// This error with the failed step size, the largest step size that succeeds, and the names of the configurations.
    /// `step` tries a step of another size from the same state.
    #[cold]
    #[inline(never)]
    #[must_use]
    pub fn explained<T, G, const D: usize, W, const E: usize>(
        self,
        h: T,
        configurations: &'static &'static [&'static str],
        step: impl Fn(T, Search<T, G, D, W, E>) -> Result<(), StepError>,
    ) -> Self
    where
        T: Real,
        G: Group<T> + Found<W>,
        W: Group<T>,
    {
        self.explained_by(h, configurations, &|h| step(h, Search::to_try()))
    }

    /// Like `explained`, if `step` searches by itself.
    #[cold]
    #[inline(never)]
    #[must_use]
    pub fn explained_by<T: Real>(
        self,
        h: T,
        configurations: &'static &'static [&'static str],
        step: &dyn Fn(T) -> Result<(), StepError>,
    ) -> Self {
        if self.tried {
            return self;
        }
        let nearest = Cell::new(self);
        let tried = |share: f64| match step(h * T::from_f64(share)) {
            Ok(()) => Some(0.0),
            Err(StepError {
                cause: StepCause::Newton(e),
                ..
            }) => {
                nearest.set(e);
                None
            }
            Err(_) => None,
        };
        let share = confirmed_step(&tried, &tried);
        let NewtonError { worst, lane, .. } = match share > 0.0 && share < 1.0 {
            true => nearest.get(),
            false => self,
        };
        let h = h.lane(usize::from(lane));
        Self {
            h: Some(h),
            largest_step: Some(h * share),
            worst,
            lane,
            configurations,
            ..self
        }
    }
}

impl fmt::Display for NewtonError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            iterations,
            residual,
            tolerance,
            worst,
            ..
        } = self;
        in_lane(f, self.lane)?;
        match self.failure {
            NewtonFailure::NotConverged => write!(
                f,
                "Newton's method did not converge in {iterations} iterations: residual \
                 {residual:.3e}, needed {tolerance:.3e}"
            )?,
            NewtonFailure::SingularTangent => write!(
                f,
                "the tangent is singular at Newton iteration {iterations} (residual \
                 {residual:.3e}, needed {tolerance:.3e})"
            )?,
            NewtonFailure::NotFinite => write!(
                f,
                "the residual is NaN or infinite at Newton iteration {iterations}"
            )?,
            NewtonFailure::Fold { share } => write!(
                f,
                "the equation of the step has no solution connected to h = 0: its tangent becomes singular at {share:.6} of \
                 the momentum"
            )?,
        }
        match self.configuration() {
            Some(name) => write!(
                f,
                "; the largest residual is {} of the momentum of `{name}`",
                worst.part
            )?,
            None => write!(
                f,
                "; the largest residual is {} of factor {}",
                worst.part,
                u16::from(worst.factor) + 1
            )?,
        }
        match (self.h, self.largest_step) {
            (Some(h), Some(largest)) if largest != h && largest != 0.0 => write!(
                f,
                "; the step is {} times the largest step that can be solved from this state: reduce it from {} to at most {}",
                Times(h / largest),
                Plain(h),
                AtMost(largest)
            ),
            (Some(h), Some(largest)) if largest == 0.0 => instead(f, h, largest),
            _ => write!(f, "; reduce the step size or check the values"),
        }
    }
}

impl std::error::Error for NewtonError {}

impl<T: Real, G, const D: usize, W: Group<T>, const E: usize> Search<T, G, D, W, E>
where
    G: Group<T> + Found<W>,
{
    /// Forgets all solutions and measurements. Returns false if there were no solutions.
    #[cold]
    fn forget(&mut self) -> bool {
        let begun = self.known > 0;
        *self = Self {
            tries: self.tries,
            last: self.last,
            ..Self::from_rest()
        };
        begun
    }
}

impl<T: Real, G, const D: usize, W: Group<T>, const E: usize> Newton<'_, T, G, D, W, E>
where
    G: Group<T> + Found<W>,
{
    /// Starts the step again without the solutions and measurements of earlier steps. Returns false if this attempt
    /// already does so.
    #[cold]
    #[inline(never)]
    pub fn begin_afresh(&mut self) -> bool {
        if !self.search.forget() {
            return false;
        }
        self.attempt = 1;
        self.anchor = None;
        self.begin_at(G::identity());
        true
    }

    /// Starts the next attempt, or returns the error of the last attempt.
    #[cold]
    #[inline(never)]
    pub(super) fn failed(&mut self) -> Progress<G> {
        if self.attempt == 0 {
            self.attempt = 1;
            self.begin_at(self.search.start());
            return Progress::Continue;
        }
        if self.attempt < LAST_ATTEMPT && self.begin_afresh() {
            return Progress::Continue;
        }
        let (failure, iterations) = if !self.size.is_finite() {
            (NewtonFailure::NotFinite, self.iteration.saturating_sub(1))
        } else if self.iteration == MOST_ITERATIONS {
            (NewtonFailure::NotConverged, MOST_ITERATIONS)
        } else {
            (NewtonFailure::SingularTangent, self.iteration)
        };
        let looked_at = G::DIMENSION.min(D);
        let residual = self.residual.as_slice().get(..looked_at).unwrap_or(&[]);
        Progress::Failed(NewtonError {
            tried: self.search.tries(),
            ..NewtonError::of(
                failure,
                iterations,
                residual,
                self.search.weights.as_slice(),
                &G::coordinate,
            )
        })
    }

    /// The error if the principal root was found, but its residual exceeds rounding.
    #[cold]
    #[inline(never)]
    pub fn unpolished(&self) -> NewtonError {
        let looked_at = G::DIMENSION.min(D);
        let residual = self.residual.as_slice().get(..looked_at).unwrap_or(&[]);
        NewtonError {
            tried: self.search.tries(),
            ..NewtonError::of(
                NewtonFailure::NotConverged,
                self.iteration,
                residual,
                self.search.weights.as_slice(),
                &G::coordinate,
            )
        }
    }

    /// The error if the principal root does not exist; `failure` is the cause of an earlier failure.
    #[cold]
    #[inline(never)]
    pub fn folded(&self, fold: Fold, failure: Option<NewtonError>) -> NewtonError {
        match failure {
            // The curve could not be followed at all.
            Some(e) if fold.share == 0.0 => e,
            _ => NewtonError {
                tried: self.search.tries(),
                ..NewtonError::at_fold(fold, W::coordinate(fold.fastest))
            },
        }
    }
}
