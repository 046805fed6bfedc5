//! Arguments that are refused, and the sentences that say so.

use crate::bodies::Body;
use crate::systems::{Plane, Splitting, oscillators, pendulum};
use clebsch_analysis::{
    Direction, Search, Section, Track, continuation, equilibrium, linear, lyapunov, orbit, sections,
};
use nalgebra::Vector3;

/// Checks that an error says what is wrong and what to do, in at most two sentences.
pub fn says(error: &dyn std::error::Error, words: &str) {
    let text = error.to_string();
    assert!(text.contains(words), "{text}");
    let sentences = text.matches(". ").count() + usize::from(text.ends_with('.'));
    assert!(sentences == 2, "{text}");
}

#[test]
fn step_sizes_and_numbers() {
    let flow = Splitting::leapfrog(pendulum());
    let at = vec![0.1, 0.0];
    let value = |z: &Vec<f64>| z[0];
    let section = Section {
        value: &value,
        rate: None,
        direction: Direction::Both,
    };
    let search = Search::default();
    for h in [0.0, f64::NAN, f64::INFINITY] {
        says(&lyapunov(&flow, &at, h, 10, 1).unwrap_err(), "step size");
        says(&orbit(&flow, &at, h, 10, &search).unwrap_err(), "step size");
        says(&linear(&flow, &at, h, true).unwrap_err(), "step size");
        says(
            &sections(&flow, &at, h, &section, 1, 10).unwrap_err(),
            "step size",
        );
    }
    says(
        &lyapunov(&flow, &at, 0.1, 0, 1).unwrap_err(),
        "steps is zero",
    );
    says(
        &lyapunov(&flow, &at, 0.1, 10, 0).unwrap_err(),
        "exponents is zero",
    );
    says(
        &lyapunov(&flow, &at, 0.1, 10, 3).unwrap_err(),
        "exponents is 3",
    );
    says(
        &orbit(&flow, &at, 0.1, 0, &search).unwrap_err(),
        "period is zero",
    );
    says(
        &orbit(
            &flow,
            &at,
            0.1,
            5,
            &Search {
                tolerance: f64::NAN,
                ..search
            },
        )
        .unwrap_err(),
        "tolerance",
    );
    says(
        &sections(&flow, &at, 0.1, &section, 0, 10).unwrap_err(),
        "crossings is zero",
    );
    says(
        &sections(&flow, &at, 0.1, &section, 1, 0).unwrap_err(),
        "steps is zero",
    );
}

#[test]
fn states_that_are_not_finite() {
    let flow = Splitting::leapfrog(pendulum());
    let at = vec![f64::NAN, 0.0];
    let value = |z: &Vec<f64>| z[0];
    let section = Section {
        value: &value,
        rate: None,
        direction: Direction::Both,
    };
    says(
        &lyapunov(&flow, &at, 0.1, 10, 1).unwrap_err(),
        "undefined number",
    );
    says(
        &orbit(&flow, &at, 0.1, 10, &Search::default()).unwrap_err(),
        "undefined number",
    );
    says(
        &linear(&flow, &at, 0.1, true).unwrap_err(),
        "undefined number",
    );
    says(
        &sections(&flow, &at, 0.1, &section, 1, 10).unwrap_err(),
        "undefined number",
    );
    let blows_up = Plane(|[x, y]: [f64; 2], _| Some(([x * x, y], [2.0 * x, 0.0, 0.0, 1.0])));
    says(
        &lyapunov(&blows_up, &[10.0, 0.0], 1.0, 1000, 2).unwrap_err(),
        "undefined number",
    );
}

#[test]
fn systems_without_coordinates() {
    let flow = Splitting::leapfrog(oscillators(0));
    let at = Vec::new();
    let value = |_: &Vec<f64>| 1.0;
    let section = Section {
        value: &value,
        rate: None,
        direction: Direction::Both,
    };
    says(
        &lyapunov(&flow, &at, 0.1, 10, 1).unwrap_err(),
        "exponents is 1",
    );
    says(
        &orbit(&flow, &at, 0.1, 10, &Search::default()).unwrap_err(),
        "coordinates is zero",
    );
    says(
        &linear(&flow, &at, 0.1, true).unwrap_err(),
        "coordinates is zero",
    );
    says(
        &sections(&flow, &at, 0.1, &section, 1, 10).unwrap_err(),
        "No crossing",
    );
}

#[test]
fn energies() {
    let body = Body {
        inertia: [1.0, 2.0, 3.0],
        symmetric: false,
    };
    let (at, search) = (Vector3::y(), Search::default());
    says(
        &equilibrium(&body, &at, &[], 2.0, &search).unwrap_err(),
        "0 rows",
    );
    says(
        &equilibrium(&body, &at, &[f64::INFINITY], 2.0, &search).unwrap_err(),
        "undefined number",
    );
    says(
        &equilibrium(&body, &at, &[0.5], f64::NAN, &search).unwrap_err(),
        "parameter",
    );
    says(
        &equilibrium(&body, &at, &[-0.5], 2.0, &search).unwrap_err(),
        "No equilibrium",
    );
    says(
        &equilibrium(&body, &Vector3::repeat(f64::NAN), &[0.5], 2.0, &search).unwrap_err(),
        "undefined number",
    );
    says(
        &continuation(&body, &at, &[0.5], 2.0, 2.0, &Track::between(2.0, 2.0)).unwrap_err(),
        "first step",
    );
    says(
        &continuation(&body, &at, &[0.5], 2.0, f64::NAN, &Track::between(2.0, 3.0)).unwrap_err(),
        "parameter",
    );
    let none = Track {
        points: 0,
        ..Track::between(2.0, 3.0)
    };
    says(
        &continuation(&body, &at, &[0.5], 2.0, 3.0, &none).unwrap_err(),
        "points is zero",
    );
    let few = Track {
        points: 3,
        ..Track::between(2.0, 3.0)
    };
    assert_eq!(
        continuation(&body, &at, &[0.5], 2.0, 3.0, &few)
            .unwrap()
            .points
            .len(),
        3
    );
}

#[test]
fn failed_steps_are_quoted() {
    let flow = Plane(|_: [f64; 2], _| None);
    let value = |z: &[f64; 2]| z[0];
    let section = Section {
        value: &value,
        rate: None,
        direction: Direction::Both,
    };
    says(
        &lyapunov(&flow, &[0.0, 0.0], 0.1, 10, 1).unwrap_err(),
        "failed: the step is not defined. Use",
    );
    says(
        &orbit(&flow, &[0.0, 0.0], 0.1, 10, &Search::default()).unwrap_err(),
        "not defined. Use",
    );
    says(
        &linear(&flow, &[0.0, 0.0], 0.1, true).unwrap_err(),
        "not defined. Use",
    );
    says(
        &sections(&flow, &[0.0, 0.0], 0.1, &section, 1, 10).unwrap_err(),
        "not defined. Use",
    );
}
