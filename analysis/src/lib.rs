//! Analysis of discrete systems: how the steps of a variational integrator behave over long times and near special
//! states.
//!
//! The algorithms need two traits. [`Flow`] gives a step and its derivative in local coordinates of a manifold;
//! [`Energy`] gives an energy and conserved quantities with two derivatives. No algorithm takes a finite difference.
//!
//! - [`lyapunov()`]: Lyapunov exponents;
//! - [`orbit()`]: periodic orbits with Floquet multipliers;
//! - [`linear()`]: modes, frequencies and stability at an equilibrium of a step;
//! - [`equilibrium()`]: relative equilibria with a verdict from the second variation;
//! - [`continuation()`]: branches of relative equilibria, with folds and branch points;
//! - [`sections()`]: crossings of a surface;
//! - [`fit()`]: least squares with standard errors;
//! - [`eigen()`]: eigenvalues of matrices that are not symmetric.
//!
//! # Example
//!
//! An oscillator by symplectic Euler, x' = x + h p', p' = p - h x. Its period is a little shorter than 2 pi.
//!
//! ```
//! use clebsch_analysis::{Flow, Stability, linear};
//! use nalgebra::DMatrix;
//!
//! struct Oscillator;
//!
//! impl Flow for Oscillator {
//!     type State = [f64; 2];
//!     type Error = std::convert::Infallible;
//!
//!     fn dimension(&self) -> usize {
//!         2
//!     }
//!
//!     fn step(&self, [x, p]: &[f64; 2], h: f64) -> Result<[f64; 2], Self::Error> {
//!         let p = p - h * x;
//!         Ok([x + h * p, p])
//!     }
//!
//!     fn tangent(&self, at: &[f64; 2], h: f64) -> Result<([f64; 2], DMatrix<f64>), Self::Error> {
//!         Ok((self.step(at, h)?, DMatrix::from_row_slice(2, 2, &[1.0 - h * h, h, -h, 1.0])))
//!     }
//!
//!     fn moved(&self, [x, p]: &[f64; 2], by: &[f64]) -> [f64; 2] {
//!         [x + by[0], p + by[1]]
//!     }
//!
//!     fn difference(&self, from: &[f64; 2], to: &[f64; 2]) -> Vec<f64> {
//!         vec![to[0] - from[0], to[1] - from[1]]
//!     }
//! }
//!
//! let found = linear(&Oscillator, &[0.0, 0.0], 0.1, false)?;
//! assert_eq!(found.verdict.stability, Stability::SpectrallyStable);
//! // The step turns by 2 asin(h / 2) / h per unit of time, and the limit for small steps by 1.
//! assert!((found.modes[1].frequency - 20.0 * 0.05_f64.asin()).abs() < 1e-13);
//! assert!((found.limit_modes[1].frequency - 1.0).abs() < 1e-10);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod branch;
mod continuation;
mod crossing;
mod eigen;
mod eigen_pairs;
mod equilibrium;
mod error;
mod fit;
mod flow;
mod generator;
mod kkt;
mod linear;
mod lyapunov;
mod marquardt;
mod mode;
mod newton;
mod orbit;
mod root;
mod section;
mod singular;
mod track;
mod variation;

pub use continuation::continuation;
pub use crossing::{Crossing, Direction, Section, SectionError, Sections};
pub use eigen::{Eigen, EigenError, eigen, pairing_defect};
pub use equilibrium::{Equilibrium, EquilibriumError, equilibrium};
pub use error::Invalid;
pub use fit::{Fit, FitError, Residuals, UNDETERMINED};
pub use flow::{Energy, First, Flow};
pub use linear::{FIXED, Linear, LinearError, linear};
pub use lyapunov::{Estimate, Lyapunov, LyapunovError, lyapunov};
pub use marquardt::fit;
pub use mode::{Mode, Stability, Verdict};
pub use newton::Search;
pub use orbit::{Orbit, OrbitError, orbit};
pub use section::sections;
pub use track::{Branch, BranchPoint, ContinuationError, End, Event, Special, Track};
pub use variation::{Definiteness, NULL, Variation};
