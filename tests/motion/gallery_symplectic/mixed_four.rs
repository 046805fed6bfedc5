//! Four groups together: the symplectic defect of one step on their product, for a case at a random state.

use super::Turn;
use crate::seeded::Seeded;
use clebsch::nalgebra::{Matrix3, SVector, Vector3};
use clebsch::{
    Additive, BodyImpulse, BodyMomentum, Dual, FieldMomentum, RigidMotion, Rotation, UnitQuaternion,
};
use clebsch_models::Case;
use clebsch_oracle::physics::random_states::Draws;
use clebsch_oracle::physics::symplectic::defect_on_group;

/// mu . [E_a, E_b] on SO(3) x SE(3) x SU(2) x R^3, with three, six, three and three components.
fn along_mixed(mu: &[f64], a: usize, b: usize) -> f64 {
    let turned = |a: usize, b: usize, mu: &[f64]| match (b + 3 - a) % 3 {
        1 => mu[(a + 2) % 3],
        2 => -mu[(a + 1) % 3],
        _ => 0.0,
    };
    match (a, b) {
        (0..3, 0..3) => turned(a, b, &mu[0..3]),
        (3..6, 3..6) => turned(a - 3, b - 3, &mu[3..6]),
        (3..6, 6..9) => turned(a - 3, b - 6, &mu[6..9]),
        (6..9, 3..6) => turned(a - 6, b - 3, &mu[6..9]),
        (9..12, 9..12) => turned(a - 9, b - 9, &mu[9..12]),
        _ => 0.0,
    }
}

pub(super) fn mixed_four(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::mixed_four::*;
    // Fifteen variations of the elements, then fifteen of the momenta.
    let seeds = 30;
    let numbers =
        |values: &[f64]| -> Vec<Seeded> { values.iter().map(|x| Dual::constant(*x)).collect() };
    let vector = |at: usize| Vector3::from_column_slice(&numbers(&case.parameters[at]));
    let square = |at: usize| Matrix3::from_row_slice(&numbers(&case.parameters[at]));
    let one = |at: usize| Dual::constant(case.parameters[at][0]);
    let model = MixedFour::new(MixedFourParameters {
        J: square(0),
        A: square(1),
        M: one(2),
        I: square(3),
        m: one(4),
        b: one(5),
        k: one(6),
        p: vector(7),
        s: vector(8),
        e: vector(9),
        g: vector(10),
    })
    .expect("parameters of a case");
    let change = |first: usize| Vector3::from_fn(|i, _| Seeded::variable(0.0, first + i));
    let mut turn = |first: usize| {
        let q = draws.attitude().0.map(Dual::constant);
        Rotation::from_quaternion(q).expect("a unit quaternion") * Rotation::exp(&change(first))
    };
    let (body, second) = (turn(0), turn(9));
    let own = draws.attitude().0.map(Dual::constant);
    let own = RigidMotion {
        rotation: Rotation::from_quaternion(own).expect("a unit quaternion"),
        translation: Vector3::from_column_slice(&numbers(&draws.direction())),
    };
    // This equals the exponential to first order.
    let motion = own
        * RigidMotion {
            rotation: Rotation::exp(&change(3)),
            translation: change(6),
        };
    let place = draws.direction();
    let start: Vec<f64> = (0..15).map(|_| draws.uniform(-0.5, 0.5)).collect();
    let momentum = |at: usize| Seeded::variable(start[at], 15 + at);
    let initial = MixedFourInitial {
        R: body,
        body_momentum_R: BodyMomentum(Vector3::from_fn(|i, _| momentum(i))),
        G: motion,
        body_momentum_G: BodyImpulse(SVector::from_fn(|i, _| momentum(3 + i))),
        q: UnitQuaternion::from_components(second.quaternion()).expect("a unit quaternion"),
        body_momentum_q: BodyMomentum(Vector3::from_fn(|i, _| momentum(9 + i))),
        X: Additive::new(Vector3::from_fn(|i, _| Dual::variable(place[i], 12 + i))),
        momentum_X: FieldMomentum(Vector3::from_fn(|i, _| momentum(12 + i))),
    };
    let h = Dual::constant(case.h) * (Dual::constant(1.0) + Dual::constant(warp) * momentum(0));
    let (mut state, mut workspace) = model.start(initial, h).expect("solvable");
    model.step(&mut state, &mut workspace).expect("solvable");
    let turns = |m: Matrix3<Seeded>| -> Vec<Vec<f64>> {
        let value = m.map(|x| x.real);
        let seen: Vec<_> = (0..seeds)
            .map(|seed| value.transpose() * m.map(|x| x.dual[seed]))
            .collect();
        [(2, 1), (0, 2), (1, 0)]
            .map(|at| seen.iter().map(|t| t[at]).collect())
            .to_vec()
    };
    let rigid = state.G();
    let back = rigid.rotation.matrix().map(|x| x.real).transpose();
    let moved: Vec<_> = (0..seeds)
        .map(|seed| back * rigid.translation.map(|x| x.dual[seed]))
        .collect();
    let mut jacobian = turns(state.R().turn());
    jacobian.extend(turns(rigid.rotation.matrix()));
    jacobian.extend((0..3).map(|i| moved.iter().map(|v| v[i]).collect()));
    jacobian.extend(turns(state.q().turn()));
    jacobian.extend(state.X().matrix().iter().map(|x| x.dual[..seeds].to_vec()));
    let after: Vec<Seeded> = (state.body_momentum_R().0.iter())
        .chain(&state.body_momentum_G().0)
        .chain(&state.body_momentum_q().0)
        .chain(&state.momentum_X().0)
        .copied()
        .collect();
    jacobian.extend(after.iter().map(|x| x.dual[..seeds].to_vec()));
    let after: Vec<f64> = after.iter().map(|x| x.real).collect();
    defect_on_group(&jacobian, &start, &after, along_mixed)
}
