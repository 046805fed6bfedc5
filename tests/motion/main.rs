//! Tests of emitted and hand-written steppers in motion: reference states, orders, conservation, symplecticity, solvers and their
//! errors, ensembles. All tests share one binary, because linking dominates the build time of a test.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables, confusable_idents)]
// Some models are deliberately of first order or lack a small-step limit; the macro warns about these with this lint.
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
mod handwritten;
mod handwritten_laws;
mod handwritten_oracle;
mod handwritten_systems;
mod seeded;
mod solver_choice;
mod substepping;
mod systems_against_hand;
