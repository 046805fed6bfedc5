//! More random token streams and mutated models than `main.rs` has: the engine never panics, never hangs and never fills
//! the memory.

mod kinds;
mod memory;
mod probe;
mod tokens;

use clebsch_oracle::oracle::points::asked_for;
use clebsch_oracle::sizes::{FUZZED, FUZZED_LONG};
use kinds::{judge, judge_mutated};
use probe::probe_all;
use std::ops::Range;

/// Those of `main.rs`, and the last of each kind; a hundred thousand by `FUZZ_INPUTS=100000`.
fn inputs() -> Range<u64> {
    FUZZED..asked_for("FUZZ_INPUTS", FUZZED_LONG)
}

/// Long, since some thousand texts are derived.
/// One after the other, each on all threads.
#[test]
fn token_streams_and_mutated_models() {
    judge(&probe_all(inputs(), kinds::stream));
    let models = kinds::models();
    judge_mutated(&probe_all(inputs(), |number| {
        kinds::mutated(number, &models)
    }));
}
