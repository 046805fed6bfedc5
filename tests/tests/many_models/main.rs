//! Many models: random models and long chains against the oracle, second proofs of all derivations, and models stated in these
//! tests. All tests share one binary, because linking dominates the build time of a test.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables, confusable_idents)]
// Some models are deliberately of first order or lack a small-step limit; the macro warns about these with this lint.
#![allow(deprecated)]

#[path = "../common/mod.rs"]
mod common;
mod lagrangians;
mod lattices;
mod second_proof;
mod stated;
