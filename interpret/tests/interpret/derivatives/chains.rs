//! Chains, stepped by loops over sites: tangents against differences, gradients against products of tangents.

use super::differences::{NEAR, off_by, slope};
use super::gallery::{Last, by_tangents};
use crate::lattices::{BEADS, SINE_GORDON, TOPS, card, values};
use clebsch::card::{Card, Settings};
use clebsch::derivatives::Derivatives;
use nalgebra::{DMatrix, DVector};

/// Sites of a label: too many to expand a chain body by body.
const SITES: usize = 40;

/// The steps of a run whose gradient is taken.
const STEPS: u64 = 5;

fn open(card: &Card, of: &dyn Fn(&str, Option<usize>) -> Vec<f64>, h: f64) -> Box<dyn Derivatives> {
    let [parameters, initial] = [card.parameters, card.initial].map(|fields| values(fields, of));
    let differentiate = card.differentiate.expect("a model from its text");
    differentiate(&parameters, &initial, Settings::step(h)).expect("a chain that starts")
}

/// Compares derivatives of a chain.
fn compare(mut flow: Box<dyn Derivatives>) {
    let name = flow.card().name;
    let n: usize = flow.dimensions().iter().sum();
    assert!(n > SITES, "{name} has {n} coordinates");
    let mut at = flow.start();
    for _ in 0..3 {
        at = flow.step(&at).expect("a step");
    }
    let (next, tangent) = flow.tangent(&at).expect("a tangent");
    let tangent = DMatrix::from_column_slice(n, n, &tangent.entries);
    for seed in [1.0, 2.0] {
        let along = DVector::from_fn(n, |i, _| (seed * 1.7 * (i as f64 + 1.0)).sin());
        let mut stepped = |d: f64| {
            let by: Vec<f64> = along.iter().map(|x| x * d).collect();
            let moved = flow.moved(&at, &by).expect("a state nearby");
            let moved = flow.step(&moved).expect("a step");
            flow.difference(&next, &moved).expect("coordinates")
        };
        let expected = slope(&mut stepped, 1e-3);
        let off = off_by((&tangent * along).as_slice(), &expected);
        assert!(off < NEAR, "{name}: {off:e}");
    }
    let gradient = flow.gradient(STEPS, &mut Last(STEPS)).expect("a gradient");
    // Rounding of five products of matrices.
    let off = off_by(&gradient.initial.concat(), &by_tangents(&mut *flow, STEPS));
    assert!(off < 1e-12, "{name}: {off:e}");
}

#[test]
fn a_chain_with_prescribed_ends_has_derivatives() {
    let read = card(SINE_GORDON, SITES, false, ["pinned", "pinned"]);
    let value = |name: &str, site: Option<usize>| {
        vec![match name {
            "s" => 0.1,
            "k" => 1.3,
            "w" => 0.1,
            "u" => (0.2 * site.unwrap_or(0) as f64).sin(),
            _ => 0.01,
        }]
    };
    compare(open(&read, &value, 0.05));
}

#[test]
fn a_chain_of_bodies_has_derivatives() {
    let read = card(TOPS, SITES, false, ["free", "free"]);
    let value = |name: &str, site: Option<usize>| match name {
        "s" => vec![1.0],
        "J" => vec![0.5, 0.0, 0.0, 0.0, 0.6, 0.0, 0.0, 0.0, 0.9],
        "C" => vec![0.4, 0.0, 0.0, 0.0, 0.3, 0.0, 0.0, 0.0, 0.2],
        "gU" | "z" => vec![0.0, 0.0, 1.0],
        name if name.starts_with("Lambda") => {
            let angle = 0.1 * site.unwrap_or(0) as f64;
            let (sin, cos) = angle.sin_cos();
            vec![cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0]
        }
        _ => vec![0.1, 0.02 * site.unwrap_or(0) as f64, 1.0],
    };
    compare(open(&read, &value, 0.05));
}

#[test]
fn a_ring_whose_velocities_are_coupled_has_derivatives() {
    let read = card(BEADS, SITES, true, ["free", "free"]);
    let value = |name: &str, site: Option<usize>| {
        let turn = site.unwrap_or(0) as f64;
        vec![match name {
            "m" | "k" => 1.0,
            "x" => (1.3 * turn).sin(),
            "q" => 0.0,
            "momentum_x" => 0.2,
            _ => 1.0 + 0.1 * turn,
        }]
    };
    compare(open(&read, &value, 0.05));
}
