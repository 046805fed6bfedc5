//! Steppers of models stated in these tests, on every group and in any dimension, for features that the gallery does not use. Most
//! models run from their text. Tests of names in a crate, of other scalars and of ensembles compile theirs.

mod blocks;
mod body_n;
mod bracket;
mod carried_momentum;
mod carried_references;
mod coordinates;
mod derived_residual;
mod dimensions_against_hand;
mod ellipsoids;
mod fields;
mod fields_and_groups;
mod high_order;
mod hygiene;
mod invariants;
mod joint_symmetries;
mod left_domain;
mod newton_refusals;
mod plane_motions;
mod printed_formulas;
mod rounding_of_fields;
mod singular_starts;
mod stated_any_dimension;
mod stated_models;
mod text_model;
mod two_numbers;
mod unit_quaternions;
