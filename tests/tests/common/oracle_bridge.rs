//! The bridge between the oracle and the engine, and the only file that uses both. Converts the oracle's plain data to assignments
//! of the engine.

use clebsch_core::Assignment;
use clebsch_oracle::oracle::points::NamedValue;

/// Required agreement of a residual, relative to the sum of its absolute summands. Rounding leaves about 1e-14; inverses and
/// quotients of random matrices lose some more digits.
pub const AGREEMENT: f64 = 1e-10;

/// The values of the oracle as an assignment of the engine.
pub fn assignment(given: &[NamedValue], step: (&str, f64)) -> Assignment {
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
