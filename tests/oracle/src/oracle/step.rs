//! Solves one step of a discrete action, independently of the engine: `q'` from `p = -D1 L(q, q')`, then `p' = D2 L(q, q')`. Takes
//! a hand-written action over any [`Number`](super::dual::Number), an initial state and its momenta; gives `q'` and `p'` to 32
//! digits. Group elements are matrices, varied by the basis of their Lie algebra in the frame of the momentum.

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
