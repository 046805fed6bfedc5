//! What the programs that time and compare share: interleaved timing, the generated free body as a method among others.
//! Takes starts; gives motions and times.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables)]

pub mod blocks;
pub mod body;
pub mod python;
pub mod truth;
