//! Random Lagrangians on every group. Compares the interpreted residual program with the variation of the unreduced action at
//! random points that solve nothing, and checks that every mutant of the program disagrees at some of them.

use super::mutants::{Judged, survivors};
use super::oracle_bridge::{AGREEMENT, assignment};
use clebsch_core::{Derivation, derive_source};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::wide::model::Family;
use clebsch_oracle::oracle::wide::{Model, Point};
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::sizes::MUTANT_POINTS;
use std::array::from_fn;
use std::panic::catch_unwind;

/// Random points per Lagrangian: three times the number that detects all mutants of all Lagrangians.
const POINTS: usize = 3 * MUTANT_POINTS;

/// A random point with the oracle's variation.
fn judged(model: &Model, source: &mut Source) -> Judged {
    let step = source.between(0.2, 1.0);
    let point = Point::draw(model, source, step);
    let nodes = from_fn(|_| point.node(source));
    Judged {
        given: point.given(&nodes),
        step: (model.style.step, step),
        oracle: point.stationarity(&nodes),
    }
}

/// The largest disagreement of a Lagrangian, or an error message.
fn found(derivation: &Derivation, model: &Model, seed: u64) -> Result<f64, String> {
    let mut source = Source::seeded(seed ^ 0x5eed);
    let mut worst: f64 = 0.0;
    for point in 0..POINTS {
        let Judged {
            given,
            step,
            oracle,
        } = judged(model, &mut source);
        let engine = derivation
            .residual(&assignment(&given, step))
            .map_err(|error| format!("cannot be evaluated: {error}"))?;
        let difference = oracle.disagreement(&engine);
        if difference > AGREEMENT {
            return Err(format!(
                "point {point}: off by {difference:e} of {:e}\noracle {:?}\nengine {engine:?}",
                oracle.scale, oracle.derivative
            ));
        }
        worst = worse(worst, difference);
    }
    Ok(worst)
}

/// The number of mutants, all detected, or an error message.
fn mutated(derivation: &Derivation, model: &Model, seed: u64) -> Result<usize, String> {
    let mut source = Source::seeded(seed ^ 0xface);
    let points: Vec<Judged> = (0..MUTANT_POINTS)
        .map(|_| judged(model, &mut source))
        .collect();
    match survivors(derivation, &points) {
        (0, _) => Err("has no mutants".to_owned()),
        (count, alive) if alive.is_empty() => Ok(count),
        (_, alive) => Err(format!("is not changed by\n{}", alive.join("\n"))),
    }
}

/// The largest disagreement of a model and the number of its mutants, or an error message.
pub fn judge(model: &Model, seed: u64) -> Result<(f64, usize), String> {
    let derivation =
        derive_source(&model.text()).map_err(|errors| format!("is refused:\n{errors}"))?;
    let worst = found(&derivation, model, seed)?;
    // For rotations in dimensions other than three, programs contain summands on which no residual component depends.
    match model
        .bodies
        .iter()
        .any(|b| matches!(b.family, Family::Rotation(n) if n != 3))
    {
        true => Ok((worst, 0)),
        false => Ok((worst, mutated(&derivation, model, seed)?)),
    }
}

/// Fails if a Lagrangian of these seeds disagrees with the oracle, or if one of its mutants agrees.
pub fn agree_and_their_mutants_do_not(seeds: impl Iterator<Item = u64>) {
    let mut failures = Vec::new();
    let (mut worst, mut count): (f64, usize) = (0.0, 0);
    for seed in seeds {
        // A panic for one seed must not hide the failures of others.
        let failure = match catch_unwind(|| judge(&Model::of_seed(seed), seed)) {
            Ok(Ok((difference, mutants))) => {
                worst = worse(worst, difference);
                count += mutants;
                continue;
            }
            Ok(Err(failure)) => failure,
            Err(_) => "panics".to_owned(),
        };
        let text = Model::of_seed(seed).text();
        failures.push(format!("seed {seed}\n{text}\n{failure}"));
    }
    println!("worst {worst:e}, {count} mutants");
    assert!(
        failures.is_empty(),
        "{} failed\n{}",
        failures.len(),
        failures.join("\n\n")
    );
}
