//! Points in space: the symplectic defect of one step of a case at a random state.

use super::{column, number, values};
use crate::seeded::Seeded;
use clebsch::nalgebra::Vector3;
use clebsch::{Additive, Dual, FieldMomentum};
use clebsch_models::Case;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::random_states::Draws;
use clebsch_oracle::physics::symplectic::defect_on_group;

/// A position at distance one from the origin and a momentum, with independent variations.
fn point(draws: &mut Draws) -> (Vector3<Seeded>, Vector3<Seeded>) {
    let (place, momentum) = (draws.direction(), draws.direction());
    (
        Vector3::from_fn(|i, _| Dual::variable(place[i], i)),
        Vector3::from_fn(|i, _| Dual::variable(momentum[i], 3 + i)),
    )
}

/// Starts a model of a point, steps once, and returns the defect.
macro_rules! point_stepped {
    ($model:ident, $parameters:expr, $initial:ident, $place:expr, $momentum:expr, $h:expr) => {{
        let model = $model::new($parameters).expect("parameters of a case");
        let initial = $initial {
            X: Additive::new($place),
            momentum: FieldMomentum($momentum),
        };
        let (mut state, mut workspace) = model.start(initial, $h).expect("solvable");
        model.step(&mut state, &mut workspace).expect("solvable");
        let moved: Vec<Seeded> = state.X().matrix().iter().copied().collect();
        let after = state.momentum().0;
        let jacobian: Vec<Vec<f64>> = moved
            .iter()
            .chain(&after)
            .map(|x| x.dual[..6].to_vec())
            .collect();
        let size = $momentum
            .iter()
            .chain(&after)
            .fold(1.0_f64, |m, x| worse(m, x.real.abs()));
        let [before, after] = [&$momentum, &after].map(|p| values(p));
        defect_on_group(&jacobian, &before, &after, |_, _, _| 0.0) / size
    }};
}

pub(super) fn charged_particle(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::charged_particle::*;
    let (x, p) = point(draws);
    let parameters = ChargedParticleParameters {
        m: number(&case.parameters[0]),
        q: number(&case.parameters[1]),
        B: column(&case.parameters[2]),
        E: column(&case.parameters[3]),
    };
    let h = Dual::constant(case.h) * (Dual::constant(1.0) + Dual::constant(warp) * p[0]);
    point_stepped!(ChargedParticle, parameters, ChargedParticleInitial, x, p, h)
}

pub(super) fn kepler(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::kepler::*;
    let (x, p) = point(draws);
    let parameters = KeplerParameters {
        m: number(&case.parameters[0]),
        k: number(&case.parameters[1]),
    };
    let h = Dual::constant(case.h) * (Dual::constant(1.0) + Dual::constant(warp) * p[0]);
    point_stepped!(Kepler, parameters, KeplerInitial, x, p, h)
}
