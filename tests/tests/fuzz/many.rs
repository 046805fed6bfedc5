//! More random token streams and mutated models than `main.rs`: the engine never panics, hangs or exhausts memory.

mod kinds;
mod memory;
mod probe;
mod tokens;

use clebsch_oracle::oracle::points::asked_for;
use clebsch_oracle::sizes::{FUZZED, FUZZED_LONG};
use kinds::{judge, judge_mutated};
use probe::probe_all;
use std::ops::Range;

/// The inputs that follow the inputs of `main.rs`; `FUZZ_INPUTS=100000` requests a hundred thousand of each kind.
fn inputs() -> Range<u64> {
    FUZZED..asked_for("FUZZ_INPUTS", FUZZED_LONG)
}

/// Slow: several thousand texts are derived. The kinds run in sequence, each on all threads.
#[test]
fn token_streams_and_mutated_models() {
    judge(&probe_all(inputs(), kinds::stream));
    let models = kinds::models();
    judge_mutated(&probe_all(inputs(), |number| {
        kinds::mutated(number, &models)
    }));
}
