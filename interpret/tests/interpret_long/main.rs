//! The tests of model files that take ten seconds or more: chains against compiled chains and expanded bodies, chains in
//! coordinates, elastic bodies, saved trajectories.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables)]

mod comparison;
mod compiled;
mod constrained_lines;
mod coordinates;
mod elastic;
mod lines;
mod quaternions;
mod saved;
