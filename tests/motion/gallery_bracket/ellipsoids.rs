//! Ellipsoids on GL(n): starts a case at a random point, steps once, and returns both nodes.

use super::{Step, length, number, quantity};
use crate::seeded::Seeded;
use clebsch::nalgebra::SMatrix;
use clebsch::{BodyMomentumMatrix, Dual, Linear, SpatialMomentumMatrix};
use clebsch_models::Case;
use clebsch_oracle::physics::random_states::Draws;

/// A symmetric matrix near the identity with independent variations from seed `first`.
fn near_identity<const N: usize>(draws: &mut Draws, first: usize) -> SMatrix<Seeded, N, N> {
    let mut out = SMatrix::<Seeded, N, N>::repeat(Dual::constant(0.0));
    let upper = (0..N).flat_map(|i| (i..N).map(move |j| (i, j)));
    for (k, (i, j)) in upper.enumerate() {
        let one = f64::from(u8::from(i == j));
        out[(i, j)] = Dual::variable(one + draws.uniform(-0.1, 0.1), first + k);
        out[(j, i)] = out[(i, j)];
    }
    out
}

/// `(A + A^T)/2`, exactly symmetric.
fn symmetric<const N: usize>(a: SMatrix<Seeded, N, N>) -> SMatrix<Seeded, N, N> {
    (a + a.transpose()) * Dual::constant(0.5)
}

/// Defines the start of an ellipsoid. Its advected matrix varies independently; `$chosen` computes the parameter, (C0, I0), from
/// the inverse placement and the advected matrix.
macro_rules! ellipsoid {
    ($name:ident, $of_size:ident, $module:ident, $model:ident, $parameters:ident, $initial:ident,
     $momentum:ident, $kind:ident, $advected:ident, $chosen:expr) => {
        fn $of_size<const N: usize>(case: &Case, draws: &mut Draws, warp: f64) -> Step {
            use clebsch_models::$module::*;
            type Matrix<const N: usize> = SMatrix<Seeded, N, N>;
            let mu: Matrix<N> =
                SMatrix::from_fn(|r, c| Dual::variable(draws.uniform(-0.4, 0.4), N * r + c));
            let advected: Matrix<N> = near_identity(draws, N * N);
            let square = |values: &[f64]| -> Matrix<N> {
                SMatrix::from_fn(|r, c| Dual::constant(values[N * r + c]))
            };
            let random: Vec<f64> = (0..N * N).map(|_| draws.uniform(-0.1, 0.1)).collect();
            let placement = square(&case.initial[0]) + square(&random);
            let placement = Linear::from_matrix(&placement).expect("regular");
            let (metric, moments) = (square(&case.parameters[0]), square(&case.parameters[1]));
            let back = placement.inverse().matrix();
            let (metric, moments): (Matrix<N>, Matrix<N>) =
                $chosen(back, advected, metric, moments);
            let model = $model::<N, Seeded>::new($parameters {
                C0: metric,
                I0: moments,
                a: number(&case.parameters[2]),
                b: number(&case.parameters[3]),
                c: number(&case.parameters[4]),
                d: number(&case.parameters[5]),
            })
            .expect("parameters of a case");
            let initial = $initial {
                Q: placement,
                $momentum: $kind(mu),
            };
            let h = length(case, warp, mu[0]);
            let (mut state, mut workspace) = model.start(initial, h).expect("solvable");
            let before = vec![
                quantity(&state.$momentum().0),
                quantity(&model.$advected(&state)),
            ];
            model.step(&mut state, &mut workspace).expect("solvable");
            let after = vec![
                quantity(&state.$momentum().0),
                quantity(&model.$advected(&state)),
            ];
            (before, after)
        }

        pub(super) fn $name(case: &Case, draws: &mut Draws, warp: f64) -> Step {
            match case.parameters[0].len() {
                4 => $of_size::<2>(case, draws, warp),
                9 => $of_size::<3>(case, draws, warp),
                16 => $of_size::<4>(case, draws, warp),
                entries => panic!("no start for {entries} entries"),
            }
        }
    };
}

ellipsoid!(
    ellipsoid_convective,
    convective_of_size,
    ellipsoid_convective,
    EllipsoidConvective,
    EllipsoidConvectiveParameters,
    EllipsoidConvectiveInitial,
    body_momentum,
    BodyMomentumMatrix,
    C,
    |back: Matrix<N>, advected, _, moments| (
        symmetric(back.transpose() * advected * back),
        moments
    )
);

ellipsoid!(
    ellipsoid_spatial,
    spatial_of_size,
    ellipsoid_spatial,
    EllipsoidSpatial,
    EllipsoidSpatialParameters,
    EllipsoidSpatialInitial,
    spatial_momentum,
    SpatialMomentumMatrix,
    S,
    |back: Matrix<N>, advected, metric, _| (metric, symmetric(back * advected * back.transpose()))
);
