//! Between the oracle and the engine: the only place where both are known.
//! Takes the plain data of the oracle; gives assignments for the engine and compares residuals.

use clebsch_core::Assignment;
use clebsch_oracle::oracle::action::Variation;
use clebsch_oracle::oracle::points::Given;
use clebsch_oracle::physics::measure::worse;

/// Agreement asked of a residual, relative to the sum of the sizes of its summands. Rounding leaves about
/// 1e-14; inverses and quotients of random matrices lose some digits more.
pub const AGREEMENT: f64 = 1e-10;

/// The values of the oracle as the engine takes them.
pub fn assignment(given: &[Given], step: (&str, f64)) -> Assignment {
    let mut assignment = Assignment::new();
    for value in given {
        assignment.set(
            &value.name,
            value.shift,
            value.rows,
            value.cols,
            &value.data,
        );
    }
    assignment.set_scalar(step.0, step.1);
    assignment
}

/// The largest difference of a component, relative to the natural scale; infinite for different lengths
/// and for anything that is not finite, which must never pass as agreement.
pub fn disagreement(oracle: &Variation, engine: &[f64]) -> f64 {
    if oracle.derivative.len() != engine.len() {
        return f64::INFINITY;
    }
    let mut worst: f64 = 0.0;
    for (expected, found) in oracle.derivative.iter().zip(engine) {
        let difference = (expected - found).abs() / oracle.scale;
        if !difference.is_finite() {
            return f64::INFINITY;
        }
        worst = worse(worst, difference);
    }
    worst
}
