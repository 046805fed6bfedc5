//! The linear equation of a step: `L (Ω - Id) R = M` on GL(n), `L ΔQ R Q^T = M` with constant factors, and
//! `L ΔX R = P` for a field. It is solved by small systems for `L` and `R` instead of one system for all entries.
//! Takes the factors and the known side; gives the velocity.

use crate::Real;
use crate::groups::{Additive, Linear};
use crate::linalg::small_solve;
use core::fmt;
use nalgebra::SMatrix;

/// A factor of the equation is singular: the velocity does not exist or is not unique.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SingularFactor {
    /// The factor, as the model writes it.
    pub factor: &'static str,
}

impl fmt::Display for SingularFactor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the velocity is not determined: {} is singular to working precision, so the kinetic energy does not depend on \
             every velocity; check its parameters and the state",
            self.factor
        )
    }
}

impl std::error::Error for SingularFactor {}

/// The solution of `left (Ω - Id) right = known`; `names` are the names of the factors.
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
    let change = two_sided_increment(left, known, right, names)?;
    Ok(Linear::stepped(SMatrix::identity() + change.matrix()))
}

/// The solution `ΔQ` of `left ΔQ right Q^T = known`, given the inverses of both factors. The entries of an
/// inverse are not finite if the factor is singular. `names` are the names of the factors.
///
/// # Errors
/// [`SingularFactor`] if a factor is singular.
#[inline]
pub fn displaced<T: Real, const N: usize>(
    element: &Linear<N, T>,
    left_inverse: &SMatrix<T, N, N>,
    known: &SMatrix<T, N, N>,
    right_inverse: &SMatrix<T, N, N>,
    names: &[&'static str; 2],
) -> Result<SMatrix<T, N, N>, SingularFactor> {
    for (inverse, factor) in [left_inverse, right_inverse].into_iter().zip(names) {
        if !inverse.trace().is_finite() {
            return Err(SingularFactor { factor });
        }
    }
    let seen = known * element.inverse().matrix().transpose();
    Ok(left_inverse * (seen * right_inverse))
}

/// The solution of `left ΔX right = known`.
///
/// # Errors
/// [`SingularFactor`] where elimination finds no pivot.
#[inline]
pub fn two_sided_increment<T: Real, const R: usize, const C: usize>(
    left: &SMatrix<T, R, R>,
    known: &SMatrix<T, R, C>,
    right: &SMatrix<T, C, C>,
    names: &[&'static str; 2],
) -> Result<Additive<R, C, T>, SingularFactor> {
    let half = left_sided(left, known, names[0])?.matrix();
    let whole = small_solve(&right.transpose(), &half.transpose());
    let whole = whole.ok_or(SingularFactor { factor: names[1] })?;
    Ok(Additive::new(whole.transpose()))
}

/// The solution of `left ΔX right = known`, given the inverses of both factors. The entries of an inverse are not
/// finite if the factor is singular. `names` are the names of the factors.
///
/// # Errors
/// [`SingularFactor`] if a factor is singular.
#[inline]
pub fn increment_between<T: Real, const R: usize, const C: usize>(
    left_inverse: &SMatrix<T, R, R>,
    known: &SMatrix<T, R, C>,
    right_inverse: &SMatrix<T, C, C>,
    names: &[&'static str; 2],
) -> Result<Additive<R, C, T>, SingularFactor> {
    let half = increment_behind(left_inverse, known, names[0])?;
    increment_before(&half.matrix(), right_inverse, names[1])
}

/// The solution of `left ΔX = known`, given the inverse of the factor, as for [`increment_between`].
///
/// # Errors
/// [`SingularFactor`] if the factor is singular.
#[inline]
pub fn increment_behind<T: Real, const R: usize, const C: usize>(
    left_inverse: &SMatrix<T, R, R>,
    known: &SMatrix<T, R, C>,
    factor: &'static str,
) -> Result<Additive<R, C, T>, SingularFactor> {
    match left_inverse.trace().is_finite() {
        true => Ok(Additive::new(left_inverse * known)),
        false => Err(SingularFactor { factor }),
    }
}

/// The solution of `ΔX right = known`, given the inverse of the factor, as for [`increment_between`].
///
/// # Errors
/// [`SingularFactor`] if the factor is singular.
#[inline]
pub fn increment_before<T: Real, const R: usize, const C: usize>(
    known: &SMatrix<T, R, C>,
    right_inverse: &SMatrix<T, C, C>,
    factor: &'static str,
) -> Result<Additive<R, C, T>, SingularFactor> {
    match right_inverse.trace().is_finite() {
        true => Ok(Additive::new(known * right_inverse)),
        false => Err(SingularFactor { factor }),
    }
}

/// The solution of `left ΔX = known`.
///
/// # Errors
/// [`SingularFactor`] where elimination finds no pivot.
#[inline]
pub fn left_sided<T: Real, const R: usize, const C: usize>(
    left: &SMatrix<T, R, R>,
    known: &SMatrix<T, R, C>,
    name: &'static str,
) -> Result<Additive<R, C, T>, SingularFactor> {
    let solved = small_solve(left, known).ok_or(SingularFactor { factor: name })?;
    Ok(Additive::new(solved))
}

/// The solution of `ΔX right = known`.
///
/// # Errors
/// [`SingularFactor`] where elimination finds no pivot.
#[inline]
pub fn right_sided<T: Real, const R: usize, const C: usize>(
    known: &SMatrix<T, R, C>,
    right: &SMatrix<T, C, C>,
    name: &'static str,
) -> Result<Additive<R, C, T>, SingularFactor> {
    let solved = small_solve(&right.transpose(), &known.transpose());
    let solved = solved.ok_or(SingularFactor { factor: name })?;
    Ok(Additive::new(solved.transpose()))
}

/// The solution of `number ΔX = known`.
///
/// # Errors
/// [`SingularFactor`] where the number is zero or not finite.
#[inline]
pub fn divided<T: Real, const R: usize, const C: usize>(
    known: &SMatrix<T, R, C>,
    number: T,
    name: &'static str,
) -> Result<Additive<R, C, T>, SingularFactor> {
    match divided_at_once(known, number) {
        (solved, true) => Ok(Additive::new(solved)),
        _ => Err(SingularFactor { factor: name }),
    }
}

/// Divides without a branch, so that a loop over many sites vectorises. Also returns whether the solution is finite.
#[inline(always)]
pub fn divided_at_once<T: Real, const R: usize, const C: usize>(
    known: &SMatrix<T, R, C>,
    number: T,
) -> (SMatrix<T, R, C>, bool) {
    let inverse = T::one() / number;
    let found = inverse.is_finite() & number.is_finite();
    (known * inverse, found)
}
