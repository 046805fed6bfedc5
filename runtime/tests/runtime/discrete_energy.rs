//! The discrete energy of a step is how fast its action falls as the step grows, both nodes held
//! fixed: also where a quantity is no action of the group on a constant and is advanced step by
//! step, which reads off other quantities and the velocity.

// The fields of the models are Greek letters, as in the papers.
#![allow(non_snake_case)]

use super::common::Random;
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation};

clebsch::model! {
    /// A top whose second load trails the vertical.
    model Trailing {
        param J: Sym<3>;
        param a, b: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ, Y: Vec<3>;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        constraint next(Y) = Ω^T*(Y + Γ);
        lagrangian = -tr(J*Ω)/h - h*dot(a, Γ) - h*dot(b, Y);
    }
}
use trailing::{Trailing, TrailingInitial, TrailingParameters, TrailingState};

/// The action of a step, from nothing but the states at its ends. Terms at a node count half at
/// each end of the edge.
fn action(p: &TrailingParameters, h: f64, before: &TrailingState, after: &TrailingState) -> f64 {
    let turned = before.Λ.matrix().transpose() * after.Λ.matrix();
    let next_vertical = turned.transpose() * before.Γ;
    let next_load = turned.transpose() * (before.Y + before.Γ);
    let potential =
        |vertical: &Vector3<f64>, load: &Vector3<f64>| h * (p.a.dot(vertical) + p.b.dot(load));
    let ends = potential(&before.Γ, &before.Y) + potential(&next_vertical, &next_load);
    -(p.J * turned).trace() / h - ends / 2.0
}

#[test]
fn a_quantity_that_is_advanced_step_by_step_counts_at_both_nodes() {
    let mut random = Random(7);
    for _ in 0..20 {
        let parameters = TrailingParameters {
            J: Matrix3::from_diagonal(&Vector3::new(1.0, 1.5, 2.0)),
            a: random.vector(),
            b: random.vector(),
        };
        let model = Trailing::new(parameters).expect("a body");
        let initial = TrailingInitial {
            Λ: Rotation::exp(&random.vector()),
            body_momentum: BodyMomentum(random.vector()),
            Γ: random.vector(),
            Y: random.vector(),
        };
        let h = 0.1;
        let (mut state, mut work) = model.start(initial, h).expect("solvable");
        let before = state;
        model.step(&mut state, &mut work).expect("solvable");
        let found = model.discrete_energy(h, &before, &state);
        // Central differences extrapolated once: the error is (δ/h)^4 of a trace over h.
        let slope = |δ: f64| {
            let at = |h| action(&parameters, h, &before, &state);
            -(at(h + δ) - at(h - δ)) / (2.0 * δ)
        };
        let δ = 1e-3 * h;
        let expected = (4.0 * slope(δ) - slope(2.0 * δ)) / 3.0;
        let size = parameters.J.trace() / (h * h);
        // 4 (δ/h)^4 of the size, and the rounding of the action over δ.
        let tolerance = 1e-11 * size;
        assert!((found - expected).abs() < tolerance, "{found} {expected}");
    }
}
