//! Motions driven by a clock, an advected scalar that increases by the step size. Steps from random states equal Störmer-Verlet
//! steps with the force at the time of the node.

// The fields of the models are Greek letters, as in the papers.
#![allow(non_snake_case)]

use super::common::Random;
use clebsch::nalgebra::{Matrix3, SMatrix, Vector3};
use clebsch::{Additive, BodyMomentum, FieldMomentum, Rotation};

clebsch::model! {
    /// A pendulum on a lift that goes up and down.
    model DrivenPendulum {
        param m, L, g, A, w: Real;
        field q: Real;
        /// the time
        advected τ: Real;
        constraint next(τ) = τ + h;
        let a = g + A*sin(w*τ);
        lagrangian = m*L^2*(next(q) - q)^2/(2*h) + h*m*a*L*cos(q);
    }
}

clebsch::model! {
    /// A heavy top in gravity that grows with time.
    model DrivenTop {
        param J: Sym<3>;
        param gU, z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        advected τ: Real;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        constraint next(τ) = τ + h;
        lagrangian = -tr(J*Ω)/h - h*τ*dot(gU, Γ);
    }
}

#[test]
fn a_pendulum_on_a_lift_steps_as_by_hand() {
    let mut random = Random(11);
    for _ in 0..200 {
        let [m, L, g, A, w] = [1.3, 0.7, 2.0, 1.5, 3.0];
        let (v, h) = (random.vector(), 0.1);
        let model = DrivenPendulum::new(DrivenPendulumParameters { m, L, g, A, w });
        let model = model.expect("a pendulum");
        let initial = DrivenPendulumInitial {
            q: Additive::new(SMatrix::<f64, 1, 1>::new(v[0])),
            momentum: FieldMomentum(SMatrix::<f64, 1, 1>::new(v[1])),
            τ: v[2],
        };
        let (mut state, mut work) = model.start(initial, h).expect("solvable");
        let (mut q, mut p, mut t) = (v[0], v[1], v[2]);
        for _ in 0..5 {
            model.step(&mut state, &mut work).expect("solvable");
            let kick = |q: f64, t: f64| -0.5 * h * m * (g + A * (w * t).sin()) * L * q.sin();
            p += kick(q, t);
            q += h * p / (m * L * L);
            t += h;
            p += kick(q, t);
            let [found, momentum] = [state.q().matrix()[0], state.momentum().0[0]];
            // Five steps with a few rounding errors each.
            assert!((found - q).abs() < 1e-14 * (1.0 + q.abs()), "{found} {q}");
            assert!(
                (momentum - p).abs() < 1e-14 * (1.0 + p.abs()),
                "{momentum} {p}"
            );
            // A force evaluated one step later would differ.
            assert!((kick(q, t) - kick(q, t + h)).abs() > 0.0);
        }
    }
}

/// The torque at a node uses the time of the node: half of it at the start of a step, half at the end.
#[test]
fn a_top_in_gravity_that_grows_takes_the_torque_of_each_node() {
    let mut random = Random(12);
    for _ in 0..50 {
        let J = Matrix3::from_diagonal(&Vector3::new(1.0, 1.5, 2.0));
        let (gU, z, h, t) = (random.vector(), random.vector(), 0.05, random.vector()[0]);
        let model = DrivenTop::new(DrivenTopParameters { J, gU, z }).expect("a top");
        let initial = DrivenTopInitial {
            Λ: Rotation::exp(&random.vector()),
            body_momentum: BodyMomentum(random.vector()),
            τ: t,
        };
        let (mut state, mut work) = model.start(initial, h).expect("solvable");
        let before = state;
        model.step(&mut state, &mut work).expect("solvable");
        let [R0, R1] = [before.Λ(), state.Λ()].map(|r| r.matrix());
        // In space, the change of the momentum is the mean of the torques at both ends times the step size.
        let torque = |R: Matrix3<f64>, t: f64| -(t * R * gU).cross(&z);
        let change = 0.5 * h * (torque(R0, t) + torque(R1, t + h));
        let [m0, m1] = [&before, &state].map(|s| s.spatial_momentum().0);
        let off = (m1 - m0 - change).amax();
        assert!(off < 1e-14 * (1.0 + m0.amax()), "{off:e}");
        let late = 0.5 * h * (torque(R0, t) + torque(R1, t));
        assert!((m1 - m0 - late).amax() > 1e-8);
    }
}
