//! Shared by the benchmark programs: interleaved timing, and the generated free body as a method for comparison.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables)]

pub mod blocks;
pub mod body;
pub mod python;
pub mod reference_motion;
