//! The unreduced discrete action and its variation at one node. Takes the action of one step as a function of the group elements at
//! both ends. Gives the discrete Euler-Lagrange residual, the two discrete momenta and the scale for comparisons.

pub mod bodies;
pub mod coupled;
pub mod elastic;
pub mod mixed;
pub mod motions;
pub mod plane;
pub mod quaternions;
pub mod spatial;

use super::dual::{Dual, Number};
pub use super::points::Variation;
pub use super::sides::{NodeRule, Side};
use super::square::{Square, hat};
use crate::physics::measure::worse;
use std::array::from_fn;

/// The unreduced action of one step, with `G` group elements at either end, each an `N` by `N` matrix.
pub trait DiscreteAction<const N: usize, const G: usize> {
    /// The side on which the variations act.
    fn side(&self) -> Side {
        Side::Body
    }

    /// The summands of the action of the edge from `tail` (node k) to `head` (node k+1).
    fn edge<T: Number>(&self, tail: &[Square<T, N>; G], head: &[Square<T, N>; G]) -> Vec<T>;
}

/// The basis `hat(e1), hat(e2), hat(e3)` of the Lie algebra of SO(3).
#[must_use]
pub fn rotations() -> Vec<Square<f64, 3>> {
    (0..3)
        .map(|i| hat(&from_fn(|j| if i == j { 1.0 } else { 0.0 })))
        .collect()
}

/// The residual of the discrete Euler-Lagrange equations at the middle of three nodes: the derivative of the action of both edges
/// along each direction.
pub fn stationarity<const N: usize, const G: usize>(
    action: &impl DiscreteAction<N, G>,
    nodes: &[[Square<f64, N>; G]; 3],
    basis: &[Square<f64, N>],
) -> Variation {
    stationarity_along(action, nodes, [basis; G])
}

/// Like `stationarity`, with a separate basis for each group.
pub fn stationarity_along<const N: usize, const G: usize>(
    action: &impl DiscreteAction<N, G>,
    nodes: &[[Square<f64, N>; G]; 3],
    bases: [&[Square<f64, N>]; G],
) -> Variation {
    let [before, here, after] = nodes;
    let (before, after) = (steady(before), steady(after));
    vary(action.side(), here, bases, |varied| {
        let mut summands = action.edge(&before, varied);
        summands.extend(action.edge(varied, &after));
        summands
    })
}

/// The momentum at the head of an edge: `d/dξ L_d(tail -> head)` for a variation of the head.
pub fn momentum_in<const N: usize, const G: usize>(
    action: &impl DiscreteAction<N, G>,
    tail: &[Square<f64, N>; G],
    head: &[Square<f64, N>; G],
    basis: &[Square<f64, N>],
) -> Variation {
    let tail = steady(tail);
    vary(action.side(), head, [basis; G], |varied| {
        action.edge(&tail, varied)
    })
}

/// The momentum at the tail of an edge: `-d/dξ L_d(tail -> head)` for a variation of the tail.
pub fn momentum_out<const N: usize, const G: usize>(
    action: &impl DiscreteAction<N, G>,
    tail: &[Square<f64, N>; G],
    head: &[Square<f64, N>; G],
    basis: &[Square<f64, N>],
) -> Variation {
    let head = steady(head);
    let mut variation = vary(action.side(), tail, [basis; G], |varied| {
        action.edge(varied, &head)
    });
    for component in &mut variation.derivative {
        *component = -*component;
    }
    variation
}

/// The largest change of a result relative to changes of the group entries: the factor by which it amplifies their rounding. Finite
/// differences suffice for this bound.
pub fn sensitivity<const N: usize, const G: usize, const M: usize>(
    nodes: &[[Square<f64, N>; G]; M],
    basis: &[Square<f64, N>],
    result: impl Fn(&[[Square<f64, N>; G]; M]) -> Vec<f64>,
) -> f64 {
    // The square root of the rounding unit balances rounding and curvature.
    let epsilon = 1e-8;
    let here = result(nodes);
    let mut sum = 0.0;
    for node in 0..M {
        for group in 0..G {
            for direction in basis {
                let mut moved = *nodes;
                let element = moved[node][group];
                moved[node][group] = element + (element * *direction).scaled(epsilon);
                let changes = result(&moved);
                sum += here
                    .iter()
                    .zip(changes)
                    .map(|(a, b)| (a - b).abs() / epsilon)
                    .fold(0.0, worse);
            }
        }
    }
    sum
}

fn steady<const N: usize, const G: usize>(node: &[Square<f64, N>; G]) -> [Square<Dual, N>; G] {
    node.map(|element| Square::constant(&element))
}

/// Derivatives of the summands of `action` at `node`, by dual numbers.
///
/// The tangent of `Λ exp(ε X)` at `ε = 0` is `Λ X`, so the exponential is not needed.
fn vary<const N: usize, const G: usize>(
    side: Side,
    node: &[Square<f64, N>; G],
    bases: [&[Square<f64, N>]; G],
    action: impl Fn(&[Square<Dual, N>; G]) -> Vec<Dual>,
) -> Variation {
    let mut derivative = Vec::new();
    let mut largest: Vec<f64> = Vec::new();
    for (group, basis) in bases.into_iter().enumerate() {
        for direction in basis {
            let mut varied = steady(node);
            let tangent = match side {
                Side::Body => node[group] * *direction,
                Side::Space => *direction * node[group],
            };
            varied[group] = Square::from_entries(|i, j| Dual {
                value: node[group].0[i][j],
                slope: tangent.0[i][j],
            });
            let summands = action(&varied);
            largest.resize(summands.len(), 0.0);
            for (size, summand) in largest.iter_mut().zip(&summands) {
                *size = size.max(summand.slope.abs()).max(summand.value.abs());
            }
            derivative.push(summands.iter().map(|summand| summand.slope).sum());
        }
    }
    Variation {
        derivative,
        scale: largest.iter().sum(),
    }
}
