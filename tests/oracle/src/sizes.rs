//! Numbers of random models, points and inputs in the test suites. Where a comment names an environment variable, it can raise the
//! number.

/// Random models in the long derivation tests, each with all mutants.
pub const DERIVED: u64 = 160;
/// Random models in the quick derivation tests: one of every group and product of groups.
pub const DERIVED_QUICKLY: u64 = 20;
/// Compiled random models; `CLEBSCH_RANDOM_MODELS` raises the number.
pub const COMPILED: u64 = 60;
/// Random models whose variations are compared with finite differences.
pub const DIFFERENTIATED: u64 = 300;
/// Random models whose texts are searched for every feature of the language.
pub const WRITTEN: u64 = 500;
/// Points at which a mutant is evaluated; one is enough for nearly all.
pub const MUTANT_POINTS: usize = 30;
/// Points at which residuals of a hand-written system are compared.
pub const POINTS: usize = 1000;
/// Fuzz inputs of each kind in the quick tests.
pub const FUZZED: u64 = 500;
/// Fuzz inputs of each kind in the long tests; `FUZZ_INPUTS` raises the number.
pub const FUZZED_LONG: u64 = 6_000;
/// Largest number of segments for which the hand-written action of a chain is changed term by term; `LATTICE_CHANGES` raises it.
pub const CHANGED_SEGMENTS: u64 = 5;
