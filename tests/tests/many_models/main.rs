//! Random models and long lines against the oracle, and second proofs of all that is derived: what `derivation` asks of a
//! few models, asked of many.

#[path = "../common/mod.rs"]
mod common;
mod groups;
mod lagrangians;
mod lattices;
mod mixed;
mod second_proof;
