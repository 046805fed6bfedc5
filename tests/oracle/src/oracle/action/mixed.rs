//! The hand-written unreduced action of three coupled bodies on different groups: unit quaternions, rotations and rigid motions.
//! Every element is stored as a 4 x 4 matrix.

use super::super::dual::Number;
use super::super::points::{NamedValue, Source};
use super::super::square::{Square, constant_column, dot};
use super::motions::{self, Motion};
use super::quaternions::{self, conjugate, hamilton, imaginary, of_matrix, rotation};
use super::{DiscreteAction, NodeRule};
use std::array::from_fn;

/// The statement in velocities and advected quantities.
pub const REDUCED: &str = "model Mixed {
    param K1: Diag<3>; param J2, J3, M: Sym<3>; param d1, d2, d3, z: Vec<3>; param eps: Real;
    group q: SU<2> velocity W;
    group R: SO<3> velocity U;
    group G: SE<3> velocity V;
    advected A: SO<3> = rot(q)^T*R;
    advected B: SO<3> = R^T*rot(G);
    advected Z: Vec<3> = rot(q)^T*z;
    constraint next(q) = q*W;
    constraint next(R) = R*U;
    constraint next(G) = G*V;
    constraint next(A) = rot(W)^T*A*U;
    constraint next(B) = U^T*B*rot(V);
    constraint next(Z) = rot(W)^T*Z;
    lagrangian = (2*dot(im(W), K1*im(W)) - tr(J2*U) - tr(J3*rot(V)) + dot(pos(V), M*pos(V))/2
        - eps*dot((rot(W) - Id)*d1, A*(U - Id)*d2))/h
        - h*dot(Z, d1) - h*dot(d2, B*d3);
}";

/// The statement in configurations at both ends of the step.
pub const UNREDUCED: &str = "model Mixed {
    param K1: Diag<3>; param J2, J3, M: Sym<3>; param d1, d2, d3, z: Vec<3>; param eps: Real;
    group q: SU<2> velocity W;
    group R: SO<3> velocity U;
    group G: SE<3> velocity V;
    constraint next(q) = q*W;
    constraint next(R) = R*U;
    constraint next(G) = G*V;
    let w = im(q^T*next(q));
    let x = rot(G)^T*(pos(next(G)) - pos(G));
    lagrangian = (2*dot(w, K1*w) - tr(J2*R^T*next(R)) - tr(J3*rot(G)^T*rot(next(G)))
        + dot(x, M*x)/2 - eps*dot((rot(next(q)) - rot(q))*d1, (next(R) - R)*d2))/h
        - h*dot(z, rot(q)*d1) - h*dot(R*d2, rot(G)*d3);
}";

/// Three bodies on three groups.
#[derive(Clone, Debug)]
pub struct Mixed {
    /// The step size.
    pub h: f64,
    moments: [f64; 3],
    second: Square<f64, 3>,
    third: Square<f64, 3>,
    mass: Square<f64, 3>,
    levers: [[f64; 3]; 3],
    vertical: [f64; 3],
    /// The coupling `eps`.
    pub coupling: f64,
}

fn block<T: Number>(a: &Square<T, 4>) -> Square<T, 3> {
    Square::from_entries(|i, j| a.0[i][j])
}

/// A 3 x 3 matrix in the upper left of a 4 x 4 matrix, with `corner` as the last diagonal entry.
fn widened(a: &Square<f64, 3>, corner: f64) -> Square<f64, 4> {
    Square::from_entries(|i, j| match (i, j) {
        (3, 3) => corner,
        (3, _) | (_, 3) => 0.0,
        (i, j) => a.0[i][j],
    })
}

/// Bases of the three Lie algebras.
#[must_use]
pub fn bases() -> [Vec<Square<f64, 4>>; 3] {
    let turns = super::rotations();
    let turns = turns.iter().map(|x| widened(x, 0.0)).collect();
    [quaternions::halves(), turns, motions::twists()]
}

/// Random elements.
pub fn node(source: &mut Source) -> [Square<f64, 4>; 3] {
    let [q] = quaternions::node(source);
    let r = widened(&source.orthogonal(), 1.0);
    let [g] = motions::node(source);
    [q, r, g]
}

impl Mixed {
    /// Random parameters.
    pub fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            moments: from_fn(|_| source.between(0.3, 2.0)),
            second: source.positive(),
            third: source.positive(),
            mass: source.positive(),
            levers: from_fn(|_| source.vector()),
            vertical: source.vector(),
            coupling: source.between(-1.0, 1.0),
        }
    }

    /// Values of all names in both statements.
    #[must_use]
    pub fn given(&self, nodes: &[[Square<f64, 4>; 3]; 3]) -> Vec<NamedValue> {
        let mut given = NamedValue::at_nodes("q", nodes.map(|[q, _, _]| q));
        given.extend(NamedValue::at_nodes("R", nodes.map(|[_, r, _]| block(&r))));
        given.extend(NamedValue::at_nodes("G", nodes.map(|[_, _, g]| g)));
        let moments: Square<f64, 3> =
            Square::from_entries(|i, j| if i == j { self.moments[i] } else { 0.0 });
        given.push(NamedValue::square("K1", 0, &moments));
        given.push(NamedValue::square("J2", 0, &self.second));
        given.push(NamedValue::square("J3", 0, &self.third));
        given.push(NamedValue::square("M", 0, &self.mass));
        for (name, lever) in ["d1", "d2", "d3"].iter().zip(&self.levers) {
            given.push(NamedValue::column(name, 0, lever));
        }
        given.push(NamedValue::column("z", 0, &self.vertical));
        given.push(NamedValue::scalar("eps", self.coupling));
        given
    }
}

impl DiscreteAction<4, 3> for Mixed {
    fn edge<T: Number>(&self, tail: &[Square<T, 4>; 3], head: &[Square<T, 4>; 3]) -> Vec<T> {
        let c = T::constant;
        let (h, half) = (c(self.h), c(0.5));
        let [d1, d2, d3] = self.levers.map(|d| constant_column(&d));
        let [q, q1] = [tail, head].map(|n| of_matrix(&n[0]));
        let [r, r1] = [tail, head].map(|n| block(&n[1]));
        let [g, g1] = [tail, head].map(|n| Motion::of(&n[2]));
        let w = imaginary(hamilton(conjugate(q), q1));
        let spin = (0..3).map(|i| c(2.0 * self.moments[i]) * w[i] * w[i]);
        let moved: [T; 3] = from_fn(|i| g1.shift[i] - g.shift[i]);
        let drift = g.turn.transpose().apply(&moved);
        let change = |a: [T; 3], b: [T; 3]| -> [T; 3] { from_fn(|i| a[i] - b[i]) };
        let first = change(rotation(q1).apply(&d1), rotation(q).apply(&d1));
        let second = change(r1.apply(&d2), r.apply(&d2));
        let mut summands: Vec<T> = spin.map(|t| t / h).collect();
        let trace = |j: &Square<f64, 3>, a: Square<T, 3>, b: Square<T, 3>| {
            -(Square::constant(j) * a.transpose() * b).trace() / h
        };
        summands.push(trace(&self.second, r, r1));
        summands.push(trace(&self.third, g.turn, g1.turn));
        summands.push(half * dot(&drift, &Square::constant(&self.mass).apply(&drift)) / h);
        summands.push(-c(self.coupling) * dot(&first, &second) / h);
        let weight = |q| -h * dot(&constant_column(&self.vertical), &rotation(q).apply(&d1));
        summands.push(NodeRule::Symmetric.split(weight(q), weight(q1)));
        let joint = |r: Square<T, 3>, g: &Motion<T>| -h * dot(&r.apply(&d2), &g.turn.apply(&d3));
        summands.push(NodeRule::Symmetric.split(joint(r, &g), joint(r1, &g1)));
        summands
    }
}
