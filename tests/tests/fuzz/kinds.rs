//! Inputs by number: streams of tokens, and valid models with changes.

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

/// The models that are changed, in tokens.
pub fn models() -> Vec<Vec<String>> {
    let models = tokens::models();
    models.iter().map(|text| tokens::lex(text)).collect()
}

/// One of the models with changes.
pub fn mutated(number: u64, models: &[Vec<String>]) -> Input {
    let mut source = Source::seeded(number ^ 0x00f0_0d00);
    Input {
        name: format!("mutated model {number}"),
        text: tokens::mutate(&mut source, models),
    }
}

/// Fails if an input did.
pub fn judge(report: &Report) {
    println!("{report}");
    assert!(
        report.failures.is_empty(),
        "{}",
        report.failures.join("\n\n")
    );
}

/// The same of mutated models, of which some are valid: otherwise nothing but the parser is tested.
pub fn judge_mutated(report: &Report) {
    assert!(
        report.accepted * 100 >= report.probed,
        "only {} of {} were valid",
        report.accepted,
        report.probed
    );
    judge(report);
}
