//! Points in space: starts a case at a random point, steps once, and returns both nodes.

use super::{Node, Step, column, length, number, quantity, vector};
use crate::seeded::Seeded;
use clebsch::{Additive, FieldMomentum};
use clebsch_models::Case;
use clebsch_oracle::physics::random_states::Draws;

/// Starts a model of a point, steps once, and returns both nodes.
macro_rules! point_stepped {
    ($model:ident, $parameters:expr, $initial:ident, $case:expr, $draws:expr, $warp:expr) => {{
        let (momentum, place) = (vector($draws, 0), vector($draws, 3));
        let model = $model::new($parameters).expect("parameters of a case");
        let initial = $initial {
            X: Additive::new(place),
            momentum: FieldMomentum(momentum),
        };
        let h = length($case, $warp, momentum[0]);
        let (mut state, mut workspace) = model.start(initial, h).expect("solvable");
        let seen = |s: &_| -> Node {
            let s: &<$model<Seeded> as clebsch::integrate::Stepper>::State = s;
            vec![quantity(&s.momentum().0), quantity(&s.X().matrix())]
        };
        let before = seen(&state);
        model.step(&mut state, &mut workspace).expect("solvable");
        (before, seen(&state))
    }};
}

pub(super) fn charged_particle(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::charged_particle::*;
    let parameters = ChargedParticleParameters {
        m: number(&case.parameters[0]),
        q: number(&case.parameters[1]),
        B: column(&case.parameters[2]),
        E: column(&case.parameters[3]),
    };
    point_stepped!(
        ChargedParticle,
        parameters,
        ChargedParticleInitial,
        case,
        draws,
        warp
    )
}

pub(super) fn kepler(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::kepler::*;
    let parameters = KeplerParameters {
        m: number(&case.parameters[0]),
        k: number(&case.parameters[1]),
    };
    point_stepped!(Kepler, parameters, KeplerInitial, case, draws, warp)
}
