//! When corrections say that a velocity is found: the last one is rounding of the velocity in its own scale.
//! Takes one correction after the other, each relative to the length of the part of the velocity it changes. Knows
//! nothing of the sizes by which residuals are judged, so that wrong ones end no iteration.

use crate::scalar::Real;

/// A correction of fewer roundings of its part of the velocity is rounding: solving for it makes a few of a badly
/// conditioned tangent.
const ROUNDINGS: f64 = 64.0;

/// A correction of fewer roundings need not be made.
const LEFT_ROUNDINGS: f64 = 4.0;

/// A correction below this that is not half of the one before is what rounding leaves: Newton's method squares it
/// otherwise, and a tangent of some steps before still makes it a hundredth.
const SMALL: f64 = 1e-8;

/// So many larger corrections without progress are rounding as well: of a velocity that vanishes beside the terms of
/// its equations, at rest or where it turns, nothing but rounding is left to correct.
const WITHOUT_PROGRESS: u32 = 3;

/// The corrections of one iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corrections {
    last: f64,
    /// The last that was less than half of those before.
    least: f64,
    /// How many followed that one.
    without_progress: u32,
}

impl Corrections {
    /// None yet.
    pub const fn none() -> Self {
        Self {
            last: f64::INFINITY,
            least: f64::INFINITY,
            without_progress: 0,
        }
    }

    /// Takes a correction over the length of its part of the velocity; says whether it was rounding.
    #[inline(always)]
    pub fn are_rounding_with<T: Real>(&mut self, moved: f64) -> bool {
        // NaN is no progress, and ends nothing.
        if moved < 0.5 * self.least {
            self.least = moved;
            self.without_progress = 0;
        } else {
            self.without_progress += 1;
        }
        self.last = moved;
        moved <= ROUNDINGS * T::EPSILON
            || (moved <= SMALL && self.without_progress > 0)
            || (self.without_progress >= WITHOUT_PROGRESS && moved.is_finite())
    }

    /// Whether the correction after the last need not be made, if it is smaller by the same factor as the residual.
    #[inline(always)]
    pub fn leave_rounding<T: Real>(&self, factor: f64) -> bool {
        self.last * factor <= ROUNDINGS * T::EPSILON
            || (self.without_progress > 0 && self.last <= SMALL)
    }
}

#[cfg(test)]
mod tests {
    use super::Corrections;

    /// After how many of these corrections the iteration may end.
    fn ends(moved: &[f64]) -> Option<usize> {
        let mut corrections = Corrections::none();
        let found = moved
            .iter()
            .position(|m| corrections.are_rounding_with::<f64>(*m));
        found.map(|i| i + 1)
    }

    #[test]
    fn only_rounding_ends_an_iteration() {
        assert_eq!(ends(&[0.0]), Some(1));
        assert_eq!(ends(&[1.0, 1e-3, 1e-7, 1e-15]), Some(4));
        // As Newton's method begins where a cubic term rules: each correction is two thirds of the one before.
        let slow: Vec<f64> = (0..20).map(|i| 0.5 * f64::powi(2.0 / 3.0, i)).collect();
        assert_eq!(ends(&slow), None);
        // What a badly conditioned tangent makes of rounding.
        assert_eq!(ends(&[1e-4, 1e-11, 8e-12]), Some(3));
        // A velocity that vanishes beside the terms of its equations.
        assert_eq!(ends(&[1.0, 0.9, 1.0, 0.8]), Some(4));
        let not_a_number = [f64::NAN; 9];
        assert_eq!(ends(&not_a_number), None);
        assert_eq!(ends(&[f64::INFINITY; 9]), None);
    }
}
