//! Rounding of fields. Forces between positions far from the origin keep the digits of their distance, and exact invariants do not
//! lose the digits of `1/h`, however the model states them.

use super::text_model::{Given, Motion, TextModel, given};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{RigidMotion, Rotation};
use clebsch_oracle::oracle::points::Source;

/// Two masses on a spring that hardens.
const HARD: &str = "model Hard {
    param m, k: Real;
    field X, Y: Vec<3>;
    let r = X - Y;
    lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h)
        + m*dot(next(Y) - Y, next(Y) - Y)/(2*h) - h*k*dot(r, r)^2;
}";

/// Three masses with a different spring for each pair.
const THREE: &str = "model Three {
    param k, l: Real;
    field X, Y, Z: Vec<3>;
    lagrangian = dot(next(X) - X, next(X) - X)/(2*h) + dot(next(Y) - Y, next(Y) - Y)/(2*h)
        + dot(next(Z) - Z, next(Z) - Z)/(2*h)
        - h*k*dot(X - Y, X - Y)^2 - h*l*dot(X - Z, X - Z)^3;
}";

/// A mass on a spring that hardens, at the arm of a body in space.
const TIED: &str = "model Tied {
    param m, k: Real;
    param a: Vec<3>;
    param J: Sym<3>;
    group G: SE<3> velocity V;
    field X: Vec<3>;
    constraint next(G) = G*V;
    let s = X - pos(G) - rot(G)*a;
    lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) - tr(J*rot(V))/h
        + m*dot(pos(V), pos(V))/(2*h) - h*k*dot(s, s)^2;
}";

/// A mass that falls, its kinetic energy spelled out.
const SPELLED: &str = "model Spelled {
    param m: Real;
    param g: Vec<3>;
    field X: Vec<3>;
    lagrangian = m*dot(next(X), next(X))/(2*h) - m*dot(next(X), X)/h + m*dot(X, X)/(2*h)
        + h*m*dot(g, X);
}";

/// A body whose centre is a field, with a mass on an arm.
const ARM: &str = "model Arm {
    param m: Real;
    param J: Sym<3>;
    param a: Vec<3>;
    group R: SO<3> velocity W;
    field X: Vec<3>;
    constraint next(R) = R*W;
    let c = X + R*a;
    lagrangian = m*dot(next(c) - c, next(c) - c)/(2*h) - tr(J*W)/h
        + dot(next(X) - X, next(X) - X)/(2*h);
}";

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

/// The momenta of these names after one step.
fn after_a_step(text: &str, given: &Given, names: &[&str]) -> Vec<f64> {
    let mut motion = TextModel::read(text).start(0.125, given).expect("solvable");
    motion.steps(1);
    names.iter().flat_map(|name| motion.numbers(name)).collect()
}

fn hard(by: f64) -> Vec<f64> {
    let [x, y, _] = places();
    let given = given! {
        m: 1.0, k: 0.5, X: x + away(by), momentum_X: y, Y: y + away(by), momentum_Y: x,
    };
    after_a_step(HARD, &given, &["momentum_X", "momentum_Y"])
}

fn three(by: f64) -> Vec<f64> {
    let [x, y, z] = places();
    let given = given! {
        k: 0.5, l: 0.25, X: x + away(by), momentum_X: y, Y: y + away(by), momentum_Y: x,
        Z: z + away(by), momentum_Z: z,
    };
    after_a_step(THREE, &given, &["momentum_X", "momentum_Y", "momentum_Z"])
}

fn tied(by: f64) -> Vec<f64> {
    let [x, y, _] = places();
    let place = RigidMotion {
        rotation: Rotation::identity(),
        translation: x + away(by),
    };
    let given = given! {
        m: 1.0, k: 0.5, a: [0.5, 0.25, -0.5], J: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0)),
        G: place, body_momentum_G: [0.1, 0.2, -0.1, 0.3, 0.1, 0.2], X: y + away(by), momentum_X: x,
    };
    let all = after_a_step(TIED, &given, &["spatial_momentum_G", "momentum_X"]);
    // The moment about the origin depends on the distance.
    all[3..].to_vec()
}

#[test]
fn forces_between_far_places_keep_the_digits_of_their_distance() {
    for run in [hard, three, tied] {
        let (near, far) = (run(0.0), run(FAR));
        for (near, far) in near.chunks(3).zip(far.chunks(3)) {
            let [near, far] = [near, far].map(Vector3::from_row_slice);
            assert!((near - far).norm() < FAR_ROUNDING, "{near} {far}");
        }
    }
}

#[test]
fn a_spelled_out_kinetic_energy_keeps_the_momentum() {
    let g = Vector3::new(0.3, 0.0, -0.7);
    let [x, p, _] = places();
    for h in [1e-1, 1e-4, 1e-8] {
        let given = given! { m: 1.5, g: g, X: x, momentum: p };
        let mut motion = TextModel::read(SPELLED).start(h, &given).expect("solvable");
        motion.steps(1000);
        let pushed = p + g * (1.5 * 1000.0 * h);
        // Rounding errors of a thousand additions and of the increments.
        let rounding = 2000.0 * f64::EPSILON * (1.0 + pushed.norm());
        assert!(
            (motion.vector("momentum") - pushed).norm() < rounding,
            "{h:e}"
        );
    }
}

#[test]
fn a_mass_on_an_arm_keeps_the_total_momenta_at_small_steps() {
    let mut source = Source::seeded(51);
    for h in [1e-2, 1e-5, 1e-8] {
        let given = given! {
            m: 0.7, J: Matrix3::from_diagonal(&Vector3::new(0.4, 0.6, 0.9)), a: [0.5, -0.3, 0.8],
            R: Matrix3::<f64>::identity(), body_momentum_R: source.vector::<3>(), X: source.vector::<3>(),
            momentum_X: source.vector::<3>(),
        };
        let mut motion = TextModel::read(ARM).start(h, &given).expect("solvable");
        let about = |m: &Motion| {
            m.vector("spatial_momentum_R") + m.vector::<3>("X").cross(&m.vector("momentum_X"))
        };
        let (total, first) = (about(&motion), motion.numbers("momentum_X"));
        motion.steps(1000);
        assert_eq!(motion.numbers("momentum_X"), first);
        // A thousand steps with a few rounding errors of numbers of order one.
        let drift = (about(&motion) - total).norm();
        assert!(drift < 1e-12, "{h:e}: {drift:e}");
    }
}
