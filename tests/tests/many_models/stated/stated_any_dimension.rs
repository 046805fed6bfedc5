//! Models on SO(n) and GL(n), tested through their statements alone: fixed and named sizes, forcing by advected quantities,
//! Lagrangians without Moser-Veselov form.

use super::derived_residual::DerivedResidual;
use super::text_model::{Given, TextModel, given};
use clebsch_oracle::oracle::action::{
    DiscreteAction, Side, momentum_in, momentum_out, sensitivity, stationarity,
};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{Square, dot};
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

/// Body in four dimensions.
const BODY4: &str = "model Body4 {
    param C: Mat<4>;
    group Λ: SO<4> velocity Ω;
    constraint next(Λ) = Λ*Ω;
    lagrangian = -tr(C^T*Ω)/h;
}";

/// Body of any dimension, in a field that is linear in a direction.
const TOP_N: &str = "model TopN {
    dim n in 2..=5;
    param J: Sym<n>;
    param g: Vec<n>;
    param z: Vec<n>;
    group Λ: SO<n> velocity Ω;
    advected Γ: Vec<n> = Λ^T*z;
    constraint next(Λ) = Λ*Ω;
    constraint next(Γ) = Ω^T*Γ;
    lagrangian = -tr(J*Ω)/h - h*dot(g, Γ);
}";

/// A body of any dimension in the space frame, with advected inertia.
const SPATIAL_N: &str = "model SpatialN {
    dim n in 3..=4;
    param K: Sym<n>;
    group Λ: SO<n> velocity ω;
    advected J: Sym<n>;
    constraint next(Λ) = ω*Λ;
    constraint next(J) = ω*J*ω^T;
    lagrangian = -tr(ω*J)/h - h*tr(K*J);
}";

/// A Lagrangian that is not linear in the velocity.
const STIFF4: &str = "model Stiff4 {
    param J: Sym<4>;
    param c: Real;
    group Λ: SO<4> velocity Ω;
    advected S: Sym<4>;
    constraint next(Λ) = Λ*Ω;
    constraint next(S) = Ω^T*S*Ω;
    lagrangian = -tr(J*Ω)/h + c*tr(Ω*J*Ω*J)/h - h*tr(J*S);
}";

/// Elastic ellipsoid, convective.
const ELLIPSOID_N: &str = "model EllipsoidN {
    dim n in 2..=4;
    param C0, I0: Sym<n>;
    param a, d: Real;
    group Q: GL<n> velocity G;
    advected C: Sym<n> = Q^T*C0*Q;
    constraint next(Q) = Q*G;
    constraint next(C) = G^T*C*G;
    lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*(a*tr(C) - (d/2)*log(det(C)));
}";

/// Elastic ellipsoid in the plane, spatial.
const ELLIPSOID2: &str = "model Ellipsoid2 {
    param C0, I0: Sym<2>;
    group Q: GL<2> velocity γ;
    advected S: Sym<2> = Q*I0*Q^T;
    constraint next(Q) = γ*Q;
    constraint next(S) = γ*S*γ^T;
    lagrangian = tr(C0*(γ - Id)*S*(γ - Id)^T)/(2*h) - h*tr(S);
}";

clebsch::model! {
    /// A rotation in space and a rotation in four dimensions, coupled only by the solver.
    model Pair {
        param J: Sym<3>;
        param K: Sym<4>;
        param v: Vec<3>;
        param w: Vec<4>;
        group R: SO<3> velocity Ω;
        group Q: SO<4> velocity W;
        constraint next(R) = R*Ω;
        constraint next(Q) = Q*W;
        lagrangian = -tr(J*Ω)/h - tr(K*W)/h + dot(v, (Ω - Id)*v)*dot(w, (W - Id)*w)/h;
    }
}

/// Random points and random states per model.
const POINTS: usize = 60;
/// Tolerance of residuals, relative to the sum of the absolute summands.
const AGREEMENT: f64 = 1e-12;
/// Tolerance of a solved equation: a thousand rounding errors of 1e-16, amplified by the sensitivity of the equation to the entries
/// of the group elements.
const ROUNDING: f64 = 1e-13;

/// The hand-written unreduced action of one step, with random parameters.
trait System<const N: usize>: DiscreteAction<N, 1> + Sized {
    /// The text, with the names of its configuration and of its momentum.
    const STATED: [&'static str; 3];

    fn draw(source: &mut Source, h: f64) -> Self;
    /// A random configuration.
    fn node(source: &mut Source) -> Square<f64, N> {
        source.orthogonal()
    }
    /// The basis of the Lie algebra.
    fn basis() -> Vec<Square<f64, N>> {
        planes()
    }
    /// The step size.
    fn h(&self) -> f64;
    /// The parameters.
    fn parameters(&self) -> Given;
    /// Advected quantities without a definition, at a configuration.
    fn carried(&self, _node: &Square<f64, N>) -> Given {
        Vec::new()
    }
    /// Configuration and advected quantities.
    fn at(&self, node: &Square<f64, N>) -> Given {
        let mut all = self.carried(node);
        all.push((Self::STATED[1].to_owned(), node.0.concat()));
        all
    }
    /// Two steps from a node and the coordinates of its momentum.
    fn two_steps(
        &self,
        model: &TextModel,
        start: &Square<f64, N>,
        momentum: &[f64],
    ) -> Option<Steps<N>> {
        let [_, element, name] = Self::STATED;
        let basis = Self::basis();
        let terms = basis.iter().zip(momentum).map(|(b, x)| b.scaled(*x));
        let zero = Square::from_entries(|_, _| 0.0);
        let own = terms.fold(zero, |sum, term| sum + term);
        let mut given = [self.parameters(), self.at(start)].concat();
        given.push((name.to_owned(), own.0.concat()));
        let mut motion = model.start(self.h(), &given).ok()?;
        let mut nodes = [motion.square(element); 3];
        motion.step().ok()?;
        nodes[1] = motion.square(element);
        let second = motion.square::<N>(name);
        motion.step().ok()?;
        nodes[2] = motion.square(element);
        Some(Steps {
            nodes,
            momenta: [momentum.to_vec(), coordinates(&basis, &second)],
        })
    }
}

/// Three nodes, and the momenta at the first two.
struct Steps<const N: usize> {
    nodes: [Square<f64, N>; 3],
    momenta: [Vec<f64>; 2],
}

/// `E_ji - E_ij` for `i < j`, row by row.
fn planes<const N: usize>() -> Vec<Square<f64, N>> {
    let pairs = (0..N).flat_map(|i| (i + 1..N).map(move |j| (i, j)));
    pairs
        .map(|(i, j)| {
            Square::from_entries(|r, c| {
                f64::from(u8::from((r, c) == (j, i))) - f64::from(u8::from((r, c) == (i, j)))
            })
        })
        .collect()
}

/// The coordinates of a matrix along a basis: each entry where only one element is 1.
fn coordinates<const N: usize>(basis: &[Square<f64, N>], a: &Square<f64, N>) -> Vec<f64> {
    let along = basis.iter().map(|b| {
        let is_one = |k: &usize| b.0[k / N][k % N] == 1.0;
        let k = (0..N * N).find(is_one).expect("an entry");
        a.0[k / N][k % N]
    });
    along.collect()
}

fn kinetic<T: Number, const N: usize>(
    c: &Square<f64, N>,
    tail: &Square<T, N>,
    head: &Square<T, N>,
    h: f64,
) -> T {
    -(Square::<T, N>::constant(c).transpose() * tail.transpose() * *head).trace() / T::constant(h)
}

/// [`BODY4`].
struct Body {
    h: f64,
    c: Square<f64, 4>,
}

impl DiscreteAction<4, 1> for Body {
    fn edge<T: Number>(&self, tail: &[Square<T, 4>; 1], head: &[Square<T, 4>; 1]) -> Vec<T> {
        vec![kinetic(&self.c, &tail[0], &head[0], self.h)]
    }
}

impl System<4> for Body {
    fn draw(source: &mut Source, h: f64) -> Self {
        // A positive matrix plus a small skew one: not symmetric.
        let c = source.positive() + source.skew().scaled(0.2);
        Self { h, c }
    }
    const STATED: [&'static str; 3] = [BODY4, "Λ", "body_momentum"];
    fn h(&self) -> f64 {
        self.h
    }
    fn parameters(&self) -> Given {
        given! { C: self.c }
    }
}

/// [`TOP_N`].
struct Top<const N: usize> {
    h: f64,
    j: Square<f64, N>,
    g: [f64; N],
    z: [f64; N],
}

impl<const N: usize> DiscreteAction<N, 1> for Top<N> {
    fn edge<T: Number>(&self, tail: &[Square<T, N>; 1], head: &[Square<T, N>; 1]) -> Vec<T> {
        let potential = |x: &Square<T, N>| {
            let direction = x.transpose().apply(&self.z.map(T::constant));
            dot(&self.g.map(T::constant), &direction)
        };
        let mean = (potential(&tail[0]) + potential(&head[0])) * T::constant(0.5);
        vec![
            kinetic(&self.j, &tail[0], &head[0], self.h),
            -T::constant(self.h) * mean,
        ]
    }
}

impl<const N: usize> System<N> for Top<N> {
    fn draw(source: &mut Source, h: f64) -> Self {
        Self {
            h,
            j: source.positive(),
            g: source.vector(),
            z: source.vector(),
        }
    }
    const STATED: [&'static str; 3] = [TOP_N, "Λ", "body_momentum"];
    fn h(&self) -> f64 {
        self.h
    }
    fn parameters(&self) -> Given {
        given! { J: self.j, g: self.g, z: self.z }
    }
}

/// [`SPATIAL_N`]: the inertia at the identity is `j`.
struct Spatial<const N: usize> {
    h: f64,
    j: Square<f64, N>,
    k: Square<f64, N>,
}

impl<const N: usize> DiscreteAction<N, 1> for Spatial<N> {
    fn side(&self) -> Side {
        Side::Space
    }
    fn edge<T: Number>(&self, tail: &[Square<T, N>; 1], head: &[Square<T, N>; 1]) -> Vec<T> {
        let (k, j) = (
            Square::<T, N>::constant(&self.k),
            Square::<T, N>::constant(&self.j),
        );
        let potential = |x: &Square<T, N>| (k * *x * j * x.transpose()).trace();
        let mean = (potential(&tail[0]) + potential(&head[0])) * T::constant(0.5);
        vec![
            kinetic(&self.j, &tail[0], &head[0], self.h),
            -T::constant(self.h) * mean,
        ]
    }
}

impl<const N: usize> System<N> for Spatial<N> {
    fn draw(source: &mut Source, h: f64) -> Self {
        Self {
            h,
            j: source.positive(),
            k: source.symmetric().scaled(0.5),
        }
    }
    const STATED: [&'static str; 3] = [SPATIAL_N, "Λ", "spatial_momentum"];
    fn h(&self) -> f64 {
        self.h
    }
    fn parameters(&self) -> Given {
        given! { K: self.k }
    }
    fn carried(&self, node: &Square<f64, N>) -> Given {
        given! { J: turned(node, &self.j) }
    }
}

/// `Λ J Λ^T`, exactly symmetric.
fn turned<const N: usize>(node: &Square<f64, N>, j: &Square<f64, N>) -> Square<f64, N> {
    let value = *node * *j * node.transpose();
    (value + value.transpose()).scaled(0.5)
}

/// [`STIFF4`]: the advected matrix at the identity is `s`.
struct Stiff {
    h: f64,
    j: Square<f64, 4>,
    s: Square<f64, 4>,
    c: f64,
}

impl DiscreteAction<4, 1> for Stiff {
    fn edge<T: Number>(&self, tail: &[Square<T, 4>; 1], head: &[Square<T, 4>; 1]) -> Vec<T> {
        let (j, s) = (
            Square::<T, 4>::constant(&self.j),
            Square::<T, 4>::constant(&self.s),
        );
        let turned = tail[0].transpose() * head[0] * j;
        let potential = |x: &Square<T, 4>| (j * x.transpose() * s * *x).trace();
        let mean = (potential(&tail[0]) + potential(&head[0])) * T::constant(0.5);
        vec![
            kinetic(&self.j, &tail[0], &head[0], self.h),
            T::constant(self.c / self.h) * (turned * turned).trace(),
            -T::constant(self.h) * mean,
        ]
    }
}

impl System<4> for Stiff {
    fn draw(source: &mut Source, h: f64) -> Self {
        Self {
            h,
            j: source.positive(),
            s: source.symmetric(),
            c: source.between(-0.02, 0.02),
        }
    }
    const STATED: [&'static str; 3] = [STIFF4, "Λ", "body_momentum"];
    fn h(&self) -> f64 {
        self.h
    }
    fn parameters(&self) -> Given {
        given! { J: self.j, c: self.c }
    }
    fn carried(&self, node: &Square<f64, 4>) -> Given {
        given! { S: turned(&node.transpose(), &self.s) }
    }
}

/// [`ELLIPSOID_N`].
struct Convective<const N: usize> {
    h: f64,
    c0: Square<f64, N>,
    i0: Square<f64, N>,
    a: f64,
    d: f64,
}

impl<const N: usize> DiscreteAction<N, 1> for Convective<N> {
    fn edge<T: Number>(&self, tail: &[Square<T, N>; 1], head: &[Square<T, N>; 1]) -> Vec<T> {
        let (c0, i0) = (
            Square::<T, N>::constant(&self.c0),
            Square::<T, N>::constant(&self.i0),
        );
        let change = head[0] - tail[0];
        let potential = |q: &Square<T, N>| {
            let c = q.transpose() * c0 * *q;
            T::constant(self.a) * c.trace() - T::constant(self.d / 2.0) * c.determinant().ln()
        };
        let mean = (potential(&tail[0]) + potential(&head[0])) * T::constant(0.5);
        vec![
            (c0 * change * i0 * change.transpose()).trace() * T::constant(0.5 / self.h),
            -T::constant(self.h) * mean,
        ]
    }
}

impl<const N: usize> System<N> for Convective<N> {
    fn draw(source: &mut Source, h: f64) -> Self {
        Self {
            h,
            c0: source.positive(),
            i0: source.positive(),
            a: source.between(0.2, 0.6),
            d: source.between(0.2, 0.6),
        }
    }
    fn node(source: &mut Source) -> Square<f64, N> {
        source.invertible()
    }
    fn basis() -> Vec<Square<f64, N>> {
        clebsch_oracle::oracle::action::elastic::entries()
    }
    const STATED: [&'static str; 3] = [ELLIPSOID_N, "Q", "body_momentum"];
    fn h(&self) -> f64 {
        self.h
    }
    fn parameters(&self) -> Given {
        given! { C0: self.c0, I0: self.i0, a: self.a, d: self.d }
    }
}

/// [`ELLIPSOID2`].
struct Planar {
    h: f64,
    c0: Square<f64, 2>,
    i0: Square<f64, 2>,
}

impl DiscreteAction<2, 1> for Planar {
    fn side(&self) -> Side {
        Side::Space
    }
    fn edge<T: Number>(&self, tail: &[Square<T, 2>; 1], head: &[Square<T, 2>; 1]) -> Vec<T> {
        let (c0, i0) = (
            Square::<T, 2>::constant(&self.c0),
            Square::<T, 2>::constant(&self.i0),
        );
        let change = head[0] - tail[0];
        let potential = |q: &Square<T, 2>| (*q * i0 * q.transpose()).trace();
        let mean = (potential(&tail[0]) + potential(&head[0])) * T::constant(0.5);
        vec![
            (c0 * change * i0 * change.transpose()).trace() * T::constant(0.5 / self.h),
            -T::constant(self.h) * mean,
        ]
    }
}

impl System<2> for Planar {
    fn draw(source: &mut Source, h: f64) -> Self {
        Self {
            h,
            c0: source.positive(),
            i0: source.positive(),
        }
    }
    fn node(source: &mut Source) -> Square<f64, 2> {
        source.invertible()
    }
    fn basis() -> Vec<Square<f64, 2>> {
        clebsch_oracle::oracle::action::elastic::entries()
    }
    const STATED: [&'static str; 3] = [ELLIPSOID2, "Q", "spatial_momentum"];
    fn h(&self) -> f64 {
        self.h
    }
    fn parameters(&self) -> Given {
        given! { C0: self.c0, I0: self.i0 }
    }
}

/// Checks residuals at points that solve nothing, and steps that solve the equations.
fn agrees<const N: usize, S: System<N>>() {
    let mut source = Source::seeded(11);
    let model = TextModel::read(S::STATED[0]);
    let model = match model.card.dimensions {
        [] => model,
        _ => model.of_size(N),
    };
    let derived = DerivedResidual::of(model.card);
    let basis = S::basis();
    let mut worst = [0.0f64; 4];
    let mut keep = |slot: usize, expected: &[f64], found: &[f64], allowance: f64, limit: f64| {
        for (i, found) in found.iter().enumerate() {
            // Components beyond the coordinates are zero.
            let expected = expected.get(i).copied().unwrap_or(0.0);
            let off = (expected - found).abs() / allowance;
            assert!(
                off <= limit,
                "{slot}: off by {off:e}: {expected:e}, {found:e}"
            );
            worst[slot] = worse(worst[slot], off);
        }
        assert!(found.len() >= expected.len());
    };
    for _ in 0..POINTS {
        let h = source.between(0.1, 1.0);
        let system = S::draw(&mut source, h);
        let nodes = from_fn(|_| S::node(&mut source));
        let oracle = stationarity(&system, &nodes.map(|n| [n]), &basis);
        keep(
            0,
            &oracle.derivative,
            &derived.at(h, &system.parameters(), &nodes.map(|n| system.at(&n))),
            oracle.scale,
            AGREEMENT,
        );
    }
    let (mut done, mut refused) = (0, 0);
    while done < POINTS {
        let h = source.between(0.01, 0.05);
        let system = S::draw(&mut source, h);
        let start = S::node(&mut source);
        let momentum: Vec<f64> = basis.iter().map(|_| source.between(-0.5, 0.5)).collect();
        let Some(Steps { nodes, momenta }) = system.two_steps(&model, &start, &momentum) else {
            refused += 1;
            assert!(
                refused * 20 <= POINTS,
                "{refused} of {done} states are refused"
            );
            continue;
        };
        done += 1;
        let three = nodes.map(|n| [n]);
        let residual = stationarity(&system, &three, &basis);
        let sensitive = sensitivity(&three, &basis, |n| {
            stationarity(&system, n, &basis).derivative
        });
        let zero = vec![0.0; basis.len()];
        keep(
            1,
            &residual.derivative,
            &zero,
            residual.scale + sensitive,
            ROUNDING,
        );
        let edge = [three[0], three[1]];
        let out = momentum_out(&system, &edge[0], &edge[1], &basis);
        let sensitive = sensitivity(&edge, &basis, |[t, h]| {
            momentum_out(&system, t, h, &basis).derivative
        });
        keep(
            2,
            &out.derivative,
            &momenta[0],
            out.scale + sensitive,
            ROUNDING,
        );
        let into = momentum_in(&system, &edge[0], &edge[1], &basis);
        let sensitive = sensitivity(&edge, &basis, |[t, h]| {
            momentum_in(&system, t, h, &basis).derivative
        });
        keep(
            3,
            &into.derivative,
            &momenta[1],
            into.scale + sensitive,
            ROUNDING,
        );
    }
    println!("worst {worst:?}, {refused} refused");
}

#[test]
fn body_in_four_dimensions() {
    agrees::<4, Body>();
}

#[test]
fn tops_of_two_to_five_dimensions() {
    agrees::<2, Top<2>>();
    agrees::<3, Top<3>>();
    agrees::<4, Top<4>>();
    agrees::<5, Top<5>>();
}

#[test]
fn bodies_seen_from_space() {
    agrees::<3, Spatial<3>>();
    agrees::<4, Spatial<4>>();
}

#[test]
fn a_lagrangian_without_moser_veselov_form() {
    agrees::<4, Stiff>();
}

#[test]
fn ellipsoids() {
    agrees::<2, Convective<2>>();
    agrees::<3, Convective<3>>();
    agrees::<4, Convective<4>>();
    agrees::<2, Planar>();
}
