//! Models that run from their texts, against compiled models and against actions typed by hand. All tests share one binary,
//! because linking dominates the build time of a test.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables)]

mod constraints;
mod derivatives;
mod fluids;
mod forms_of_lines;
mod gallery;
mod lattices;
mod linear_in_velocity;
mod other;
mod shared_tapes;
mod side_by_side;
mod steps;
