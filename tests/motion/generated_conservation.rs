//! Invariants of the generated steppers over long runs: to rounding for exact laws, and without drift otherwise. The tests of the
//! hand-written steppers check that the same measurements reject a faulty stepper.

use super::generated_motion::{GeneratedBody, GeneratedTop};
use clebsch_oracle::handwritten::attitude::{apply, cross, dot};
use clebsch_oracle::physics::cases::Start;
use clebsch_oracle::physics::cases::{
    asymmetric_body, flat_body, generic_top, hanging_top, lagrange_top, steady_body, symmetric_body,
};
use clebsch_oracle::physics::drift_detection::trend;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::measure::{energies, free_drift, top_drift};
use clebsch_oracle::physics::motion::Motion;
use clebsch_oracle::physics::taylor_reference::inverse_inertia;

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

/// Over a million steps, measures the largest |R mu - m| / |m| with the momentum that the solver stores. It also measures the
/// largest corrections that projection makes to momentum and attitude, times the sine of the angle between momentum and velocity.
/// If that sine is small, the surfaces of constant energy and momentum are nearly parallel, and a correction along both grows by
/// the inverse sine.
fn rounding(start: &Start, projects: bool) -> (f64, [f64; 2]) {
    let mut body = GeneratedBody::start(start);
    if !projects {
        body.workspace = body.workspace.without_projection();
    }
    let inverse = inverse_inertia(&start.top.poinsot);
    let spatial = body.spatial_momentum();
    let length = dot(&spatial, &spatial).sqrt();
    let (mut error, mut corrections) = (0.0_f64, [0.0_f64; 2]);
    for _ in 0..MILLION {
        body.step().expect("solvable");
        let mu = body.workspace.solver().body_momentum().0.into();
        let seen = apply(&body.attitude(), &mu);
        let away: [f64; 3] = std::array::from_fn(|i| seen[i] - spatial[i]);
        error = worse(error, dot(&away, &away).sqrt() / length);
        if body.state.node().is_multiple_of(64) {
            let velocity = apply(&inverse, &mu);
            let product = cross(&mu, &velocity);
            let sine = (dot(&product, &product) / dot(&velocity, &velocity)).sqrt() / length;
            let made = body.workspace.solver().correction();
            corrections[0] = worse(corrections[0], made.momentum * sine);
            corrections[1] = worse(corrections[1], made.attitude * sine);
        }
    }
    (error, corrections)
}

#[test]
fn projection_takes_out_rounding_and_nothing_else() {
    for (name, start) in [
        ("I = (2, 2, 1)", symmetric_body()),
        ("I = (3.5, 2.5, 2)", asymmetric_body()),
        ("I = (1, 2, 3), J singular", flat_body()),
        ("J full", generic_top()),
    ] {
        let (error, corrections) = rounding(&start, true);
        let (left, none) = rounding(&start, false);
        println!("{name}: {error:e}, corrections {corrections:?}; without {left:e}");
        assert!(error < 5e-15, "{name}: {error:e}");
        // Sixty-four rounding errors in random directions add up to about eight; the limit is twice that.
        for size in corrections {
            assert!(0.0 < size && size < 3.6e-15, "{name}: {size:e}");
        }
        // A million rounding errors in random directions add up to about a thousand; with a common sign they would reach 2e-10.
        assert_eq!(none, [0.0; 2], "{name}");
        assert!(left < 1e-12, "{name}: {left:e}");
        assert!(left > 4.0 * error, "{name}: {left:e} against {error:e}");
    }
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
        // The amplitude is proportional to h^2, up to h^4 terms of a few percent at h = 0.1.
        let ratio = coarse.amplitude / fine.amplitude;
        assert!((ratio - 4.0).abs() < 0.4, "{name}: {ratio}");
    }
}
