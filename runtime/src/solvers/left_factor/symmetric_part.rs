//! Finds the symmetric part of `A = R C^T` by an iteration that costs one matrix product, for momenta up to about half
//! the bound. Takes the principal values of the factor and `V = h N`, in the principal frame; gives a rotation near the
//! solution, or `None` if it converges too slowly.
//!
//! With `A = S + V/2` the skew part is correct for every `S`. The orthogonality of `R` becomes `A^T A = D^2`, the
//! matrix Riccati equation. Its tangent at zero momentum is diagonal: the correction of `S_ij` is the defect at `ij`
//! over `d_i + d_j`. (The tangent at the solution is a Lyapunov operator, a matrix with `N^2 / 2` rows.)

use crate::Real;
use crate::linalg::product;
use nalgebra::{ArrayStorage, SMatrix, SVector};

/// The largest number of sweeps: at the slowest admitted rate, the defect then reaches rounding.
const MOST_SWEEPS: usize = 60;

/// If a sweep leaves more than this fraction of the defect, a factored tangent is cheaper.
const SLOW: f64 = 0.6;

/// The number of first sweeps in which the defect may decrease more slowly.
const OPENING: usize = 3;

/// Defects below this many roundings of each row are at rounding level.
const CONVERGED_ROUNDINGS: f64 = 1.0;

/// If the defect stops decreasing below this many roundings, the cause is rounding.
const STAGNATED_ROUNDINGS: f64 = 64.0;

/// The smallest admissible ratio of principal values. The rotation is `A` divided by them, so the ratio amplifies
/// rounding.
const FLATTEST: f64 = 1e-2;

type Square<T, const N: usize> = [[T; N]; N];

/// A rotation, accurate to rounding times the ratio of the principal values.
#[inline]
pub(super) fn nearby_rotation<T: Real, const N: usize>(
    spectrum: &SVector<T, N>,
    reciprocals: &SMatrix<T, N, N>,
    v: &SMatrix<T, N, N>,
) -> Option<SMatrix<T, N, N>> {
    let d = &spectrum.data.0[0];
    let (least, greatest) = d.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), x| {
        (low.min(x.least()), high.max(x.greatest()))
    });
    let unit = T::EPSILON * greatest * greatest * N as f64;
    // This form of the comparison also rejects NaN.
    let solid = least > FLATTEST * greatest;
    if !solid {
        return None;
    }
    let half = T::from_f64(0.5);
    // The given reciprocals belong to pairs.
    let mut reciprocals = reciprocals.data.0;
    for (i, x) in d.iter().enumerate() {
        reciprocals[i][i] = half / *x;
    }
    let half_v = v.data.0.map(|column| column.map(|x| x * half));
    let mut s = [[T::zero(); N]; N];
    for (i, x) in d.iter().enumerate() {
        s[i][i] = *x;
    }
    let mut previous = f64::INFINITY;
    for sweep in 0..MOST_SWEEPS {
        let (a, gram) = gram(&s, &half_v);
        let (defect, square) = defect(d, &gram);
        let size = square.greatest().sqrt();
        if size <= CONVERGED_ROUNDINGS * unit
            || (size <= STAGNATED_ROUNDINGS * unit && size >= 0.5 * previous)
        {
            return Some(over(&a, d));
        }
        // This form of the comparison also rejects NaN.
        if !(size <= SLOW * previous || (sweep < OPENING && size.is_finite())) {
            return None;
        }
        previous = size;
        for ((s, defect), reciprocals) in s.iter_mut().zip(&defect).zip(&reciprocals) {
            for ((s, defect), reciprocal) in s.iter_mut().zip(defect).zip(reciprocals) {
                *s += *defect * *reciprocal;
            }
        }
    }
    None
}

/// `A` and `A^T A`, in columns. `S` is exactly symmetric, so the transpose of `A` is `S - V/2`.
#[inline(always)]
fn gram<T: Real, const N: usize>(
    s: &Square<T, N>,
    half_v: &Square<T, N>,
) -> (Square<T, N>, SMatrix<T, N, N>) {
    let (mut a, mut transposed) = (*s, *s);
    for j in 0..N {
        for i in 0..N {
            a[j][i] += half_v[j][i];
            transposed[j][i] -= half_v[j][i];
        }
    }
    let [a_matrix, transposed] = [a, transposed].map(|m| SMatrix::from_data(ArrayStorage(m)));
    (a, product(&transposed, &a_matrix))
}

/// `D^2 - A^T A`, made exactly symmetric, and the sum of its squares.
#[inline(always)]
fn defect<T: Real, const N: usize>(d: &[T; N], gram: &SMatrix<T, N, N>) -> (Square<T, N>, T) {
    let gram = &gram.data.0;
    let mut defect = [[T::zero(); N]; N];
    let mut squares = [T::zero(); N];
    let half = T::from_f64(0.5);
    for j in 0..N {
        for i in 0..N {
            defect[j][i] = -(gram[j][i] + gram[i][j]) * half;
        }
        defect[j][j] += d[j] * d[j];
        for i in 0..N {
            squares[i] += defect[j][i] * defect[j][i];
        }
    }
    (
        defect,
        squares.into_iter().fold(T::zero(), |sum, x| sum + x),
    )
}

/// `A D^-1`, orthogonalised by a Newton step.
#[inline(always)]
fn over<T: Real, const N: usize>(a: &Square<T, N>, d: &[T; N]) -> SMatrix<T, N, N> {
    let mut r = *a;
    for (column, d) in r.iter_mut().zip(d) {
        let reciprocal = T::one() / *d;
        for x in column {
            *x *= reciprocal;
        }
    }
    crate::linalg::orthonormalised(&SMatrix::from_data(ArrayStorage(r)))
}
