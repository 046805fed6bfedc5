//! What the quick tests of derivations and those of many models share: the way from the oracle to the engine, typed
//! actions of lines, and random models.

pub mod lagrangians;
pub mod lattices;
pub mod mutants;
pub mod oracle_bridge;
