//! Hand-written unreduced actions of one rigid body in the body representation, with random parameters. Each gives the action of
//! one step as a function of Λ at both ends, in the physical sign: kinetic minus potential energy, times the step size.

use super::super::dual::Number;
use super::super::points::{NamedValue, Source};
use super::super::square::{Square, constant_column, dot};
use super::{DiscreteAction, NodeRule};
use std::array::from_fn;

/// A hand-written action and the model that states the same system.
pub trait Stated<const N: usize, const G: usize>: DiscreteAction<N, G> {
    /// The system with random parameters.
    fn random(source: &mut Source) -> Self;
    /// The model in the model language.
    fn text() -> String;
    /// The step size.
    fn step(&self) -> f64;
    /// Parameters, configurations, and advected quantities without a definition.
    fn given(&self, nodes: &[[Square<f64, N>; G]; 3]) -> Vec<NamedValue>;
    /// A random configuration.
    fn node(source: &mut Source) -> [Square<f64, N>; G] {
        from_fn(|_| source.orthogonal())
    }
}

/// `-tr(J Λ_kᵀ Λ_{k+1})/h`, the kinetic term of every body here, without its constant.
pub(super) fn kinetic<T: Number, const N: usize>(
    second_moment: &Square<f64, N>,
    tail: &Square<T, N>,
    head: &Square<T, N>,
    h: f64,
) -> T {
    -(Square::constant(second_moment) * tail.transpose() * *head).trace() / T::constant(h)
}

/// The configurations of a single group at the three nodes.
pub(super) fn attitudes<const N: usize>(
    name: &str,
    nodes: &[[Square<f64, N>; 1]; 3],
) -> Vec<NamedValue> {
    NamedValue::at_nodes(name, nodes.map(|[element]| element))
}

/// The free rigid body.
#[derive(Clone, Debug)]
pub struct FreeBody {
    /// The step size.
    pub h: f64,
    /// The Poinsot matrix J, body frame.
    pub second_moment: Square<f64, 3>,
}

impl DiscreteAction<3, 1> for FreeBody {
    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 1], head: &[Square<T, 3>; 1]) -> Vec<T> {
        vec![kinetic(&self.second_moment, &tail[0], &head[0], self.h)]
    }
}

impl Stated<3, 1> for FreeBody {
    fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            second_moment: source.positive(),
        }
    }
    fn text() -> String {
        "model FreeBody {
            param J: Sym<3>;
            group Λ: SO<3> velocity Ω;
            constraint next(Λ) = Λ*Ω;
            lagrangian = -tr(J*Ω)/h;
        }"
        .to_owned()
    }
    fn step(&self) -> f64 {
        self.h
    }
    fn given(&self, nodes: &[[Square<f64, 3>; 1]; 3]) -> Vec<NamedValue> {
        let mut given = attitudes("Λ", nodes);
        given.push(NamedValue::square("J", 0, &self.second_moment));
        given
    }
}

/// The heavy top with the vertical recomputed from the attitude, `Γ = Λᵀ z`.
///
/// `RULE` is 0, 1, 2 for symmetric, incoming, outgoing nodes; `THESIS` uses `scale -h`.
#[derive(Clone, Debug)]
pub struct HeavyTop<const RULE: u8, const THESIS: bool = false> {
    /// The step size.
    pub h: f64,
    /// The Poinsot matrix J, body frame.
    pub second_moment: Square<f64, 3>,
    /// Weight times the vector from the support to the centre of mass, body frame.
    pub lever: [f64; 3],
    /// The upward vertical, spatial frame.
    pub vertical: [f64; 3],
}

impl<const RULE: u8, const THESIS: bool> HeavyTop<RULE, THESIS> {
    /// The rule of the nodes.
    #[must_use]
    pub fn rule() -> NodeRule {
        match RULE {
            0 => NodeRule::Symmetric,
            1 => NodeRule::Incoming,
            _ => NodeRule::Outgoing,
        }
    }
}

impl<const RULE: u8, const THESIS: bool> DiscreteAction<3, 1> for HeavyTop<RULE, THESIS> {
    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 1], head: &[Square<T, 3>; 1]) -> Vec<T> {
        let (lever, vertical) = (
            constant_column(&self.lever),
            constant_column(&self.vertical),
        );
        // The height of the centre of mass: the spatial lever along the vertical.
        let weight = |attitude: &Square<T, 3>| {
            -T::constant(self.h) * dot(&attitude.apply(&lever), &vertical)
        };
        vec![
            kinetic(&self.second_moment, &tail[0], &head[0], self.h),
            Self::rule().split(weight(&tail[0]), weight(&head[0])),
        ]
    }
}

impl<const RULE: u8, const THESIS: bool> Stated<3, 1> for HeavyTop<RULE, THESIS> {
    fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            second_moment: source.positive(),
            lever: source.vector(),
            vertical: source.vector(),
        }
    }
    fn text() -> String {
        let (scale, lagrangian) = if THESIS {
            ("scale -h;", "tr(Ω*J) + h^2*dot(gU, Γ)")
        } else {
            ("", "-tr(J*Ω)/h - h*dot(gU, Γ)")
        };
        format!(
            "model HeavyTop {{
            {scale}
            node {};
            param J: Sym<3>;
            param gU: Vec<3>;
            param z: Vec<3>;
            group Λ: SO<3> velocity Ω;
            advected Γ: Vec<3> = Λ^T*z;
            constraint next(Λ) = Λ*Ω;
            constraint next(Γ) = Ω^T*Γ;
            lagrangian = {lagrangian};
        }}",
            Self::rule().word()
        )
    }
    fn step(&self) -> f64 {
        self.h
    }
    fn given(&self, nodes: &[[Square<f64, 3>; 1]; 3]) -> Vec<NamedValue> {
        let mut given = attitudes("Λ", nodes);
        given.push(NamedValue::square("J", 0, &self.second_moment));
        given.push(NamedValue::column("gU", 0, &self.lever));
        given.push(NamedValue::column("z", 0, &self.vertical));
        given
    }
}

/// A body in a quadratic field; the advected Γ has only a spatial value and no definition.
#[derive(Clone, Debug)]
pub struct QuadraticField {
    /// The step size.
    pub h: f64,
    /// The Poinsot matrix J, body frame.
    pub second_moment: Square<f64, 3>,
    /// The quadratic form K of the potential `Γ·KΓ/2`, body frame.
    pub form: Square<f64, 3>,
    /// Γ in the spatial frame, where it is constant.
    pub direction: [f64; 3],
}

impl DiscreteAction<3, 1> for QuadraticField {
    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 1], head: &[Square<T, 3>; 1]) -> Vec<T> {
        let potential = |attitude: &Square<T, 3>| {
            let seen = attitude
                .transpose()
                .apply(&constant_column(&self.direction));
            -T::constant(0.5 * self.h) * dot(&seen, &Square::constant(&self.form).apply(&seen))
        };
        vec![
            kinetic(&self.second_moment, &tail[0], &head[0], self.h),
            NodeRule::Symmetric.split(potential(&tail[0]), potential(&head[0])),
        ]
    }
}

impl Stated<3, 1> for QuadraticField {
    fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            second_moment: source.positive(),
            form: source.symmetric(),
            direction: source.vector(),
        }
    }
    fn text() -> String {
        "model BodyInQuadraticField {
            param J, K: Sym<3>;  group Λ: SO<3> velocity Ω;  advected Γ: Vec<3>;
            constraint next(Λ) = Λ*Ω;  constraint next(Γ) = Ω^T*Γ;
            lagrangian = -tr(J*Ω)/h - (h/2)*dot(Γ, K*Γ);
        }"
        .to_owned()
    }
    fn step(&self) -> f64 {
        self.h
    }
    fn given(&self, nodes: &[[Square<f64, 3>; 1]; 3]) -> Vec<NamedValue> {
        let seen = nodes.map(|[attitude]| attitude.transpose().apply(&self.direction));
        let mut given = attitudes("Λ", nodes);
        given.extend(NamedValue::columns_at_nodes("Γ", seen));
        given.push(NamedValue::square("J", 0, &self.second_moment));
        given.push(NamedValue::square("K", 0, &self.form));
        given
    }
}

/// A body with two advected vectors, one with a definition and one without, coupled to each other and to the velocity.
#[derive(Clone, Debug)]
pub struct TwoVectors {
    /// The step size.
    pub h: f64,
    /// The Poinsot matrix J, body frame.
    pub second_moment: Square<f64, 3>,
    /// A matrix without symmetry, body frame.
    pub coupling: Square<f64, 3>,
    /// The first vector in space: `Γ = Λᵀ z`.
    pub first: [f64; 3],
    /// The second vector in space, without a definition in the model.
    pub second: [f64; 3],
    /// A vector fixed in the body.
    pub marker: [f64; 3],
}

impl DiscreteAction<3, 1> for TwoVectors {
    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 1], head: &[Square<T, 3>; 1]) -> Vec<T> {
        let h = T::constant(self.h);
        let marker: [T; 3] = constant_column(&self.marker);
        let coupling = Square::constant(&self.coupling);
        let first = |a: &Square<T, 3>| a.transpose().apply(&constant_column(&self.first));
        let second = |a: &Square<T, 3>| a.transpose().apply(&constant_column(&self.second));
        let triple = |a: &Square<T, 3>| {
            let (x, y) = (first(a), second(a));
            // The volume spanned by the marker and both vectors, written out.
            let volume = marker[0] * (x[1] * y[2] - x[2] * y[1])
                + marker[1] * (x[2] * y[0] - x[0] * y[2])
                + marker[2] * (x[0] * y[1] - x[1] * y[0]);
            -h * volume
        };
        let relative = tail[0].transpose() * head[0];
        let mixed = -dot(
            &first(&tail[0]),
            &relative.apply(&coupling.apply(&second(&tail[0]))),
        );
        vec![
            kinetic(&self.second_moment, &tail[0], &head[0], self.h),
            NodeRule::Symmetric.split(triple(&tail[0]), triple(&head[0])),
            mixed,
        ]
    }
}

impl Stated<3, 1> for TwoVectors {
    fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            second_moment: source.positive(),
            coupling: source.matrix(),
            first: source.vector(),
            second: source.vector(),
            marker: source.vector(),
        }
    }
    fn text() -> String {
        "model TwoVectors {
            param J: Sym<3>;  param B: Mat<3>;  param z, c: Vec<3>;
            group Λ: SO<3> velocity Ω;
            advected Γ: Vec<3> = Λ^T*z;  advected χ: Vec<3>;
            constraint next(Λ) = Λ*Ω;  constraint next(Γ) = Ω^T*Γ;  constraint next(χ) = Ω^T*χ;
            lagrangian = -tr(J*Ω)/h - h*dot(c, cross(Γ, χ)) - dot(Γ, Ω*B*χ);
        }"
        .to_owned()
    }
    fn step(&self) -> f64 {
        self.h
    }
    fn given(&self, nodes: &[[Square<f64, 3>; 1]; 3]) -> Vec<NamedValue> {
        let seen = nodes.map(|[attitude]| attitude.transpose().apply(&self.second));
        let mut given = attitudes("Λ", nodes);
        given.extend(NamedValue::columns_at_nodes("χ", seen));
        given.push(NamedValue::square("J", 0, &self.second_moment));
        given.push(NamedValue::square("B", 0, &self.coupling));
        given.push(NamedValue::column("z", 0, &self.first));
        given.push(NamedValue::column("c", 0, &self.marker));
        given
    }
}

/// A rigid body in four dimensions whose kinetic matrix is not symmetric: `-tr(Cᵀ Ω)/h`.
#[derive(Clone, Debug)]
pub struct FourDimensional {
    /// The step size.
    pub h: f64,
    /// The matrix C, body frame.
    pub matrix: Square<f64, 4>,
}

impl DiscreteAction<4, 1> for FourDimensional {
    fn edge<T: Number>(&self, tail: &[Square<T, 4>; 1], head: &[Square<T, 4>; 1]) -> Vec<T> {
        // tr(Cᵀ Ω) is the sum of the products of the entries.
        let relative = tail[0].transpose() * head[0];
        let mut sum = T::constant(0.0);
        for i in 0..4 {
            for j in 0..4 {
                sum = sum + T::constant(self.matrix.0[i][j]) * relative.0[i][j];
            }
        }
        vec![-sum / T::constant(self.h)]
    }
}

impl Stated<4, 1> for FourDimensional {
    fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            matrix: source.matrix(),
        }
    }
    fn text() -> String {
        "model BodyFour {
            param C: Mat<4>;
            group Λ: SO<4> velocity Ω;   constraint next(Λ) = Λ*Ω;
            lagrangian = -tr(C^T*Ω)/h;
        }"
        .to_owned()
    }
    fn step(&self) -> f64 {
        self.h
    }
    fn given(&self, nodes: &[[Square<f64, 4>; 1]; 3]) -> Vec<NamedValue> {
        let mut given = attitudes("Λ", nodes);
        given.push(NamedValue::square("C", 0, &self.matrix));
        given
    }
}
