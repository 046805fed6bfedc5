//! Models on SO(n) and GL(n), tested through their statements alone: fixed and named sizes, forcing by advected quantities,
//! Lagrangians without Moser-Veselov form.

use clebsch::nalgebra::{SMatrix, SVector};
use clebsch::{BodyMomentumMatrix, Linear, Orthogonal, SpatialMomentumMatrix};
use clebsch_oracle::oracle::action::{
    DiscreteAction, Side, momentum_in, momentum_out, sensitivity, stationarity,
};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{Square, dot};
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

clebsch::model! {
    /// Body in four dimensions.
    model Body4 {
        param C: Mat<4>;
        group Λ: SO<4> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(C^T*Ω)/h;
    }
}

clebsch::model! {
    /// Body of any dimension, in a field that is linear in a direction.
    model TopN {
        dim n in 2..=5;
        param J: Sym<n>;
        param g: Vec<n>;
        param z: Vec<n>;
        group Λ: SO<n> velocity Ω;
        advected Γ: Vec<n> = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(g, Γ);
    }
}

clebsch::model! {
    /// A body of any dimension in the space frame, with advected inertia.
    model SpatialN {
        dim n in 3..=4;
        param K: Sym<n>;
        group Λ: SO<n> velocity ω;
        advected J: Sym<n>;
        constraint next(Λ) = ω*Λ;
        constraint next(J) = ω*J*ω^T;
        lagrangian = -tr(ω*J)/h - h*tr(K*J);
    }
}

clebsch::model! {
    /// A Lagrangian that is not linear in the velocity.
    model Stiff4 {
        param J: Sym<4>;
        param c: Real;
        group Λ: SO<4> velocity Ω;
        advected S: Sym<4>;
        constraint next(Λ) = Λ*Ω;
        constraint next(S) = Ω^T*S*Ω;
        lagrangian = -tr(J*Ω)/h + c*tr(Ω*J*Ω*J)/h - h*tr(J*S);
    }
}

clebsch::model! {
    /// Elastic ellipsoid, convective.
    model EllipsoidN {
        dim n in 2..=4;
        param C0, I0: Sym<n>;
        param a, d: Real;
        group Q: GL<n> velocity G;
        advected C: Sym<n> = Q^T*C0*Q;
        constraint next(Q) = Q*G;
        constraint next(C) = G^T*C*G;
        lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*(a*tr(C) - (d/2)*log(det(C)));
    }
}

clebsch::model! {
    /// Elastic ellipsoid in the plane, spatial.
    model Ellipsoid2 {
        param C0, I0: Sym<2>;
        group Q: GL<2> velocity γ;
        advected S: Sym<2> = Q*I0*Q^T;
        constraint next(Q) = γ*Q;
        constraint next(S) = γ*S*γ^T;
        lagrangian = tr(C0*(γ - Id)*S*(γ - Id)^T)/(2*h) - h*tr(S);
    }
}

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
    fn draw(source: &mut Source, h: f64) -> Self;
    /// A random configuration.
    fn node(source: &mut Source) -> Square<f64, N> {
        source.orthogonal()
    }
    /// The basis of the Lie algebra.
    fn basis() -> Vec<Square<f64, N>> {
        planes()
    }
    /// The emitted residual.
    fn residual(&self, nodes: &[Square<f64, N>; 3]) -> Vec<f64>;
    /// Two emitted steps from a node and the coordinates of its momentum.
    fn two_steps(&self, start: &Square<f64, N>, momentum: &[f64]) -> Option<Steps<N>>;
}

/// Three nodes from emitted code, and the momenta at the first two.
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

fn matrix<const N: usize>(a: &Square<f64, N>) -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|i, j| a.0[i][j])
}

fn square<const N: usize>(a: SMatrix<f64, N, N>) -> Square<f64, N> {
    Square::from_entries(|i, j| a[(i, j)])
}

fn skew<const N: usize>(coordinates: &[f64]) -> SMatrix<f64, N, N> {
    let basis = planes::<N>();
    let terms = basis.iter().zip(coordinates).map(|(b, x)| matrix(b) * *x);
    terms.sum()
}

fn coordinates<const N: usize>(skew: &SMatrix<f64, N, N>) -> Vec<f64> {
    let pairs = (0..N).flat_map(|i| (i + 1..N).map(move |j| (i, j)));
    pairs.map(|(i, j)| skew[(j, i)]).collect()
}

fn entries<const N: usize>(a: &SMatrix<f64, N, N>) -> Vec<f64> {
    a.transpose().as_slice().to_vec()
}

fn kinetic<T: Number, const N: usize>(
    c: &Square<f64, N>,
    tail: &Square<T, N>,
    head: &Square<T, N>,
    h: f64,
) -> T {
    -(Square::<T, N>::constant(c).transpose() * tail.transpose() * *head).trace() / T::constant(h)
}

/// Implements `residual` and `two_steps` with the emitted model.
macro_rules! emitted {
    ($model:ident, $parameters:ident, $configuration:ident, $initial:ident, $group:ident,
     $element:ident, $momentum:ident: $frame:ident, $read:ident, $write:ident, $n:expr,
     |$this:ident| { $($field:ident: $value:expr),* }, |$node:ident, $at:ident| { $($kept:ident: $kept_value:expr),* }) => {
        fn residual(&self, nodes: &[Square<f64, $n>; 3]) -> Vec<f64> {
            let $this = self;
            let model = $model::new($parameters { $($field: $value),* }).expect("parameters");
            let [before, here, after] = nodes.map(|node| {
                let ($node, $at) = (&node, self);
                let _ = ($node, $at);
                $configuration {
                    $group: $element::from_matrix(&matrix($node)).expect("an element"),
                    $($kept: $kept_value,)*
                }
            });
            model.balance(self.h, &before, &here, &after).as_slice().to_vec()
        }

        fn two_steps(&self, start: &Square<f64, $n>, momentum: &[f64]) -> Option<Steps<$n>> {
            let $this = self;
            let model = $model::new($parameters { $($field: $value),* }).expect("parameters");
            let ($node, $at) = (start, self);
            let _ = ($node, $at);
            let initial = $initial {
                $group: $element::from_matrix(&matrix($node)).expect("an element"),
                $momentum: $frame($read(momentum)),
                $($kept: $kept_value,)*
            };
            let (mut state, mut work) = model.start(initial, self.h).ok()?;
            let mut nodes = [square(state.$group().matrix()); 3];
            model.step(&mut state, &mut work).ok()?;
            nodes[1] = square(state.$group().matrix());
            let second = $write(&state.$momentum().0);
            model.step(&mut state, &mut work).ok()?;
            nodes[2] = square(state.$group().matrix());
            Some(Steps { nodes, momenta: [momentum.to_vec(), second] })
        }
    };
}

fn general<const N: usize>(numbers: &[f64]) -> SMatrix<f64, N, N> {
    SMatrix::from_row_slice(numbers)
}

/// [`Body4`].
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
    emitted!(
        Body4, Body4Parameters, Body4Configuration, Body4Initial, Λ, Orthogonal,
        body_momentum: BodyMomentumMatrix, skew, coordinates, 4,
        |this| { C: matrix(&this.c) }, |node, at| {}
    );
}

/// [`TopN`].
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
    emitted!(
        TopN, TopNParameters, TopNConfiguration, TopNInitial, Λ, Orthogonal,
        body_momentum: BodyMomentumMatrix, skew, coordinates, N,
        |this| { J: matrix(&this.j), g: SVector::from(this.g), z: SVector::from(this.z) },
        |node, at| {}
    );
}

/// [`SpatialN`]: the inertia at the identity is `j`.
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
    emitted!(
        SpatialN, SpatialNParameters, SpatialNConfiguration, SpatialNInitial, Λ, Orthogonal,
        spatial_momentum: SpatialMomentumMatrix, skew, coordinates, N,
        |this| { K: matrix(&this.k) },
        |node, at| { J: carried(node, &at.j) }
    );
}

/// `Λ J Λ^T`, exactly symmetric.
fn carried<const N: usize>(node: &Square<f64, N>, j: &Square<f64, N>) -> SMatrix<f64, N, N> {
    let value = matrix(&(*node * *j * node.transpose()));
    (value + value.transpose()) * 0.5
}

/// [`Stiff4`]: the advected matrix at the identity is `s`.
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
    emitted!(
        Stiff4, Stiff4Parameters, Stiff4Configuration, Stiff4Initial, Λ, Orthogonal,
        body_momentum: BodyMomentumMatrix, skew, coordinates, 4,
        |this| { J: matrix(&this.j), c: this.c },
        |node, at| { S: carried(&node.transpose(), &at.s) }
    );
}

/// [`EllipsoidN`].
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
    emitted!(
        EllipsoidN, EllipsoidNParameters, EllipsoidNConfiguration, EllipsoidNInitial, Q, Linear,
        body_momentum: BodyMomentumMatrix, general, entries, N,
        |this| { C0: matrix(&this.c0), I0: matrix(&this.i0), a: this.a, d: this.d },
        |node, at| {}
    );
}

/// [`Ellipsoid2`].
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
    emitted!(
        Ellipsoid2, Ellipsoid2Parameters, Ellipsoid2Configuration, Ellipsoid2Initial, Q, Linear,
        spatial_momentum: SpatialMomentumMatrix, general, entries, 2,
        |this| { C0: matrix(&this.c0), I0: matrix(&this.i0) },
        |node, at| {}
    );
}

/// Checks residuals at points that solve nothing, and steps that solve the equations.
fn agrees<const N: usize, S: System<N>>() {
    let mut source = Source::seeded(11);
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
            &system.residual(&nodes),
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
        let Some(Steps { nodes, momenta }) = system.two_steps(&start, &momentum) else {
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
