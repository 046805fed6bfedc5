//! One step of models on groups other than the rotations of space, and of fields, against the oracle.

#![allow(missing_docs)]

mod steps;

use steps::judged;

#[path = "steps/rows/constraints.rs"]
mod constraints;
#[path = "steps/rows/fields.rs"]
mod fields;
#[path = "steps/rows/maps.rs"]
mod maps;
#[path = "steps/rows/motions.rs"]
mod motions;
#[path = "steps/rows/quaternions.rs"]
mod quaternions;
#[path = "steps/rows/rotations.rs"]
mod rotations;

#[test]
fn rotations_of_the_plane_and_of_four_dimensions() {
    judged(rotations::ROWS);
}

#[test]
fn unit_quaternions() {
    judged(quaternions::ROWS);
}

#[test]
fn rigid_motions() {
    judged(motions::ROWS);
}

#[test]
fn linear_maps() {
    judged(maps::ROWS);
}

#[test]
fn numbers_vectors_and_matrices() {
    judged(fields::ROWS);
}

#[test]
fn constraints_that_are_held() {
    judged(constraints::ROWS);
}
