//! Words and signs of Python, other languages and papers that the language does not have. The errors suggest what to
//! write instead.

mod functions;
mod names;
mod signs;
mod statements;

pub(crate) use functions::{PAIRS, RADIANS, function, how_to_sum, nearest_function};
pub(crate) use names::{ANGLES, MODULES, STEPS, TIMES, VELOCITIES, name, shape};
pub(super) use signs::{VECTOR, ends_expression, ends_statement, instead_of_operand};
pub(crate) use statements::is_force;
pub(super) use statements::{no_start, statement};
