//! A trajectory in progress: its samples, its checkpoints, and the checks of its steps and invariants.

pub(crate) mod checkpoint;
pub(crate) mod record;
pub(crate) mod stated;
pub(crate) mod step_limit;
pub(crate) mod verdict;
