//! Newton's method measures each equation on its own scale: bodies of very different mass and size in one model, and the same
//! problem in other units of length, mass and time.

// The fields of the models are Greek letters, as in the papers.
#![allow(non_snake_case, reason = "as in the papers")]

use crate::common::Random;
use crate::principal::models::*;
use crate::principal::stated::*;
use clebsch::integrate::Model;
use clebsch::nalgebra::{Matrix3, SVector, Vector3, Vector4};
use clebsch::{BodyImpulse, BodyMomentum, BodyMomentumMatrix, Linear, RigidMotion, UnitQuaternion};

/// The number of base units in each unit.
#[derive(Clone, Copy)]
struct Units {
    length: f64,
    mass: f64,
    time: f64,
}

const BASE: Units = Units {
    length: 1.0,
    mass: 1.0,
    time: 1.0,
};

impl Units {
    /// The factor of a quantity with this dimension.
    fn of(self, mass: i32, length: i32, time: i32) -> f64 {
        self.mass.powi(mass) * self.length.powi(length) * self.time.powi(time)
    }
    fn inertia(self) -> f64 {
        self.of(1, 2, 0)
    }
    fn angular(self) -> f64 {
        self.of(1, 2, -1)
    }
    fn linear(self) -> f64 {
        self.of(1, 1, -1)
    }
}

/// One step from a random state, as numbers in base units.
macro_rules! stepped {
    ($model:expr, $initial:expr, $h:expr, |$state:ident| $numbers:expr) => {{
        let (model, h) = ($model.expect("valid"), $h);
        let before = model.begin($initial).expect("valid");
        let mut $state = before;
        let mut work = model.workspace(&before, h).expect("solvable");
        model.step(&mut $state, &mut work).expect("solvable");
        $numbers
    }};
}

fn six(angular: Vector3<f64>, linear: Vector3<f64>, u: Units) -> BodyImpulse {
    let (angular, linear) = (angular * u.angular(), linear * u.linear());
    BodyImpulse(SVector::from_fn(|i, _| {
        if i < 3 { angular[i] } else { linear[i - 3] }
    }))
}

fn motion_numbers(g: RigidMotion, m: SVector<f64, 6>, u: Units) -> Vec<f64> {
    let mut all = g.rotation.quaternion().to_vec();
    all.extend(g.translation.iter().map(|x| x / u.length));
    all.extend(m.iter().enumerate().map(|(i, x)| match i < 3 {
        true => x / u.angular(),
        false => x / u.linear(),
    }));
    all
}

/// Two bodies with a joint; the second body and the joint are lighter by a factor.
fn pair(r: &mut Random, u: Units, lighter: f64) -> Vec<f64> {
    let eps = between(r, 0.1, 0.5) * lighter;
    let arms = [(); 2].map(|()| vector(r, 0.7));
    let j = [1.0, lighter].map(|s| positive(r) * s);
    let m = [1.0, lighter].map(|s| momentum(r) * s);
    let turns = [(); 2].map(|()| r.rotation());
    let moment = |i: usize| (j[i] + arms[i] * arms[i].transpose() * eps) * u.inertia();
    let model = Pair::new(PairParameters {
        J1: moment(0),
        J2: moment(1),
        d1: arms[0],
        d2: arms[1],
        eps: eps * u.inertia(),
        k: between(r, -0.5, 0.5) * lighter * u.of(1, 2, -2),
    });
    let initial = PairInitial {
        Λ1: turns[0],
        body_momentum_Λ1: BodyMomentum(m[0] * u.angular()),
        Λ2: turns[1],
        body_momentum_Λ2: BodyMomentum(m[1] * u.angular()),
    };
    stepped!(model, initial, 0.05 * u.time, |state| {
        let mut all = state.Λ1().quaternion().to_vec();
        all.extend(state.Λ2().quaternion());
        let m = [state.spatial_momentum_Λ1().0, state.spatial_momentum_Λ2().0];
        all.extend(m.iter().flat_map(|m| m.iter().map(|x| x / u.angular())));
        all
    })
}

/// A body in a fluid, smaller than one unit of length by a factor.
fn body_in_fluid(r: &mut Random, u: Units, smaller: f64) -> Vec<f64> {
    let own = Units {
        length: u.length * smaller,
        ..u
    };
    let model = FluidBody::new(FluidBodyParameters {
        J: positive(r) * own.inertia(),
        M: positive(r) * 3.0 * own.mass,
        D: positive(r) * between(r, 0.0, 0.1) * own.of(1, 1, 0),
        b: {
            let [x, y, z, w] = [(); 4].map(|()| between(r, -0.3, 0.3));
            let moment = own.of(1, 2, -2);
            Vector4::new(x * moment, y * moment, z * moment, w * own.of(1, 1, -2))
        },
        Z: Vector4::new(0.0, 0.0, 1.0, 0.0),
    });
    let initial = FluidBodyInitial {
        G: RigidMotion {
            rotation: r.rotation(),
            translation: vector(r, own.length),
        },
        body_momentum: six(momentum(r), momentum(r), own),
    };
    stepped!(model, initial, 0.05 * u.time, |state| {
        motion_numbers(state.G(), state.body_momentum().0, own)
    })
}

/// Three bodies with springs; the inertia of the third is smaller by a factor.
fn springs(r: &mut Random, u: Units, thinner: f64) -> Vec<f64> {
    let j = [1.0, 1.0, thinner].map(|s| positive(r) * s * u.inertia());
    let [a, b] = [(); 2].map(|()| vector(r, 0.5));
    let model = ThreeSprings::new(ThreeSpringsParameters {
        J1: j[0],
        J2: j[1],
        J3: j[2],
        m: between(r, 0.5, 2.0) * u.mass,
        k: between(r, 0.1, 1.0) * thinner * u.of(1, 0, -2),
        a: a * u.length,
        b: b * u.length,
    });
    let places = [(); 3].map(|()| RigidMotion {
        rotation: r.rotation(),
        translation: vector(r, u.length),
    });
    let parts = [1.0, 1.0, thinner].map(|s| six(momentum(r) * s, momentum(r), u));
    let initial = ThreeSpringsInitial {
        G1: places[0],
        body_momentum_G1: parts[0],
        G2: places[1],
        body_momentum_G2: parts[1],
        G3: places[2],
        body_momentum_G3: parts[2],
    };
    stepped!(model, initial, 0.05 * u.time, |state| [
        motion_numbers(state.G1(), state.body_momentum_G1().0, u),
        motion_numbers(state.G2(), state.body_momentum_G2().0, u),
        motion_numbers(state.G3(), state.body_momentum_G3().0, u),
    ]
    .concat())
}

/// A deformable ellipsoid, whose matrix is dimensionless.
fn ellipsoid(r: &mut Random, u: Units, _: f64) -> Vec<f64> {
    let shape = Matrix3::identity() + positive(r) * 0.3;
    let model = Ellipsoid::new(EllipsoidParameters {
        I0: positive(r) * u.inertia(),
        k: between(r, -0.5, 0.5) * u.of(1, 2, -2),
    });
    let initial = EllipsoidInitial {
        Q: Linear::from_matrix(&shape).expect("regular"),
        body_momentum: BodyMomentumMatrix(
            Matrix3::from_fn(|_, _| between(r, -0.3, 0.3)) * u.angular(),
        ),
    };
    stepped!(model, initial, 0.05 * u.time, |state| {
        let mut all: Vec<f64> = state.Q().matrix().iter().copied().collect();
        let m = state.body_momentum().0;
        all.extend(m.iter().map(|x| x / u.angular()));
        all
    })
}

/// Unit quaternions.
fn quaternion(r: &mut Random, u: Units, _: f64) -> Vec<f64> {
    let model = StiffQuaternion::new(StiffQuaternionParameters {
        S: positive(r) * u.inertia(),
        c: 0.0,
    });
    let start = r.rotation().quaternion();
    let initial = StiffQuaternionInitial {
        q: UnitQuaternion::from_components(start).expect("unit"),
        body_momentum: BodyMomentum(momentum(r) * 0.3 * u.angular()),
    };
    stepped!(model, initial, 0.02 * u.time, |state| {
        let mut all = state.q().components().to_vec();
        let m = state.body_momentum().0;
        all.extend(m.iter().map(|x| x / u.angular()));
        all
    })
}

type Step = fn(&mut Random, Units, f64) -> Vec<f64>;

const ALL: [(&str, Step); 5] = [
    ("pair", pair),
    ("body in a fluid", body_in_fluid),
    ("springs", springs),
    ("ellipsoid", ellipsoid),
    ("quaternion", quaternion),
];

/// The bits of all numbers.
fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|x| x.to_bits()).collect()
}

/// Every step succeeds, however small one body is.
#[test]
fn bodies_of_very_different_sizes_are_solved_together() {
    for (name, step) in &ALL[..3] {
        for order in 0..=12 {
            let mut random = Random(5);
            for _ in 0..40 {
                let made = step(&mut random, BASE, 0.1_f64.powi(order));
                assert!(made.iter().all(|x| x.is_finite()), "{name}, 1e-{order}");
            }
        }
    }
}

#[test]
fn units_that_are_powers_of_four_give_the_same_bits() {
    for (name, step) in ALL {
        let (mut random, mut units) = (Random(11), Random(12));
        for problem in 0..1000 {
            let mut unit = || 4.0_f64.powi((10.0 * units.symmetric()) as i32);
            let others = Units {
                length: unit(),
                mass: unit(),
                time: unit(),
            };
            let mut again = Random(random.0);
            let one = step(&mut random, BASE, 0.1);
            let other = step(&mut again, others, 0.1);
            assert_eq!(bits(&one), bits(&other), "{name} {problem}");
        }
    }
}

/// Data have a few rounding errors in the other units, and steps of at most a third of a radian amplify these at most tenfold.
const SAME: f64 = 2e-14;

#[test]
fn other_units_give_the_same_step() {
    for (name, step) in ALL {
        let (mut random, mut units) = (Random(21), Random(22));
        let mut worst = 0.0_f64;
        for problem in 0..1000 {
            let mut unit = || 10.0_f64.powf(6.0 * units.symmetric());
            let others = Units {
                length: unit(),
                mass: unit(),
                time: unit(),
            };
            let mut again = Random(random.0);
            let one = step(&mut random, BASE, 0.1);
            let other = step(&mut again, others, 0.1);
            for (x, y) in one.iter().zip(&other) {
                let off = (x - y).abs() / (1.0 + x.abs());
                let fine = off <= SAME;
                assert!(fine, "{name} {problem}: {x} {y}");
                worst = worst.max(off);
            }
            // A different problem gives a different step, so the test can fail.
            assert_ne!(bits(&one), bits(&step(&mut again, others, 0.1)));
            let _ = step(&mut random, BASE, 0.1);
        }
        println!("{name}: {worst:.1e}");
    }
}
