//! A hand-written unreduced action on SE(2). A motion consists of a complex factor for the rotation and a complex shift.

use super::super::dual::Number;
use super::super::points::Source;
use super::super::square::{Square, constant_column, dot};
use super::{DiscreteAction, NodeRule, Side};
use std::array::from_fn;

/// A complex number, real and imaginary part.
type Complex<T> = [T; 2];

fn times<T: Number>(a: Complex<T>, b: Complex<T>) -> Complex<T> {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn plus<T: Number>(a: Complex<T>, b: Complex<T>) -> Complex<T> {
    [a[0] + b[0], a[1] + b[1]]
}

fn conjugate<T: Number>(a: Complex<T>) -> Complex<T> {
    [a[0], -a[1]]
}

/// `p -> turn p + shift`.
#[derive(Clone, Copy, Debug)]
struct Motion<T> {
    turn: Complex<T>,
    shift: Complex<T>,
}

impl<T: Number> Motion<T> {
    /// From a homogeneous matrix.
    fn of(a: &Square<T, 3>) -> Self {
        Motion {
            turn: [a.0[0][0], a.0[1][0]],
            shift: [a.0[0][2], a.0[1][2]],
        }
    }

    fn inverse(&self) -> Self {
        let turn = conjugate(self.turn);
        Motion {
            shift: times(turn, self.shift).map(|x| -x),
            turn,
        }
    }

    /// First `other`, then `self`.
    fn after(&self, other: &Self) -> Self {
        Motion {
            turn: times(self.turn, other.turn),
            shift: plus(times(self.turn, other.shift), self.shift),
        }
    }

    /// The matrix of the rotation.
    fn block(&self) -> Square<T, 2> {
        let [c, s] = self.turn;
        Square::from_entries(|i, j| match (i, j) {
            (0, 1) => -s,
            (1, 0) => s,
            _ => c,
        })
    }

    fn matrix(&self) -> Square<T, 3> {
        let block = self.block();
        Square::from_entries(|i, j| match (i, j) {
            (2, 2) => T::constant(1.0),
            (2, _) => T::constant(0.0),
            (i, 2) => self.shift[i],
            (i, j) => block.0[i][j],
        })
    }

    /// The image of a line `(n, d)` under the inverse motion: `(R^T n, d + n . x)`.
    fn line_back(&self, p: &[T; 3]) -> [T; 3] {
        let n = [p[0], p[1]];
        let [x, y] = times(conjugate(self.turn), n);
        [x, y, p[2] + dot(&n, &self.shift)]
    }
}

/// The basis of the Lie algebra of SE(2): the rotation, then two translations.
#[must_use]
pub fn plane_twists() -> Vec<Square<f64, 3>> {
    let entry = |k: usize, i: usize, j: usize| match (k, i, j) {
        (0, 1, 0) | (1, 0, 2) | (2, 1, 2) => 1.0,
        (0, 0, 1) => -1.0,
        _ => 0.0,
    };
    (0..3)
        .map(|k| Square::from_entries(|i, j| entry(k, i, j)))
        .collect()
}

/// A body given by its second moments about its origin, in potentials, with a term linear in the velocity `V`: the sum of
/// `tr((V - Id)*Q*(V - Id)^T)/(2*h)`, `a5*dot(pos(V^-1), A*u)`, `a14*dot(P, K*P)`, `a15*dot(Γ, u)` and
/// `a19*exp(-dot(pos(G), pos(G)))*dot(Γ, A*Γ)`, with an advected vector `Γ` and an advected line `P`.
#[derive(Clone, Debug)]
pub struct PlaneSum {
    /// The step size.
    pub h: f64,
    /// The side of the velocity.
    pub side: Side,
    /// `a5`, `a14`, `a15`, `a19`.
    pub weights: [f64; 4],
    /// `A`.
    pub general: Square<f64, 2>,
    /// `K`, positive.
    pub three: Square<f64, 3>,
    /// `Q`, positive.
    pub moments: Square<f64, 3>,
    /// `u`.
    pub lever: [f64; 2],
    /// `z`.
    pub vertical: [f64; 2],
    /// `P0`.
    pub line: [f64; 3],
}

impl PlaneSum {
    /// Random parameters; the potential of the line keeps the body near the origin.
    pub fn random(source: &mut Source, side: Side, h: f64) -> Self {
        let [a5, a14, a15, a19] = source.vector::<4>().map(|a| 0.05 * a);
        Self {
            h,
            side,
            weights: [a5, -a14.abs(), a15, a19],
            general: source.matrix(),
            three: source.positive(),
            moments: source.positive(),
            lever: source.vector(),
            vertical: source.vector(),
            line: source.vector(),
        }
    }

    /// The advected vector and line at a node.
    fn carried<T: Number>(&self, g: &Motion<T>) -> ([T; 2], [T; 3]) {
        let (z, n) = (constant_column(&self.vertical), constant_column(&self.line));
        match self.side {
            Side::Body => (times(conjugate(g.turn), z), g.line_back(&n)),
            Side::Space => (times(g.turn, z), g.inverse().line_back(&n)),
        }
    }
}

impl DiscreteAction<3, 1> for PlaneSum {
    fn side(&self) -> Side {
        self.side
    }

    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 1], head: &[Square<T, 3>; 1]) -> Vec<T> {
        let c = T::constant;
        let (here, next) = (Motion::of(&tail[0]), Motion::of(&head[0]));
        let v = match self.side {
            Side::Body => here.inverse().after(&next),
            Side::Space => next.after(&here.inverse()),
        };
        let a = Square::constant(&self.general);
        let k = Square::constant(&self.three);
        let u = constant_column(&self.lever);
        let from_rest = v.matrix() - Square::identity();
        let moved = from_rest * Square::constant(&self.moments) * from_rest.transpose();
        let [a5, a14, a15, a19] = self.weights.map(c);
        let at = |g: &Motion<T>| {
            let (gamma, n) = self.carried(g);
            [
                a14 * dot(&n, &k.apply(&n)),
                a15 * dot(&gamma, &u),
                a19 * (-dot(&g.shift, &g.shift)).exp() * dot(&gamma, &a.apply(&gamma)),
            ]
        };
        let (from, to) = (at(&here), at(&next));
        let nodal = from_fn::<T, 3, _>(|i| NodeRule::Symmetric.split(from[i], to[i]));
        let edge = [
            moved.trace() / c(2.0 * self.h),
            a5 * dot(&v.inverse().shift, &a.apply(&u)),
        ];
        edge.into_iter().chain(nodal).collect()
    }
}
