//! The inverse of a small matrix by its cofactors, if that is as accurate as elimination. It needs no pivots and one
//! division. Takes a square matrix; uses elimination if the matrix has another size or is badly conditioned.

use super::elimination::{inverse, solve_many};
use crate::Real;
use nalgebra::SMatrix;

/// The largest ratio of `|A|^N` to `|det A|`; it is at least 2 and 5.2 for sizes 2 and 3, which rotations attain. A
/// cofactor has an error of a few roundings of `|A|^(N-1)`, so at most this many roundings are lost.
const WELL: f64 = 50.0;

/// The adjugate of a matrix of two or three rows, which is `det(A) A^-1` if the matrix has an inverse: its transposed
/// cofactors, each rounded relative to its own two products. NaN for other sizes.
#[inline(always)]
#[must_use]
pub fn adjugate<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let at = |i: usize, j: usize| a.data.0[j][i];
    let mut adjugate = SMatrix::<T, N, N>::zeros();
    match N {
        2 => {
            adjugate.data.0[0][0] = at(1, 1);
            adjugate.data.0[1][0] = -at(0, 1);
            adjugate.data.0[0][1] = -at(1, 0);
            adjugate.data.0[1][1] = at(0, 0);
        }
        3 => {
            for i in 0..3 {
                for j in 0..3 {
                    let (p, q) = ((i + 1) % 3, (i + 2) % 3);
                    let (r, s) = ((j + 1) % 3, (j + 2) % 3);
                    adjugate.data.0[i][j] = at(p, r) * at(q, s) - at(p, s) * at(q, r);
                }
            }
        }
        _ => return SMatrix::repeat(T::from_f64(f64::NAN)),
    }
    adjugate
}

/// The inverse by cofactors; `None` unless the matrix is well-conditioned in every lane.
#[inline(always)]
pub(super) fn by_cofactors<T: Real, const N: usize>(
    a: &SMatrix<T, N, N>,
) -> Option<SMatrix<T, N, N>> {
    if N != 2 && N != 3 {
        return None;
    }
    let at = |i: usize, j: usize| a.data.0[j][i];
    let adjugate = adjugate(a);
    let first = |j: usize| at(0, j) * adjugate.data.0[0][j];
    let det = match N {
        2 => at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0),
        _ => first(0) + first(1) + first(2),
    };
    let size = a.iter().fold(T::zero(), |sum, x| sum + *x * *x);
    let most = match N {
        2 => size * size,
        _ => size * size * size,
    };
    // Also refuses NaN.
    let well = (det * det * T::from_f64(WELL * WELL) - most).exceeds(T::zero());
    well.then(|| adjugate * (T::one() / det))
}

/// The inverse, or `None` for a matrix without a usable pivot.
#[inline]
pub fn small_inverse<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> Option<SMatrix<T, N, N>> {
    match by_cofactors(a) {
        Some(x) => Some(x),
        None => inverse(a),
    }
}

/// The solution of `A X = B`, or `None` under the conditions of [`small_inverse`].
#[inline]
pub fn small_solve<T: Real, const N: usize, const C: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, C>,
) -> Option<SMatrix<T, N, C>> {
    match by_cofactors(a) {
        Some(x) => Some(x * b),
        None => solve_many(a, b),
    }
}

#[cfg(test)]
mod tests {
    use super::{adjugate, by_cofactors, small_inverse};
    use crate::linalg::determinant;
    use nalgebra::{Matrix2, Matrix3, Matrix4, SMatrix};

    fn left<const N: usize>(a: &SMatrix<f64, N, N>) -> f64 {
        (small_inverse(a).unwrap() * a - SMatrix::identity()).norm()
    }

    #[test]
    fn cofactors_serve_well_conditioned_matrices() {
        let two = Matrix2::new(2.0, 0.3, -0.4, 1.5);
        let three = Matrix3::new(1.2, 0.3, -0.2, 0.1, 0.9, 0.4, -0.5, 0.2, 1.1);
        assert!(by_cofactors(&two).is_some() && by_cofactors(&three).is_some());
        for scale in [1e-60, 1.0, 1e60] {
            assert!(left(&(two * scale)) < 1e-15 * 8.0);
            assert!(left(&(three * scale)) < 1e-15 * 16.0);
        }
        assert!(left(&Matrix4::from_diagonal_element(3.0)) < 1e-15);
    }

    #[test]
    fn adjugates_are_the_determinant_times_the_inverse() {
        let two = Matrix2::new(2.0, 0.3, -0.4, 1.5);
        let three = Matrix3::new(1.2, 0.3, -0.2, 0.1, 0.9, 0.4, -0.5, 0.2, 1.1);
        let off = adjugate(&two) * two - Matrix2::identity() * determinant(&two);
        assert!(off.norm() < 1e-15);
        let off = adjugate(&three) * three - Matrix3::identity() * determinant(&three);
        assert!(off.norm() < 1e-15);
        // For rank two the adjugate maps to the kernel, for rank one it vanishes.
        let flat = Matrix3::new(1.0, 2.0, 3.0, 2.0, 4.0, 6.0, 0.0, 1.0, 1.0);
        let own = adjugate(&flat);
        assert!(own.norm() > 1.0 && (flat * own).norm() == 0.0);
        assert!(adjugate(&Matrix3::repeat(2.0)).norm() == 0.0);
        assert!(adjugate(&Matrix4::<f64>::identity()).norm().is_nan());
    }

    #[test]
    fn others_are_eliminated() {
        let thin = Matrix3::new(1.0, 1.0, 1.0, 1.0, 1.0 + 1e-6, 1.0, 1.0, 1.0, 1.0 + 2e-6);
        assert!(by_cofactors(&thin).is_none() && small_inverse(&thin).is_some());
        assert!(small_inverse(&Matrix3::<f64>::zeros()).is_none());
        assert!(small_inverse(&Matrix3::repeat(f64::NAN)).is_none());
    }
}
