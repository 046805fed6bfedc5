//! SU(2), SE(2) and SE(3): all terms, and sums of random ones.

use super::common::groups::{every_term, of_every_group, random_lagrangians};

/// Sums of random terms of each group.
const LAGRANGIANS: usize = 60;

#[test]
fn every_term_on_every_group() {
    of_every_group!(every_term, 1);
}

#[test]
fn random_lagrangians_on_every_group_and_side() {
    of_every_group!(random_lagrangians, LAGRANGIANS);
}
