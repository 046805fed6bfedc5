//! Chains and rings of up to fifty sites, with all pairs of ends, against hand-written actions;
//! `tests/tests/derivation/lattices.rs` tests the shortest of each kind.

use super::common::lattices::{
    Ends, FREE, beam, body_chain, hoop, prescribed_end, rod, scalars, sets, shallow_water, tops,
};

#[test]
fn toda_chains() {
    for segments in [12, 50] {
        scalars::toda(segments, Ends::Ring);
        scalars::toda(segments, FREE);
    }
}

#[test]
fn pendulums_in_a_row() {
    for segments in [12, 50] {
        for first in ["free", "pinned"] {
            for last in ["free", "pinned"] {
                scalars::pendulums(segments, Ends::Open(first, last));
            }
        }
    }
}

#[test]
fn pendulums_in_a_ring() {
    for segments in [12, 50] {
        scalars::pendulums(segments, Ends::Ring);
    }
}

#[test]
fn tops_in_a_row() {
    for segments in [12, 50] {
        tops::check(segments, FREE);
    }
}

#[test]
fn tops_in_a_ring() {
    for segments in [12, 50] {
        tops::check(segments, Ends::Ring);
    }
}

#[test]
fn held_tops() {
    for segments in [2, 5, 12] {
        for first in ["held", "free"] {
            for last in ["free", "held"] {
                prescribed_end::check(segments, Ends::Open(first, last));
            }
        }
    }
}

#[test]
fn tops_that_carry_in_a_ring() {
    for segments in [5, 12] {
        prescribed_end::check(segments, Ends::Ring);
    }
}

#[test]
fn held_tops_in_a_long_row() {
    prescribed_end::check(50, Ends::Open("held", "held"));
}

#[test]
fn bodies_in_a_row() {
    for segments in [12, 50] {
        body_chain::check(segments);
    }
}

#[test]
fn beams_with_any_ends() {
    for segments in [2, 3, 5, 12] {
        for first in ["free", "spring", "pinned"] {
            for last in ["free", "pinned", "spring"] {
                beam::check(segments, Ends::Open(first, last));
            }
        }
    }
}

#[test]
fn beams_in_a_ring() {
    beam::check(12, Ends::Ring);
}

#[test]
fn long_beams() {
    // With 50 segments the derivation exceeds the engine's limit.
    beam::check(40, Ends::Open("spring", "spring"));
    beam::check(40, Ends::Ring);
}

#[test]
fn short_rods() {
    for segments in [2, 3, 5] {
        rod::any_ends(segments);
    }
}

#[test]
fn longer_rods() {
    rod::any_ends(12);
}

#[test]
fn long_rods() {
    for (first, last) in [
        ("free", "free"),
        ("free", "pinned"),
        ("pinned", "clamped"),
        ("clamped", "load"),
    ] {
        rod::check(50, first, last);
    }
}

#[test]
fn hoops() {
    for segments in [3, 5, 12, 24] {
        hoop::check(segments, Ends::Ring);
    }
}

#[test]
fn hoops_cut_open() {
    for segments in [3, 5, 12, 24] {
        hoop::check(segments, FREE);
    }
}

#[test]
fn a_cloud_beside_a_line() {
    for (particles, segments) in [(3, 5), (5, 3), (12, 12)] {
        sets::check(particles, segments, FREE);
        sets::check(particles, segments, Ends::Ring);
    }
}

#[test]
fn a_large_cloud_beside_a_long_line() {
    sets::check(50, 50, FREE);
}

#[test]
fn shallow_water() {
    for segments in [9, 12, 50] {
        shallow_water::check(segments, Ends::Ring);
    }
    for segments in [8, 12, 50] {
        shallow_water::check(segments, FREE);
    }
}
