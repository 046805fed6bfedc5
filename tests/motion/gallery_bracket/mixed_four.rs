//! Four groups together: starts a case at a random point, steps once, and returns both nodes.

use super::{Node, Step, attitude, column, length, matrix, number, quantity, seeded};
use crate::seeded::Seeded;
use clebsch::nalgebra::{SVector, Vector3};
use clebsch::{
    Additive, BodyImpulse, BodyMomentum, Dual, FieldMomentum, RigidMotion, Rotation, UnitQuaternion,
};
use clebsch_models::Case;
use clebsch_oracle::physics::random_states::Draws;

pub(super) fn mixed_four(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::mixed_four::*;
    let vector = |at: usize| column::<3>(&case.parameters[at]);
    let model = MixedFour::new(MixedFourParameters {
        J: matrix(&case.parameters[0]),
        A: matrix(&case.parameters[1]),
        M: number(&case.parameters[2]),
        I: matrix(&case.parameters[3]),
        m: number(&case.parameters[4]),
        b: number(&case.parameters[5]),
        k: number(&case.parameters[6]),
        p: vector(7),
        s: vector(8),
        e: vector(9),
        g: vector(10),
    })
    .expect("parameters of a case");
    let turn = |first: usize| Rotation::exp(&seeded([0.0; 3], first));
    let second = attitude(draws) * turn(24);
    let own = RigidMotion {
        rotation: attitude(draws),
        translation: column(&draws.direction()),
    };
    let motion = own
        * RigidMotion {
            rotation: turn(18),
            translation: seeded([0.0; 3], 21),
        };
    let mut momentum: Vec<Seeded> = Vec::new();
    for at in 0..15 {
        momentum.push(Dual::variable(draws.uniform(-0.5, 0.5), at));
    }
    let part = |first: usize| Vector3::from_column_slice(&momentum[first..first + 3]);
    let initial = MixedFourInitial {
        R: attitude(draws) * turn(15),
        body_momentum_R: BodyMomentum(part(0)),
        G: motion,
        body_momentum_G: BodyImpulse(SVector::from_column_slice(&momentum[3..9])),
        q: UnitQuaternion::from_components(second.quaternion()).expect("a unit quaternion"),
        body_momentum_q: BodyMomentum(part(9)),
        X: Additive::new(seeded(draws.direction(), 27)),
        momentum_X: FieldMomentum(part(12)),
    };
    let h = length(case, warp, momentum[0]);
    let (mut state, mut workspace) = model.start(initial, h).expect("solvable");
    let seen = |s: &MixedFourState<Seeded>| -> Node {
        vec![
            quantity(&s.body_momentum_R().0),
            quantity(&s.body_momentum_G().0),
            quantity(&s.body_momentum_q().0),
            quantity(&s.momentum_X().0),
            quantity(&s.R().matrix()),
            quantity(&s.G().matrix()),
            quantity(&s.q().matrix()),
            quantity(&s.X().matrix()),
        ]
    };
    let before = seen(&state);
    model.step(&mut state, &mut workspace).expect("solvable");
    (before, seen(&state))
}
