//! Nothing: the models are part of the test, `tests/agree/compiled.rs`, so that only those who run
//! it compile them.
