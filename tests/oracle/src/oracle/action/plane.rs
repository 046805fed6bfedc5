//! Unreduced actions on SE(2), typed by hand: sums of terms drawn from a list, each with its text in the
//! model language and its own meaning here. A motion is taken as a complex number that turns and one
//! that is added.

use super::super::dual::Number;
use super::super::points::{Given, Source};
use super::super::square::{Square, constant_column, dot};
use super::{DiscreteAction, NodeRule, Side, TermSum};
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
    /// Read from its homogeneous matrix.
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

    /// The matrix of the turn.
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

    /// A point `(p, w)` in homogeneous coordinates.
    fn point(&self, p: &[T; 3]) -> [T; 3] {
        let [x, y] = times(self.turn, [p[0], p[1]]);
        [x + self.shift[0] * p[2], y + self.shift[1] * p[2], p[2]]
    }

    /// A line `(n, d)` as the inverse of this motion carries it: `(R^T n, d + n . x)`.
    fn line_back(&self, p: &[T; 3]) -> [T; 3] {
        let n = [p[0], p[1]];
        let [x, y] = times(conjugate(self.turn), n);
        [x, y, p[2] + dot(&n, &self.shift)]
    }
}

/// The basis of the Lie algebra of SE(2): the turn, then two translations.
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

/// Terms by their text: the velocity `V`, a vector `u`, matrices `A`, `S`, `K`, `Q`, and advected `Γ` (a
/// vector), `p` (a point), `P` (a line). The last six live at a node.
const TERMS: [&str; 20] = [
    "tr((V - Id)*Q*(V - Id)^T)/(2*h)",
    "dot(pos(V), S*pos(V))/h",
    "-tr(S*rot(V))/h",
    "tr(K*V)",
    "tr(A*rot(V))",
    "dot(pos(V^-1), A*u)",
    "dot(p, K*V*p)",
    "dot(next(p), K*P)",
    "dot(Γ, rot(V)*u)",
    "dot(u, pos(V*V))",
    "det(rot(V) + S)",
    "tr(K*V^-1)",
    "log(2 + dot(pos(V), pos(V)))*dot(Γ, u)",
    "dot(Γ, A*(pos(V) - pos(V^-1)))",
    "dot(P, K*P)",
    "dot(Γ, u)",
    "dot(pos(G), A*u)",
    "dot(p, K*p)",
    "tr(A*rot(G))",
    "exp(-dot(pos(G), pos(G)))*dot(Γ, A*Γ)",
];

/// How many of them live at a node.
const NODAL: usize = 6;

/// A sum of such terms.
#[derive(Clone, Debug)]
pub struct PlaneSum {
    /// The step.
    pub h: f64,
    /// The side of the velocity.
    pub side: Side,
    /// Which terms, each with its coefficient.
    pub terms: Vec<(usize, f64)>,
    /// `A`.
    pub general: Square<f64, 2>,
    /// `S`.
    pub symmetric: Square<f64, 2>,
    /// `K`.
    pub three: Square<f64, 3>,
    /// `Q`, positive.
    pub moments: Square<f64, 3>,
    /// `u`.
    pub lever: [f64; 2],
    /// `z`.
    pub vertical: [f64; 2],
    /// `p0`.
    pub point: [f64; 3],
    /// `P0`.
    pub line: [f64; 3],
}

impl TermSum<3> for PlaneSum {
    const TERMS: &'static [&'static str] = &TERMS;
    const TAKEN: usize = 20;

    fn basis() -> Vec<Square<f64, 3>> {
        plane_twists()
    }

    fn node(source: &mut Source) -> [Square<f64, 3>; 1] {
        let (sine, cosine) = source.between(-3.0, 3.0).sin_cos();
        let motion = Motion {
            turn: [cosine, sine],
            shift: source.vector(),
        };
        [motion.matrix()]
    }

    fn random(source: &mut Source, side: Side, terms: &[usize]) -> Self {
        let terms = terms.iter();
        Self {
            h: source.between(0.1, 1.0),
            side,
            terms: terms.map(|t| (*t, source.between(-1.0, 1.0))).collect(),
            general: source.matrix(),
            symmetric: source.symmetric(),
            three: source.matrix(),
            moments: source.positive(),
            lever: source.vector(),
            vertical: source.vector(),
            point: source.vector(),
            line: source.vector(),
        }
    }

    fn text(side: Side, terms: &[usize], defined: bool) -> String {
        let (update, vector, point, line) = match side {
            Side::Body => ("G*V", "rot(V)^T*Γ", "V^-1*p", "V^T*P"),
            Side::Space => ("V*G", "rot(V)*Γ", "V*p", "(V^-1)^T*P"),
        };
        let [of_vector, of_point, of_line] = match (defined, side) {
            (false, _) => ["", "", ""],
            (true, Side::Body) => [" = rot(G)^T*z", " = G^-1*p0", " = G^T*P0"],
            (true, Side::Space) => [" = rot(G)*z", " = G*p0", " = (G^-1)^T*P0"],
        };
        let sum: Vec<String> = terms
            .iter()
            .map(|t| format!("a{t}*({})", TERMS[*t]))
            .collect();
        let names: Vec<String> = terms.iter().map(|t| format!("a{t}")).collect();
        format!(
            "model PlaneSum {{
            param {}: Real; param A: Mat<2>; param S: Sym<2>; param K: Mat<3>; param Q: Sym<3>;
            param u, z: Vec<2>; param p0, P0: Vec<3>;
            group G: SE<2> velocity V;
            advected Γ: Vec<2>{of_vector}; advected p: Vec<3>{of_point}; advected P: Vec<3>{of_line};
            constraint next(G) = {update}; constraint next(Γ) = {vector};
            constraint next(p) = {point}; constraint next(P) = {line};
            lagrangian = {};
        }}",
            names.join(", "),
            sum.join(" + ")
        )
    }

    fn step(&self) -> f64 {
        self.h
    }

    fn given(&self, nodes: &[[Square<f64, 3>; 1]; 3]) -> Vec<Given> {
        let mut given = Given::at_nodes("G", nodes.map(|[g]| g));
        let carried = nodes.map(|[g]| self.carried(&Motion::of(&g)));
        given.extend(Given::columns_at_nodes("Γ", carried.map(|c| c.0)));
        given.extend(Given::columns_at_nodes("p", carried.map(|c| c.1)));
        given.extend(Given::columns_at_nodes("P", carried.map(|c| c.2)));
        given.push(Given::square("A", 0, &self.general));
        given.push(Given::square("S", 0, &self.symmetric));
        given.push(Given::square("K", 0, &self.three));
        given.push(Given::square("Q", 0, &self.moments));
        given.push(Given::column("u", 0, &self.lever));
        given.push(Given::column("z", 0, &self.vertical));
        given.push(Given::column("p0", 0, &self.point));
        given.push(Given::column("P0", 0, &self.line));
        for (t, a) in &self.terms {
            given.push(Given::scalar(&format!("a{t}"), *a));
        }
        given
    }
}

impl PlaneSum {
    /// The advected vector, point and line at a node.
    fn carried<T: Number>(&self, g: &Motion<T>) -> ([T; 2], [T; 3], [T; 3]) {
        let (z, p, n) = (
            constant_column(&self.vertical),
            constant_column(&self.point),
            constant_column(&self.line),
        );
        let back = g.inverse();
        match self.side {
            Side::Body => (times(back.turn, z), back.point(&p), g.line_back(&n)),
            Side::Space => (times(g.turn, z), g.point(&p), back.line_back(&n)),
        }
    }

    fn term<T: Number>(&self, t: usize, v: &Motion<T>, here: &Motion<T>, next: &Motion<T>) -> T {
        let c = T::constant;
        let x = v.shift;
        let (gamma, p, n) = self.carried(here);
        let (_, p_next, _) = self.carried(next);
        let a = Square::constant(&self.general);
        let s = Square::constant(&self.symmetric);
        let k = Square::constant(&self.three);
        let u = constant_column(&self.lever);
        let from_rest = v.matrix() - Square::identity();
        let moved = from_rest * Square::constant(&self.moments) * from_rest.transpose();
        let back = v.inverse().shift;
        let gone: [T; 2] = from_fn(|i| x[i] - back[i]);
        match t {
            0 => moved.trace() / c(2.0 * self.h),
            1 => dot(&x, &s.apply(&x)) / c(self.h),
            2 => -(s * v.block()).trace() / c(self.h),
            3 => (k * v.matrix()).trace(),
            4 => (a * v.block()).trace(),
            5 => dot(&back, &a.apply(&u)),
            6 => dot(&p, &k.apply(&v.point(&p))),
            7 => dot(&p_next, &k.apply(&n)),
            8 => dot(&gamma, &times(v.turn, u)),
            9 => dot(&u, &v.after(v).shift),
            10 => (v.block() + s).determinant(),
            11 => (k * v.inverse().matrix()).trace(),
            12 => (c(2.0) + dot(&x, &x)).ln() * dot(&gamma, &u),
            13 => dot(&gamma, &a.apply(&gone)),
            14 => dot(&n, &k.apply(&n)),
            15 => dot(&gamma, &u),
            16 => dot(&here.shift, &a.apply(&u)),
            17 => dot(&p, &k.apply(&p)),
            18 => (a * here.block()).trace(),
            19 => (-dot(&here.shift, &here.shift)).exp() * dot(&gamma, &a.apply(&gamma)),
            _ => c(f64::NAN),
        }
    }
}

impl DiscreteAction<3, 1> for PlaneSum {
    fn side(&self) -> Side {
        self.side
    }

    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 1], head: &[Square<T, 3>; 1]) -> Vec<T> {
        let (here, next) = (Motion::of(&tail[0]), Motion::of(&head[0]));
        let v = match self.side {
            Side::Body => here.inverse().after(&next),
            Side::Space => next.after(&here.inverse()),
        };
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
