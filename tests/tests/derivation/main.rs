//! Tests of derivation, printing and rejection of models: against the oracle, snapshots, and files of the repository. All tests
//! share one binary, because linking dominates the build time of a test.

// Models are stated in Greek letters, as in the papers.
#![allow(mixed_script_confusables, confusable_idents)]
// Some models are deliberately of first order or lack a small-step limit; the macro warns about these with this lint.
#![allow(deprecated)]

#[path = "../common/allocations.rs"]
mod allocations;
mod architecture;
mod citations;
#[path = "../common/mod.rs"]
mod common;
mod constraints;
mod continuous_limit;
mod documents;
mod equations_of_a_step;
mod expansion;
mod folders;
mod generated_fresh;
mod kinetic_analogy;
mod latex;
mod lattices;
mod meaning_of_sums;
mod mutation;
mod oracle_groups;
mod oracle_interpreted;
mod oracle_self;
mod prose;
mod quoted_figures;
mod reduction;
mod reduction_of_motions;
mod reference_numbers;
mod refusals;
mod snapshots;
mod wrong_sides;
