//! The steps, energies and quantities of a case with exact derivatives, for commands that analyse a motion. Takes a
//! resolved model and a plan; gives the flow, the energy and expressions in observables and invariants.
//!
//! Derivatives always come from the text of a model, also for models that were compiled.

pub(crate) mod coordinates;
pub(crate) mod energy;
pub(crate) mod expression;
pub(crate) mod fixed;
pub(crate) mod flow;
pub(crate) mod problem;
mod symmetry;
