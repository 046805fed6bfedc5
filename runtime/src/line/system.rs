//! The small linear system of the velocities of one site.
//! Takes its columns and its right side; gives the velocities, or that none are determined.

use crate::Real;
use crate::linalg::small_solve;
use crate::solvers::two_sided::SingularFactor;
use nalgebra::{SMatrix, SVector};

/// The solution of `A x = known`.
///
/// # Errors
/// [`SingularFactor`] where elimination finds no pivot.
#[inline]
pub fn solve_columns<T: Real, const N: usize>(
    a: &SMatrix<T, N, N>,
    known: &SVector<T, N>,
    name: &'static str,
) -> Result<SVector<T, N>, SingularFactor> {
    small_solve(a, known).ok_or(SingularFactor { factor: name })
}
