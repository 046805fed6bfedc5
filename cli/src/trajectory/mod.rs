//! A trajectory on its way: its samples, the words of its checkpoints, and what is judged of it.

pub(crate) mod checkpoint;
pub(crate) mod record;
pub(crate) mod stated;
pub(crate) mod step_limit;
pub(crate) mod verdict;
