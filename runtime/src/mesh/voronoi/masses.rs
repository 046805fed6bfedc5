//! Checks the masses of particles. Takes one mass for each particle; rejects invalid ones.

use crate::{ParameterError, Problem, Real};

/// Rejects invalid masses.
pub(super) fn check_masses<T: Real>(masses: &[T], particles: usize) -> Result<(), ParameterError> {
    let refused = |problem, remedy| ParameterError {
        field: "m",
        problem,
        remedy,
    };
    if masses.len() != particles {
        let text = "there is one mass for each particle";
        let remedy = "give as many masses as particles";
        return Err(refused(Problem::AssumptionFails { text }, remedy));
    }
    for (index, mass) in masses.iter().enumerate() {
        let value = mass.value();
        let remedy = "give every particle a positive mass";
        if !mass.is_finite() {
            return Err(refused(Problem::NotFinite { index, value }, remedy));
        }
        if value <= 0.0 {
            return Err(refused(Problem::NotPositive { value }, remedy));
        }
    }
    Ok(())
}
