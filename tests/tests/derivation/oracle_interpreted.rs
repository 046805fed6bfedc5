//! The engine's residual program, interpreted, against the variation of the unreduced action.
//! Takes hand-typed systems and random Lagrangians at random points that solve nothing; gives agreement
//! to 1e-10 relative to the sum of the sizes of the summands.

use super::oracle_bridge::{AGREEMENT, assignment, disagreement};
use clebsch_core::derive_source;
use clebsch_oracle::oracle::action::bodies::{
    FourDimensional, FreeBody, HeavyTop, QuadraticField, Stated, TwoVectors,
};
use clebsch_oracle::oracle::action::coupled::CoupledBodies;
use clebsch_oracle::oracle::action::elastic::{EllipsoidConvective, EllipsoidSpatial, entries};
use clebsch_oracle::oracle::action::spatial::{FreeBodySpatial, HeavyTopSpatial};
use clebsch_oracle::oracle::action::{Side, rotations, stationarity};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::random::RandomLagrangian;
use clebsch_oracle::oracle::random::sample::Sample;
use clebsch_oracle::oracle::random::tree::{Kind, Role};
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;
use std::panic::catch_unwind;

/// Random points for every system and every random Lagrangian.
const POINTS: usize = 1000;
/// Random Lagrangians: well beyond a hundred of them have advected vectors or symmetric matrices.
const LAGRANGIANS: u64 = 160;

fn agrees<const N: usize, const G: usize, S: Stated<N, G>>(basis: &[Square<f64, N>]) {
    let text = S::text();
    let derivation = match derive_source(&text) {
        Ok(derivation) => derivation,
        Err(errors) => panic!("{text}\nis refused:\n{errors}"),
    };
    let mut source = Source::seeded(2);
    let mut worst: f64 = 0.0;
    for point in 0..POINTS {
        let system = S::random(&mut source);
        let nodes: [[Square<f64, N>; G]; 3] = from_fn(|_| S::node(&mut source));
        let oracle = stationarity(&system, &nodes, basis);
        let values = assignment(&system.given(&nodes), ("h", system.step()));
        let engine = match derivation.residual(&values) {
            Ok(engine) => engine,
            Err(error) => panic!("{text}\ncannot be evaluated: {error}"),
        };
        let difference = disagreement(&oracle, &engine);
        worst = worse(worst, difference);
        assert!(
            difference <= AGREEMENT,
            "{text}\npoint {point}: off by {difference:e} of {:e}\noracle {:?}\nengine {engine:?}",
            oracle.scale,
            oracle.derivative
        );
    }
    println!("worst {worst:e}");
}

/// `E_ji - E_ij` for `i < j`: the basis of the Lie algebra of SO(n) beyond three dimensions.
fn planes<const N: usize>() -> Vec<Square<f64, N>> {
    let mut basis = Vec::new();
    for i in 0..N {
        for j in i + 1..N {
            basis.push(Square::from_entries(|row, column| {
                if (row, column) == (j, i) {
                    1.0
                } else if (row, column) == (i, j) {
                    -1.0
                } else {
                    0.0
                }
            }));
        }
    }
    basis
}

#[test]
fn free_body() {
    agrees::<3, 1, FreeBody>(&rotations());
}

#[test]
fn heavy_top_under_every_rule_of_the_nodes() {
    agrees::<3, 1, HeavyTop<0>>(&rotations());
    agrees::<3, 1, HeavyTop<1>>(&rotations());
    agrees::<3, 1, HeavyTop<2>>(&rotations());
}

#[test]
fn heavy_top_scaled_as_in_the_thesis() {
    agrees::<3, 1, HeavyTop<0, true>>(&rotations());
}

#[test]
fn body_in_a_quadratic_field() {
    agrees::<3, 1, QuadraticField>(&rotations());
}

#[test]
fn two_advected_vectors() {
    agrees::<3, 1, TwoVectors>(&rotations());
}

#[test]
fn coupled_bodies() {
    agrees::<3, 2, CoupledBodies<true>>(&rotations());
}

#[test]
fn coupled_bodies_without_definition() {
    agrees::<3, 2, CoupledBodies<false>>(&rotations());
}

#[test]
fn free_body_spatial() {
    agrees::<3, 1, FreeBodySpatial>(&rotations());
}

#[test]
fn heavy_top_spatial() {
    agrees::<3, 1, HeavyTopSpatial>(&rotations());
}

#[test]
fn body_of_four_dimensions() {
    agrees::<4, 1, FourDimensional>(&planes());
}

#[test]
fn ellipsoid_convective() {
    agrees::<3, 1, EllipsoidConvective<3>>(&entries());
}

#[test]
fn ellipsoid_spatial() {
    agrees::<3, 1, EllipsoidSpatial>(&entries());
}

/// The worst disagreement of a random Lagrangian, or what went wrong.
fn random_disagreement(seed: u64) -> Result<f64, String> {
    let lagrangian = RandomLagrangian::of_seed(seed);
    let text = lagrangian.text();
    let derivation = derive_source(&text)
        .map_err(|errors| format!("seed {seed}\n{text}\nis refused:\n{errors}"))?;
    let mut source = Source::seeded(seed ^ 0x5eed);
    let mut worst: f64 = 0.0;
    for point in 0..POINTS {
        let sample = Sample::draw(&lagrangian, &mut source);
        let nodes = from_fn(|_| [source.orthogonal()]);
        let oracle = stationarity(&sample, &nodes, &rotations());
        let values = assignment(&sample.given(&nodes), (lagrangian.step, sample.step));
        let engine = derivation
            .residual(&values)
            .map_err(|error| format!("seed {seed}\n{text}\ncannot be evaluated: {error}"))?;
        let difference = disagreement(&oracle, &engine);
        if difference > AGREEMENT {
            return Err(format!(
                "seed {seed}\n{text}\npoint {point}: off by {difference:e} of {:e}\noracle {:?}\nengine {engine:?}",
                oracle.scale, oracle.derivative
            ));
        }
        worst = worse(worst, difference);
    }
    Ok(worst)
}

fn random_lagrangians_agree(seeds: impl Iterator<Item = u64>) {
    let mut failures = Vec::new();
    let mut worst: f64 = 0.0;
    for seed in seeds {
        // A panic of one seed must not hide what is wrong with the others.
        match catch_unwind(|| random_disagreement(seed)) {
            Ok(Ok(difference)) => worst = worse(worst, difference),
            Ok(Err(failure)) => failures.push(failure),
            Err(_) => failures.push(format!(
                "seed {seed}\n{}\npanics",
                RandomLagrangian::of_seed(seed).text()
            )),
        }
    }
    println!("worst {worst:e}");
    assert!(
        failures.is_empty(),
        "{} failed\n{}",
        failures.len(),
        failures.join("\n\n")
    );
}

#[test]
fn random_lagrangians_of_even_seeds() {
    random_lagrangians_agree((0..LAGRANGIANS).step_by(2));
}

#[test]
fn random_lagrangians_of_odd_seeds() {
    random_lagrangians_agree((1..LAGRANGIANS).step_by(2));
}

/// Lagrangians further on whose derivations once went wrong: a determinant of a singular matrix, whose
/// derivative is its adjugate and not the determinant times an inverse.
#[test]
fn random_lagrangians_that_were_hard() {
    random_lagrangians_agree([1384].into_iter());
}

#[test]
fn more_than_a_hundred_carry_vectors_or_symmetric_matrices() {
    let (mut vectors, mut matrices, mut either, mut spatial) = (0, 0, 0, 0);
    for seed in 0..LAGRANGIANS {
        let lagrangian = RandomLagrangian::of_seed(seed);
        let carries = |kind: Kind| {
            lagrangian
                .symbols
                .iter()
                .enumerate()
                .any(|(index, symbol)| {
                    symbol.kind == kind
                        && matches!(symbol.role, Role::Advected { .. })
                        && lagrangian.uses(index)
                })
        };
        let (vector, matrix) = (carries(Kind::Vector), carries(Kind::Symmetric));
        vectors += usize::from(vector);
        matrices += usize::from(matrix);
        either += usize::from(vector || matrix);
        spatial += usize::from(lagrangian.side == Side::Space);
    }
    println!("vectors {vectors}, symmetric {matrices}, either {either}, spatial {spatial}");
    assert!(either >= 100 && vectors >= 50 && matrices >= 50 && spatial >= 20);
}
