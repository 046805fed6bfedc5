//! How far an invariant has moved: relative to its natural scale, absolute where that scale is zero.
//! Takes its value at every step; gives the largest and the last deviation.

use crate::scalar::larger;

/// The drift of one component of one invariant since the run began.
///
/// A body at rest has no momentum to compare with, one without weight no potential: an invariant
/// whose natural scale is zero (or below the smallest normal number, where quotients have no digits)
/// is measured by its change itself, in its own unit. [`Drift::is_absolute`] says so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// `max |I_k - I_0| / scale` over every step, or `max |I_k - I_0|` where the scale is zero; NaN
    /// once a value was NaN.
    pub worst: f64,
    /// `(I_k - I_0) / scale` at the last step, with its sign, or `I_k - I_0` where the scale is zero.
    pub last: f64,
    /// The natural scale of the component, as the trajectory gives it at node 0.
    pub scale: f64,
}

impl Drift {
    /// No drift yet.
    pub(super) fn at_rest(scale: f64) -> Self {
        Self {
            worst: 0.0,
            last: 0.0,
            scale,
        }
    }

    /// The drift that a deviation `I_k - I_0` makes, with its sign: divided by the natural scale, or
    /// as it is where the scale is zero. NaN if either number is.
    #[inline]
    #[must_use]
    pub fn of(deviation: f64, scale: f64) -> f64 {
        if scale.abs() < f64::MIN_POSITIVE {
            deviation
        } else {
            deviation / scale
        }
    }

    /// Whether the drift is the change itself, the natural scale being zero.
    #[must_use]
    pub fn is_absolute(&self) -> bool {
        self.scale.abs() < f64::MIN_POSITIVE
    }

    /// Takes in the deviation `I_k - I_0`.
    #[inline]
    pub(super) fn record(&mut self, deviation: f64) {
        self.last = Self::of(deviation, self.scale);
        self.worst = larger(self.worst, self.last.abs());
    }
}

#[cfg(test)]
mod tests {
    use super::Drift;

    fn after(scale: f64, deviations: &[f64]) -> Drift {
        let mut drift = Drift::at_rest(scale);
        deviations.iter().for_each(|d| drift.record(*d));
        drift
    }

    #[test]
    fn relative_to_a_scale_and_absolute_without_one() {
        let drift = after(4.0, &[2.0, -6.0, 1.0]);
        assert_eq!((drift.worst, drift.last), (1.5, 0.25));
        assert!(!drift.is_absolute());
        // Zero, and what is too small to divide by: 1 / 1e-310 is infinite.
        for scale in [0.0, -0.0, 1e-310] {
            let drift = after(scale, &[0.0, -1e-15, 1e-16]);
            assert_eq!((drift.worst, drift.last), (1e-15, 1e-16));
            assert!(drift.is_absolute());
            assert_eq!(after(scale, &[0.0]).worst, 0.0);
        }
    }

    #[test]
    fn nan_enters_anywhere_and_stays() {
        for deviations in [
            [f64::NAN, 0.0, 9.0],
            [0.0, f64::NAN, 9.0],
            [9.0, 0.0, f64::NAN],
        ] {
            for scale in [0.0, 4.0] {
                assert!(after(scale, &deviations).worst.is_nan());
            }
        }
        assert!(after(f64::NAN, &[0.0]).worst.is_nan());
    }
}
