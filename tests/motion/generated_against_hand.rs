//! Compares generated steppers with hand-written ones: single steps from ten thousand random states, and long integrable motions.
//! Tests check that a faulty stepper fails both comparisons.

use super::generated_motion::{GeneratedBody, GeneratedTop};
use clebsch_oracle::handwritten::free_body::FreeBody;
use clebsch_oracle::handwritten::heavy_top::HeavyTop;
use clebsch_oracle::physics::cases::{Start, hanging_top, lagrange_top, symmetric_body};
use clebsch_oracle::physics::faulty_steppers::{Fault, FaultyTop};
use clebsch_oracle::physics::measure::{apart, worse};
use clebsch_oracle::physics::motion::Motion;
use clebsch_oracle::physics::random_states::Draws;

/// About twenty rounding errors of numbers of order one. Momenta are compared relative to |mu|.
const ONE_STEP: f64 = 1e-14;

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

/// Largest difference after one step from each random state.
fn single_steps<A: Motion, B: Motion>(
    mut draw: impl FnMut() -> Start,
    count: u32,
    a: impl Fn(&Start) -> A,
    b: impl Fn(&Start) -> B,
) -> f64 {
    (0..count).fold(0.0, |worst, _| {
        let start = draw();
        worse(
            worst,
            apart(&mut a(&start), &mut b(&start), 1).unwrap_or(f64::INFINITY),
        )
    })
}

#[test]
fn one_step_of_the_free_body() {
    let mut draws = Draws::new(11);
    let worst = single_steps(|| draws.free_body(), 10_000, GeneratedBody::start, body);
    println!("free body: {worst:.2e}");
    assert!(worst < ONE_STEP, "{worst:e}");
}

#[test]
fn one_step_of_the_heavy_top() {
    let mut draws = Draws::new(12);
    let worst = single_steps(|| draws.heavy_top(), 10_000, GeneratedTop::start, top);
    println!("heavy top: {worst:.2e}");
    assert!(worst < ONE_STEP, "{worst:e}");
}

#[test]
fn one_step_of_a_faulty_stepper_differs() {
    for fault in [
        Fault::KickAtOldNode,
        Fault::VerticalCarriedBackwards,
        Fault::EdgeForNode,
        Fault::LatePairing,
        Fault::Unsolved,
        Fault::Reversed,
        Fault::Friction,
    ] {
        let mut draws = Draws::new(12);
        let faulty = |start: &Start| {
            FaultyTop::start(
                &start.top,
                &start.attitude,
                &start.body_momentum,
                start.h,
                fault,
            )
            .expect("solvable")
        };
        let worst = single_steps(|| draws.heavy_top(), 100, GeneratedTop::start, faulty);
        assert!(worst > 1e6 * ONE_STEP, "{fault:?} passes: {worst:e}");
    }
}

#[test]
fn integrable_motions_stay_together() {
    let start = symmetric_body();
    let free =
        apart(&mut GeneratedBody::start(&start), &mut body(&start), 10_000).expect("solvable");
    println!("free {free:.2e}");
    assert!(free < 1e-12, "{free:e}");
    let start = hanging_top().with_step(0.01);
    let hanging =
        apart(&mut GeneratedTop::start(&start), &mut top(&start), 10_000).expect("solvable");
    println!("hanging {hanging:.2e}");
    assert!(hanging < 1e-12, "{hanging:e}");
}

#[test]
fn integrable_motions_part_no_faster_than_rounding_makes_them() {
    // Each stepper rounds momentum and attitude to 1.1e-16 about twice per step, a difference of about 3e-16 per step. These errors
    // add up like a random walk and separate the phases, most strongly for the upright top near its separatrix. The reference is
    // the hand-written stepper, started with a momentum larger by the length of that walk. Compared with 32 digits, either stepper
    // deviates here by up to 3e-11.
    for (name, start) in [("upright", lagrange_top()), ("hanging", hanging_top())] {
        for (h, steps) in [(0.1, 1000_u32), (0.1, 10_000), (0.01, 10_000)] {
            let start = start.with_step(h);
            let wander = 3e-16 * f64::from(steps).sqrt();
            let nearby = Start {
                body_momentum: start.body_momentum.map(|c| c * (1.0 + wander)),
                ..start
            };
            let count = u64::from(steps);
            let allowed = apart(&mut top(&nearby), &mut top(&start), count).expect("solvable");
            let off =
                apart(&mut GeneratedTop::start(&start), &mut top(&start), count).expect("solvable");
            println!("{name}, {steps} steps of {h}: {off:.2e}, amplified rounding {allowed:.2e}");
            assert!(
                off < allowed.max(1e-12),
                "{name}, {steps} steps of {h}: {off:e} > {allowed:e}"
            );
        }
    }
}

#[test]
fn integrable_motions_of_a_faulty_stepper_part() {
    let start = hanging_top();
    for fault in [
        Fault::KickAtOldNode,
        Fault::EdgeForNode,
        Fault::Unsolved,
        Fault::Friction,
    ] {
        let mut faulty = FaultyTop::start(
            &start.top,
            &start.attitude,
            &start.body_momentum,
            start.h,
            fault,
        )
        .expect("solvable");
        let worst =
            apart(&mut GeneratedTop::start(&start), &mut faulty, 10_000).unwrap_or(f64::INFINITY);
        assert!(worst > 1e-6, "{fault:?} passes: {worst:e}");
    }
}

#[test]
fn both_refuse_beyond_the_bound_and_only_there() {
    // `draws` computes the bound on the momentum to one part in 10^4.
    let mut draws = Draws::new(13);
    for _ in 0..1000 {
        for (share, solvable) in [(0.999, true), (1.001, false), (3.0, false)] {
            let start = draws.free_body_at(share);
            let generated = GeneratedBody::try_start(&start).and_then(|mut motion| motion.step());
            assert_eq!(
                generated.is_ok(),
                solvable,
                "{share} {start:?} {generated:?}"
            );
            let hand = FreeBody::start(
                &start.top.poinsot,
                &start.attitude,
                &start.body_momentum,
                start.h,
            );
            assert_eq!(hand.is_ok(), solvable, "{share} {start:?}");
            let start = draws.heavy_top_at(share);
            let generated = GeneratedTop::try_start(&start).and_then(|mut motion| motion.step());
            assert_eq!(
                generated.is_ok(),
                solvable,
                "{share} {start:?} {generated:?}"
            );
            assert_eq!(
                Motion::step(&mut top(&start)).is_ok(),
                solvable,
                "{share} {start:?}"
            );
        }
    }
}
