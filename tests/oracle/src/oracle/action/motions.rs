//! A hand-written unreduced action on SE(3): Kirchhoff's body in an ideal fluid. Motions are pairs of a rotation and a translation,
//! never products of matrices.

use super::super::dual::Number;
use super::super::points::{NamedValue, Source};
use super::super::square::{Square, constant_column, dot, vee};
use super::{DiscreteAction, NodeRule};
use std::array::from_fn;

/// A rotation and a translation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion<T> {
    pub(super) turn: Square<T, 3>,
    pub(super) shift: [T; 3],
}

fn plus<T: Number, const N: usize>(a: [T; N], b: [T; N]) -> [T; N] {
    from_fn(|i| a[i] + b[i])
}

impl<T: Number> Motion<T> {
    /// From a homogeneous matrix.
    pub(super) fn of(a: &Square<T, 4>) -> Self {
        Motion {
            turn: Square::from_entries(|i, j| a.0[i][j]),
            shift: from_fn(|i| a.0[i][3]),
        }
    }

    fn matrix(&self) -> Square<T, 4> {
        Square::from_entries(|i, j| match (i, j) {
            (3, 3) => T::constant(1.0),
            (3, _) => T::constant(0.0),
            (i, 3) => self.shift[i],
            (i, j) => self.turn.0[i][j],
        })
    }

    /// The image of a plane `(n, d)` under the inverse motion: `(R^T n, d + n . x)`.
    fn plane_back(&self, p: &[T; 4]) -> [T; 4] {
        let n = [p[0], p[1], p[2]];
        let turned = self.turn.transpose().apply(&n);
        [turned[0], turned[1], turned[2], p[3] + dot(&n, &self.shift)]
    }
}

/// The basis of the Lie algebra of SE(3): three rotations, then three translations.
#[must_use]
pub fn twists() -> Vec<Square<f64, 4>> {
    let entry = |k: usize, i: usize, j: usize| match (k, i, j) {
        (0, 2, 1) | (1, 0, 2) | (2, 1, 0) => 1.0,
        (0, 1, 2) | (1, 2, 0) | (2, 0, 1) => -1.0,
        (k, i, 3) if k == i + 3 => 1.0,
        _ => 0.0,
    };
    (0..6)
        .map(|k| Square::from_entries(|i, j| entry(k, i, j)))
        .collect()
}

/// A random motion as a matrix.
pub fn node(source: &mut Source) -> [Square<f64, 4>; 1] {
    let motion = Motion {
        turn: source.orthogonal(),
        shift: source.vector(),
    };
    [motion.matrix()]
}

/// Kirchhoff's body in an ideal fluid, with net weight.
#[derive(Clone, Debug)]
pub struct KirchhoffBody {
    /// The step size.
    pub h: f64,
    inertia: Square<f64, 3>,
    mass: Square<f64, 3>,
    coupling: Square<f64, 3>,
    weight: [f64; 4],
    ground: [f64; 4],
}

impl KirchhoffBody {
    /// Random parameters.
    pub fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            inertia: source.positive(),
            mass: source.positive(),
            coupling: source.matrix(),
            weight: source.vector(),
            ground: source.vector(),
        }
    }

    /// Values of all names of the gallery model.
    #[must_use]
    pub fn given(&self, nodes: &[[Square<f64, 4>; 1]; 3]) -> Vec<NamedValue> {
        let mut given = NamedValue::at_nodes("G", nodes.map(|[g]| g));
        given.push(NamedValue::square("J", 0, &self.inertia));
        given.push(NamedValue::square("M", 0, &self.mass));
        given.push(NamedValue::square("D", 0, &self.coupling));
        given.push(NamedValue::column("b", 0, &self.weight));
        given.push(NamedValue::column("Z", 0, &self.ground));
        given
    }
}

impl DiscreteAction<4, 1> for KirchhoffBody {
    fn edge<T: Number>(&self, tail: &[Square<T, 4>; 1], head: &[Square<T, 4>; 1]) -> Vec<T> {
        let (here, next) = (Motion::of(&tail[0]), Motion::of(&head[0]));
        let (h, half) = (T::constant(self.h), T::constant(0.5));
        let turn = here.turn.transpose() * next.turn;
        // The spatial displacement in the body frames of both ends, and their mean.
        let moved: [T; 3] = from_fn(|i| next.shift[i] - here.shift[i]);
        let seen = plus(
            here.turn.transpose().apply(&moved),
            next.turn.transpose().apply(&moved),
        );
        let u = seen.map(|x| x * half);
        let height = |g: &Motion<T>| {
            let plane = g.plane_back(&constant_column(&self.ground));
            -h * dot(&constant_column(&self.weight), &plane)
        };
        vec![
            -(Square::constant(&self.inertia) * turn).trace() / h,
            half * dot(&u, &Square::constant(&self.mass).apply(&u)) / h,
            dot(&vee(&turn), &Square::constant(&self.coupling).apply(&u)) / h,
            NodeRule::Symmetric.split(height(&here), height(&next)),
        ]
    }
}
