//! Residual programs with one summand removed or negated, compared with the oracle's variation of the action.

use super::oracle_bridge::{AGREEMENT, assignment};
use clebsch_core::Derivation;
use clebsch_oracle::oracle::points::{NamedValue, Variation};

/// A point with the oracle's variation.
pub struct Judged {
    pub given: Vec<NamedValue>,
    pub step: (&'static str, f64),
    pub oracle: Variation,
}

/// The number of mutants, and descriptions of those that agree with the oracle everywhere.
pub fn survivors(derivation: &Derivation, points: &[Judged]) -> (usize, Vec<String>) {
    let mutants = derivation.mutations();
    let alive = mutants
        .iter()
        .filter(|mutant| {
            points.iter().all(|point| {
                let values = assignment(&point.given, point.step);
                // A mutant that fails to evaluate counts as detected.
                mutant
                    .residual(&values)
                    .is_ok_and(|residual| point.oracle.disagreement(&residual) <= AGREEMENT)
            })
        })
        .map(|mutant| mutant.describe())
        .collect();
    (mutants.len(), alive)
}
