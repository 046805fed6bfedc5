//! Dual numbers of these tests, all of one size: every size compiles all models and solvers anew, which is half of
//! what the binary takes to build. A test seeds as many variables as it needs and reads no other derivatives.

use clebsch::Dual;

/// Derivatives a number has room for: as many as the largest phase has, an ellipsoid on GL(4) with its momentum.
pub const SEEDS: usize = 32;

/// A number with derivatives with respect to as many variables as a test seeds; all others are zero.
pub type Seeded = Dual<SEEDS>;
