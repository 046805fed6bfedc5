//! Shared by the quick derivation tests and the tests of many models: the bridge from the oracle to the engine, hand-written
//! actions of chains, and random models.

pub mod lagrangians;
pub mod lattices;
pub mod mutants;
pub mod oracle_bridge;
