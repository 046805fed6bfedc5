//! Fuzzing of the engine: it never panics, hangs or exhausts memory. Inputs of at most 10 kB are random token streams, mutated
//! valid models and adversarial texts. Each input has limits on work and peak memory. These tests have their own binary, because
//! their allocator or a stack overflow may end the process.

mod adversarial;
mod kinds;
mod memory;
mod probe;
mod tokens;

use clebsch_oracle::oracle::points::asked_for;
use clebsch_oracle::sizes::{FUZZED, FUZZED_LONG};
use kinds::{judge, judge_mutated};
use probe::{Input, probe_all};
use std::sync::{Mutex, MutexGuard};

/// Runs one kind at a time, because each uses all threads.
fn alone() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}

#[test]
fn random_token_streams() {
    let _turn = alone();
    judge(&probe_all(0..FUZZED, kinds::stream));
}

/// Slow: every text is derived as far as possible.
#[test]
fn mutated_models() {
    let _turn = alone();
    let models = kinds::models();
    judge_mutated(&probe_all(0..FUZZED, |number| {
        kinds::mutated(number, &models)
    }));
}

/// Tests the inputs after the first [`FUZZED`] of each kind; `FUZZ_INPUTS=100000` requests a hundred thousand of each kind.
#[test]
#[ignore = "derives several thousand texts"]
fn token_streams_and_mutated_models() {
    let _turn = alone();
    let inputs = FUZZED..asked_for("FUZZ_INPUTS", FUZZED_LONG);
    judge(&probe_all(inputs.clone(), kinds::stream));
    let models = kinds::models();
    judge_mutated(&probe_all(inputs, |number| kinds::mutated(number, &models)));
}

/// Probes each given input.
fn each(inputs: &[Input]) -> probe::Report {
    probe_all(0..inputs.len() as u64, |number| {
        let place = usize::try_from(number).unwrap_or(0);
        inputs.get(place).cloned().unwrap_or_default()
    })
}

#[test]
fn unmutated_models_are_valid() {
    let _turn = alone();
    let texts = tokens::models().into_iter().enumerate();
    let models: Vec<Input> = texts
        .map(|(number, text)| Input {
            name: format!("model {number}"),
            text,
        })
        .collect();
    let report = each(&models);
    judge(&report);
    assert_eq!(report.accepted, models.len() as u64);
}

#[test]
fn adversarial_inputs() {
    let _turn = alone();
    let inputs = adversarial::inputs();
    for input in &inputs {
        assert!(
            input.text.len() <= 10_000,
            "{} has {} bytes",
            input.name,
            input.text.len()
        );
    }
    judge(&each(&inputs));
}
