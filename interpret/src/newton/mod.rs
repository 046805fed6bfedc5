//! Newton's method for equations of a model file: the runtime's solver, on groups of any kind and size, with residual
//! and tangent run as operations.

mod kind;
mod search;
mod shape;
mod solve;

pub use kind::{Kind, moved};
pub use search::{SearchValue, Sought, remember, solution_value};
pub use shape::Shape;
pub use solve::{AtTrial, Settled, Solve, matrix, vector};
