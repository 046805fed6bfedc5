//! Random Lagrangians on every group, in two halves that run in parallel.

use super::common::lagrangians::agree_and_their_mutants_do_not;
use clebsch_oracle::sizes::DERIVED;

#[test]
fn of_even_seeds() {
    agree_and_their_mutants_do_not((0..DERIVED).step_by(2));
}

#[test]
fn of_odd_seeds() {
    agree_and_their_mutants_do_not((1..DERIVED).step_by(2));
}
