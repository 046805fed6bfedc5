//! Dual numbers of a single size for these tests. Every further size would compile all models and solvers again, which is half the
//! build time of the binary. A test seeds as many variables as it needs and ignores the other derivatives.

use clebsch::Dual;

/// Number of derivatives: enough for the largest phase, an ellipsoid on GL(4) with its momentum.
pub const SEEDS: usize = 32;

/// A number with derivatives with respect to the variables that a test seeds; all other derivatives are zero.
pub type Seeded = Dual<SEEDS>;
