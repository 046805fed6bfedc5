//! The engine's residual program, interpreted, against the variation of the unreduced action. Covers hand-written systems and a few
//! random Lagrangians at random points that solve nothing; requires agreement to 1e-10, relative to the sum of the absolute
//! summands.

use super::common::lagrangians::{agree_and_their_mutants_do_not, judge};
use super::common::oracle_bridge::{AGREEMENT, assignment};
use clebsch_core::derive_source;
use clebsch_oracle::oracle::action::bodies::{
    FourDimensional, FreeBody, HeavyTop, QuadraticField, Stated, TwoVectors,
};
use clebsch_oracle::oracle::action::coupled::CoupledBodies;
use clebsch_oracle::oracle::action::elastic::{EllipsoidConvective, EllipsoidSpatial, entries};
use clebsch_oracle::oracle::action::spatial::{FreeBodySpatial, HeavyTopSpatial};
use clebsch_oracle::oracle::action::{rotations, stationarity};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::sides::Side;
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::oracle::wide::Model;
use clebsch_oracle::oracle::wide::model::{Action, Family, Kind, Role};
use clebsch_oracle::oracle::wide::tree::Tree;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::sizes::{DERIVED_QUICKLY, POINTS};
use std::array::from_fn;

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
        let difference = oracle.disagreement(&engine);
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

/// One model of every group and product of groups; `tests/tests/many_models/` tests more.
#[test]
fn random_lagrangians() {
    agree_and_their_mutants_do_not(0..DERIVED_QUICKLY);
}

/// The derivative of a determinant is its adjugate. For a singular matrix, the determinant times an inverse is not defined.
#[test]
fn the_determinant_of_a_singular_matrix() {
    let mut model = Model::of("Singular".to_owned(), &[(Family::Rotation(3), Side::Space)]);
    let role = Role::Advected {
        body: 0,
        action: Action::Forward,
        turns: false,
        definition: None,
    };
    let carried = model.add("q", Kind::Vector(3), role);
    let j = model.parameter(Kind::Positive(3));
    let skew = Tree::call("hat", model.letter(carried)).plus(model.parameter(Kind::Skew(3)));
    let kinetic = Tree::call("tr", j.times(model.letter(model.bodies[0].element + 1)));
    model.summands = vec![
        (true, kinetic.over(Tree::Step)),
        (false, Tree::Step.times(Tree::call("det", skew))),
    ];
    let (worst, _) = judge(&model, 1384).unwrap_or_else(|why| panic!("{why}"));
    assert!(worst <= AGREEMENT, "{worst:e}");
}
