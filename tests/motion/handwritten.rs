//! Tests the hand-written steppers against reference numbers, the continuous motion and their conservation laws. Tests also check
//! that every measurement rejects a deliberately wrong stepper. This file uses nothing of the library under test.

use clebsch_oracle::handwritten::attitude::{Quaternion, add_scaled, apply};
use clebsch_oracle::handwritten::free_body::FreeBody;
use clebsch_oracle::handwritten::heavy_top::HeavyTop;
use clebsch_oracle::handwritten::one_sided_top::OneSidedTop;
use clebsch_oracle::handwritten::principal_axes::PrincipalAxes;
use clebsch_oracle::physics::cases::{
    Start, asymmetric_body, flat_body, generic_top, hanging_top, lagrange_top, symmetric_body,
};
use clebsch_oracle::physics::drift_detection::trend;
use clebsch_oracle::physics::faulty_steppers::{Fault, FaultyTop};
use clebsch_oracle::physics::measure::{apart, energies, free_drift, top_drift};
use clebsch_oracle::physics::motion::Motion;
use clebsch_oracle::physics::order::{confirms, errors, orders};
use clebsch_oracle::physics::random_states::Draws;
use clebsch_oracle::physics::taylor_reference::{Phase, flow, inverse_inertia};
use clebsch_oracle::physics::{against_reference, measure};
use clebsch_oracle::reference::{TOLERANCE, asymmetric_body_errors, body_sym};

fn body(start: &Start) -> FreeBody {
    FreeBody::start(
        &start.top.poinsot,
        &start.attitude,
        &start.body_momentum,
        start.h,
    )
    .expect("solvable")
}

fn top(start: &Start) -> HeavyTop {
    HeavyTop::start(&start.top, &start.attitude, &start.body_momentum, start.h).expect("solvable")
}

fn one_sided(start: &Start) -> OneSidedTop {
    OneSidedTop::start(&start.top, &start.attitude, &start.body_momentum, start.h)
        .expect("solvable")
}

fn faulty(fault: Fault) -> impl Fn(&Start) -> FaultyTop {
    move |start| {
        FaultyTop::start(
            &start.top,
            &start.attitude,
            &start.body_momentum,
            start.h,
            fault,
        )
        .expect("solvable")
    }
}

fn phase(start: &Start) -> Phase {
    Phase {
        attitude: start.attitude.normalised(),
        body_momentum: start.body_momentum,
    }
}

#[test]
fn reference_numbers() {
    for (name, deviation) in [
        ("body_sym", against_reference::symmetric(body)),
        (
            "body_sym, plain",
            against_reference::symmetric(faulty(Fault::None)),
        ),
        ("top_lagrange", against_reference::lagrange(top)),
        (
            "top_lagrange, plain",
            against_reference::lagrange(faulty(Fault::None)),
        ),
        (
            "top_lagrange, energy",
            against_reference::lagrange_energy(top),
        ),
        ("one-sided", against_reference::one_sided(one_sided)),
        ("steady_rotation", against_reference::steady(body)),
    ] {
        let deviation = deviation.expect(name);
        println!("{name}: {deviation:.2e}");
        assert!(deviation < TOLERANCE, "{name}: {deviation:e}");
    }
}

#[test]
fn reference_numbers_reject_faults() {
    for fault in [Fault::Unsolved, Fault::Reversed, Fault::Friction] {
        let deviation = against_reference::symmetric(faulty(fault)).unwrap_or(f64::INFINITY);
        assert!(
            deviation > 1e6 * TOLERANCE,
            "{fault:?} passes: {deviation:e}"
        );
        let deviation = against_reference::steady(faulty(fault)).unwrap_or(f64::INFINITY);
        assert!(
            deviation > 1e6 * TOLERANCE,
            "{fault:?} passes: {deviation:e}"
        );
    }
    for fault in [
        Fault::KickAtOldNode,
        Fault::VerticalCarriedBackwards,
        Fault::EdgeForNode,
        Fault::LatePairing,
        Fault::Unsolved,
        Fault::Reversed,
        Fault::Friction,
    ] {
        let deviation = against_reference::lagrange(faulty(fault)).unwrap_or(f64::INFINITY);
        assert!(
            deviation > 1e6 * TOLERANCE,
            "{fault:?} passes: {deviation:e}"
        );
        let deviation = against_reference::one_sided(faulty(fault)).unwrap_or(f64::INFINITY);
        assert!(
            deviation > 1e6 * TOLERANCE,
            "{fault:?} passes: {deviation:e}"
        );
    }
}

#[test]
fn the_continuous_motion_is_right() {
    // The recorded momentum of the symmetric body at t = 100, to 32 digits.
    let start = symmetric_body();
    let end = flow(&start.top, &phase(&start), 100.0);
    assert!(measure::vectors(&end.body_momentum, &body_sym::CONTINUOUS_MOMENTUM_AT_100) < 1e-12);
    // Without symmetry: energy and vertical momentum, and a run forward and back with different step sizes.
    let start = generic_top();
    let energy = |phase: &Phase| {
        FaultyTop::start(
            &start.top,
            &phase.attitude,
            &phase.body_momentum,
            0.1,
            Fault::None,
        )
        .expect("solvable")
        .energy()
    };
    let end = flow(&start.top, &phase(&start), 10.0);
    assert!((energy(&end) - energy(&phase(&start))).abs() < 1e-13);
    let halfway = flow(&start.top, &phase(&start), 4.97);
    let again = flow(&start.top, &halfway, 5.03);
    assert!(measure::vectors(&again.body_momentum, &end.body_momentum) < 1e-12);
    assert!(measure::matrices(&again.attitude.matrix(), &end.attitude.matrix()) < 1e-12);
}

#[test]
fn orders_are_two() {
    let start = asymmetric_body();
    let truth = flow(&start.top, &phase(&start), 10.0);
    let measured = errors(|h| body(&start.with_step(h)), 10.0, 50, 4, &truth).expect("solvable");
    assert!(
        confirms(&measured.momentum, 2.0, 1e-13) && confirms(&measured.attitude, 2.0, 1e-13),
        "{measured:?}"
    );
    for (error, recorded) in measured
        .attitude
        .iter()
        .zip(asymmetric_body_errors::ATTITUDE)
    {
        assert!(
            (error / recorded - 1.0).abs() < 1e-4,
            "{error:e} for {recorded:e}"
        );
    }
    let start = generic_top();
    let truth = flow(&start.top, &phase(&start), 2.0);
    let measured = errors(|h| top(&start.with_step(h)), 2.0, 20, 4, &truth).expect("solvable");
    assert!(
        confirms(&measured.momentum, 2.0, 1e-13) && confirms(&measured.attitude, 2.0, 1e-13),
        "{measured:?}"
    );
}

#[test]
fn orders_reject_faults() {
    let start = generic_top();
    let truth = flow(&start.top, &phase(&start), 2.0);
    for fault in [
        Fault::KickAtOldNode,
        Fault::VerticalCarriedBackwards,
        Fault::EdgeForNode,
        Fault::LatePairing,
        Fault::Reversed,
    ] {
        let make = |h| faulty(fault)(&start.with_step(h));
        let measured = errors(make, 2.0, 20, 4, &truth).expect("solvable");
        println!(
            "{fault:?} {:?} {:?}",
            orders(&measured.momentum),
            orders(&measured.attitude)
        );
        assert!(
            !confirms(&measured.momentum, 2.0, 1e-13),
            "{fault:?} passes"
        );
    }
    // The one-sided scheme is of first order, and the measurement shows it.
    let measured =
        errors(|h| one_sided(&start.with_step(h)), 2.0, 20, 4, &truth).expect("solvable");
    assert!(
        confirms(&measured.momentum, 1.0, 1e-13),
        "{:?}",
        orders(&measured.momentum)
    );
}

#[test]
fn free_bodies_conserve_to_rounding_over_a_million_steps() {
    for (name, start) in [
        ("2.5", symmetric_body()),
        ("2.6", asymmetric_body()),
        ("flat", flat_body()),
    ] {
        let drift = free_drift(
            &mut body(&start),
            &inverse_inertia(&start.top.poinsot),
            1_000_000,
        )
        .expect("solvable");
        println!("{name}: {drift:?}");
        assert!(drift.worst() < 1e-14, "{name}: {drift:?}");
    }
}

#[test]
fn conservation_rejects_rounding_that_accumulates() {
    // The iteration of momentum and attitude without projection is correct in exact arithmetic.
    let start = symmetric_body();
    let inverse = inverse_inertia(&start.top.poinsot);
    let drift =
        free_drift(&mut faulty(Fault::None)(&start), &inverse, 1_000_000).expect("solvable");
    println!("{drift:?}");
    assert!(drift.worst() > 1e-14, "{drift:?}");
    for fault in [Fault::Unsolved, Fault::Friction] {
        let start = asymmetric_body();
        let inverse = inverse_inertia(&start.top.poinsot);
        let drift = free_drift(&mut faulty(fault)(&start), &inverse, 1000).expect("solvable");
        assert!(drift.worst() > 1e-10, "{fault:?} passes: {drift:?}");
    }
}

#[test]
fn tops_keep_their_casimirs_over_a_million_steps() {
    for (name, start) in [
        ("lagrange", lagrange_top()),
        ("hanging", hanging_top()),
        ("generic", generic_top()),
    ] {
        let drift = top_drift(&mut top(&start), &start.top.up, 1_000_000).expect("solvable");
        println!("{name}: {drift:?}");
        assert!(drift.worst() < 1e-13, "{name}: {drift:?}");
    }
}

#[test]
fn casimirs_reject_faults() {
    let start = generic_top();
    for fault in [
        Fault::VerticalCarriedBackwards,
        Fault::LatePairing,
        Fault::KickAtOldNode,
        Fault::Friction,
    ] {
        let drift = top_drift(&mut faulty(fault)(&start), &start.top.up, 1000).expect("solvable");
        println!("{fault:?}: {drift:?}");
        assert!(drift.worst() > 1e-6, "{fault:?} passes: {drift:?}");
    }
}

/// Energies over the same time span with step sizes h and h/2.
fn two_series<M: Motion>(start: &Start, make: impl Fn(&Start) -> M, steps: u64) -> [Vec<f64>; 2] {
    [1, 2].map(|n| {
        let start = start.with_step(start.h / n as f64);
        energies(&mut make(&start), n * steps).expect("solvable")
    })
}

#[test]
fn energy_of_tops_oscillates_without_drift() {
    for (name, start) in [
        ("lagrange", lagrange_top()),
        ("hanging", hanging_top()),
        ("generic", generic_top()),
    ] {
        let [coarse, fine] = two_series(&start, top, 200_000).map(|series| trend(&series));
        println!("{name}: {coarse:?} {fine:?}");
        assert!(coarse.is_flat(), "{name}: {coarse:?}");
        assert!(fine.is_flat(), "{name}: {fine:?}");
        let ratio = coarse.amplitude / fine.amplitude;
        assert!((ratio - 4.0).abs() < 0.4, "{name}: {ratio}");
    }
}

#[test]
fn the_energy_check_rejects_faults() {
    let start = lagrange_top();
    for fault in [Fault::KickAtOldNode, Fault::Friction] {
        // A fault may also raise the energy until a step fails.
        if let Ok(series) = energies(&mut faulty(fault)(&start), 20_000) {
            let trend = trend(&series);
            println!("{fault:?}: {trend:?}");
            assert!(!trend.is_flat(), "{fault:?} passes: {trend:?}");
        }
    }
    let [coarse, fine] =
        two_series(&start, faulty(Fault::EdgeForNode), 20_000).map(|series| trend(&series));
    let ratio = coarse.amplitude / fine.amplitude;

    assert!(
        (ratio - 4.0).abs() > 0.4,
        "the one-sided reading passes: {ratio}"
    );
}

#[test]
fn one_step_agrees_with_a_plain_one() {
    let (mut free, mut heavy) = (Draws::new(1), Draws::new(2));
    let (mut worst_free, mut worst_heavy) = (0.0, 0.0);
    for _ in 0..10_000 {
        let start = free.free_body();
        let apart_by =
            apart(&mut body(&start), &mut faulty(Fault::None)(&start), 1).expect("solvable");
        worst_free = measure::worse(worst_free, apart_by);
        let start = heavy.heavy_top();
        let apart_by =
            apart(&mut top(&start), &mut faulty(Fault::None)(&start), 1).expect("solvable");
        worst_heavy = measure::worse(worst_heavy, apart_by);
    }
    println!("free {worst_free:.2e}, heavy {worst_heavy:.2e}");
    assert!(
        worst_free < 1e-14 && worst_heavy < 1e-14,
        "free {worst_free:e}, heavy {worst_heavy:e}"
    );
}

#[test]
fn integrable_motions_agree_with_a_plain_stepper() {
    let start = symmetric_body();
    let free =
        apart(&mut body(&start), &mut faulty(Fault::None)(&start), 10_000).expect("solvable");
    println!("free {free:.2e}");
    assert!(free < 1e-12, "{free:e}");
    // A rounding error of 1e-16 per step makes frequencies wander, so that phases separate like h n^(3/2). Near the separatrix of
    // the upright top they separate ten times faster, and even faster with the plain stepper, which accumulates kicks in body axes.
    for (name, start, h, steps) in [
        ("upright", lagrange_top(), 0.1, 1000),
        ("hanging", hanging_top(), 0.01, 10_000),
    ] {
        let start = start.with_step(h);
        let off =
            apart(&mut top(&start), &mut faulty(Fault::None)(&start), steps).expect("solvable");
        println!("{name}: {off:.2e}");
        assert!(off < 1e-12, "{name}: {off:e}");
    }
}

#[test]
fn principal_axes_diagonalise() {
    let mut draws = Draws::new(4);
    for _ in 0..1000 {
        let j = draws.free_body().top.poinsot;
        let axes = PrincipalAxes::new(&j).expect("positive moments");
        let moments = axes.moments;
        assert!((moments[1] - moments[0]) * (moments[1] - moments[2]) <= 0.0);
        for i in 0..3 {
            // (tr(J) Id - J) e = I e for each axis e.
            let mut unit = [0.0; 3];
            unit[i] = 1.0;
            let axis = axes.leave(&unit);
            let image = add_scaled(
                &axis.map(|c| c * (j[0][0] + j[1][1] + j[2][2])),
                -1.0,
                &apply(&j, &axis),
            );
            assert!(measure::vectors(&image, &axis.map(|c| c * moments[i])) < 1e-14);
        }
    }
}

#[test]
fn user_axes_do_not_matter() {
    // The same body in rotated axes: attitude q r, J -> r^T J r, momentum r^T mu.
    let mut draws = Draws::new(3);
    let start = asymmetric_body();
    let turn = draws.attitude();
    let r = turn.matrix();
    let back = turn.conjugate().matrix();
    let j = start.top.poinsot;
    let rows = [0, 1, 2].map(|a| {
        apply(
            &back,
            &[0, 1, 2].map(|b| (0..3).map(|k| j[b][k] * r[k][a]).sum::<f64>()),
        )
    });
    let mut symmetric = rows;
    for a in 0..3 {
        for b in 0..3 {
            symmetric[a][b] = 0.5 * (rows[a][b] + rows[b][a]);
        }
    }
    let mut plain = body(&start);
    let mut turned = FreeBody::start(
        &symmetric,
        &turn,
        &apply(&back, &start.body_momentum),
        start.h,
    )
    .expect("solvable");
    for _ in 0..1000 {
        plain.step();
        turned.step();
    }
    let brought_back = FreeBody::attitude(&turned)
        .times(&turn.conjugate())
        .matrix();
    let off = measure::matrices(&brought_back, &FreeBody::attitude(&plain).matrix());
    assert!(off < 1e-12, "{off:e}");
}

#[test]
fn the_bound_is_respected() {
    // About a principal axis the bound is |h mu| = I.
    let j = symmetric_body().top.poinsot;
    assert!(FreeBody::start(&j, &Quaternion::IDENTITY, &[0.0, 0.0, 1.0], 0.999_999).is_ok());
    assert!(FreeBody::start(&j, &Quaternion::IDENTITY, &[0.0, 0.0, 1.0], 1.000_001).is_err());
    assert!(FreeBody::start(&j, &Quaternion::IDENTITY, &[0.0, f64::NAN, 1.0], 0.1).is_err());
    let start = lagrange_top();
    let fast = Start {
        body_momentum: [0.0, 0.0, 11.0],
        ..start
    };
    assert!(top(&fast).step().is_err());
    let broken = Start {
        body_momentum: [0.0, f64::NAN, 1.0],
        ..start
    };
    assert!(top(&broken).step().is_err());
}
