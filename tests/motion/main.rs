//! Steppers, emitted and written by hand, in motion: reference states, orders, what is conserved, symplecticity,
//! solvers and their refusals, ensembles. One binary, since linking is most of what a test costs.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables, confusable_idents)]
// Some models are of first order or without a limit on purpose, of which the macro warns by this lint.
#![allow(deprecated)]

mod allocation;
#[path = "../tests/common/allocations.rs"]
mod allocations;
mod cayley_klein_symmetric;
mod coupled_solve;
mod ensembles;
mod errata;
mod fields_against_hand;
mod gallery_bracket;
mod gallery_laws;
mod gallery_refusals;
mod gallery_symplectic;
mod generated_against_hand;
mod generated_conservation;
mod generated_groups;
mod generated_motion;
mod generated_order;
mod generated_reference;
mod generated_scalars;
mod generated_symplectic;
mod groups_against_hand;
mod halved;
mod handwritten;
mod handwritten_laws;
mod handwritten_oracle;
mod handwritten_systems;
mod seeded;
mod solver_choice;
mod systems_against_hand;
