//! Kinetic energies with terms of higher order in the deviation from zero velocity, at step sizes where these terms are far below
//! the rounding of the velocity matrix. The test uses rotations about a principal axis, for which momentum and angle determine each
//! other in closed form.

// Field names follow the papers.
#![allow(non_snake_case)]

use clebsch::nalgebra::{Matrix3, SVector, Vector3};
use clebsch::{BodyImpulse, BodyMomentum, RigidMotion, Rotation, SpatialMomentum, UnitQuaternion};

clebsch::model! {
    /// A body of quartic kinetic energy.
    model Quartic {
        param J: Sym<3>;
        param k: Real;
        group A: SO<3> velocity u;
        constraint next(A) = A*u;
        lagrangian = -tr(J*u)/h + (k/h^3)*tr(Id - u)^2;
    }
}

clebsch::model! {
    /// The same in other notation: by moved points, by a number minus the trace, in space, by the real part of a
    /// quaternion, for the rotation of a rigid motion.
    model Quartics {
        param J: Sym<3>;
        param k: Real;
        group A: SO<3> velocity u;
        group B: SO<3> velocity v;
        group C: SO<3> velocity w;
        group q: SU<2> velocity y;
        group G: SE<3> velocity V;
        constraint next(A) = A*u;
        constraint next(B) = B*v;
        constraint next(C) = w*C;
        constraint next(q) = q*y;
        constraint next(G) = G*V;
        let moved = A*u - A;
        let inertia = tr(J)*Id - J;
        lagrangian = -tr(J*u)/h + (k/h^3)*tr(moved*moved^T)^2/4
            - tr(J*v)/h + (k/h^3)*(3 - tr(v))^2
            - tr(J*C^T*w*C)/h + (k/h^3)*tr(w - Id)^2
            + (2/h)*dot(im(y), inertia*im(y)) + (64*k/h^3)*(1 - re(y))^2
            - tr(J*rot(V))/h + dot(pos(V), pos(V))/(2*h) + (k/h^3)*tr(rot(V) - Id)^2;
    }
}

const K: f64 = 0.4;
const OMEGA: f64 = 0.9;

fn moments() -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(0.7, 0.8, 0.3))
}

/// The momentum of a rotation about the third axis by `θ` per step: the body's part, plus the part of the quartic term
/// `(k/h³) (2 - 2 cos θ)²`.
fn momentum(θ: f64, h: f64) -> f64 {
    let half = (θ / 2.0).sin();
    let inertia = moments().m11 + moments().m22;
    inertia * θ.sin() / h + 16.0 * K * half * half * θ.sin() / h.powi(3)
}

/// The same for a quaternion, with `(64 k/h³) (1 - cos θ/2)²`.
fn momentum_of_quaternion(θ: f64, h: f64) -> f64 {
    let quarter = (θ / 4.0).sin();
    let inertia = moments().m11 + moments().m22;
    inertia * θ.sin() / h + 128.0 * K * quarter * quarter * (θ / 2.0).sin() / h.powi(3)
}

/// Step sizes from a large rotation down to rotations for which `1 - cos θ` is zero in doubles.
const STEPS: [f64; 8] = [0.5, 1e-2, 1e-4, 1e-6, 1e-7, 1e-8, 1e-9, 1e-11];

/// Checks that the rotation angle about the third axis is correct to a few rounding errors, including those of the momentum and the
/// solution.
fn close(what: &str, found: f64, θ: f64) {
    let apart = (found / θ - 1.0).abs();
    assert!(
        apart < 1e-14,
        "{what}: {found:e} in place of {θ:e}: {apart:e}"
    );
}

fn angle(r: &Rotation) -> f64 {
    2.0 * r.quaternion()[3].asin()
}

#[test]
fn a_quartic_energy_keeps_its_digits_for_small_steps() {
    let parameters = QuarticParameters { J: moments(), k: K };
    let model = Quartic::new(parameters).expect("a body");
    for h in STEPS {
        let θ = OMEGA * h;
        let initial = QuarticInitial {
            A: Rotation::identity(),
            body_momentum: BodyMomentum(Vector3::z() * momentum(θ, h)),
        };
        let (mut state, mut work) = model.start(initial, h).expect("solvable");
        model.step(&mut state, &mut work).expect("solvable");
        close(&format!("{h:e}"), angle(&state.A()), θ);
    }
}

#[test]
fn so_it_does_however_it_is_written_and_for_every_group_of_turns() {
    let parameters = QuarticsParameters { J: moments(), k: K };
    let model = Quartics::new(parameters).expect("bodies");
    for h in STEPS {
        let θ = OMEGA * h;
        let m = Vector3::z() * momentum(θ, h);
        let still = Rotation::identity();
        let initial = QuarticsInitial {
            A: still,
            body_momentum_A: BodyMomentum(m),
            B: still,
            body_momentum_B: BodyMomentum(m),
            C: still,
            spatial_momentum_C: SpatialMomentum(m),
            q: UnitQuaternion::identity(),
            body_momentum_q: BodyMomentum(Vector3::z() * momentum_of_quaternion(θ, h)),
            G: RigidMotion::identity(),
            body_momentum_G: BodyImpulse(SVector::from([m.x, m.y, m.z, 0.0, 0.0, 0.0])),
        };
        let (mut state, mut work) = model.start(initial, h).expect("solvable");
        model.step(&mut state, &mut work).expect("solvable");
        let turned = [state.A(), state.B(), state.C(), state.q().rotation()];
        for (name, r) in ["A", "B", "C", "q"].into_iter().zip(turned) {
            close(&format!("{name}, {h:e}"), angle(&r), θ);
        }
        let moved = state.G().matrix();
        let sine = (moved[(1, 0)] - moved[(0, 1)]) / 2.0;
        close(&format!("G, {h:e}"), sine.asin(), θ);
    }
}
