//! Decides when a velocity is found: the last correction must be rounding of the velocity at its own scale, and each
//! residual rounding of its terms. Takes the corrections in order, each relative to the present length of its part of the
//! velocity, and the residuals relative to the sizes of their terms. Neither alone ends an iteration: sizes of terms can
//! be old, and far from a root a long velocity hides its corrections.

use super::{CONVERGED_ROUNDINGS, FORESIGHT, POLISHED_ROUNDINGS, STAGNATED_ROUNDINGS};
use crate::scalar::{Real, larger};

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

impl Residual {
    /// Whether the residual is rounding of its terms, if their sizes are current.
    #[inline(always)]
    fn is_rounding<T: Real>(self) -> bool {
        self.size <= CONVERGED_ROUNDINGS * T::EPSILON
            || (self.size <= STAGNATED_ROUNDINGS * T::EPSILON && self.size >= 0.5 * self.previous)
    }
}

/// A correction over the length of its part of the velocity: the maximum over all parts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    /// Each part has its own length.
    pub own: f64,
    /// The length is at least a share of the longest part.
    pub shared: f64,
}

impl Moved {
    /// No correction.
    pub const NOT: Self = Self {
        own: 0.0,
        shared: 0.0,
    };

    /// A correction that cannot be compared with a length.
    pub const FAR: Self = Self {
        own: f64::INFINITY,
        shared: f64::INFINITY,
    };

    /// The larger of each.
    #[inline(always)]
    pub fn or(self, other: Self) -> Self {
        Self {
            own: larger(self.own, other.own),
            shared: larger(self.shared, other.shared),
        }
    }
}

/// The next action after a correction is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NextAction {
    /// Apply the correction and continue.
    Correct,
    /// Apply the correction and stop.
    CorrectAndEnd,
    /// Apply the correction and stop, if the sizes of the terms are of this step: some part of the velocity is only
    /// rounding of longer parts, or corrections no longer decrease.
    EndIfRounding,
    /// Compute the sizes of the terms at this trial, and evaluate the equations again.
    Measure,
    /// Stop without the correction: the error is already at rounding level, and the correction would add its own
    /// rounding.
    End,
}

/// The corrections of one iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corrections {
    last: Moved,
    /// The last decrement that was below a quarter of the previous minimum: its correction was half as long.
    least: f64,
    /// The number of corrections since then.
    without_fall: u32,
}

impl Corrections {
    /// No corrections yet.
    pub const fn none() -> Self {
        Self {
            last: Moved::FAR,
            least: f64::INFINITY,
            without_fall: 0,
        }
    }

    /// Whether the next correction is rounding with the factored tangent, too.
    #[inline(always)]
    pub fn are_small(&self) -> bool {
        self.last.shared <= SMALL
    }

    /// Takes a correction and its residual. `decrement` is Newton's decrement, the scalar product of both. Its unit is an
    /// action for all equations, and it does not depend on their scales.
    #[inline(always)]
    pub fn next<T: Real>(
        &mut self,
        r: Residual,
        moved: Moved,
        decrement: impl FnOnce() -> f64,
    ) -> NextAction {
        let before = self.last;
        self.last = moved;
        let is_rounding = r.is_rounding::<T>();
        // A predicted velocity is corrected at least once, and derivatives become exact by a correction.
        let may_end = T::ORDER == 0 && r.iteration > 0;
        let unit = T::EPSILON;
        if is_rounding && moved.own <= ROUNDINGS * unit {
            let is_exact =
                moved.own <= LEFT_ROUNDINGS * unit && r.size <= POLISHED_ROUNDINGS * unit;
            return match may_end && is_exact {
                true => NextAction::End,
                false => NextAction::CorrectAndEnd,
            };
        }
        if may_end && is_foreseen::<T>(r, moved.own, before.own) {
            return NextAction::CorrectAndEnd;
        }
        // A part that still comes nearer to its own root is not rounding, neither of longer parts nor of its terms.
        let falls = moved.own < 0.25 * before.own;
        let ends = is_rounding
            && (self.stand_still(decrement()) || moved.shared <= ROUNDINGS * unit)
            && !falls;
        match ends {
            true => NextAction::EndIfRounding,
            false => NextAction::Correct,
        }
    }

    /// Whether the corrections no longer decrease.
    #[inline(always)]
    fn stand_still(&mut self, decrement: f64) -> bool {
        if decrement < 0.25 * self.least {
            self.least = decrement;
            self.without_fall = 0;
        } else {
            self.without_fall += 1;
        }
        (self.last.shared <= SMALL && self.without_fall > 0)
            || (self.without_fall >= MOST_WITHOUT_FALL && self.last.shared.is_finite())
    }
}

/// Whether the correction after this one would be rounding, and its residual too: both decrease as the last ones. The
/// decrease of residuals alone can be too optimistic: if one equation dominated at the first trial, it hides the others. The
/// tangent may belong to the last trial: its relative error is then the length of the last correction.
#[inline(always)]
fn is_foreseen<T: Real>(r: Residual, moved: f64, before: f64) -> bool {
    // If no velocity was known, as at rest, every correction counts as large.
    let before = before.min(1.0);
    let factor = FORESIGHT * (r.size / r.previous).max(moved / before).max(before);
    r.size * factor <= POLISHED_ROUNDINGS * T::EPSILON
        && moved * factor <= LEFT_ROUNDINGS * T::EPSILON
}

#[cfg(test)]
mod tests {
    use super::{Corrections, Moved, NextAction, ROUNDINGS, Residual};
    use crate::groups::{Additive, Group};
    use crate::solvers::newton::{Solved, solve};
    use nalgebra::SMatrix;

    /// The number of these corrections, for a velocity of this length, after which the iteration ends. All residuals
    /// are rounding of their terms.
    fn ends(length: f64, moved: &[f64]) -> Option<usize> {
        let mut corrections = Corrections::none();
        let mut each = moved.iter().enumerate();
        let found = each.position(|(iteration, moved)| {
            let r = Residual {
                size: 0.0,
                previous: 0.0,
                iteration,
            };
            let relative = moved / length;
            let relative = Moved {
                own: relative,
                shared: relative,
            };
            let next = corrections.next::<f64>(r, relative, || moved * moved);
            next != NextAction::Correct
        });
        found.map(|i| i + 1)
    }

    #[test]
    fn only_rounding_ends_an_iteration() {
        assert_eq!(ends(1.0, &[0.0]), Some(1));
        assert_eq!(ends(1.0, &[1.0, 1e-3, 1e-7, 1e-15]), Some(4));
        // The fourth correction would be at most 1e-16.
        assert_eq!(ends(1.0, &[1.0, 1e-5, 1e-12, 1e-20]), Some(3));
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
                let moved = Moved {
                    own: moved,
                    shared: moved,
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
        assert_eq!(next([1e-10, 1e-13]), NextAction::CorrectAndEnd);
        assert_eq!(next([1e-13, 1e-26]), NextAction::End);
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
