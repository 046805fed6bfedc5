//! The models of the table: rotations of space, models on other groups, fields, chains.

use super::{judged, judged_lines};

mod chains;
mod constraints;
mod coupled;
mod fields;
mod maps;
mod motions;
mod quaternions;
mod rods;
mod rotations;
mod space;
mod velocities;

#[test]
fn powers_products_and_functions_of_velocities() {
    judged(velocities::ROWS);
}

#[test]
fn what_rotations_carry_and_what_their_inertia_depends_on() {
    judged(coupled::ROWS);
}

#[test]
fn velocities_seen_from_space() {
    judged(space::ROWS);
}

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

#[test]
fn chains_of_numbers_and_vectors() {
    judged_lines(chains::ROWS);
}

#[test]
fn bodies_along_a_line() {
    judged_lines(rods::ROWS);
}
