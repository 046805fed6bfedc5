//! The hand-written unreduced action of two bodies coupled by a spherical joint, with random parameters, as a function of both
//! attitudes at both ends. The relative attitude `R = Λ1ᵀ Λ2` never appears: the coupling is written in space.

use super::super::dual::Number;
use super::super::points::{NamedValue, Source};
use super::super::square::{Square, constant_column, dot};
use super::DiscreteAction;
use super::bodies::{Stated, kinetic};
use std::array::from_fn;

/// Two bodies joined at a point; the centre of mass is at rest and eliminated.
///
/// `DEFINED` selects whether the model defines `R = Λ1ᵀ Λ2` or leaves R undefined.
#[derive(Clone, Debug)]
pub struct CoupledBodies<const DEFINED: bool> {
    /// The step size.
    pub h: f64,
    /// The Poinsot matrices of both bodies, reduced mass included, body frames.
    pub second_moments: [Square<f64, 3>; 2],
    /// From the centre of mass of each body to the joint, body frames.
    pub arms: [[f64; 3]; 2],
    /// The reduced mass.
    pub reduced_mass: f64,
    /// The constant `Λ1 R Λ2ᵀ`: the identity if R is defined, otherwise arbitrary.
    pub reference: Square<f64, 3>,
}

impl<const DEFINED: bool> DiscreteAction<3, 2> for CoupledBodies<DEFINED> {
    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 2], head: &[Square<T, 3>; 2]) -> Vec<T> {
        // The spatial change of each arm over the step: Λ_i (Ω_i - 1) d_i.
        let change = |body: usize| {
            let arm = constant_column(&self.arms[body]);
            let (from, to) = (tail[body].apply(&arm), head[body].apply(&arm));
            from_fn(|i| to[i] - from[i])
        };
        let (first, second): ([T; 3], [T; 3]) = (change(0), change(1));
        let carried = Square::constant(&self.reference).apply(&second);
        vec![
            kinetic(&self.second_moments[0], &tail[0], &head[0], self.h),
            kinetic(&self.second_moments[1], &tail[1], &head[1], self.h),
            -T::constant(self.reduced_mass / self.h) * dot(&first, &carried),
        ]
    }
}

impl<const DEFINED: bool> Stated<3, 2> for CoupledBodies<DEFINED> {
    fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            second_moments: from_fn(|_| source.positive()),
            arms: from_fn(|_| source.vector()),
            reduced_mass: source.between(0.2, 2.0),
            reference: if DEFINED {
                Square::identity()
            } else {
                source.orthogonal()
            },
        }
    }
    fn text() -> String {
        let definition = if DEFINED { " = Λ1^T*Λ2" } else { "" };
        format!(
            "model CoupledBodies {{
            param J1, J2: Sym<3>;  param d1, d2: Vec<3>;  param eps: Real;
            group Λ1: SO<3> velocity Ω1;  group Λ2: SO<3> velocity Ω2;
            advected R: SO<3>{definition};
            constraint next(Λ1) = Λ1*Ω1;  constraint next(Λ2) = Λ2*Ω2;  constraint next(R) = Ω1^T*R*Ω2;
            lagrangian = -(tr(J1*Ω1) + tr(J2*Ω2) + eps*dot((Ω1 - Id)*d1, R*(Ω2 - Id)*d2))/h;
        }}"
        )
    }
    fn step(&self) -> f64 {
        self.h
    }
    fn given(&self, nodes: &[[Square<f64, 3>; 2]; 3]) -> Vec<NamedValue> {
        let mut given = NamedValue::at_nodes("Λ1", nodes.map(|[first, _]| first));
        given.extend(NamedValue::at_nodes("Λ2", nodes.map(|[_, second]| second)));
        if !DEFINED {
            let relative = nodes.map(|[first, second]| first.transpose() * self.reference * second);
            given.extend(NamedValue::at_nodes("R", relative));
        }
        given.push(NamedValue::square("J1", 0, &self.second_moments[0]));
        given.push(NamedValue::square("J2", 0, &self.second_moments[1]));
        given.push(NamedValue::column("d1", 0, &self.arms[0]));
        given.push(NamedValue::column("d2", 0, &self.arms[1]));
        given.push(NamedValue::scalar("eps", self.reduced_mass));
        given
    }
}
