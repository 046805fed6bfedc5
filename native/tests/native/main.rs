//! Models and random tapes in native code, against compiled models and sequential evaluation.

mod models;
#[path = "../../../program/tests/random_tapes/mod.rs"]
mod random_tapes;
#[path = "../../../interpret/tests/interpret/side_by_side.rs"]
mod side_by_side;
mod tapes;
