//! The linear equation `L (Ω - Id) R = M` of a step on GL(n): two small linear systems, one after the other,
//! never one in all entries. Takes the factors and the known side; gives the velocity.

use crate::Real;
use crate::groups::Linear;
use crate::linalg::small_solve;
use core::fmt;
use nalgebra::SMatrix;

/// A factor of the equation has no inverse: no velocity solves it, or many do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SingularFactor {
    /// The factor, as the model writes it.
    pub factor: &'static str,
}

impl fmt::Display for SingularFactor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the velocity is not determined: {} is singular to working precision, so that the \
             kinetic energy does not see every velocity; check the parameters in it, and how the \
             motion got there",
            self.factor
        )
    }
}

impl std::error::Error for SingularFactor {}

/// The solution of `left (Ω - Id) right = known`; `names` are those of the factors.
///
/// # Errors
/// [`SingularFactor`] where elimination finds no pivot.
#[inline]
pub fn two_sided<T: Real, const N: usize>(
    left: &SMatrix<T, N, N>,
    known: &SMatrix<T, N, N>,
    right: &SMatrix<T, N, N>,
    names: &[&'static str; 2],
) -> Result<Linear<N, T>, SingularFactor> {
    let singular = |side: usize| SingularFactor {
        factor: names[side],
    };
    let half = small_solve(left, known).ok_or_else(|| singular(0))?;
    let whole = small_solve(&right.transpose(), &half.transpose()).ok_or_else(|| singular(1))?;
    Ok(Linear::stepped(SMatrix::identity() + whole.transpose()))
}
