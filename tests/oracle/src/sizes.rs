//! How many random models, points and inputs the suites take. Where an environment variable is named, it asks for more.

/// Random models whose derivations are judged with all their mutants, in the long tests.
pub const DERIVED: u64 = 160;
/// The first of them, in the quick tests: one of every group and product of groups.
pub const DERIVED_QUICKLY: u64 = 20;
/// Those that are compiled; `CLEBSCH_RANDOM_MODELS` asks for more.
pub const COMPILED: u64 = 60;
/// Those whose variations are compared with differences.
pub const DIFFERENTIATED: u64 = 300;
/// Those in whose texts every feature of the language is looked for.
pub const WRITTEN: u64 = 500;
/// Points at which a mutant may be noticed; one is enough for nearly all.
pub const MUTANT_POINTS: usize = 30;
/// Points at which a residual of a hand-typed system is compared.
pub const POINTS: usize = 1000;
/// Inputs of each kind that the engine is fuzzed with, in the quick tests.
pub const FUZZED: u64 = 500;
/// Those of the long tests; `FUZZ_INPUTS` asks for more.
pub const FUZZED_LONG: u64 = 6_000;
/// Segments up to which the typed action of a line is changed term by term; `LATTICE_CHANGES` asks for more.
pub const CHANGED_SEGMENTS: u64 = 5;
