//! Between the oracle and the engine: the only place where both are known.
//! Takes the plain data of the oracle; gives assignments for the engine.

use clebsch_core::Assignment;
use clebsch_oracle::oracle::points::Given;

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
