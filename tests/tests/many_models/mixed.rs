//! Random models of fields and groups together, in two halves that run side by side.

use super::common::mixed::agree_with_their_own_masses_alone;
use clebsch_oracle::oracle::points::asked_for;

/// Models; more by `RANDOM_MIXED=1000`.
fn count() -> u64 {
    asked_for("RANDOM_MIXED", 100)
}

#[test]
fn of_even_seeds() {
    agree_with_their_own_masses_alone((0..count()).step_by(2));
}

#[test]
fn of_odd_seeds() {
    agree_with_their_own_masses_alone((1..count()).step_by(2));
}
