//! Inputs by number: token streams, and mutations of valid models.

use crate::probe::{Input, Report};
use crate::tokens;
use clebsch_oracle::oracle::points::Source;

/// A stream of random tokens.
pub fn stream(number: u64) -> Input {
    let mut source = Source::seeded(number);
    Input {
        name: format!("token stream {number}"),
        text: tokens::stream(&mut source),
    }
}

/// The models to mutate, as tokens.
pub fn models() -> Vec<Vec<String>> {
    let models = tokens::models();
    models.iter().map(|text| tokens::lex(text)).collect()
}

/// One of the models with mutations.
pub fn mutated(number: u64, models: &[Vec<String>]) -> Input {
    let mut source = Source::seeded(number ^ 0x00f0_0d00);
    Input {
        name: format!("mutated model {number}"),
        text: tokens::mutate(&mut source, models),
    }
}

/// Fails if an input failed.
pub fn judge(report: &Report) {
    println!("{report}");
    assert!(
        report.failures.is_empty(),
        "{}",
        report.failures.join("\n\n")
    );
}

/// Like `judge`, for mutated models. Some of them must be valid; otherwise the inputs test only the parser.
pub fn judge_mutated(report: &Report) {
    assert!(
        report.accepted * 100 >= report.probed,
        "only {} of {} were valid",
        report.accepted,
        report.probed
    );
    judge(report);
}
