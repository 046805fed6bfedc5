//! Short chains and rings of all kinds against hand-written actions; `tests/tests/many_models/` tests longer ones.

use super::common::lattices::{
    Ends, FREE, beam, body_chain, hoop, prescribed_end, rod, scalars, sets, shallow_water, tops,
};

#[test]
fn toda_chains() {
    for segments in [1, 2, 3, 5] {
        scalars::toda(segments, Ends::Ring);
        scalars::toda(segments, FREE);
    }
}

#[test]
fn pendulums_in_a_row() {
    for segments in [2, 3, 5] {
        for first in ["free", "pinned"] {
            for last in ["free", "pinned"] {
                scalars::pendulums(segments, Ends::Open(first, last));
            }
        }
    }
}

#[test]
fn pendulums_in_a_ring() {
    for segments in [1, 2, 3, 5] {
        scalars::pendulums(segments, Ends::Ring);
    }
}

#[test]
fn tops_in_a_row() {
    for segments in [1, 2, 3, 5] {
        tops::check(segments, FREE);
    }
}

#[test]
fn tops_in_a_ring() {
    for segments in [1, 2, 3, 5] {
        tops::check(segments, Ends::Ring);
    }
}

#[test]
fn held_tops() {
    prescribed_end::check(1, Ends::Open("held", "free"));
    prescribed_end::check(1, Ends::Open("free", "held"));
    for first in ["held", "free"] {
        for last in ["free", "held"] {
            prescribed_end::check(3, Ends::Open(first, last));
        }
    }
}

#[test]
fn tops_that_carry_in_a_ring() {
    for segments in [1, 2, 3] {
        prescribed_end::check(segments, Ends::Ring);
    }
}

#[test]
fn bodies_in_a_row() {
    for segments in [1, 2, 3, 5] {
        body_chain::check(segments);
    }
}

#[test]
fn beams_with_any_ends() {
    for (first, last) in [("free", "free"), ("spring", "pinned"), ("pinned", "spring")] {
        beam::check(1, Ends::Open(first, last));
        beam::check(3, Ends::Open(first, last));
    }
}

#[test]
fn beams_in_a_ring() {
    for segments in [1, 2, 3, 4, 5] {
        beam::check(segments, Ends::Ring);
    }
}

#[test]
fn rods_with_any_ends() {
    rod::any_ends(1);
    rod::check(3, "pinned", "load");
}

#[test]
fn hoops() {
    for segments in [1, 2] {
        hoop::check(segments, Ends::Ring);
        hoop::check(segments, FREE);
    }
}

#[test]
fn a_cloud_beside_a_line() {
    for (particles, segments) in [(1, 2), (2, 2), (2, 3)] {
        sets::check(particles, segments, FREE);
        sets::check(particles, segments, Ends::Ring);
    }
}

#[test]
fn shallow_water() {
    for segments in [2, 3, 5] {
        shallow_water::check(segments, Ends::Ring);
        shallow_water::check(segments, FREE);
    }
    shallow_water::check(1, Ends::Ring);
}
