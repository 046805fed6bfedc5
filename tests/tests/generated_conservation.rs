//! What the generated steppers conserve over long runs: to rounding where the law is exact, without drift otherwise.
//! The same measurements reject steppers with a fault: see the tests of the hand-written steppers.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables)]

mod generated_motion;

use clebsch_tests::physics::cases::{
    asymmetric_body, flat_body, generic_top, hanging_top, lagrange_top, steady_body, symmetric_body,
};
use clebsch_tests::physics::measure::{energies, free_drift, top_drift};
use clebsch_tests::physics::trend::trend;
use clebsch_tests::physics::truth::inverse_inertia;
use generated_motion::{GeneratedBody, GeneratedTop};

const MILLION: u64 = 1_000_000;

#[test]
fn free_bodies_conserve_to_rounding() {
    for (name, start) in [
        ("I = (2, 2, 1)", symmetric_body()),
        ("I = (3.5, 2.5, 2)", asymmetric_body()),
        ("I = (1, 2, 3), J singular", flat_body()),
        ("steady", steady_body()),
    ] {
        let inverse = inverse_inertia(&start.top.poinsot);
        let drift =
            free_drift(&mut GeneratedBody::start(&start), &inverse, MILLION).expect("solvable");
        println!("{name}: {drift:?}");
        assert!(drift.worst() < 1e-14, "{name}: {drift:?}");
    }
}

#[test]
fn a_free_body_in_any_axes_conserves_to_rounding() {
    let start = generic_top();
    let inverse = inverse_inertia(&start.top.poinsot);
    let drift = free_drift(&mut GeneratedBody::start(&start), &inverse, MILLION).expect("solvable");
    println!("{drift:?}");
    assert!(drift.worst() < 1e-14, "{drift:?}");
}

#[test]
fn tops_keep_their_casimirs() {
    for (name, start) in [
        ("lagrange", lagrange_top()),
        ("hanging", hanging_top()),
        ("generic", generic_top()),
    ] {
        let drift =
            top_drift(&mut GeneratedTop::start(&start), &start.top.up, MILLION).expect("solvable");
        println!("{name}: {drift:?}");
        assert!(drift.worst() < 1e-13, "{name}: {drift:?}");
    }
}

#[test]
fn energy_of_tops_oscillates_without_drift() {
    for (name, start) in [
        ("lagrange", lagrange_top()),
        ("hanging", hanging_top()),
        ("generic", generic_top()),
    ] {
        let [coarse, fine] = [1, 2].map(|n| {
            let start = start.with_step(start.h / n as f64);
            trend(&energies(&mut GeneratedTop::start(&start), n * 200_000).expect("solvable"))
        });
        println!("{name}: {coarse:?} {fine:?}");
        assert!(coarse.is_flat(), "{name}: {coarse:?}");
        assert!(fine.is_flat(), "{name}: {fine:?}");
        // Proportional to h^2 up to terms of order h^4, which are a few percent at h = 0.1.
        let ratio = coarse.amplitude / fine.amplitude;
        assert!((ratio - 4.0).abs() < 0.4, "{name}: {ratio}");
    }
}
