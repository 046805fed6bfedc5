//! Zero-padding inclusions of vectors and the projections that undo them: constant matrices.

use crate::Real;
use nalgebra::SMatrix;

/// The `R x C` matrix that embeds a vector of length `C` into a vector of length `R`, starting at row `at`; its
/// transpose extracts it again.
#[inline]
#[must_use]
pub fn inclusion<T: Real, const R: usize, const C: usize>(at: usize) -> SMatrix<T, R, C> {
    SMatrix::from_fn(|i, j| if i == at + j { T::one() } else { T::zero() })
}

/// `P^T A` for the inclusion `P` of length `C` at row `at`: `C` rows of `A`.
#[inline]
#[must_use]
pub fn rows_from<T: Real, const R: usize, const C: usize, const N: usize>(
    a: &SMatrix<T, R, N>,
    at: usize,
) -> SMatrix<T, C, N> {
    SMatrix::from_fn(|i, j| a.get((at + i, j)).copied().unwrap_or_else(T::zero))
}

/// `A P` for the inclusion `P` of length `C` at row `at`: `C` columns of `A`.
#[inline]
#[must_use]
pub fn columns_from<T: Real, const R: usize, const C: usize, const N: usize>(
    a: &SMatrix<T, N, R>,
    at: usize,
) -> SMatrix<T, N, C> {
    SMatrix::from_fn(|i, j| a.get((i, at + j)).copied().unwrap_or_else(T::zero))
}

/// `P A` for the inclusion `P` of length `C` at row `at`: `A` with rows of zeros around it.
#[inline]
#[must_use]
pub fn into_rows<T: Real, const R: usize, const C: usize, const N: usize>(
    a: &SMatrix<T, C, N>,
    at: usize,
) -> SMatrix<T, R, N> {
    SMatrix::from_fn(|i, j| {
        let inside = i.checked_sub(at).and_then(|i| a.get((i, j)));
        inside.copied().unwrap_or_else(T::zero)
    })
}

/// `A P^T` for the inclusion `P` of length `C` at row `at`: `A` with columns of zeros around it.
#[inline]
#[must_use]
pub fn into_columns<T: Real, const R: usize, const C: usize, const N: usize>(
    a: &SMatrix<T, N, C>,
    at: usize,
) -> SMatrix<T, N, R> {
    SMatrix::from_fn(|i, j| {
        let inside = j.checked_sub(at).and_then(|j| a.get((i, j)));
        inside.copied().unwrap_or_else(T::zero)
    })
}
