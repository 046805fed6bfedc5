//! Modes of a linear system, and the verdict on stability that they give.

use crate::eigen::Eigen;
use nalgebra::{Complex, DVector};

/// A growth above this many of its errors is certain.
const CERTAIN: f64 = 10.0;

/// A mode of the linearised system.
#[derive(Clone, Debug)]
pub struct Mode {
    /// For a mode of the step, the multiplier over one step; for a mode of the limit, the exponent per unit of time.
    pub eigenvalue: Complex<f64>,
    /// The angular frequency per unit of time, with the sign of the imaginary part.
    pub frequency: f64,
    /// The rate of growth per unit of time.
    pub growth: f64,
    /// An estimate of the error of frequency and growth.
    pub error: f64,
    /// The unit eigenvector in local coordinates.
    pub vector: DVector<Complex<f64>>,
}

/// Whether small motions stay small, from the growth of modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// A mode grows, by more than ten errors.
    Unstable,
    /// A mode grows by one to ten errors, so that rounding may be the reason.
    Undecided,
    /// No mode grows beyond its error. For conservative systems this is all that linearisation can say. Growth slower
    /// than the error, and drift proportional to time, are not excluded.
    SpectrallyStable,
    /// All modes decay, by more than ten errors.
    Attracting,
}

/// A verdict with the mode that decided it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// The verdict.
    pub stability: Stability,
    /// The rate of growth that decided: the largest one in units of its error.
    pub growth: f64,
    /// The error of this rate.
    pub error: f64,
}

/// Modes from eigenvalues. `of` gives the eigenvalue, growth, frequency and error.
pub(crate) fn modes(
    eigen: &Eigen,
    errors: &[f64],
    of: impl Fn(usize, f64) -> (Complex<f64>, f64, f64, f64),
) -> Vec<Mode> {
    let mode = |(i, &error): (usize, &f64)| {
        let (eigenvalue, growth, frequency, error) = of(i, error);
        Mode {
            eigenvalue,
            frequency,
            growth,
            error,
            vector: eigen.vectors.column(i).into_owned(),
        }
    };
    let mut modes: Vec<Mode> = errors.iter().enumerate().map(mode).collect();
    // Rates of growth within rounding of zero must not decide the order.
    let rounded = |mode: &Mode| {
        if mode.growth.abs() <= CERTAIN * mode.error {
            0.0
        } else {
            mode.growth
        }
    };
    modes.sort_by(|a, b| {
        rounded(b)
            .total_cmp(&rounded(a))
            .then(a.frequency.total_cmp(&b.frequency))
    });
    modes
}

/// The verdict from modes.
pub(crate) fn verdict(modes: &[Mode]) -> Verdict {
    let ratio = |mode: &Mode| mode.growth / mode.error.max(f64::MIN_POSITIVE);
    let decides = modes.iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b)));
    let Some(mode) = decides else {
        return Verdict {
            stability: Stability::SpectrallyStable,
            growth: 0.0,
            error: 0.0,
        };
    };
    let stability = match ratio(mode) {
        ratio if ratio > CERTAIN => Stability::Unstable,
        ratio if ratio > 1.0 => Stability::Undecided,
        ratio if ratio < -CERTAIN => Stability::Attracting,
        _ => Stability::SpectrallyStable,
    };
    Verdict {
        stability,
        growth: mode.growth,
        error: mode.error,
    }
}
