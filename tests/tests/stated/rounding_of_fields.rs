//! Rounding of fields. Forces between positions far from the origin keep the digits of their distance, and exact invariants do not
//! lose the digits of `1/h`, however the model states them.

use clebsch::nalgebra::{Matrix3, Vector3, Vector6};
use clebsch::{Additive, BodyImpulse, FieldMomentum, RigidMotion, Rotation};
use clebsch_oracle::oracle::points::Source;

clebsch::model! {
    /// Two masses on a spring that hardens.
    model Hard {
        param m, k: Real;
        field X, Y: Vec<3>;
        let r = X - Y;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h)
            + m*dot(next(Y) - Y, next(Y) - Y)/(2*h) - h*k*dot(r, r)^2;
    }
}

clebsch::model! {
    /// Three masses with a different spring for each pair.
    model Three {
        param k, l: Real;
        field X, Y, Z: Vec<3>;
        lagrangian = dot(next(X) - X, next(X) - X)/(2*h) + dot(next(Y) - Y, next(Y) - Y)/(2*h)
            + dot(next(Z) - Z, next(Z) - Z)/(2*h)
            - h*k*dot(X - Y, X - Y)^2 - h*l*dot(X - Z, X - Z)^3;
    }
}

clebsch::model! {
    /// A mass on a spring that hardens, at the arm of a body in space.
    model Tied {
        param m, k: Real;
        param a: Vec<3>;
        param J: Sym<3>;
        group G: SE<3> velocity V;
        field X: Vec<3>;
        constraint next(G) = G*V;
        let s = X - pos(G) - rot(G)*a;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) - tr(J*rot(V))/h
            + m*dot(pos(V), pos(V))/(2*h) - h*k*dot(s, s)^2;
    }
}

clebsch::model! {
    /// A mass that falls, its kinetic energy spelled out.
    model Spelled {
        param m: Real;
        param g: Vec<3>;
        field X: Vec<3>;
        lagrangian = m*dot(next(X), next(X))/(2*h) - m*dot(next(X), X)/h + m*dot(X, X)/(2*h)
            + h*m*dot(g, X);
    }
}

clebsch::model! {
    /// A body whose centre is a field, with a mass on an arm.
    model Arm {
        param m: Real;
        param J: Sym<3>;
        param a: Vec<3>;
        group R: SO<3> velocity W;
        field X: Vec<3>;
        constraint next(R) = R*W;
        let c = X + R*a;
        lagrangian = m*dot(next(c) - c, next(c) - c)/(2*h) - tr(J*W)/h
            + dot(next(X) - X, next(X) - X)/(2*h);
    }
}

/// At this distance from the origin, numbers have eight digits left.
const FAR: f64 = 67_108_864.0;

/// The rounding error of a position at that distance, times the effect of the force gradient, at most a hundred, in one step.
const FAR_ROUNDING: f64 = 100.0 * FAR * f64::EPSILON;

fn away(by: f64) -> Vector3<f64> {
    Vector3::new(by, -by, 2.0 * by)
}

/// Positions with few digits, which are exact at any distance.
fn places() -> [Vector3<f64>; 3] {
    [[0.5, 0.25, -0.5], [-0.25, 0.5, 0.75], [1.0, -0.75, 0.25]].map(Vector3::from)
}

fn hard(by: f64) -> [Vector3<f64>; 2] {
    let model = Hard::new(HardParameters { m: 1.0, k: 0.5 }).expect("parameters");
    let [x, y, _] = places();
    let initial = HardInitial {
        X: Additive::new(x + away(by)),
        momentum_X: FieldMomentum(y),
        Y: Additive::new(y + away(by)),
        momentum_Y: FieldMomentum(x),
    };
    let (mut state, mut work) = model.start(initial, 0.125).expect("solvable");
    model.step(&mut state, &mut work).expect("solvable");
    [state.momentum_X().0, state.momentum_Y().0]
}

fn three(by: f64) -> [Vector3<f64>; 3] {
    let model = Three::new(ThreeParameters { k: 0.5, l: 0.25 }).expect("parameters");
    let [x, y, z] = places();
    let initial = ThreeInitial {
        X: Additive::new(x + away(by)),
        momentum_X: FieldMomentum(y),
        Y: Additive::new(y + away(by)),
        momentum_Y: FieldMomentum(x),
        Z: Additive::new(z + away(by)),
        momentum_Z: FieldMomentum(z),
    };
    let (mut state, mut work) = model.start(initial, 0.125).expect("solvable");
    model.step(&mut state, &mut work).expect("solvable");
    [
        state.momentum_X().0,
        state.momentum_Y().0,
        state.momentum_Z().0,
    ]
}

fn tied(by: f64) -> [Vector3<f64>; 2] {
    let parameters = TiedParameters {
        m: 1.0,
        k: 0.5,
        a: Vector3::new(0.5, 0.25, -0.5),
        J: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0)),
    };
    let model = Tied::new(parameters).expect("parameters");
    let [x, y, _] = places();
    let initial = TiedInitial {
        G: RigidMotion {
            rotation: Rotation::identity(),
            translation: x + away(by),
        },
        body_momentum_G: BodyImpulse(Vector6::new(0.1, 0.2, -0.1, 0.3, 0.1, 0.2)),
        X: Additive::new(y + away(by)),
        momentum_X: FieldMomentum(x),
    };
    let (mut state, mut work) = model.start(initial, 0.125).expect("solvable");
    model.step(&mut state, &mut work).expect("solvable");
    let impulse = state.spatial_momentum_G().0;
    [
        impulse.fixed_rows::<3>(3).into_owned(),
        state.momentum_X().0,
    ]
}

#[test]
fn forces_between_far_places_keep_the_digits_of_their_distance() {
    for (near, far) in hard(0.0).iter().zip(hard(FAR)) {
        assert!((near - far).norm() < FAR_ROUNDING, "{near} {far}");
    }
    for (near, far) in three(0.0).iter().zip(three(FAR)) {
        assert!((near - far).norm() < FAR_ROUNDING, "{near} {far}");
    }
    for (near, far) in tied(0.0).iter().zip(tied(FAR)) {
        assert!((near - far).norm() < FAR_ROUNDING, "{near} {far}");
    }
}

#[test]
fn a_spelled_out_kinetic_energy_keeps_the_momentum() {
    let g = Vector3::new(0.3, 0.0, -0.7);
    let model = Spelled::new(SpelledParameters { m: 1.5, g }).expect("parameters");
    let [x, p, _] = places();
    for h in [1e-1, 1e-4, 1e-8] {
        let initial = SpelledInitial {
            X: Additive::new(x),
            momentum: FieldMomentum(p),
        };
        let (mut state, mut work) = model.start(initial, h).expect("solvable");
        for _ in 0..1000 {
            model.step(&mut state, &mut work).expect("solvable");
        }
        let pushed = p + g * (1.5 * 1000.0 * h);
        // Rounding errors of a thousand additions and of the increments.
        let rounding = 2000.0 * f64::EPSILON * (1.0 + pushed.norm());
        assert!((state.momentum().0 - pushed).norm() < rounding, "{h:e}");
    }
}

#[test]
fn a_mass_on_an_arm_keeps_the_total_momenta_at_small_steps() {
    let mut source = Source::seeded(51);
    let parameters = ArmParameters {
        m: 0.7,
        J: Matrix3::from_diagonal(&Vector3::new(0.4, 0.6, 0.9)),
        a: Vector3::new(0.5, -0.3, 0.8),
    };
    let model = Arm::new(parameters).expect("parameters");
    for h in [1e-2, 1e-5, 1e-8] {
        let initial = ArmInitial {
            R: Rotation::identity(),
            body_momentum_R: clebsch::BodyMomentum(Vector3::from(source.vector())),
            X: Additive::new(Vector3::from(source.vector())),
            momentum_X: FieldMomentum(Vector3::from(source.vector())),
        };
        let (mut state, mut work) = model.start(initial, h).expect("solvable");
        let about =
            |s: &ArmState<f64>| s.spatial_momentum_R().0 + s.X().matrix().cross(&s.momentum_X().0);
        let (total, first) = (about(&state), state.momentum_X().0);
        for _ in 0..1000 {
            model.step(&mut state, &mut work).expect("solvable");
        }
        assert_eq!(state.momentum_X().0, first);
        // A thousand steps with a few rounding errors of numbers of order one.
        let drift = (about(&state) - total).norm();
        assert!(drift < 1e-12, "{h:e}: {drift:e}");
    }
}
