//! Words and signs of Python, of other languages and of papers that this language does not have. Takes the word, or the
//! cursor before the sign; gives the mistake, with what to write instead.

mod functions;
mod names;
mod signs;
mod statements;

pub(crate) use functions::{PAIRS, RADIANS, function};
pub(crate) use names::{ANGLES, MODULES, STEPS, TIMES, VELOCITIES, name, shape};
pub(super) use signs::{VECTOR, ends_expression, ends_statement, instead_of_operand};
pub(crate) use statements::is_force;
pub(super) use statements::{no_start, statement};
