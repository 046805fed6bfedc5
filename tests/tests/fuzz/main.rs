//! The engine under arbitrary input: it never panics, never hangs and never fills the memory.
//! Takes random token streams, mutated valid models and adversarial inputs; gives for each the time and the
//! peak of the memory that it took, against the limits for inputs of at most 10 kB.

mod adversarial;
mod memory;
mod probe;
mod tokens;

use clebsch_oracle::oracle::points::{Source, asked_for};
use probe::{Input, Report, probe_all};
use std::sync::{Mutex, MutexGuard};

/// Inputs of each kind; a hundred thousand by `FUZZ_INPUTS=100000`.
fn inputs() -> u64 {
    asked_for("FUZZ_INPUTS", 6_000)
}

/// Threads that probe; the machines this runs on have two cores.
const THREADS: u64 = 2;

/// One kind at a time: two threads each, and times that mean something.
fn alone() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn judge(report: &Report) {
    println!("{report}");
    assert!(
        report.failures.is_empty(),
        "{}",
        report.failures.join("\n\n")
    );
}

#[test]
fn random_token_streams() {
    let _turn = alone();
    judge(&probe_all(THREADS, inputs(), |number| {
        let mut source = Source::seeded(number);
        Input {
            name: format!("token stream {number}"),
            text: tokens::stream(&mut source),
        }
    }));
}

#[test]
fn mutated_models() {
    let _turn = alone();
    let models: Vec<Vec<String>> = tokens::models()
        .iter()
        .map(|text| tokens::lex(text))
        .collect();
    let report = probe_all(THREADS, inputs(), |number| {
        let mut source = Source::seeded(number ^ 0x00f0_0d00);
        Input {
            name: format!("mutated model {number}"),
            text: tokens::mutate(&mut source, &models),
        }
    });
    // Some mutants are valid models: otherwise nothing but the parser is tested.
    assert!(
        report.accepted * 100 >= inputs(),
        "only {} were valid",
        report.accepted
    );
    judge(&report);
}

#[test]
fn unmutated_models_are_valid() {
    let _turn = alone();
    let models = tokens::models();
    let report = probe_all(1, models.len() as u64, |number| {
        let place = usize::try_from(number).unwrap_or(0);
        Input {
            name: format!("model {number}"),
            text: models.get(place).cloned().unwrap_or_default(),
        }
    });
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
    judge(&probe_all(1, inputs.len() as u64, |number| {
        let place = usize::try_from(number).unwrap_or(0);
        inputs.get(place).cloned().unwrap_or_default()
    }));
}
