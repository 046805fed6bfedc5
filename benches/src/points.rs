//! Blocks of work for points in space, a planet and a charge: the same steps from the same initial state. Each step is a fallible
//! call, and initialisation is outside the measured time.

use crate::loops::{generated, written};
use crate::operation_counts::Block;
use clebsch::nalgebra::Vector3;
use clebsch::{Additive, FieldMomentum};
use clebsch_models::charged_particle::{
    ChargedParticle, ChargedParticleInitial, ChargedParticleParameters,
};
use clebsch_models::kepler::{Kepler, KeplerInitial, KeplerParameters};
use clebsch_oracle::handwritten;
use clebsch_oracle::handwritten::attitude::Vector;
use clebsch_oracle::handwritten::charged_particle::Charge;
use clebsch_oracle::reference::H;

/// A circular orbit about a sun with gravitational parameter 1, which the step size of the benchmarks resolves.
const PLACE: Vector = [1.0, 0.0, 0.0];

const MOMENTUM: Vector = [0.0, 0.8, 0.6];

const CHARGE: Charge = Charge {
    mass: 1.0,
    charge: 1.0,
    magnetic: [0.3, -0.2, 0.9],
    electric: [0.1, 0.05, -0.1],
};

/// A block of the generated planet.
pub fn generated_kepler() -> Block<impl FnOnce()> {
    let initial = KeplerInitial {
        X: Additive::new(Vector3::from(PLACE)),
        momentum: FieldMomentum(Vector3::from(MOMENTUM)),
    };
    generated!(Kepler::new(KeplerParameters { m: 1.0, k: 1.0 }), initial)
}

/// A block of the hand-written planet.
pub fn written_kepler() -> impl FnOnce() {
    let motion = handwritten::kepler::Kepler::start(1.0, 1.0, &PLACE, &MOMENTUM, H);
    written!(motion.expect("solvable"))
}

/// A block of the generated charge.
pub fn generated_charge() -> Block<impl FnOnce()> {
    let parameters = ChargedParticleParameters {
        m: CHARGE.mass,
        q: CHARGE.charge,
        B: Vector3::from(CHARGE.magnetic),
        E: Vector3::from(CHARGE.electric),
    };
    let initial = ChargedParticleInitial {
        X: Additive::new(Vector3::from(PLACE)),
        momentum: FieldMomentum(Vector3::from(MOMENTUM)),
    };
    generated!(ChargedParticle::new(parameters), initial)
}

/// A block of the hand-written charge.
pub fn written_charge() -> impl FnOnce() {
    let motion =
        handwritten::charged_particle::ChargedParticle::start(&CHARGE, &PLACE, &MOMENTUM, H);
    written!(motion.expect("solvable"))
}
