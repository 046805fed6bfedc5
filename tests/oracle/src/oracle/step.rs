//! One step of a discrete action, solved apart from the engine: of `p = -D1 L(q, q')` the end `q'`, then `p' = D2 L(q, q')`.
//! Takes an action typed by hand over any [`Number`](super::dual::Number), a start and its momenta; gives both in 32 digits.
//! Elements of groups are matrices, varied by the basis of their Lie algebra in the frame of the momentum.

pub mod action;
pub mod compare;
pub mod dense;
pub mod group;
pub mod motion;
pub mod place;
pub mod problem;
pub mod solve;

pub use action::{Action, Edge};
pub use motion::{Block, Motion};
pub use place::{Place, Table};
pub use problem::Problem;
pub use solve::Solved;
