//! Unreduced actions on SU(2), typed by hand: the Cayley-Klein body on both sides, and sums of terms
//! drawn from a list, each with its text in the model language and its own meaning here.
//! Quaternions are taken as four components; matrices are made of them as the definition says.

use super::super::dual::Number;
use super::super::points::{Given, Source};
use super::super::square::{Square, constant_column, dot};
use super::{DiscreteAction, NodeRule, Side, TermSum};
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

/// The quaternion without real part.
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

/// The quaternion of a left multiplication: what it makes of 1.
pub(super) fn of_matrix<T: Number>(a: &Square<T, 4>) -> [T; 4] {
    from_fn(|i| a.0[i][0])
}

/// The imaginary part of any 4 x 4 matrix: a quarter of its pairings with the three units.
fn nearest<T: Number>(a: &Square<T, 4>) -> [T; 3] {
    from_fn(|k| {
        let unit = from_fn(|i| T::constant(f64::from(u8::from(i == k + 1))));
        (left(unit).transpose() * *a).trace() * T::constant(0.25)
    })
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

/// Terms by their text: the velocity `W`, vectors `u`, `Γ` (advected), matrices `A`, `S`, `K`, an
/// advected tensor `B`. The last five live at a node.
pub const TERMS: [&str; 18] = [
    "dot(im(W), S*im(W))/h",
    "re(W)",
    "re(W)^2",
    "dot(u, A*im(W))",
    "tr(K*W)",
    "dot(u, im(K*W))",
    "tr(K*W^T*K^T*W)",
    "tr(A*rot(W))",
    "dot(Γ, A*rot(W)*u)",
    "dot(next(Γ), A*im(W))",
    "re(quat(u)*W*quat(Γ))",
    "det(rot(W) + S)",
    "sqrt(2 + re(W))*dot(Γ, im(W*quat(u)*W^T))",
    "dot(Γ, S*Γ)",
    "dot(u, Γ)",
    "tr(A*B)",
    "log(3 + dot(Γ, u)^2)",
    "dot(u, B*Γ)",
];

/// How many of them live at a node.
const NODAL: usize = 5;

/// A sum of such terms.
#[derive(Clone, Debug)]
pub struct QuaternionSum {
    /// The step.
    pub h: f64,
    /// The side of the velocity.
    pub side: Side,
    /// Which terms, each with its coefficient.
    pub terms: Vec<(usize, f64)>,
    general: Square<f64, 3>,
    symmetric: Square<f64, 3>,
    four: Square<f64, 4>,
    lever: [f64; 3],
    vertical: [f64; 3],
}

impl TermSum<4> for QuaternionSum {
    const TERMS: &'static [&'static str] = &TERMS;
    const TAKEN: usize = 25;

    fn basis() -> Vec<Square<f64, 4>> {
        halves()
    }

    fn node(source: &mut Source) -> [Square<f64, 4>; 1] {
        node(source)
    }

    fn step(&self) -> f64 {
        self.h
    }

    fn random(source: &mut Source, side: Side, terms: &[usize]) -> Self {
        let terms = terms.iter();
        Self {
            h: source.between(0.1, 1.0),
            side,
            terms: terms.map(|t| (*t, source.between(-1.0, 1.0))).collect(),
            general: source.matrix(),
            symmetric: source.symmetric(),
            four: source.matrix(),
            lever: source.vector(),
            vertical: source.vector(),
        }
    }

    fn text(side: Side, terms: &[usize], defined: bool) -> String {
        let (update, vector, tensor) = match side {
            Side::Body => ("q*W", "rot(W)^T*Γ", "rot(W)^T*B*rot(W)"),
            Side::Space => ("W*q", "rot(W)*Γ", "rot(W)*B*rot(W)^T"),
        };
        let (of_vector, of_tensor) = match (defined, side) {
            (false, _) => ("", ""),
            (true, Side::Body) => (" = rot(q)^T*z", " = rot(q)^T*S*rot(q)"),
            (true, Side::Space) => (" = rot(q)*z", " = rot(q)*S*rot(q)^T"),
        };
        let sum: Vec<String> = terms
            .iter()
            .map(|t| format!("a{t}*{}", TERMS[*t]))
            .collect();
        let names: Vec<String> = terms.iter().map(|t| format!("a{t}")).collect();
        format!(
            "model QuaternionSum {{
            param {}: Real; param A: Mat<3>; param S: Sym<3>; param K: Mat<4>; param u, z: Vec<3>;
            group q: SU<2> velocity W; advected Γ: Vec<3>{of_vector}; advected B: Sym<3>{of_tensor};
            constraint next(q) = {update}; constraint next(Γ) = {vector};
            constraint next(B) = {tensor};
            lagrangian = {};
        }}",
            names.join(", "),
            sum.join(" + ")
        )
    }

    fn given(&self, nodes: &[[Square<f64, 4>; 1]; 3]) -> Vec<Given> {
        let mut given = Given::at_nodes("q", nodes.map(|[q]| q));
        let carried = nodes.map(|[q]| self.carried(&of_matrix(&q)));
        given.extend(Given::columns_at_nodes("Γ", carried.map(|(v, _)| v)));
        given.extend(Given::at_nodes("B", carried.map(|(_, b)| b)));
        given.push(Given::square("A", 0, &self.general));
        given.push(Given::square("S", 0, &self.symmetric));
        given.push(Given::square("K", 0, &self.four));
        given.push(Given::column("u", 0, &self.lever));
        given.push(Given::column("z", 0, &self.vertical));
        for (t, a) in &self.terms {
            given.push(Given::scalar(&format!("a{t}"), *a));
        }
        given
    }
}

impl QuaternionSum {
    /// The advected vector and tensor at a node.
    fn carried<T: Number>(&self, q: &[T; 4]) -> ([T; 3], Square<T, 3>) {
        let r = match self.side {
            Side::Body => rotation(conjugate(*q)),
            Side::Space => rotation(*q),
        };
        let tensor = r * Square::constant(&self.symmetric) * r.transpose();
        (r.apply(&constant_column(&self.vertical)), tensor)
    }

    fn term<T: Number>(&self, t: usize, w: [T; 4], here: &[T; 4], next: &[T; 4]) -> T {
        let c = T::constant;
        let v = imaginary(w);
        let r = rotation(w);
        let m = left(w);
        let (gamma, b) = self.carried(here);
        let (gamma_next, _) = self.carried(next);
        let a = Square::constant(&self.general);
        let s = Square::constant(&self.symmetric);
        let k = Square::constant(&self.four);
        let u = constant_column(&self.lever);
        match t {
            0 => dot(&v, &s.apply(&v)) / c(self.h),
            1 => w[0],
            2 => w[0] * w[0],
            3 => dot(&u, &a.apply(&v)),
            4 => (k * m).trace(),
            5 => dot(&u, &nearest(&(k * m))),
            6 => (k * m.transpose() * k.transpose() * m).trace(),
            7 => (a * r).trace(),
            8 => dot(&gamma, &a.apply(&r.apply(&u))),
            9 => dot(&gamma_next, &a.apply(&v)),
            10 => hamilton(hamilton(of_vector(&u), w), of_vector(&gamma))[0],
            11 => (r + s).determinant(),
            12 => (c(2.0) + w[0]).sqrt() * dot(&gamma, &r.apply(&u)),
            13 => dot(&gamma, &s.apply(&gamma)),
            14 => dot(&u, &gamma),
            15 => (a * b).trace(),
            16 => (c(3.0) + dot(&gamma, &u) * dot(&gamma, &u)).ln(),
            17 => dot(&u, &b.apply(&gamma)),
            _ => c(f64::NAN),
        }
    }
}

impl DiscreteAction<4, 1> for QuaternionSum {
    fn side(&self) -> Side {
        self.side
    }

    fn edge<T: Number>(&self, tail: &[Square<T, 4>; 1], head: &[Square<T, 4>; 1]) -> Vec<T> {
        let (here, next) = (of_matrix(&tail[0]), of_matrix(&head[0]));
        let w = match self.side {
            Side::Body => hamilton(conjugate(here), next),
            Side::Space => hamilton(next, conjugate(here)),
        };
        let terms = self.terms.iter();
        terms
            .map(|(t, a)| {
                let at_tail = self.term(*t, w, &here, &next);
                let value = if *t >= TERMS.len() - NODAL {
                    let at_head = self.term(*t, w, &next, &next);
                    NodeRule::Symmetric.split(at_tail, at_head)
                } else {
                    at_tail
                };
                value * T::constant(*a)
            })
            .collect()
    }
}

/// The Cayley-Klein body (rigid body on SU(2)), in the body or in space.
#[derive(Clone, Debug)]
pub struct CayleyKlein {
    /// The step.
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

    /// Values of all names of the two models of the gallery.
    #[must_use]
    pub fn given(&self, nodes: &[[Square<f64, 4>; 1]; 3]) -> Vec<Given> {
        let mut given = Given::at_nodes("q", nodes.map(|[q]| q));
        given.push(Given::scalar("c", self.c));
        let diagonal = Square::from_entries(|i, j| if i == j { self.moments[i] } else { 0.0 });
        match self.side {
            Side::Body => given.push(Given::square("I", 0, &diagonal)),
            Side::Space => {
                let carried = nodes.map(|[q]| {
                    let r = rotation(of_matrix(&q));
                    r * diagonal * r.transpose()
                });
                given.extend(Given::at_nodes("I", carried));
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
        // Unreduced on either side: the velocity in the body, where the moments are constant.
        let w = hamilton(conjugate(of_matrix(&tail[0])), of_matrix(&head[0]));
        let mut summands = vec![-T::constant(4.0 * self.c / self.h) * w[0]];
        for (i, moment) in self.moments.iter().enumerate() {
            let factor = T::constant(2.0 / self.h * (moment - self.c));
            summands.push(factor * w[i + 1] * w[i + 1]);
        }
        summands
    }
}
