//! Shallow water as other methods compute it. Fourier components on a grid, whose error is far below that of particles
//! while fields are smooth, are the reference of particle-mesh methods.

mod fourier;
mod spectral;

pub use spectral::{Fields, Smoothing, Spectral};
