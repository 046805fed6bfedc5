//! Small dense linear algebra for any [`Real`](crate::Real): hat and vee, determinants, inverses, linear solves,
//! eigenvalues of a symmetric 3x3 matrix, coefficients of pencils. Takes and gives nalgebra matrices of fixed size;
//! only [`Dense`] allocates, whose size is known when a model is read.

mod cofactors;
mod dense;
mod eigenvalues;
mod elimination;
mod factors;
mod frame;
mod identity_difference;
mod inclusion;
mod motion;
mod pencil;
mod product;
mod quaternion;
mod singular_values;
mod skew;

pub use cofactors::{adjugate, small_inverse, small_solve};
pub use dense::{Dense, Reals};
pub use eigenvalues::symmetric_eigenvalues;
pub use elimination::{
    determinant, held_scales, inverse, inverse_leading, solve, solve_leading, solve_many,
    solve_scaled,
};
pub(crate) use elimination::{is_usable, weight};
pub use factors::{DenseFactors, Factors};
pub use frame::principal_frame;
pub use identity_difference::less_identity;
pub use inclusion::{columns_from, inclusion, into_columns, into_rows, rows_from};
pub use motion::{Coordinates, Homogeneous, motion_rotation, motion_translation, twist};
pub use pencil::{even_count, even_degrees, pencil_coefficients};
pub use product::{orthonormalised, product};
pub use quaternion::{
    left_multiplication, pure_quaternion, quaternion_imaginary, quaternion_real,
    quaternion_rotation,
};
pub use singular_values::{singular_ratio, singular_ratio_of};
pub use skew::{
    axial_of_difference, crossed, crossing, hat, skew_coordinates, skew_from, trace_complement, vee,
};
