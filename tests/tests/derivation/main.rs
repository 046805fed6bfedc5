//! What the engine derives, prints and refuses: against the oracle, against snapshots, against files of the repository.
//! One binary, since linking is most of what a test costs.

// Models are stated in Greek letters, as in the papers.
#![allow(mixed_script_confusables, confusable_idents)]
// Some models are of first order or without a limit on purpose, of which the macro warns by this lint.
#![allow(deprecated)]

#[path = "../common/allocations.rs"]
mod allocations;
mod architecture;
mod citations;
#[path = "../common/mod.rs"]
mod common;
mod continuous_limit;
mod documents;
mod equations_of_a_step;
mod expansion;
mod folders;
mod generated_fresh;
mod held;
mod kinetic_analogy;
mod latex;
mod lattices;
mod meant;
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
