//! Hand-written unreduced actions on SU(2): the Cayley-Klein body on both sides, and a top. Quaternions are four components; their
//! matrices follow from the definition.

use super::super::dual::Number;
use super::super::points::{NamedValue, Source};
use super::super::square::{Square, constant_column, dot};
use super::{DiscreteAction, NodeRule, Side};
use std::array::from_fn;

/// Hamilton's product of `(w, x, y, z)`.
pub(super) fn hamilton<T: Number>(a: [T; 4], b: [T; 4]) -> [T; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] + a[2] * b[0] + a[3] * b[1] - a[1] * b[3],
        a[0] * b[3] + a[3] * b[0] + a[1] * b[2] - a[2] * b[1],
    ]
}

pub(super) fn conjugate<T: Number>(a: [T; 4]) -> [T; 4] {
    [a[0], -a[1], -a[2], -a[3]]
}

pub(super) fn imaginary<T: Number>(a: [T; 4]) -> [T; 3] {
    [a[1], a[2], a[3]]
}

/// The purely imaginary quaternion of a vector.
pub(super) fn of_vector<T: Number>(v: &[T; 3]) -> [T; 4] {
    [T::constant(0.0), v[0], v[1], v[2]]
}

/// The matrix of `p -> a p` on `(1, i, j, k)`: its columns are the images of the four units.
pub fn left<T: Number>(a: [T; 4]) -> Square<T, 4> {
    let columns: [[T; 4]; 4] = from_fn(|j| {
        let unit = from_fn(|i| T::constant(f64::from(u8::from(i == j))));
        hamilton(a, unit)
    });
    Square::from_entries(|i, j| columns[j][i])
}

/// `q v q*`, column by column.
pub(super) fn rotation<T: Number>(q: [T; 4]) -> Square<T, 3> {
    let columns: [[T; 3]; 3] = from_fn(|j| {
        let unit: [T; 3] = from_fn(|i| T::constant(f64::from(u8::from(i == j))));
        imaginary(hamilton(hamilton(q, of_vector(&unit)), conjugate(q)))
    });
    Square::from_entries(|i, j| columns[j][i])
}

/// The quaternion of a left multiplication: its image of 1.
pub(super) fn of_matrix<T: Number>(a: &Square<T, 4>) -> [T; 4] {
    from_fn(|i| a.0[i][0])
}

/// The basis of the Lie algebra of SU(2): half the imaginary units.
#[must_use]
pub fn halves() -> Vec<Square<f64, 4>> {
    (1..4)
        .map(|k| left(from_fn(|i| if i == k { 0.5 } else { 0.0 })))
        .collect()
}

/// A random unit quaternion as a matrix.
pub fn node(source: &mut Source) -> [Square<f64, 4>; 1] {
    let q: [f64; 4] = source.vector();
    let length = dot(&q, &q).sqrt();
    [left(q.map(|x| x / length))]
}

/// A top: the sum of `a0*dot(im(W), S*im(W))/h`, `b*re(W)`, `a13*dot(Γ, S*Γ)` and `a14*dot(u, Γ)`, with an advected `Γ`.
#[derive(Clone, Debug)]
pub struct QuaternionTop {
    /// The step size.
    pub h: f64,
    /// `a0`, `b`, `a13`, `a14`.
    pub weights: [f64; 4],
    /// `S`.
    pub symmetric: Square<f64, 3>,
    /// `u`.
    pub lever: [f64; 3],
    /// The value of `Γ` at the identity.
    pub vertical: [f64; 3],
}

impl QuaternionTop {
    /// Random parameters.
    pub fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            weights: source.vector(),
            symmetric: source.symmetric(),
            lever: source.vector(),
            vertical: source.vector(),
        }
    }
}

impl DiscreteAction<4, 1> for QuaternionTop {
    fn edge<T: Number>(&self, tail: &[Square<T, 4>; 1], head: &[Square<T, 4>; 1]) -> Vec<T> {
        let (here, next) = (of_matrix(&tail[0]), of_matrix(&head[0]));
        let w = hamilton(conjugate(here), next);
        let v = imaginary(w);
        let s = Square::constant(&self.symmetric);
        let [a0, b, a13, a14] = self.weights.map(T::constant);
        let at = |q: [T; 4]| {
            let gamma = rotation(conjugate(q)).apply(&constant_column(&self.vertical));
            let lever = constant_column(&self.lever);
            [
                a13 * dot(&gamma, &s.apply(&gamma)),
                a14 * dot(&lever, &gamma),
            ]
        };
        let (from, to) = (at(here), at(next));
        vec![
            a0 * dot(&v, &s.apply(&v)) / T::constant(self.h),
            b * w[0],
            NodeRule::Symmetric.split(from[0], to[0]),
            NodeRule::Symmetric.split(from[1], to[1]),
        ]
    }
}

/// The Cayley-Klein body (rigid body on SU(2)), in the body or in space.
#[derive(Clone, Debug)]
pub struct CayleyKlein {
    /// The step size.
    pub h: f64,
    /// The member of the family.
    pub c: f64,
    /// Principal moments of inertia.
    pub moments: [f64; 3],
    /// The side of the velocity.
    pub side: Side,
}

impl CayleyKlein {
    /// Random parameters.
    pub fn random(source: &mut Source, side: Side) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            c: source.between(-1.0, 1.0),
            moments: from_fn(|_| source.between(0.3, 2.0)),
            side,
        }
    }

    /// Values of all names of the two gallery models.
    #[must_use]
    pub fn given(&self, nodes: &[[Square<f64, 4>; 1]; 3]) -> Vec<NamedValue> {
        let mut given = NamedValue::at_nodes("q", nodes.map(|[q]| q));
        given.push(NamedValue::scalar("c", self.c));
        let diagonal = Square::from_entries(|i, j| if i == j { self.moments[i] } else { 0.0 });
        match self.side {
            Side::Body => given.push(NamedValue::square("I", 0, &diagonal)),
            Side::Space => {
                let carried = nodes.map(|[q]| {
                    let r = rotation(of_matrix(&q));
                    r * diagonal * r.transpose()
                });
                given.extend(NamedValue::at_nodes("I", carried));
            }
        }
        given
    }
}

impl DiscreteAction<4, 1> for CayleyKlein {
    fn side(&self) -> Side {
        self.side
    }

    fn edge<T: Number>(&self, tail: &[Square<T, 4>; 1], head: &[Square<T, 4>; 1]) -> Vec<T> {
        // Both sides use the body velocity, because the moments are constant in the body.
        let w = hamilton(conjugate(of_matrix(&tail[0])), of_matrix(&head[0]));
        let mut summands = vec![-T::constant(4.0 * self.c / self.h) * w[0]];
        for (i, moment) in self.moments.iter().enumerate() {
            let factor = T::constant(2.0 / self.h * (moment - self.c));
            summands.push(factor * w[i + 1] * w[i + 1]);
        }
        summands
    }
}
