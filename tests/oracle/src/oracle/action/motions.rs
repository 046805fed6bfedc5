//! Unreduced actions on SE(3), typed by hand: Kirchhoff's body in an ideal fluid, and sums of terms
//! drawn from a list, each with its text in the model language and its own meaning here.
//! Motions are taken as a rotation and a translation, never as matrices that are multiplied.

use super::super::dual::Number;
use super::super::points::{Given, Source};
use super::super::square::{Square, constant_column, cross, dot, vee};
use super::{DiscreteAction, NodeRule, Side, TermSum};
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
    /// Read from its homogeneous matrix.
    pub(super) fn of(a: &Square<T, 4>) -> Self {
        Motion {
            turn: Square::from_entries(|i, j| a.0[i][j]),
            shift: from_fn(|i| a.0[i][3]),
        }
    }

    fn inverse(&self) -> Self {
        let turn = self.turn.transpose();
        Motion {
            shift: turn.apply(&self.shift).map(|x| -x),
            turn,
        }
    }

    /// First `other`, then `self`.
    fn after(&self, other: &Self) -> Self {
        Motion {
            turn: self.turn * other.turn,
            shift: plus(self.turn.apply(&other.shift), self.shift),
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

    /// A point `(p, s)` in homogeneous coordinates.
    fn point(&self, p: &[T; 4]) -> [T; 4] {
        let turned = self.turn.apply(&[p[0], p[1], p[2]]);
        let moved: [T; 3] = from_fn(|i| turned[i] + self.shift[i] * p[3]);
        [moved[0], moved[1], moved[2], p[3]]
    }

    /// A plane `(n, d)` as the inverse of this motion carries it: `(R^T n, d + n . x)`.
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

/// Terms by their text: the velocity `V`, a vector `u`, matrices `A`, `S`, `K`, and advected `Γ` (a
/// vector), `p` (a point), `P` (a plane). The last five live at a node.
pub const TERMS: [&str; 19] = [
    "dot(pos(V), S*pos(V))/h",
    "tr(K*V)",
    "tr(K*(V - Id)^T*(V - Id))",
    "dot(pos(V^-1), A*u)",
    "tr(A*rot(V))",
    "dot(vee(rot(V)), A*pos(V))",
    "dot(p, K*V*p)",
    "dot(next(p), K*P)",
    "dot(Γ, rot(V)*u)",
    "dot(u, pos(V*V))",
    "det(rot(V) + S)",
    "tr(K*V^-1)",
    "dot(cross(pos(V), u), rot(V)^T*Γ)",
    "log(2 + dot(pos(V), pos(V)))*dot(Γ, u)",
    "dot(P, K*P)",
    "dot(Γ, u)",
    "dot(pos(G), A*u)",
    "dot(p, K*p)",
    "tr(A*rot(G))",
];

/// How many of them live at a node.
const NODAL: usize = 5;

/// A sum of such terms.
#[derive(Clone, Debug)]
pub struct MotionSum {
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
    point: [f64; 4],
    plane: [f64; 4],
}

impl TermSum<4> for MotionSum {
    const TERMS: &'static [&'static str] = &TERMS;
    const TAKEN: usize = 20;

    fn basis() -> Vec<Square<f64, 4>> {
        twists()
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
            point: source.vector(),
            plane: source.vector(),
        }
    }

    fn text(side: Side, terms: &[usize], defined: bool) -> String {
        let (update, vector, point, plane) = match side {
            Side::Body => ("G*V", "rot(V)^T*Γ", "V^-1*p", "V^T*P"),
            Side::Space => ("V*G", "rot(V)*Γ", "V*p", "(V^-1)^T*P"),
        };
        let [of_vector, of_point, of_plane] = match (defined, side) {
            (false, _) => ["", "", ""],
            (true, Side::Body) => [" = rot(G)^T*z", " = G^-1*p0", " = G^T*P0"],
            (true, Side::Space) => [" = rot(G)*z", " = G*p0", " = (G^-1)^T*P0"],
        };
        let sum: Vec<String> = terms
            .iter()
            .map(|t| format!("a{t}*{}", TERMS[*t]))
            .collect();
        let names: Vec<String> = terms.iter().map(|t| format!("a{t}")).collect();
        format!(
            "model MotionSum {{
            param {}: Real; param A: Mat<3>; param S: Sym<3>; param K: Mat<4>; param u, z: Vec<3>;
            param p0, P0: Vec<4>;
            group G: SE<3> velocity V;
            advected Γ: Vec<3>{of_vector}; advected p: Vec<4>{of_point}; advected P: Vec<4>{of_plane};
            constraint next(G) = {update}; constraint next(Γ) = {vector};
            constraint next(p) = {point}; constraint next(P) = {plane};
            lagrangian = {};
        }}",
            names.join(", "),
            sum.join(" + ")
        )
    }

    fn given(&self, nodes: &[[Square<f64, 4>; 1]; 3]) -> Vec<Given> {
        let mut given = Given::at_nodes("G", nodes.map(|[g]| g));
        let carried = nodes.map(|[g]| self.carried(&Motion::of(&g)));
        given.extend(Given::columns_at_nodes("Γ", carried.map(|c| c.0)));
        given.extend(Given::columns_at_nodes("p", carried.map(|c| c.1)));
        given.extend(Given::columns_at_nodes("P", carried.map(|c| c.2)));
        given.push(Given::square("A", 0, &self.general));
        given.push(Given::square("S", 0, &self.symmetric));
        given.push(Given::square("K", 0, &self.four));
        given.push(Given::column("u", 0, &self.lever));
        given.push(Given::column("z", 0, &self.vertical));
        given.push(Given::column("p0", 0, &self.point));
        given.push(Given::column("P0", 0, &self.plane));
        for (t, a) in &self.terms {
            given.push(Given::scalar(&format!("a{t}"), *a));
        }
        given
    }
}

impl MotionSum {
    /// The advected vector, point and plane at a node.
    fn carried<T: Number>(&self, g: &Motion<T>) -> ([T; 3], [T; 4], [T; 4]) {
        let (z, p, n) = (
            constant_column(&self.vertical),
            constant_column(&self.point),
            constant_column(&self.plane),
        );
        let back = g.inverse();
        match self.side {
            Side::Body => (back.turn.apply(&z), back.point(&p), g.plane_back(&n)),
            Side::Space => (g.turn.apply(&z), g.point(&p), back.plane_back(&n)),
        }
    }

    fn term<T: Number>(&self, t: usize, v: &Motion<T>, here: &Motion<T>, next: &Motion<T>) -> T {
        let c = T::constant;
        let x = v.shift;
        let (gamma, p, n) = self.carried(here);
        let (_, p_next, _) = self.carried(next);
        let a = Square::constant(&self.general);
        let s = Square::constant(&self.symmetric);
        let k = Square::constant(&self.four);
        let u = constant_column(&self.lever);
        let change = v.matrix() - Square::identity();
        match t {
            0 => dot(&x, &s.apply(&x)) / c(self.h),
            1 => (k * v.matrix()).trace(),
            2 => (k * change.transpose() * change).trace(),
            3 => dot(&v.inverse().shift, &a.apply(&u)),
            4 => (a * v.turn).trace(),
            5 => dot(&vee(&v.turn), &a.apply(&x)),
            6 => dot(&p, &k.apply(&v.point(&p))),
            7 => dot(&p_next, &k.apply(&n)),
            8 => dot(&gamma, &v.turn.apply(&u)),
            9 => dot(&u, &v.after(v).shift),
            10 => (v.turn + s).determinant(),
            11 => (k * v.inverse().matrix()).trace(),
            12 => dot(&cross(&x, &u), &v.turn.transpose().apply(&gamma)),
            13 => (c(2.0) + dot(&x, &x)).ln() * dot(&gamma, &u),
            14 => dot(&n, &k.apply(&n)),
            15 => dot(&gamma, &u),
            16 => dot(&here.shift, &a.apply(&u)),
            17 => dot(&p, &k.apply(&p)),
            18 => (a * here.turn).trace(),
            _ => c(f64::NAN),
        }
    }
}

fn velocity<T: Number>(side: Side, here: &Motion<T>, next: &Motion<T>) -> Motion<T> {
    match side {
        Side::Body => here.inverse().after(next),
        Side::Space => next.after(&here.inverse()),
    }
}

impl DiscreteAction<4, 1> for MotionSum {
    fn side(&self) -> Side {
        self.side
    }

    fn edge<T: Number>(&self, tail: &[Square<T, 4>; 1], head: &[Square<T, 4>; 1]) -> Vec<T> {
        let (here, next) = (Motion::of(&tail[0]), Motion::of(&head[0]));
        let v = velocity(self.side, &here, &next);
        let terms = self.terms.iter();
        terms
            .map(|(t, a)| {
                let at_tail = self.term(*t, &v, &here, &next);
                let value = if *t >= TERMS.len() - NODAL {
                    NodeRule::Symmetric.split(at_tail, self.term(*t, &v, &next, &next))
                } else {
                    at_tail
                };
                value * T::constant(*a)
            })
            .collect()
    }
}

/// Kirchhoff's body in an ideal fluid, with net weight.
#[derive(Clone, Debug)]
pub struct KirchhoffBody {
    /// The step.
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

    /// Values of all names of the model of the gallery.
    #[must_use]
    pub fn given(&self, nodes: &[[Square<f64, 4>; 1]; 3]) -> Vec<Given> {
        let mut given = Given::at_nodes("G", nodes.map(|[g]| g));
        given.push(Given::square("J", 0, &self.inertia));
        given.push(Given::square("M", 0, &self.mass));
        given.push(Given::square("D", 0, &self.coupling));
        given.push(Given::column("b", 0, &self.weight));
        given.push(Given::column("Z", 0, &self.ground));
        given
    }
}

impl DiscreteAction<4, 1> for KirchhoffBody {
    fn edge<T: Number>(&self, tail: &[Square<T, 4>; 1], head: &[Square<T, 4>; 1]) -> Vec<T> {
        let (here, next) = (Motion::of(&tail[0]), Motion::of(&head[0]));
        let (h, half) = (T::constant(self.h), T::constant(0.5));
        let turn = here.turn.transpose() * next.turn;
        // The displacement in space, seen from the body at both ends, and the mean of the two.
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
