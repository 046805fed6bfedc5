//! The discrete energy of a step is minus the derivative of its action with respect to the step size, with both nodes fixed. This
//! also holds for a quantity that is not a group action on a constant. Such a quantity is advanced step by step, and depends on
//! other quantities, parameters and the velocity.

// The fields of the models are Greek letters, as in the papers.
#![allow(non_snake_case)]

use super::common::Random;
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation};

clebsch::model! {
    /// A top whose load trails the vertical.
    model Trailing {
        param J: Sym<3>;
        param b: Vec<3>;
        param s: Real;
        group Λ: SO<3> velocity Ω;
        advected Γ, Y: Vec<3>;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        constraint next(Y) = Ω^T*(Y + s*Γ);
        lagrangian = -tr(J*Ω)/h - h*dot(b, Y);
    }
}

clebsch::model! {
    /// The same with a kinetic energy that is solved by Newton's method.
    model StiffTrailing {
        param J: Sym<3>;
        param b: Vec<3>;
        param s, c: Real;
        group Λ: SO<3> velocity Ω;
        advected Γ, Y: Vec<3>;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        constraint next(Y) = Ω^T*(Y + s*Γ);
        lagrangian = -tr(J*Ω)/h + c*tr(Ω)^2/h - h*dot(b, Y);
    }
}

/// One step from a random state; `$stiff` is the coefficient of the quadratic term.
macro_rules! compared {
    ($module:ident, $model:ident, $initial:ident, $parameters:ident, $stiff:expr $(, $c:ident)?) => {{
        use $module::{$initial, $model, $parameters};
        let mut random = Random(7);
        for _ in 0..20 {
            let J = Matrix3::from_diagonal(&Vector3::new(1.0, 1.5, 2.0));
            let (b, s) = (random.vector(), random.symmetric());
            $(let $c = $stiff;)?
            let model = $model::new($parameters { J, b, s $(, $c)? }).expect("a body");
            let (Γ, Y) = (random.vector(), random.vector());
            let Λ = Rotation::exp(&random.vector());
            let body_momentum = BodyMomentum(random.vector());
            let initial = $initial { Λ, body_momentum, Γ, Y };
            let h = 0.1;
            let (mut state, mut work) = model.start(initial, h).expect("solvable");
            let before = state;
            model.step(&mut state, &mut work).expect("solvable");
            let Ω = before.Λ().matrix().transpose() * state.Λ().matrix();
            // Values from the constraints.
            let (next_vertical, next_load) = (Ω.transpose() * Γ, Ω.transpose() * (Y + Γ * s));
            let rounding = 1e-14 * (1.0 + Γ.norm() + Y.norm());
            assert!((model.Γ(&state) - next_vertical).norm() < rounding);
            assert!((model.Y(&state) - next_load).norm() < rounding);
            // Nodal terms count half at each end of the edge; the constant of the kinetic energy at zero velocity is dropped.
            let action = |h: f64| {
                let still = (J.trace() - $stiff * 9.0) / h;
                let kinetic = -(J * Ω).trace() / h + $stiff * Ω.trace().powi(2) / h + still;
                kinetic - h * (b.dot(&Y) + b.dot(&next_load)) / 2.0
            };
            let slope = |δ: f64| -(action(h + δ) - action(h - δ)) / (2.0 * δ);
            let δ = 1e-3 * h;
            let expected = (4.0 * slope(δ) - slope(2.0 * δ)) / 3.0;
            let found = model.discrete_energy(h, &before, &state);
            // Extrapolated central differences have an error of 4 (δ/h)^4 of the terms of the slope; the rounding of the action
            // divided by δ is smaller.
            let size = (J.trace() + 9.0 * $stiff) / (h * h);
            assert!((found - expected).abs() < 1e-11 * size, "{found} {expected}");
        }
    }};
}

#[test]
fn a_quantity_that_is_advanced_step_by_step_counts_at_both_nodes() {
    compared!(trailing, Trailing, TrailingInitial, TrailingParameters, 0.0);
    compared!(
        stiff_trailing,
        StiffTrailing,
        StiffTrailingInitial,
        StiffTrailingParameters,
        0.05,
        c
    );
}
