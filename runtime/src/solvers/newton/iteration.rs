//! The course of an iteration, for groups described by types and by values alike: which attempt runs, which correction
//! comes next, and when a new tangent or new sizes of terms are needed. Takes the size of each residual and correction.

use super::corrections::{Corrections, Moved, NextAction, Residual};
use super::{
    CONVERGED_ROUNDINGS, CURRENT_SCALE, LATE, MOST_ITERATIONS, NewtonFailure, OLDEST_SCALE,
    OLDEST_TANGENT, WORTH_KEEPING,
};
use crate::scalar::Real;

/// An attempt after which no other follows.
const LAST_ATTEMPT: u32 = 2;

/// How an iteration goes on.
pub(super) enum Correction {
    /// Evaluate the equations at the trial.
    Next,
    /// The trial solves the equations.
    Last {
        /// Whether the trial moved since its evaluation.
        moved: bool,
    },
    /// This attempt failed.
    Impossible,
}

/// The state of an iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Iteration {
    /// The first attempt extrapolates previous solutions, the second starts at the last one.
    attempt: u32,
    /// The residual at the trial relative to its terms, and at the trial before.
    size: f64,
    previous: f64,
    corrections: Corrections,
    count: usize,
    /// Whether the solution is found, and only its eliminated unknowns are still needed.
    pub found: bool,
    /// Whether the sizes of the terms were computed anew because they had to decide.
    renewed: bool,
}

impl Iteration {
    /// The first attempt, or the second if no previous solutions can be extrapolated.
    pub const fn new(is_foreseen: bool) -> Self {
        Self {
            attempt: if is_foreseen { 0 } else { 1 },
            size: f64::NAN,
            previous: f64::INFINITY,
            corrections: Corrections::none(),
            count: 0,
            found: false,
            renewed: false,
        }
    }

    /// Starts another attempt, without corrections so far.
    fn restart(&mut self, attempt: u32) {
        *self = Self {
            attempt,
            size: self.size,
            renewed: self.renewed,
            ..Self::new(false)
        };
    }

    /// Starts the attempt without extrapolation.
    pub fn restart_at_last(&mut self) {
        self.restart(1);
    }

    /// Starts an attempt after which no other follows.
    pub fn restart_finally(&mut self) {
        self.restart(LAST_ATTEMPT);
    }

    /// Whether this is the first attempt.
    pub const fn is_first(&self) -> bool {
        self.attempt == 0
    }

    /// Whether no other attempt follows.
    pub const fn is_final(&self) -> bool {
        self.attempt >= LAST_ATTEMPT
    }

    /// The number of corrections.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// The residual at the trial relative to its terms.
    pub const fn size(&self) -> f64 {
        self.size
    }

    /// Takes the size of a residual and the age of the factored tangent; returns whether the tangent at the trial is
    /// needed.
    #[inline(always)]
    pub fn wants_tangent<T: Real>(&mut self, size: f64, age: u32) -> bool {
        self.size = size;
        if T::ORDER > 0 {
            return true;
        }
        let is_small = size <= CONVERGED_ROUNDINGS * T::EPSILON;
        if self.count > 0 {
            let falls = size <= WORTH_KEEPING * self.previous;
            let is_rounding = is_small && self.corrections.are_small();
            return !(falls || is_rounding);
        }
        // If the prediction is exact to rounding, the tangent of an earlier step suffices.
        !(is_small && age < OLDEST_TANGENT)
    }

    /// The action after a correction of this relative length: see [`Corrections::next`]. The sizes of the terms are
    /// `weighed` steps old.
    #[inline(always)]
    pub fn next<T: Real>(
        &mut self,
        moved: Moved,
        weighed: u32,
        decrement: impl FnOnce() -> f64,
    ) -> NextAction {
        let residual = Residual {
            size: self.size,
            previous: self.previous,
            iteration: self.count,
        };
        let next = self.corrections.next::<T>(residual, moved, decrement);
        let is_current = weighed < CURRENT_SCALE || self.renewed || !self.is_first();
        match next == NextAction::EndIfRounding && !is_current {
            true => NextAction::Measure,
            false => next,
        }
    }

    /// Asks for new sizes of the terms at the same trial, once.
    #[cold]
    pub fn measure(&mut self, weighed: &mut u32) -> Correction {
        self.renewed = true;
        *weighed = OLDEST_SCALE;
        Correction::Next
    }

    /// Counts an applied correction.
    #[inline(always)]
    pub fn corrected(&mut self, next: NextAction, weighed: &mut u32) -> Correction {
        self.previous = self.size;
        self.count += 1;
        if next != NextAction::Correct {
            return Correction::Last { moved: true };
        }
        if self.count == LATE {
            *weighed = OLDEST_SCALE;
        }
        match self.count == MOST_ITERATIONS || !self.size.is_finite() {
            true => Correction::Impossible,
            false => Correction::Next,
        }
    }

    /// Why the attempt failed, and the number of corrections until then.
    #[cold]
    pub fn failure(&self) -> (NewtonFailure, usize) {
        match self.count {
            _ if !self.size.is_finite() => (NewtonFailure::NotFinite, self.count.saturating_sub(1)),
            MOST_ITERATIONS => (NewtonFailure::NotConverged, MOST_ITERATIONS),
            _ => (NewtonFailure::SingularTangent, self.count),
        }
    }
}
