//! Every model of the gallery: tangents of steps, slopes of observables and invariants, gradients of runs.

use super::differences::{NEAR, columns, off, off_by, slope};
use clebsch::card::{Card, Kind, Settings};
use clebsch::derivatives::{Cost, Derivatives, Seen};
use clebsch_models::{Case, Entry, gallery};
use nalgebra::{DMatrix, DVector};

/// The steps of a run whose gradient is taken.
const STEPS: u64 = 40;

fn read(entry: &Entry, case: &Case) -> Card {
    let card = clebsch_interpret::card(entry.card.source).expect("a model of the gallery");
    let built = entry.card_of(case);
    let sizes: Vec<usize> = built.dimensions.iter().map(|d| d.value).collect();
    (card.sized)(&sizes).expect("a size of the gallery")
}

pub fn open(card: &Card, case: &Case, settings: Settings) -> Box<dyn Derivatives> {
    let differentiate = card.differentiate.expect("a model from its text");
    differentiate(&case.parameters, &case.initial, settings).expect("a case of the gallery")
}

/// The models with their first cases.
pub fn cases(of_each: usize) -> impl Iterator<Item = (Card, Case)> {
    gallery().into_iter().flat_map(move |entry| {
        let cases: Vec<Case> = entry.cases.iter().take(of_each).cloned().collect();
        cases
            .into_iter()
            .map(move |case| (read(&entry, &case), case))
            .collect::<Vec<_>>()
    })
}

/// The weight of an observable in the cost.
fn weight(i: usize) -> f64 {
    1.0 / (1.0 + i as f64)
}

/// A weighted sum of all observables at one node.
pub struct Last(pub u64);

impl Cost for Last {
    fn is_at(&self, node: u64) -> bool {
        node == self.0
    }

    fn weigh(&mut self, _: u64, _: &Seen<'_>, weights: &mut [f64], _: &mut [f64]) {
        for (i, w) in weights.iter_mut().enumerate() {
            *w += weight(i);
        }
    }
}

/// The cost of a run.
fn cost(flow: &mut dyn Derivatives, steps: u64) -> f64 {
    let mut at = flow.start();
    for _ in 0..steps {
        at = flow.step(&at).expect("a step");
    }
    let seen = flow.observe(&at).expect("observables");
    seen.iter().enumerate().map(|(i, x)| weight(i) * x).sum()
}

#[test]
fn tangents_and_slopes_are_limits_of_differences() {
    for (card, case) in cases(2) {
        let mut flow = open(&card, &case, Settings::step(case.h));
        let mut at = flow.start();
        for _ in 0..3 {
            at = flow.step(&at).expect("a step");
        }
        let (next, tangent) = flow.tangent(&at).expect("a tangent");
        let steps = columns(&mut *flow, &at, &mut |flow, x| {
            let y = flow.step(x).expect("a step");
            flow.difference(&next, &y).expect("coordinates")
        });
        let observed = flow.observed(&at).expect("slopes");
        let seen = columns(&mut *flow, &at, &mut |flow, x| {
            flow.observe(x).expect("observables")
        });
        let conserved = flow.conserved(&at).expect("slopes");
        let invariants = columns(&mut *flow, &at, &mut |flow, x| {
            flow.invariants(x).expect("invariants")
        });
        let all = [
            off(&tangent, &steps),
            off(&observed, &seen),
            off(&conserved, &invariants),
        ];
        assert!(
            all.iter().all(|x| *x < NEAR),
            "{} {}: {all:?}",
            card.name,
            case.name
        );
    }
}

#[test]
fn curvatures_are_limits_of_differences_of_slopes() {
    for (card, case) in cases(1) {
        let mut flow = open(&card, &case, Settings::step(case.h));
        let at = flow.start();
        let count = card.invariant_count();
        let weights: Vec<f64> = (0..count).map(weight).collect();
        let bent = flow.curvature(&at, &weights).expect("a curvature");
        assert_eq!([bent.rows, bent.cols], [flow.start_dimension(); 2]);
        // Second differences lose half of the digits: 1e-16 / DISTANCE^2, extrapolated.
        let n = bent.rows;
        let value = |flow: &mut dyn Derivatives, by: &[f64]| -> f64 {
            let moved = flow.moved(&at, by).expect("a state nearby");
            let all = flow.invariants(&moved).expect("invariants");
            all.iter().zip(&weights).map(|(x, w)| x * w).sum()
        };
        for j in 0..n {
            for i in 0..=j {
                let mixed = |flow: &mut dyn Derivatives, d: f64| {
                    let mut sum = 0.0;
                    for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                        let mut by = vec![0.0; n];
                        by[i] += a * d;
                        by[j] += b * d;
                        sum += a * b * value(flow, &by);
                    }
                    sum / (4.0 * d * d)
                };
                let (wide, near) = (mixed(&mut *flow, 8e-3), mixed(&mut *flow, 4e-3));
                let expected = (4.0 * near - wide) / 3.0;
                let found = bent.entries[j * n + i];
                let size = bent.entries.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
                assert!(
                    (found - expected).abs() < 1e-6 * size,
                    "{} {i} {j}: {found} {expected}",
                    card.name
                );
                assert!(
                    (found - bent.entries[i * n + j]).abs() < 1e-12 * size,
                    "{}",
                    card.name
                );
            }
        }
    }
}

trait StartDimension {
    fn start_dimension(&self) -> usize;
}

impl StartDimension for Box<dyn Derivatives> {
    fn start_dimension(&self) -> usize {
        self.dimensions().iter().sum()
    }
}

/// The gradient of [`Last`] in the initial values, as a product of the tangents of all steps.
pub fn by_tangents(flow: &mut dyn Derivatives, steps: u64) -> Vec<f64> {
    let n: usize = flow.dimensions().iter().sum();
    let (mut at, mut product) = (flow.start(), DMatrix::<f64>::identity(n, n));
    for _ in 0..steps {
        let (next, tangent) = flow.tangent(&at).expect("a tangent");
        product = DMatrix::from_column_slice(n, n, &tangent.entries) * product;
        at = next;
    }
    let seen = flow.observed(&at).expect("slopes");
    let seen = DMatrix::from_column_slice(seen.rows, seen.cols, &seen.entries);
    let weights = DVector::from_fn(seen.nrows(), |i, _| weight(i));
    (seen * product).tr_mul(&weights).as_slice().to_vec()
}

#[test]
fn gradients_are_products_of_tangents() {
    for (card, case) in cases(1) {
        let mut flow = open(&card, &case, Settings::step(case.h));
        let gradient = flow.gradient(STEPS, &mut Last(STEPS)).expect("a gradient");
        let off = off_by(&gradient.initial.concat(), &by_tangents(&mut *flow, STEPS));
        // Rounding of forty products of matrices.
        assert!(off < 1e-12, "{} {}: {off:e}", card.name, case.name);
    }
}

#[test]
fn gradients_in_parameters_and_the_step_size_are_limits_of_differences() {
    for (card, case) in cases(1) {
        let settings = Settings::step(case.h);
        let mut flow = open(&card, &case, settings);
        let gradient = flow.gradient(STEPS, &mut Last(STEPS)).expect("a gradient");
        let by_step = slope(
            &mut |by| {
                let mut other = flow.with_step(case.h + by).expect("a step size");
                vec![cost(&mut *other, STEPS)]
            },
            1e-3 * case.h,
        );
        let size = gradient.step.abs().max(1.0);
        assert!(
            (by_step[0] - gradient.step).abs() < 1e-8 * size,
            "{}: {} {}",
            card.name,
            by_step[0],
            gradient.step
        );
        for (k, field) in card.parameters.iter().enumerate() {
            for i in 0..field.count() {
                // Both entries of a symmetric matrix change; the derivative is their sum.
                let (row, col) = (i / field.cols, i % field.cols);
                let mirrored = match field.kind {
                    Kind::Symmetric | Kind::SecondMoments => col * field.cols + row,
                    Kind::Diagonal | Kind::Skew => continue,
                    _ => i,
                };
                let largest = case.parameters[k]
                    .iter()
                    .fold(1e-2, |m: f64, x| m.max(x.abs()));
                let by_entry = slope(
                    &mut |by| {
                        let mut case = case.clone();
                        case.parameters[k][i] += by;
                        if mirrored != i {
                            case.parameters[k][mirrored] += by;
                        }
                        vec![cost(&mut *open(&card, &case, settings), STEPS)]
                    },
                    1e-3 * largest,
                );
                let found = match mirrored == i {
                    true => gradient.parameters[k][i],
                    false => gradient.parameters[k][i] + gradient.parameters[k][mirrored],
                };
                // Rounding of a run, divided by the smallest distance.
                assert!(
                    (by_entry[0] - found).abs() < 1e-7 * found.abs().max(1.0),
                    "{} {}: {} {found}",
                    card.name,
                    field.name,
                    by_entry[0]
                );
            }
        }
    }
}

/// Coordinates of a linear map are its entries, so that derivatives carry the names of entries.
#[test]
fn entries_of_a_linear_map_are_moved_alone() {
    let (card, case) = cases(1)
        .find(|(card, _)| card.name == "EllipsoidConvective")
        .expect("a model on GL(n)");
    let mut flow = open(&card, &case, Settings::step(case.h));
    let mut at = flow.start();
    for _ in 0..5 {
        at = flow.step(&at).expect("a step");
    }
    let before = flow.observe(&at).expect("observables");
    let count = flow.dimensions()[0];
    for k in 0..count {
        let mut by = vec![0.0; flow.start_dimension()];
        by[k] = 0.125;
        let moved = flow.moved(&at, &by).expect("a state nearby");
        let after = flow.observe(&moved).expect("observables");
        for (i, (a, b)) in after.iter().zip(&before).take(count).enumerate() {
            let expected = if i == k { 0.125 } else { 0.0 };
            // Rounding of a sum of two numbers near 1.
            assert!((a - b - expected).abs() < 1e-14, "{i} {k}: {a} {b}");
        }
    }
}
