//! Particles between walls. Steps that reach no wall make the action stationary; a reflection changes neither the kinetic energy
//! nor the depth; a position too far beyond a wall is an error.

use super::action::{stationarity, stationarity_weighed};
use super::models::{Basin, Line, Plane};
use clebsch::line::LineError;
use clebsch::mesh::MeshError;
use clebsch::nalgebra::{SMatrix, Vector2};

#[test]
fn steps_between_walls_make_the_action_stationary() {
    for n in [1, 2, 5, 12, 50] {
        let lines: [Box<dyn Line>; 2] = [Box::new(Basin { n }), Box::new(Plane { n, walls: true })];
        for line in lines {
            let residual = stationarity(line.as_ref(), &line.three(1));
            assert!(
                residual < super::STATIONARY,
                "{}: {residual:e}",
                line.name()
            );
            for term in 0..line.terms() {
                let wrong = line.flipped(term);
                let residual = stationarity_weighed(line.as_ref(), &wrong, &line.three(1));
                assert!(
                    residual > 1e-4,
                    "{}: term {term} leaves {residual:e}",
                    line.name()
                );
            }
        }
    }
}

#[test]
fn a_reflection_keeps_the_kinetic_energy_and_turns_the_velocity_across_the_wall() {
    // A massless particle produces no depth gradient, so one free particle reaches the wall.
    let line = Basin { n: 1 };
    let model = line.stepper();
    let mut initial = line.initial(0);
    initial.X[0] = SMatrix::repeat(0.013);
    initial.momentum_X[0] = SMatrix::repeat(-1.0);
    let h = 0.02;
    let (mut state, mut work) = model.start(initial, h).expect("starts");
    let (before, _) = model.energies(&state);
    let energy = model.energy(&state);
    model.step(&mut state, &mut work).expect("steps");
    assert_eq!(work.reflections(), 1);
    let (after, _) = model.energies(&state);
    assert!(state.X()[0][0] > 0.0 && state.momentum_X()[0][0] > 0.0);
    // At the wall, the particle's own image pushes it along the wall, with a displacement of the order of the step size.
    assert!((after - before).abs() < 0.2 * before, "{before} {after}");
    for _ in 0..2000 {
        model.step(&mut state, &mut work).expect("steps");
    }
    assert!(work.reflections() > 30, "{}", work.reflections());
    let off = (model.energy(&state) - energy).abs() / energy;
    assert!(off < 2e-2, "{off:e}");
    // Forward and back through walls. Reflections are exact up to two rounding errors each.
    let mut back = model.workspace(&state, -h).expect("a step back");
    for _ in 0..2001 {
        model.step(&mut state, &mut back).expect("steps back");
    }
    assert!(
        (state.X()[0][0] - 0.013).abs() < 1e-10,
        "{}",
        state.X()[0][0]
    );
}

#[test]
fn between_walls_in_a_turning_frame_the_kinetic_velocity_is_turned() {
    let line = Plane { n: 1, walls: true };
    let model = line.stepper();
    let mut initial = line.initial(0);
    let (m, f) = (1.0, 0.9);
    let place = Vector2::new(1.095, 0.3);
    initial.X[0] = place;
    // The canonical momentum of the kinetic velocity (0.7, 0.2).
    let rest = |x: &Vector2<f64>| Vector2::new(-x[1], x[0]) * (m * f / 2.0);
    initial.momentum_X[0] = Vector2::new(0.7, 0.2) * m + rest(&place);
    let (mut state, mut work) = model.start(initial, 0.02).expect("starts");
    let energy = model.energy(&state);
    model.step(&mut state, &mut work).expect("steps");
    assert_eq!(work.reflections(), 1);
    let velocity = (state.momentum_X()[0] - rest(&state.X()[0])) / m;
    // The velocity is rotated by f dt and mirrored; the depth gradient adds a few times dt.
    assert!(
        (velocity[0] + 0.7).abs() < 0.1 && (velocity[1] - 0.2).abs() < 0.1,
        "{velocity}"
    );
    for _ in 0..20_000 {
        model.step(&mut state, &mut work).expect("steps");
    }
    assert!(work.reflections() > 100, "{}", work.reflections());
    let off = (model.energy(&state) - energy).abs() / energy;
    assert!(off < 2e-2, "{off:e}");
}

#[test]
fn a_step_far_beyond_a_wall_is_refused_with_a_shorter_one() {
    let line = Basin { n: 3 };
    let model = line.stepper();
    let mut initial = line.initial(2);
    initial.momentum_X[1] = SMatrix::repeat(100.0);
    let told = model.start(initial.clone(), 0.02).expect_err("too long");
    let LineError::Functional { cause, works, .. } = told else {
        panic!("{told}");
    };
    assert!(
        matches!(cause, MeshError::Outside { site: 1, .. }),
        "{cause}"
    );
    assert!(model.start(initial, works.expect("a shorter step")).is_ok());
}
