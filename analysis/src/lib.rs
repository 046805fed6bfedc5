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
