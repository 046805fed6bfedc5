//! Small dense linear algebra for any [`Real`](crate::Real): hat and vee, determinants, inverses,
//! linear solves, eigenvalues of a symmetric 3x3 matrix.
//! Takes and gives nalgebra matrices of fixed size; nothing allocates.

mod eigenvalues;
mod elimination;
mod skew;

pub use eigenvalues::symmetric_eigenvalues;
pub use elimination::{determinant, inverse, solve, solve_leading, solve_many};
pub use skew::{axial_of_difference, hat, skew_coordinates, skew_from, vee};
