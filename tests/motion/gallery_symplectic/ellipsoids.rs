//! Ellipsoids on GL(n): the symplectic defect of one step of a case at a random state.

use super::number;
use crate::seeded::Seeded;
use clebsch::nalgebra::SMatrix;
use clebsch::{BodyMomentumMatrix, Dual, Linear, SpatialMomentumMatrix};
use clebsch_models::Case;
use clebsch_oracle::physics::random_states::Draws;
use clebsch_oracle::physics::symplectic::defect_on_group;

/// Defines the start of an ellipsoid: near the placement of the case, with any small body momentum, which `$seen` converts to the
/// momentum of the model.
macro_rules! ellipsoid {
    ($name:ident, $of_size:ident, $module:ident, $model:ident, $parameters:ident, $initial:ident,
     $momentum:ident, $seen:expr) => {
        fn $of_size<const N: usize>(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
            use clebsch_models::$module::*;
            // The first seeds vary the placement, the others the momentum.
            let seeds = 2 * N * N;
            let square = |values: &[f64]| -> SMatrix<Seeded, N, N> {
                SMatrix::from_fn(|r, c| Dual::constant(values[N * r + c]))
            };
            let random: Vec<f64> = (0..N * N).map(|_| draws.uniform(-0.1, 0.1)).collect();
            let start: Vec<f64> = (0..N * N).map(|_| draws.uniform(-0.4, 0.4)).collect();
            let one = SMatrix::<Seeded, N, N>::identity();
            let change = SMatrix::from_fn(|r, c| Dual::variable(0.0, N * r + c));
            let mu = SMatrix::from_fn(|r, c| Seeded::variable(start[N * r + c], N * N + N * r + c));
            let placement = square(&case.initial[0]) * (one + square(&random)) * (one + change);
            let placement = Linear::from_matrix(&placement).expect("regular");
            let model = $model::<N, Seeded>::new($parameters {
                C0: square(&case.parameters[0]),
                I0: square(&case.parameters[1]),
                a: number(&case.parameters[2]),
                b: number(&case.parameters[3]),
                c: number(&case.parameters[4]),
                d: number(&case.parameters[5]),
            })
            .expect("parameters of a case");
            let initial = $initial {
                Q: placement,
                $momentum: $seen(&placement, mu),
            };
            let longer = Dual::constant(1.0) + Dual::constant(warp) * mu[0];
            let (mut state, mut workspace) = model
                .start(initial, Dual::constant(case.h) * longer)
                .expect("solvable");
            model.step(&mut state, &mut workspace).expect("solvable");
            let (moved, after) = (state.Q().matrix(), state.body_momentum().0);
            let back = state.Q().inverse().matrix().map(|x| x.real);
            let turns: Vec<_> = (0..seeds)
                .map(|seed| back * moved.map(|x| x.dual[seed]))
                .collect();
            let places: Vec<(usize, usize)> = (0..N * N).map(|k| (k / N, k % N)).collect();
            let mut jacobian: Vec<Vec<f64>> = places
                .iter()
                .map(|at| turns.iter().map(|t| t[*at]).collect())
                .collect();
            jacobian.extend(places.iter().map(|at| after[*at].dual[..seeds].to_vec()));
            let after: Vec<f64> = places.iter().map(|at| after[*at].real).collect();
            // tr(mu^T [E_ij, E_kl]).
            let along = |mu: &[f64], a: usize, b: usize| {
                let ((i, j), (k, l)) = (places[a], places[b]);
                let first = if j == k { mu[N * i + l] } else { 0.0 };
                let second = if l == i { mu[N * k + j] } else { 0.0 };
                first - second
            };
            defect_on_group(&jacobian, &start, &after, along)
        }

        pub(super) fn $name(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
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
    |_, mu| BodyMomentumMatrix(mu)
);

ellipsoid!(
    ellipsoid_spatial,
    spatial_of_size,
    ellipsoid_spatial,
    EllipsoidSpatial,
    EllipsoidSpatialParameters,
    EllipsoidSpatialInitial,
    spatial_momentum,
    |q: &Linear<N, Seeded>, mu| {
        let turned: SMatrix<Seeded, N, N> = mu * q.matrix().transpose();
        SpatialMomentumMatrix(q.inverse().matrix().transpose() * turned)
    }
);
