//! Random models and long lines against the oracle, and second proofs of all that is derived: what `derivation` asks of a
//! few models, asked of many.

#[path = "../common/mod.rs"]
mod common;
mod lagrangians;
mod lattices;
mod second_proof;
