//! The judge of steps: the gallery within its bounds, and running errors that are bounds.

mod gallery;
mod numbers;
