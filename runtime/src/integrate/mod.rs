//! The integration loop: runs a trajectory, samples it, watches its invariants; and steps of high
//! order composed of a model's own.
//! Takes a trajectory and an observer; gives a summary with the drift of every invariant.

mod composition;
mod drift;
mod run;
mod stepper;

pub use composition::{Composition, CompositionOrder};
pub use drift::Drift;
pub use run::{Observer, Summary, run};
pub use stepper::{Reversible, Stepper};
