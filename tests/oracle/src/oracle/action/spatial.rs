//! Hand-written unreduced actions of rigid bodies in the spatial representation, with random parameters, as functions of Λ at both
//! ends. The velocity is `Λ_{k+1} Λ_kᵀ`; the Poinsot matrix and the lever are advected with the body.

use super::super::dual::Number;
use super::super::points::{NamedValue, Source};
use super::super::square::{Square, constant_column, dot};
use super::bodies::{Stated, attitudes};
use super::{DiscreteAction, NodeRule, Side};

/// `-tr(ω J_k)/h` with `ω = Λ_{k+1} Λ_kᵀ` and `J_k = Λ_k J Λ_kᵀ`, multiplied out.
fn kinetic<T: Number>(
    second_moment: &Square<f64, 3>,
    tail: &Square<T, 3>,
    head: &Square<T, 3>,
    h: f64,
) -> T {
    let velocity = *head * tail.transpose();
    let carried = *tail * Square::constant(second_moment) * tail.transpose();
    -(velocity * carried).trace() / T::constant(h)
}

/// The spatial Poinsot matrix at each node.
fn seen(second_moment: &Square<f64, 3>, nodes: &[[Square<f64, 3>; 1]; 3]) -> [Square<f64, 3>; 3] {
    nodes.map(|[attitude]| attitude * *second_moment * attitude.transpose())
}

/// The free body.
#[derive(Clone, Debug)]
pub struct FreeBodySpatial {
    /// The step size.
    pub h: f64,
    /// The Poinsot matrix in the body frame, where it is constant.
    pub second_moment: Square<f64, 3>,
}

impl DiscreteAction<3, 1> for FreeBodySpatial {
    fn side(&self) -> Side {
        Side::Space
    }
    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 1], head: &[Square<T, 3>; 1]) -> Vec<T> {
        vec![kinetic(&self.second_moment, &tail[0], &head[0], self.h)]
    }
}

impl Stated<3, 1> for FreeBodySpatial {
    fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            second_moment: source.positive(),
        }
    }
    fn text() -> String {
        "model FreeBodySpatial {
            group Λ: SO<3> velocity ω;   advected J: Sym<3>;
            constraint next(Λ) = ω*Λ;    constraint next(J) = ω*J*ω^T;
            lagrangian = -tr(ω*J)/h;
        }"
        .to_owned()
    }
    fn step(&self) -> f64 {
        self.h
    }
    fn given(&self, nodes: &[[Square<f64, 3>; 1]; 3]) -> Vec<NamedValue> {
        let mut given = attitudes("Λ", nodes);
        given.extend(NamedValue::at_nodes("J", seen(&self.second_moment, nodes)));
        given
    }
}

/// The heavy top; the lever of the weight is advected, the vertical is a parameter.
#[derive(Clone, Debug)]
pub struct HeavyTopSpatial {
    /// The step size.
    pub h: f64,
    /// The Poinsot matrix in the body frame, where it is constant.
    pub second_moment: Square<f64, 3>,
    /// From the support to the centre of mass, in the body frame, where it is constant.
    pub lever: [f64; 3],
    /// The upward vertical, spatial frame.
    pub vertical: [f64; 3],
    /// The weight.
    pub weight: f64,
}

impl DiscreteAction<3, 1> for HeavyTopSpatial {
    fn side(&self) -> Side {
        Side::Space
    }
    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 1], head: &[Square<T, 3>; 1]) -> Vec<T> {
        let potential = |attitude: &Square<T, 3>| {
            let lever = attitude.apply(&constant_column(&self.lever));
            -T::constant(self.h * self.weight) * dot(&lever, &constant_column(&self.vertical))
        };
        vec![
            kinetic(&self.second_moment, &tail[0], &head[0], self.h),
            NodeRule::Symmetric.split(potential(&tail[0]), potential(&head[0])),
        ]
    }
}

impl Stated<3, 1> for HeavyTopSpatial {
    fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            second_moment: source.positive(),
            lever: source.vector(),
            vertical: source.vector(),
            weight: source.between(0.2, 2.0),
        }
    }
    fn text() -> String {
        "model HeavyTopSpatial {
            param w: Real;  param z: Vec<3>;
            group Λ: SO<3> velocity ω;   advected J: Sym<3>;  advected chi: Vec<3>;
            constraint next(Λ) = ω*Λ; constraint next(J) = ω*J*ω^T; constraint next(chi) = ω*chi;
            lagrangian = -tr(ω*J)/h - h*w*dot(chi, z);
        }"
        .to_owned()
    }
    fn step(&self) -> f64 {
        self.h
    }
    fn given(&self, nodes: &[[Square<f64, 3>; 1]; 3]) -> Vec<NamedValue> {
        let mut given = attitudes("Λ", nodes);
        given.extend(NamedValue::at_nodes("J", seen(&self.second_moment, nodes)));
        let levers = nodes.map(|[attitude]| attitude.apply(&self.lever));
        given.extend(NamedValue::columns_at_nodes("chi", levers));
        given.push(NamedValue::scalar("w", self.weight));
        given.push(NamedValue::column("z", 0, &self.vertical));
        given
    }
}
