//! Steps of rotations of space.

use crate::steps::judged;

#[path = "rows/coupled.rs"]
mod coupled;
#[path = "rows/space.rs"]
mod space;
#[path = "rows/velocities.rs"]
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
