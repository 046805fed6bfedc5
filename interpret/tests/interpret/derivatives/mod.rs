//! Derivatives of model files against differences of their steps, and gradients against products of tangents.

mod chains;
mod differences;
mod gallery;
mod symplectic;
