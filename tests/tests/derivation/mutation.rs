//! Mutation of residual programs: every summand and its sign matter. Removes or negates one summand of a program at a time; each
//! mutant must disagree with the oracle at some random point. A surviving mutant would be an untested term.

use super::common::mutants::{Judged, survivors};
use super::common::oracle_bridge::{AGREEMENT, assignment};
use clebsch_core::{Derivation, derive_source};
use clebsch_oracle::oracle::action::bodies::{FreeBody, HeavyTop, Stated};
use clebsch_oracle::oracle::action::coupled::CoupledBodies;
use clebsch_oracle::oracle::action::spatial::HeavyTopSpatial;
use clebsch_oracle::oracle::action::{rotations, stationarity};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::sizes::MUTANT_POINTS;
use std::array::from_fn;

fn derive(text: &str) -> Derivation {
    match derive_source(text) {
        Ok(derivation) => derivation,
        Err(errors) => panic!("{text}\nis refused:\n{errors}"),
    }
}

fn every_mutant_is_noticed<const G: usize, S: Stated<3, G>>(least: usize) {
    let text = S::text();
    let derivation = derive(&text);
    let mut source = Source::seeded(3);
    let points: Vec<Judged> = (0..MUTANT_POINTS)
        .map(|_| {
            let system = S::random(&mut source);
            let nodes: [[Square<f64, 3>; G]; 3] = from_fn(|_| S::node(&mut source));
            Judged {
                given: system.given(&nodes),
                step: ("h", system.step()),
                oracle: stationarity(&system, &nodes, &rotations()),
            }
        })
        .collect();
    for point in &points {
        let values = assignment(&point.given, point.step);
        let sound = derivation.residual(&values).unwrap_or_default();
        assert!(point.oracle.disagreement(&sound) <= AGREEMENT, "{text}");
    }
    let (count, alive) = survivors(&derivation, &points);
    println!("{count} mutants");
    assert!(count >= least, "{text}\nhas only {count} mutants");
    assert!(
        alive.is_empty(),
        "{text}\nis not changed by\n{}",
        alive.join("\n")
    );
}

// Minimum counts: two summands of a transport difference, each removed and negated; the top has an additional torque.

#[test]
fn free_body() {
    every_mutant_is_noticed::<1, FreeBody>(4);
}

#[test]
fn heavy_top() {
    every_mutant_is_noticed::<1, HeavyTop<0>>(6);
    every_mutant_is_noticed::<1, HeavyTop<1>>(6);
    every_mutant_is_noticed::<1, HeavyTop<2>>(6);
}

#[test]
fn heavy_top_spatial() {
    every_mutant_is_noticed::<1, HeavyTopSpatial>(6);
}

#[test]
fn coupled_bodies() {
    every_mutant_is_noticed::<2, CoupledBodies<true>>(12);
}
