//! Newton's method for equations that were read: the solver of the runtime on groups of any kind and size,
//! with residual and tangent run as operations.

mod search;
mod shape;
mod solve;

pub use search::{Held, Sought, remember};
pub use shape::{Kind, Shape};
pub use solve::{Settled, Solve};
