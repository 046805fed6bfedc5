//! Decides when a velocity is found: the last correction must be rounding of the velocity at its own scale. Takes the
//! corrections in order, each relative to the length of its part of the velocity. The scales of residuals are not used,
//! so a wrong scale cannot end an iteration.

use super::{CONVERGED_ROUNDINGS, FORESIGHT, POLISHED_ROUNDINGS, STAGNATED_ROUNDINGS};
use crate::scalar::Real;

/// Corrections below this many roundings of their part of the velocity are rounding. With a badly conditioned tangent,
/// solving alone leaves a few roundings.
const ROUNDINGS: f64 = 64.0;

/// Corrections below this many roundings are not needed.
const LEFT_ROUNDINGS: f64 = 4.0;

/// A correction below this that does not decrease is caused by rounding. Otherwise Newton's method would square it, and
/// even a tangent that is some steps old would reduce it to a hundredth.
const SMALL: f64 = 1e-8;

/// After this many larger corrections without decrease, the cause is also rounding. If a velocity is negligible
/// compared with the terms of its equations, at rest or at a turning point, only rounding is left to correct.
const MOST_WITHOUT_FALL: u32 = 3;

/// The residual relative to the size of its terms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Residual {
    /// At the current trial.
    pub size: f64,
    /// At the previous trial.
    pub previous: f64,
    /// The number of corrections so far.
    pub iteration: usize,
}

/// The next action after a correction is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NextAction {
    /// Apply the correction and continue.
    Correct,
    /// Apply the correction and stop.
    CorrectAndEnd,
    /// Stop without the correction: the error is already at rounding level, and the correction would add its own
    /// rounding.
    End,
}

/// The assessment of a correction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CorrectionAssessment {
    /// Another correction is needed.
    More,
    /// The correction is rounding of the velocity, and therefore the last.
    Last,
    /// Corrections no longer decrease, because of rounding in an ill-conditioned problem. This is also the last.
    Noise,
}

/// The corrections of one iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corrections {
    last: f64,
    /// The last decrement that was below a quarter of the previous minimum: its correction was half as long.
    least: f64,
    /// The number of corrections since then.
    without_fall: u32,
}

impl Corrections {
    /// No corrections yet.
    pub const fn none() -> Self {
        Self {
            last: f64::INFINITY,
            least: f64::INFINITY,
            without_fall: 0,
        }
    }

    /// Whether the residual and any further correction would be pure rounding. A predicted velocity is corrected at
    /// least once.
    #[inline(always)]
    pub fn are_polished<T: Real>(&self, r: Residual) -> bool {
        T::order() == 0
            && r.iteration > 0
            && r.size <= POLISHED_ROUNDINGS * T::EPSILON
            && self.leave_rounding::<T>(r.size / r.previous)
    }

    /// Takes a correction over the length of its part of the velocity, and its residual. `decrement` is Newton's
    /// decrement, the scalar product of both. Its unit is an action for all equations, and it does not depend on their
    /// scales.
    #[inline(always)]
    pub fn next<T: Real>(
        &mut self,
        r: Residual,
        moved: f64,
        decrement: impl FnOnce() -> f64,
    ) -> NextAction {
        // If no velocity was known, as at rest, every correction counts as large.
        let before = self.last.min(1.0);
        let fall = moved / before;
        self.last = moved;
        let unit = T::EPSILON;
        let is_rounding = r.size <= CONVERGED_ROUNDINGS * unit
            || (r.size <= STAGNATED_ROUNDINGS * unit && r.size >= 0.5 * r.previous);
        let judged = match is_rounding {
            true => self.judged::<T>(decrement),
            false => CorrectionAssessment::More,
        };
        // A correction is needed to make derivatives exact.
        let may_end = T::order() == 0 && r.iteration > 0;
        if may_end && r.size <= POLISHED_ROUNDINGS * unit && judged == CorrectionAssessment::Last {
            return NextAction::End;
        }
        // Predicts the residual after this correction, if it is as good as the last one. The decrease of the residual
        // alone can be too optimistic: if one equation dominated at the first trial, it hides the others. The tangent may
        // belong to the last trial: its relative error is then the length of the last correction.
        let factor = FORESIGHT * (r.size / r.previous).max(fall).max(before);
        let is_foreseen = may_end && r.size * factor <= POLISHED_ROUNDINGS * unit;
        match judged != CorrectionAssessment::More
            || (is_foreseen && self.leave_rounding::<T>(factor))
        {
            true => NextAction::CorrectAndEnd,
            false => NextAction::Correct,
        }
    }

    /// Judges the last correction, if the residual is rounding.
    #[inline(always)]
    fn judged<T: Real>(&mut self, decrement: impl FnOnce() -> f64) -> CorrectionAssessment {
        if self.last <= ROUNDINGS * T::EPSILON {
            return CorrectionAssessment::Last;
        }
        let decrement = decrement();
        if decrement < 0.25 * self.least {
            self.least = decrement;
            self.without_fall = 0;
        } else {
            self.without_fall += 1;
        }
        let stands_still = (self.last <= SMALL && self.without_fall > 0)
            || (self.without_fall >= MOST_WITHOUT_FALL && self.last.is_finite());
        match stands_still {
            true => CorrectionAssessment::Noise,
            false => CorrectionAssessment::More,
        }
    }

    /// Whether the next correction can be skipped, if it is smaller than the last one by the factor of the residuals.
    #[inline(always)]
    fn leave_rounding<T: Real>(&self, factor: f64) -> bool {
        self.last * factor <= LEFT_ROUNDINGS * T::EPSILON
            || (self.without_fall > 0 && self.last <= SMALL)
    }
}

#[cfg(test)]
mod tests {
    use super::{CorrectionAssessment, Corrections, NextAction, ROUNDINGS, Residual};
    use crate::groups::{Additive, Group};
    use crate::solvers::newton::{Solved, solve};
    use nalgebra::SMatrix;

    /// The number of these corrections, for a velocity of this length, after which the iteration may end.
    fn ends(length: f64, moved: &[f64]) -> Option<usize> {
        let mut corrections = Corrections::none();
        let found = moved.iter().position(|m| {
            corrections.last = *m / length;
            corrections.judged::<f64>(|| m * m) != CorrectionAssessment::More
        });
        found.map(|i| i + 1)
    }

    #[test]
    fn only_rounding_ends_an_iteration() {
        assert_eq!(ends(1.0, &[0.0]), Some(1));
        assert_eq!(ends(1.0, &[1.0, 1e-3, 1e-7, 1e-15]), Some(4));
        // The start of Newton's method if a cubic term dominates: each correction is two thirds of the previous one.
        let slow: Vec<f64> = (0..20).map(|i| 0.5 * f64::powi(2.0 / 3.0, i)).collect();
        assert_eq!(ends(1.0, &slow), None);
        // Rounding, amplified by a badly conditioned tangent.
        assert_eq!(ends(1.0, &[1e-4, 1e-11, 8e-12]), Some(3));
        // A velocity that is negligible compared with the terms of its equations.
        assert_eq!(ends(1e-17, &[1e-17, 9e-18, 1e-17, 8e-18]), Some(4));
        assert_eq!(ends(1.0, &[f64::NAN; 9]), None);
        assert_eq!(ends(1.0, &[f64::INFINITY; 9]), None);
    }

    #[test]
    fn a_residual_that_falls_further_than_corrections_ends_no_iteration() {
        let next_of = |sizes: [f64; 2], moved: [f64; 2]| {
            let mut corrections = Corrections::none();
            let mut found = NextAction::Correct;
            for (iteration, moved) in moved.into_iter().enumerate() {
                let r = Residual {
                    size: sizes[iteration],
                    previous: [f64::INFINITY, sizes[0]][iteration],
                    iteration,
                };
                found = corrections.next::<f64>(r, moved, || 1.0);
            }
            found
        };
        let next = |moved| next_of([7e8, 2.5e-4], moved);
        // An equation without terms at rest has a large residual relative to its scale; the other corrections decrease
        // quadratically.
        assert_eq!(next([2.9e-2, 8.4e-7]), NextAction::Correct);
        // At zero velocity, the first correction cannot be compared with a length.
        assert_eq!(next([4.7e307, 1.1e-6]), NextAction::Correct);
        // Corrections that decrease as much as the residual are not rounding.
        assert_eq!(next([1e-13, 1e-26]), NextAction::CorrectAndEnd);
        // Two velocities multiply each other. The first correction found one and moved the other by a quarter. The second
        // correction uses the tangent of the first trial, which is wrong by that quarter.
        let decrease = next_of([0.1, 2.1e-9], [0.24, 3.8e-9]);
        assert_eq!(decrease, NextAction::Correct);
    }

    /// Solves `v + 4 b v^3 = p` from rest, with the sizes of the terms multiplied by `factor`. Returns this root and
    /// the root by bisection.
    fn stiffening(p: f64, b: f64, factor: f64) -> (f64, f64) {
        let of = |v: f64| v + 4.0 * b * v.powi(3) - p;
        let solved: Solved<Additive<1, 1>> = solve(
            Group::<f64>::identity(),
            factor * p,
            |v: &Additive<1, 1>| SMatrix::<f64, 1, 1>::new(of(v.matrix()[0])),
            |v| SMatrix::<f64, 1, 1>::new(1.0 + 12.0 * b * v.matrix()[0].powi(2)),
        )
        .expect("a root");
        let (mut below, mut above) = (0.0, p);
        for _ in 0..200 {
            let middle = 0.5 * (below + above);
            if of(middle) < 0.0 {
                below = middle;
            } else {
                above = middle;
            }
        }
        (solved.element.matrix()[0], above)
    }

    #[test]
    fn sizes_that_are_too_large_end_no_iteration() {
        for factor in [1.0, 1e3, 1e6, 1e9, 1e12, 1e15] {
            for p in [1e-9, 0.1, 1e4] {
                for b in [0.0, 1e-6, 0.3, 1e6] {
                    let (found, wanted) = stiffening(p, b, factor);
                    // The accepted error: the root itself is known to a few roundings.
                    let off = (found - wanted).abs();
                    assert!(
                        off <= ROUNDINGS * f64::EPSILON * wanted,
                        "{factor} {p} {b}: {off}"
                    );
                }
            }
        }
    }
}
