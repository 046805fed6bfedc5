//! Other methods for shallow water. A pseudospectral method is the reference for particle-mesh methods, because its
//! error is far smaller while fields are smooth.

mod fourier;
mod spectral;

pub use spectral::{Fields, Smoothing, Spectral};
