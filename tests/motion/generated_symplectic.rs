//! Checks that one generated step, attitude included, preserves the canonical two-form on T*SO(3), with the exact Jacobian from
//! dual numbers. A test checks that a step size that depends on the state fails.

use super::generated_motion::{column, matrix, rotation};
use super::seeded::Seeded;
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation};
use clebsch_models::free_body::{FreeBody, FreeBodyInitial, FreeBodyParameters};
use clebsch_models::heavy_top::{HeavyTop, HeavyTopInitial, HeavyTopParameters};
use clebsch_oracle::handwritten::attitude::Vector;
use clebsch_oracle::physics::cases::Start;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::random_states::Draws;
use clebsch_oracle::physics::symplectic::{Jacobian, defect};

/// Tolerance well above the rounding error of a product of three 6 x 6 matrices with entries of order one to ten.
const TOLERANCE: f64 = 1e-10;

fn constants<const R: usize, const C: usize>(
    m: &clebsch::nalgebra::SMatrix<f64, R, C>,
) -> clebsch::nalgebra::SMatrix<Seeded, R, C> {
    m.map(Seeded::constant)
}

/// Attitude and body momentum with six independent variations: Lambda exp(hat(xi)), mu + delta mu.
fn varied(start: &Start) -> (Rotation<Seeded>, Vector3<Seeded>) {
    let q = rotation(&start.attitude).quaternion().map(Seeded::constant);
    let attitude = Rotation::from_quaternion(q).expect("a unit quaternion");
    let xi = Vector3::from_fn(|i, _| Seeded::variable(0.0, i));
    let momentum = Vector3::from_fn(|i, _| Seeded::variable(start.body_momentum[i], i + 3));
    (attitude * Rotation::exp(&xi), momentum)
}

/// The Jacobian in left-trivialised coordinates, and the momentum after the step.
fn jacobian(attitude: &Matrix3<Seeded>, momentum: &Vector3<Seeded>) -> (Jacobian, Vector) {
    let value = attitude.map(|x| x.real);
    let column = |seed: usize| {
        // Lambda^T delta Lambda = hat(xi).
        let turn = value.transpose() * attitude.map(|x| x.dual[seed]);
        let axial = |r: usize, c: usize| 0.5 * (turn[(r, c)] - turn[(c, r)]);
        let change = |i: usize| momentum[i].dual[seed];
        [
            axial(2, 1),
            axial(0, 2),
            axial(1, 0),
            change(0),
            change(1),
            change(2),
        ]
    };
    let columns: [[f64; 6]; 6] = std::array::from_fn(column);
    let d = std::array::from_fn(|r| std::array::from_fn(|c| columns[c][r]));
    (d, [0, 1, 2].map(|i| momentum[i].real))
}

/// The defect of one step of the heavy top. `warp` increases the step size in proportion to the first momentum component.
fn top_defect(start: &Start, warp: f64) -> f64 {
    let (attitude, momentum) = varied(start);
    let model = HeavyTop::new(HeavyTopParameters {
        J: constants(&matrix(&start.top.poinsot)),
        gU: constants(&column(&start.top.weight)),
        z: constants(&column(&start.top.up)),
    })
    .expect("a top");
    let h =
        Seeded::constant(start.h) * (Seeded::constant(1.0) + Seeded::constant(warp) * momentum[0]);
    let initial = HeavyTopInitial {
        Λ: attitude,
        body_momentum: BodyMomentum(momentum),
    };
    let (mut state, mut workspace) = model.start(initial, h).expect("solvable");
    model.step(&mut state, &mut workspace).expect("solvable");
    let (d, after) = jacobian(&state.Λ().matrix(), &state.body_momentum().0);
    scaled_defect(&d, &start.body_momentum, &after)
}

fn body_defect(start: &Start, warp: f64) -> f64 {
    let (attitude, momentum) = varied(start);
    let model = FreeBody::new(FreeBodyParameters {
        J: constants(&matrix(&start.top.poinsot)),
    })
    .expect("a body");
    let h =
        Seeded::constant(start.h) * (Seeded::constant(1.0) + Seeded::constant(warp) * momentum[0]);
    let initial = FreeBodyInitial {
        Λ: attitude,
        body_momentum: BodyMomentum(momentum),
    };
    let (mut state, mut workspace) = model.start(initial, h).expect("solvable");
    model.step(&mut state, &mut workspace).expect("solvable");
    let (d, after) = jacobian(&state.Λ().matrix(), &state.body_momentum().0);
    scaled_defect(&d, &start.body_momentum, &after)
}

/// The defect relative to the size of the form, whose entries are ones and momenta.
fn scaled_defect(d: &Jacobian, before: &Vector, after: &Vector) -> f64 {
    let size = before
        .iter()
        .chain(after)
        .fold(1.0_f64, |m, c| worse(m, c.abs()));
    defect(d, before, after) / size
}

#[test]
fn the_heavy_top_is_symplectic() {
    let mut draws = Draws::new(21);
    for _ in 0..200 {
        let start = draws.heavy_top();
        let defect = top_defect(&start, 0.0);
        assert!(defect < TOLERANCE, "{defect:e} at {start:?}");
    }
}

#[test]
fn the_free_body_is_symplectic() {
    let mut draws = Draws::new(22);
    for _ in 0..200 {
        let start = draws.free_body();
        let defect = body_defect(&start, 0.0);
        assert!(defect < TOLERANCE, "{defect:e} at {start:?}");
    }
}

#[test]
fn a_step_that_depends_on_the_state_is_not() {
    let mut draws = Draws::new(23);
    for _ in 0..20 {
        // A momentum of order one, so that the warp changes the step size by a definite fraction.
        let start = Start {
            body_momentum: [0.3, -0.4, 0.5],
            h: 0.1,
            ..draws.heavy_top()
        };
        assert!(top_defect(&start, 0.1) > 1e4 * TOLERANCE, "{start:?}");
        assert!(body_defect(&start, 0.1) > 1e4 * TOLERANCE, "{start:?}");
    }
}
