//! The integration loop: advances a trajectory, samples it, checks its invariants; steps of high order composed of
//! the model's own steps; ensembles of independent trajectories. Takes a trajectory and an observer; gives a summary
//! with the drift of every invariant.

mod composition;
mod described;
mod drift;
mod ensemble;
mod forced;
mod longest_step;
mod model;
mod protocol;
mod run;
mod shown;
mod side_by_side;
mod step_method;
mod stepper;
mod steps;
mod stop;
mod substepping;

pub use composition::{Composition, CompositionOrder};
pub use described::{Described, only_size, open};
pub use drift::Drift;
#[doc(hidden)]
pub use drift::{filled, fills, not_less};
pub use ensemble::{Ensemble, EnsembleError, InstructionSet, Work};
pub use longest_step::{Effort, LongestStep, Unknown};
pub use model::Model;
pub use run::{LOOKS, Observer, Summary, Watch, run, run_until_stopped};
pub use side_by_side::{Moving, SideBySide, advance_side_by_side};
pub use step_method::{Offer, Way, counted};
pub use stepper::{Reversible, Stepper};
pub use steps::Steps;
pub use stop::{NotFinite, RunError, Watched};
pub use substepping::{Halved, Halvings};
