//! Step sizes that are too large, for every model, case and order of the gallery. The test reads the step size that the error
//! suggests and checks that it works and that a slightly larger one fails.

use clebsch::card::{Card, OpenError, Settings, Trajectory};
use clebsch::{StartError, StepCause};
use clebsch_models::{Case, gallery};

const ORDERS: [u32; 6] = [1, 2, 4, 6, 8, 10];

/// Starts a trajectory and steps once; returns the error message.
fn first_step(card: &Card, case: &Case, h: f64, order: Option<u32>) -> Result<(), String> {
    let settings = Settings {
        order,
        ..Settings::step(h)
    };
    let mut trajectory = match (card.open)(&case.parameters, &case.initial, settings) {
        Ok(trajectory) => trajectory,
        Err(OpenError::Start(StartError::Refused(cause))) => return Err(message(&cause)),
        Err(other) => panic!("{}: {other}", card.kebab),
    };
    step(trajectory.as_mut())
}

fn step(trajectory: &mut dyn Trajectory) -> Result<(), String> {
    trajectory.step().map_err(|e| message(&e.cause))
}

fn message(cause: &StepCause) -> String {
    cause.to_string()
}

/// The step size that an error message suggests, as a user would type it.
fn offered(said: &str) -> f64 {
    let (_, rest) = said
        .split_once("to at most ")
        .unwrap_or_else(|| panic!("nothing is offered: {said}"));
    rest.parse().unwrap_or_else(|_| panic!("no number: {said}"))
}

/// The step size that the error message reports as tried.
fn tried(said: &str) -> f64 {
    let words = said
        .split_once("; a step of ")
        .and_then(|(_, rest)| rest.split_once(" from this state succeeds"));
    let (number, _) = words.unwrap_or_else(|| panic!("nothing was tried: {said}"));
    number
        .parse()
        .unwrap_or_else(|_| panic!("no number: {said}"))
}

/// Slow: each of several hundred failures searches for the largest step size.
#[test]
fn the_step_that_a_message_offers_is_taken() {
    let mut refused = 0;
    for entry in gallery() {
        for case in &entry.cases {
            let card = entry.card_of(case);
            for order in ORDERS.into_iter().filter(|o| card.orders.contains(o)) {
                // Compositions search through all their stages, which takes a tenth of a second each.
                let composed = order != card.order;
                for h in [3.0, 30.0, 1e4, 1e100]
                    .into_iter()
                    .step_by(1 + usize::from(composed))
                {
                    let at = format!("{} {} {order} {h:e}", card.kebab, case.name);
                    let Err(said) = first_step(&card, case, h, Some(order)) else {
                        continue;
                    };
                    // Explicit steps fail by overflow, and the message then suggests no step size.
                    if said.contains("NaN or infinite") {
                        assert!(h > 1e99, "{at}: {said}");
                        continue;
                    }
                    // If a step leaves the invertible maps, the message suggests a step size that was tried from the state at which
                    // the step failed. In a composition, that state is between two nodes.
                    if said.contains("its determinant reaches 0") {
                        if order == 2 {
                            let shorter = tried(&said);
                            assert!(0.0 < shorter && shorter < h, "{at}: {said}");
                            let taken = first_step(&card, case, shorter, Some(order));
                            assert_eq!(taken, Ok(()), "{at}: {said}");
                        }
                        continue;
                    }
                    let largest = offered(&said);
                    assert!(0.0 < largest && largest < h, "{at}: {said}");
                    let taken = first_step(&card, case, largest, Some(order));
                    assert_eq!(taken, Ok(()), "{at}: {said}");
                    // The suggested step size is close to the largest.
                    let longer = first_step(&card, case, 1.01 * largest, Some(order));
                    assert!(longer.is_err(), "{at}: {said}");
                    refused += 1;
                }
            }
        }
    }
    println!("{refused} refusals");
    assert!(refused > 300);
}

#[test]
fn steps_that_have_no_inverse_or_are_none_are_named() {
    for entry in gallery() {
        let case = &entry.cases[0];
        let card = entry.card_of(case);
        for h in [0.0, -0.1, f64::NAN, f64::INFINITY, 1e-320] {
            let settings = Settings::step(h);
            let said = match (card.open)(&case.parameters, &case.initial, settings) {
                Err(OpenError::Parameter(e) | OpenError::Start(StartError::Initial(e))) => {
                    e.to_string()
                }
                other => panic!("{} {h}: {:?}", card.kebab, other.map(|_| ())),
            };
            assert!(said.contains("`h`") && said.contains("positive"), "{said}");
        }
    }
}
