//! Random problems for models that use Newton's method, and the residual of the derived equations at three consecutive nodes. A
//! stream of draws gives data, and the step size for a rotation of about one radian.

use crate::stated::derived_residual::DerivedResidual;
use crate::stated::text_model::{Given, Motion, Numbers, TextModel, given};
use clebsch::card::Kind;
use clebsch::nalgebra::{Matrix3, Matrix4, Quaternion, SMatrix, SVector, Vector3};
use clebsch::{RigidMotion, Rotation};
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::random_states::Draws;

/// Not separable: the potential of an edge depends on the rotation of the body along it.
const ROUGH_BODY: &str = "model RoughBody {
    param J: Sym<3>;
    param c: Real;
    param a, z: Vec<3>;
    group Λ: SO<3> velocity Ω;
    advected Γ: Vec<3> = Λ^T*z;
    constraint next(Λ) = Λ*Ω;
    constraint next(Γ) = Ω^T*Γ;
    lagrangian = -tr(J*Ω)/h - c*tr(J*Ω)^2/h - h*dot(a, Γ)*tr(Ω);
}";

/// In unit quaternions, with a Lagrangian that is not quadratic in the velocity.
const STIFF_QUATERNION: &str = "model StiffQuaternion {
    param S: Sym<3>;
    param c: Real;
    group q: SU<2> velocity W;
    constraint next(q) = q*W;
    lagrangian = (2/h)*dot(im(W), S*im(W)) + (2*c/h)*dot(im(W), S*im(W))^2 - (4*c/h)*re(W);
}";

/// Bodies in different groups.
const MIXED_PAIR: &str = "model MixedPair {
    param J, S: Sym<3>;
    param a: Vec<3>;
    param eps: Real;
    group Λ: SO<3> velocity Ω;
    group q: SU<2> velocity W;
    constraint next(Λ) = Λ*Ω;
    constraint next(q) = q*W;
    lagrangian = -tr(J*Ω)/h + (2/h)*dot(im(W), S*im(W)) + eps*dot(im(W), Ω*a)*re(W)/h;
}";

/// A Lagrangian in four dimensions that is not linear in the velocity.
const STIFF_BODY: &str = "model StiffBody {
    param J: Sym<4>;
    param c: Real;
    group Λ: SO<4> velocity Ω;
    constraint next(Λ) = Λ*Ω;
    lagrangian = -tr(J*Ω)/h - c*tr(J*Ω)^2/h;
}";

/// The size of the terms of a kinetic energy, from the norms of parameters and a length.
type Size = fn(&dyn Fn(&str) -> f64, f64) -> f64;

/// A model with a distribution of random problems.
pub(crate) struct Drawn {
    pub(crate) model: TextModel,
    /// The names of its configurations.
    pub(crate) names: &'static [&'static str],
    /// The data, and the step size of about one radian.
    pub(crate) draw: fn(&mut Draws) -> (Given, f64),
    size: Size,
    residual: DerivedResidual,
}

/// Configurations at a node, and the size of the momenta in space.
pub(crate) struct Node {
    elements: Given,
    momentum: f64,
}

fn norm(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |sum: f64, x| sum.hypot(*x))
}

impl Drawn {
    fn of(
        model: TextModel,
        names: &'static [&'static str],
        draw: fn(&mut Draws) -> (Given, f64),
        size: Size,
    ) -> Self {
        Self {
            model,
            names,
            draw,
            size,
            residual: DerivedResidual::of(model.card),
        }
    }

    fn node(&self, motion: &Motion) -> Node {
        let elements = self
            .names
            .iter()
            .map(|name| ((*name).to_owned(), motion.numbers(name)));
        let observables = self.model.card.observables.iter().map(|field| field.name);
        let momenta = observables.filter(|name| name.starts_with("spatial_momentum"));
        Node {
            elements: elements.collect(),
            momentum: momenta.map(|name| norm(&motion.numbers(name))).sum(),
        }
    }

    /// The first three nodes.
    pub(crate) fn two_steps(&self, h: f64, given: &Given) -> Option<[Node; 3]> {
        let mut motion = self.model.start(h, given).ok()?;
        let first = self.node(&motion);
        motion.step().ok()?;
        let second = self.node(&motion);
        motion.step().ok()?;
        Some([first, second, self.node(&motion)])
    }

    /// The largest component of the derived equations at three consecutive nodes, relative to the size of their terms. The first
    /// configuration of the last node is rotated by an angle.
    pub(crate) fn left(&self, h: f64, given: &Given, nodes: &[Node; 3], angle: f64) -> f64 {
        let kind = self.model.card.initial[0].kind;
        let mut elements = nodes.each_ref().map(|node| node.elements.clone());
        let last = &mut elements[2][0].1;
        // The translation of a step is a difference of positions.
        let place = match kind {
            Kind::RigidMotion => 1.0 + norm(&[last[3], last[7], last[11]]),
            _ => 1.0,
        };
        *last = turned(kind, last, angle);
        let size = |name: &str| {
            let found = given.iter().find(|(own, _)| own == name);
            norm(&found.expect("a parameter").1)
        };
        let size = (self.size)(&size, place) / h + nodes[1].momentum;
        let residual = self.residual.at(h, given, &elements);
        residual.iter().fold(0.0, |m, x| worse(m, x.abs())) / size
    }
}

/// An element times a rotation by this angle about a generic axis.
fn turned(kind: Kind, list: &[f64], angle: f64) -> Vec<f64> {
    let turn = Rotation::exp(&(Vector3::new(0.6, -0.64, 0.48) * angle));
    match (kind, list.len()) {
        (Kind::UnitQuaternion, _) => {
            let [p, q] =
                [list, &turn.quaternion()].map(|q| Quaternion::new(q[0], q[1], q[2], q[3]));
            let product = p * q;
            vec![product.w, product.i, product.j, product.k]
        }
        (_, 9) => (Matrix3::from_row_slice(list) * turn.matrix()).numbers(),
        _ => (Matrix4::from_row_slice(list) * turn.matrix().to_homogeneous()).numbers(),
    }
}

fn vector(draws: &mut Draws, length: f64) -> Vector3<f64> {
    Vector3::from(draws.direction()) * length
}

fn length(draws: &mut Draws) -> f64 {
    draws.uniform(0.1, 2.0)
}

fn turn(draws: &mut Draws) -> Rotation {
    Rotation::from_quaternion(draws.attitude().0).expect("unit")
}

/// A random symmetric matrix with eigenvalues from 0.2 to 1.2.
fn positive(draws: &mut Draws) -> Matrix3<f64> {
    let frame = turn(draws).matrix();
    let values = Vector3::from_fn(|_, _| draws.uniform(0.2, 1.2));
    let j = frame * Matrix3::from_diagonal(&values) * frame.transpose();
    (j + j.transpose()) * 0.5
}

/// Two bodies with a joint.
pub(crate) fn coupled() -> Drawn {
    let draw = |draws: &mut Draws| {
        let eps = draws.uniform(0.1, 1.0);
        let arms = [(); 2].map(|()| vector(draws, 0.7));
        let j = arms.map(|d| positive(draws) + d * d.transpose() * eps);
        let momenta = [(); 2].map(|()| {
            let length = length(draws);
            vector(draws, length)
        });
        let given = given! {
            J1: j[0], J2: j[1], d1: arms[0], d2: arms[1], eps: eps,
            Λ1: turn(draws), body_momentum_Λ1: momenta[0], Λ2: turn(draws), body_momentum_Λ2: momenta[1],
        };
        let unit = |i: usize| j[i].trace() / momenta[i].norm();
        (given, unit(0).min(unit(1)))
    };
    let model = TextModel::gallery("coupled-bodies");
    Drawn::of(model, &["Λ1", "Λ2"], draw, |p, _| p("J1") + p("J2"))
}

/// A body in unit quaternions, which does not use Newton's method.
pub(crate) fn quaternion() -> Drawn {
    let draw = |draws: &mut Draws| {
        let moments = Vector3::from_fn(|_, _| draws.uniform(0.5, 2.0));
        let c = draws.uniform(0.0, 1.0);
        let length = length(draws);
        let given = given! {
            I: Matrix3::from_diagonal(&moments), c: c,
            q: draws.attitude().0, body_momentum: vector(draws, length),
        };
        (given, moments.sum() / length)
    };
    let model = TextModel::gallery("cayley-klein");
    Drawn::of(model, &["q"], draw, |p, _| 4.0 * (p("I") + p("c")))
}

/// [`STIFF_QUATERNION`].
pub(crate) fn stiff() -> Drawn {
    let draw = |draws: &mut Draws| {
        let s = positive(draws);
        let c = draws.uniform(0.1, 0.5);
        let length = length(draws);
        let given = given! {
            S: s, c: c, q: draws.attitude().0, body_momentum: vector(draws, length),
        };
        (given, s.trace() / length)
    };
    let size = |p: &dyn Fn(&str) -> f64, _| 4.0 * (p("S") * (1.0 + p("S")) + p("c"));
    Drawn::of(TextModel::read(STIFF_QUATERNION), &["q"], draw, size)
}

/// A body in an ideal fluid.
pub(crate) fn fluid() -> Drawn {
    let draw = |draws: &mut Draws| {
        let (j, m) = (positive(draws), positive(draws) * 3.0);
        let d = positive(draws) * draws.uniform(0.0, 0.2);
        let b = SVector::<f64, 4>::from_fn(|_, _| draws.uniform(-0.2, 0.2));
        let rotation = turn(draws);
        let (spin, push) = (length(draws), length(draws));
        let (angular, linear) = (vector(draws, spin), vector(draws, push));
        let start = RigidMotion {
            rotation,
            translation: vector(draws, 1.0),
        };
        let impulse = [angular.as_slice(), linear.as_slice()].concat();
        let given = given! {
            J: j, M: m, D: d, b: b, Z: [0.0, 0.0, 1.0, 0.0], G: start, body_momentum: impulse,
        };
        (given, j.trace() / spin)
    };
    let size = |p: &dyn Fn(&str) -> f64, place| (p("J") + p("M") + p("D")) * place * place;
    Drawn::of(TextModel::gallery("kirchhoff-body"), &["G"], draw, size)
}

/// [`ROUGH_BODY`].
pub(crate) fn rough() -> Drawn {
    let draw = |draws: &mut Draws| {
        let j = positive(draws);
        let (c, a) = (draws.uniform(0.1, 0.5), vector(draws, 0.3));
        let length = length(draws);
        let given = given! {
            J: j, c: c, a: a, z: Vector3::z(), Λ: turn(draws), body_momentum: vector(draws, length),
        };
        (given, j.trace() / length)
    };
    let size = |p: &dyn Fn(&str) -> f64, _| p("J") * (1.0 + 6.0 * p("c") * p("J"));
    Drawn::of(TextModel::read(ROUGH_BODY), &["Λ"], draw, size)
}

/// [`MIXED_PAIR`].
pub(crate) fn mixed() -> Drawn {
    let draw = |draws: &mut Draws| {
        let (j, s) = (positive(draws), positive(draws));
        let (a, eps) = (vector(draws, 0.4), draws.uniform(0.0, 0.3));
        let lengths = [(); 2].map(|()| length(draws));
        let given = given! {
            J: j, S: s, a: a, eps: eps, Λ: turn(draws), body_momentum_Λ: vector(draws, lengths[0]),
            q: draws.attitude().0, body_momentum_q: vector(draws, lengths[1]),
        };
        (given, (j.trace() / lengths[0]).min(s.trace() / lengths[1]))
    };
    let size = |p: &dyn Fn(&str) -> f64, _| p("J") + 4.0 * p("S");
    Drawn::of(TextModel::read(MIXED_PAIR), &["Λ", "q"], draw, size)
}

/// [`STIFF_BODY`].
pub(crate) fn in_four_dimensions() -> Drawn {
    let draw = |draws: &mut Draws| {
        let skew = |draws: &mut Draws| {
            let a = SMatrix::<f64, 4, 4>::from_fn(|_, _| draws.uniform(-1.0, 1.0));
            a - a.transpose()
        };
        let a = SMatrix::<f64, 4, 4>::from_fn(|_, _| draws.uniform(-0.3, 0.3));
        let j = a * a.transpose() + SMatrix::identity() * 0.4;
        let c = draws.uniform(0.05, 0.2);
        let (turned, momentum) = (skew(draws), skew(draws) * 0.5);
        // The Cayley map of a skew matrix is a rotation.
        let one = SMatrix::<f64, 4, 4>::identity();
        let cayley = (one - turned).try_inverse().expect("skew") * (one + turned);
        let given =
            given! { J: (j + j.transpose()) * 0.5, c: c, Λ: cayley, body_momentum: momentum };
        (given, j.trace() / momentum.norm())
    };
    let size = |p: &dyn Fn(&str) -> f64, _| p("J") * (1.0 + 8.0 * p("c") * p("J"));
    Drawn::of(TextModel::read(STIFF_BODY), &["Λ"], draw, size)
}
