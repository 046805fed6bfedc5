//! Errata on orders and on the symplectic form of whole steps. Motions are random. The reference is the measured order of an error,
//! or the two-form of a map with dual numbers.

use super::{Matrix, Vector, judge, size, skew};
use crate::seeded::Seeded;
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Dual, Rotation};
use clebsch_models::free_body::{FreeBody, FreeBodyInitial, FreeBodyParameters};
use clebsch_oracle::oracle::square::{Square, cross, hat};
use clebsch_oracle::physics::symplectic::{Jacobian, defect};
use std::array::from_fn;

fn rotation(v: &Vector) -> Matrix {
    let r = Rotation::exp(&Vector3::from(*v)).matrix();
    Square::from_entries(|i, j| r[(i, j)])
}

/// The order of an error in the step size.
fn order(error: impl Fn(f64) -> f64) -> f64 {
    let (h, half) = (0.02, 0.01);
    (error(h) / error(half)).log2()
}

#[test]
fn section_2_2_1_the_velocity_of_a_step_is_of_first_order() {
    judge("Ω = 1 + Ω Δt to second order", |s| {
        let (a, b): (Vector, Vector) = (s.vector(), s.vector());
        // Λ(t) = exp(t a) exp(t² b), with body velocity exp(-t² b) a + 2 t b.
        let at = |t: f64| rotation(&a.map(|x| t * x)) * rotation(&b.map(|x| t * t * x));
        let t = 0.4;
        let back = rotation(&b.map(|x| -t * t * x)).apply(&a);
        let velocity: Vector = from_fn(|i| back[i] + 2.0 * t * b[i]);
        let edge = |h: f64| at(t - 0.5 * h).transpose() * at(t + 0.5 * h);
        let id = Square::identity();
        // The error of the whole of Ω, and of its skew part alone.
        let whole = |h: f64| size(&((edge(h) - id).scaled(1.0 / h) - hat(&velocity)));
        let part = |h: f64| size(&(skew(&edge(h)).scaled(1.0 / h) - hat(&velocity)));
        // 1 if the order is not 2 to within 0.1, otherwise 0.
        let missing = |order: f64| if (order - 2.0).abs() < 0.1 { 0.0 } else { 1.0 };
        (missing(order(whole)), missing(order(part)))
    });
}

#[test]
fn appendix_a_4_the_coupling_is_of_the_order_of_the_rest() {
    judge("coupling to order Δt²", |s| {
        let [d1, d2, xi]: [Vector; 3] = from_fn(|_| s.vector());
        let relative: Matrix = s.orthogonal();
        // The coupling term of the momentum, d1 × Λ (Ω2 - 1) d2.
        let term = |h: f64| {
            let moved = (rotation(&xi.map(|x| h * x)) - Square::identity()).apply(&d2);
            super::length(&cross(&d1, &relative.apply(&moved)))
        };
        let found = order(term);
        let missing = |wanted: f64| {
            if (found - wanted).abs() < 0.3 {
                0.0
            } else {
                1.0
            }
        };
        (missing(2.0), missing(1.0))
    });
}

/// The symplectic defect of a step of (Λ, μ).
fn off(
    step: impl Fn(Rotation<Seeded>, Vector3<Seeded>) -> (Matrix3<Seeded>, Vector3<Seeded>),
    mu: &Vector,
) -> f64 {
    let xi = Vector3::from_fn(|i, _| Dual::variable(0.0, i));
    let start = Vector3::from_fn(|i, _| Dual::variable(mu[i], 3 + i));
    let (attitude, momentum) = step(Rotation::exp(&xi), start);
    let back = attitude.map(|x| x.real).transpose();
    let mut jacobian: Jacobian = [[0.0; 6]; 6];
    let turns: [Matrix3<f64>; 6] = from_fn(|seed| back * attitude.map(|x| x.dual[seed]));
    for (seed, turn) in turns.iter().enumerate() {
        for (row, at) in [(2, 1), (0, 2), (1, 0)].into_iter().enumerate() {
            jacobian[row][seed] = turn[at];
            jacobian[3 + row][seed] = momentum[row].dual[seed];
        }
    }
    defect(&jacobian, mu, &from_fn(|i| momentum[i].real))
}

#[test]
fn two_63_holds_the_velocity_fixed_and_would_prove_too_much() {
    // The printed proof differentiates Λ Ω and P Ω with Ω held fixed. That would make every step symplectic that rotates both by a
    // function of the momentum. The step is symplectic only if the rotation solves the equation of the action.
    judge("(2.63)", |s| {
        let mu: Vector = from_fn(|_| s.between(0.3, 1.0));
        let second = [
            s.between(0.5, 0.7),
            s.between(0.8, 1.0),
            s.between(1.1, 1.4),
        ];
        let h = Dual::constant(0.5);
        let turned = |r: Rotation<Seeded>, w: Rotation<Seeded>, m: Vector3<Seeded>| {
            ((r * w).matrix(), w.inverse_rotate(&m))
        };
        let printed = off(
            |r, m| {
                // A rotation by the velocity from the moments of inertia, exact to first order.
                let all: f64 = second.iter().sum();
                let velocity = Vector3::from_fn(|i, _| m[i] * h / Dual::constant(all - second[i]));
                turned(r, Rotation::exp(&velocity), m)
            },
            &mu,
        );
        let body = FreeBody::new(FreeBodyParameters {
            J: Matrix3::from_diagonal(&Vector3::from(second.map(Dual::constant))),
        })
        .expect("a body");
        let right = off(
            |r, m| {
                let initial = FreeBodyInitial {
                    Λ: r,
                    body_momentum: BodyMomentum(m),
                };
                let (mut state, mut work) = body.start(initial, h).expect("solvable");
                body.step(&mut state, &mut work).expect("solvable");
                (state.Λ().matrix(), state.body_momentum().0)
            },
            &mu,
        );
        (printed, right)
    });
}
