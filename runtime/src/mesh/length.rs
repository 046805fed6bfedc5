//! The admissible smoothing lengths of a depth: from zero to a hundred domains. A larger value leaves only the mean,
//! and rounding of its square, compared with the square of a cell, would change the mass.

use super::Domain;
use crate::scalar::largest;
use crate::{ParameterError, Problem, Real};

/// The largest length, in units of the domain.
const MOST: f64 = 100.0;

/// Checks that a length is admissible.
///
/// # Errors
/// If the length is NaN, infinite, negative or too long.
pub(super) fn check_length<T: Real, const D: usize>(
    alpha: T,
    domain: &Domain<D>,
) -> Result<(), ParameterError> {
    let value = alpha.value();
    let longest = largest(domain.lengths);
    let refused = |problem, remedy| {
        Err(ParameterError {
            field: "alpha",
            problem,
            remedy,
        })
    };
    if !alpha.is_finite() {
        let index = 0;
        return refused(
            Problem::NotFinite { index, value },
            "give the smoothing length of the depth",
        );
    }
    if alpha.least() < 0.0 {
        return refused(
            Problem::AssumptionFails { text: "alpha >= 0" },
            "give a length that is zero or positive, about twice the distance between particles or nodes",
        );
    }
    if value > MOST * longest {
        return refused(
            Problem::AssumptionFails {
                text: "alpha <= 100 L, with L the longest side of the domain",
            },
            "give a shorter length: smoothing over this length leaves only the mean of the depth",
        );
    }
    Ok(())
}
