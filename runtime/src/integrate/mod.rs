//! The integration loop: runs a trajectory, samples it, watches its invariants.
//! Takes a trajectory and an observer; gives a summary with the drift of every invariant.

mod drift;
mod run;

pub use drift::Drift;
pub use run::{Observer, Summary, run};
