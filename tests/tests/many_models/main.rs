//! Random models and long chains against the oracle, and second proofs of all derivations: the checks of `derivation` for many more
//! models.

#[path = "../common/mod.rs"]
mod common;
mod lagrangians;
mod lattices;
mod second_proof;
