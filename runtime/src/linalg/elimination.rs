//! Gaussian elimination of small dense matrices with partial pivoting.
//! Takes a square matrix (and a right side); gives determinant, inverse or solution, or `None`.

use crate::Real;
use nalgebra::{SMatrix, SVector};

/// The determinant.
///
/// Sizes 1 to 3 are expanded, which is exact to rounding for any scalar; larger sizes are eliminated, and the result
/// is zero if no pivot is found.
#[inline]
pub fn determinant<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> T {
    let at = |i: usize, j: usize| a.data.0[j][i];
    match N {
        0 => T::one(),
        1 => at(0, 0),
        2 => at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0),
        3 => {
            at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1))
                + at(0, 1) * (at(1, 2) * at(2, 0) - at(1, 0) * at(2, 2))
                + at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0))
        }
        _ => eliminate(a, &SVector::<T, N>::zeros()).map_or_else(T::zero, |(_, det)| det),
    }
}

/// The inverse, or `None` for a matrix without a usable pivot (singular to working precision, or
/// not finite).
#[inline]
pub fn inverse<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> Option<SMatrix<T, N, N>> {
    eliminate(a, &SMatrix::<T, N, N>::identity()).map(|(x, _)| x)
}

/// The solution of `a x = b`, or `None` for a matrix without a usable pivot (singular to working
/// precision, or not finite).
#[inline]
pub fn solve<T: Real, const N: usize>(
    a: &SMatrix<T, N, N>,
    b: &SVector<T, N>,
) -> Option<SVector<T, N>> {
    eliminate(a, b).map(|(x, _)| x)
}

/// The solution of `A X = B` for several right sides, or `None` as for [`solve`].
#[inline]
pub fn solve_many<T: Real, const N: usize, const M: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
) -> Option<SMatrix<T, N, M>> {
    eliminate(a, b).map(|(x, _)| x)
}

/// The solution of the leading `size` equations in as many unknowns; the others are zero. For work
/// arrays that are larger than the problem in them.
#[inline]
pub fn solve_leading<T: Real, const N: usize>(
    a: &SMatrix<T, N, N>,
    b: &SVector<T, N>,
    size: usize,
) -> Option<SVector<T, N>> {
    let size = size.min(N);
    let solved = eliminate_leading(a, b, size);
    solved.map(|(x, _)| SVector::from_fn(|i, _| if i < size { x[i] } else { T::zero() }))
}

/// The inverse of the leading block of `size` rows and columns. The rest comes from the identity, which is
/// eliminated together with the block.
#[inline]
pub fn inverse_leading<T: Real, const N: usize>(
    a: &SMatrix<T, N, N>,
    size: usize,
) -> Option<SMatrix<T, N, N>> {
    let size = size.min(N);
    let one = SMatrix::from_fn(|i, j| match i == j && i < size {
        true => T::one(),
        false => T::zero(),
    });
    eliminate_leading(a, &one, size).map(|(x, _)| x)
}

/// Solves for `M` right sides at once and also returns the determinant.
///
/// The pivot of a column is the entry whose smallest absolute real part over the lanes is largest: all lanes exchange
/// the same rows, so the choice must suit the worst lane.
#[inline]
fn eliminate<T: Real, const N: usize, const M: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
) -> Option<(SMatrix<T, N, M>, T)> {
    eliminate_leading(a, b, N)
}

/// Like `eliminate`, for the leading block of `size` rows and columns, where `size` is at most `N`.
#[inline(always)]
fn eliminate_leading<T: Real, const N: usize, const M: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
    size: usize,
) -> Option<(SMatrix<T, N, M>, T)> {
    let mut a = a.data.0;
    let mut x = b.data.0;
    let mut det = T::one();
    for k in 0..size {
        let mut pivot = k;
        let mut best = weight(a[k][k]);
        for (i, entry) in a[k].iter().enumerate().take(size).skip(k + 1) {
            let candidate = weight(*entry);
            if candidate.exceeds(best) {
                best = candidate;
                pivot = i;
            }
        }
        if !is_usable(best) {
            return None;
        }
        if pivot != k {
            for column in &mut a {
                column.swap(k, pivot);
            }
            for column in &mut x {
                column.swap(k, pivot);
            }
            det = -det;
        }
        det *= a[k][k];
        let reciprocal = T::one() / a[k][k];
        for i in k + 1..size {
            let factor = a[k][i] * reciprocal;
            for column in a.iter_mut().take(size).skip(k + 1) {
                let above = column[k];
                column[i] -= factor * above;
            }
            for column in &mut x {
                let above = column[k];
                column[i] -= factor * above;
            }
        }
    }
    for column in &mut x {
        for k in (0..size).rev() {
            let mut sum = column[k];
            for j in k + 1..size {
                sum -= a[j][k] * column[j];
            }
            column[k] = sum / a[k][k];
        }
    }
    Some((SMatrix::from_data(nalgebra::ArrayStorage(x)), det))
}

/// The absolute value by which pivots are compared, without derivatives. NaN counts as zero.
#[inline(always)]
pub(crate) fn weight<T: Real>(x: T) -> T {
    x.where_positive(x) - (-x).where_positive(x)
}

/// Whether a pivot of this weight is positive and finite in its worst lane.
#[inline(always)]
pub(crate) fn is_usable<T: Real>(weight: T) -> bool {
    weight.exceeds(T::zero()) && !weight.exceeds(T::from_f64(f64::MAX))
}

/// Whether a number is zero in every lane. Such a diagonal entry belongs to an equation that does not contain its own
/// unknown, such as a constraint.
#[inline(always)]
pub(super) fn vanishes<T: Real>(x: T) -> bool {
    x.nowhere_positive() && (-x).nowhere_positive()
}

/// The solution of the leading `size` equations, rows and columns multiplied by scales first.
#[inline]
pub fn solve_scaled<T: Real, const N: usize>(
    entry: impl Fn(usize, usize) -> T,
    b: &SVector<T, N>,
    scale: &[T; N],
    size: usize,
) -> Option<SVector<T, N>> {
    let scaled = SMatrix::<T, N, N>::from_fn(|i, j| entry(i, j) * scale[i] * scale[j]);
    let right = SVector::<T, N>::from_fn(|i, _| b[i] * scale[i]);
    let x = solve_leading(&scaled, &right, size)?;
    Some(SVector::from_fn(|i, _| x[i] * scale[i]))
}

/// Scales of rows and columns of a symmetric matrix whose diagonal vanishes at constraints. They come from
/// [`Real::balance`]; a constraint is scaled by the power of two that brings its scaled row to the size of the
/// others. Without constraints, returns false and leaves the scales unchanged. Without scales, light bodies would be
/// lost next to the constraints, whose entries do not depend on masses.
#[inline]
pub fn held_scales<T: Real>(scale: &mut [T], entry: impl Fn(usize, usize) -> T) -> bool {
    let size = scale.len();
    if !(0..size).any(|i| vanishes(entry(i, i))) {
        return false;
    }
    for (i, scale) in scale.iter_mut().enumerate() {
        *scale = entry(i, i).balance();
    }
    for i in (0..size).filter(|i| vanishes(entry(*i, *i))) {
        let mut square = T::zero();
        for j in (0..size).filter(|j| !vanishes(entry(*j, *j))) {
            let x = entry(i, j) * scale[j];
            square += x * x;
        }
        scale[i] = square.balance();
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix4, Vector4};

    #[rustfmt::skip]
    fn sample() -> Matrix4<f64> {
        Matrix4::new(
            0.0, 2.0, -1.0, 0.5,
            3.0, 0.25, 1.0, -2.0,
            -1.5, 4.0, 0.0, 1.0,
            0.75, -0.5, 2.5, 3.0,
        )
    }

    #[test]
    fn solution_satisfies_the_system() {
        let b = Vector4::new(1.0, -2.0, 3.0, 0.5);
        let x = solve(&sample(), &b).expect("regular");
        assert!((sample() * x - b).norm() < 1e-14);
        let inv = inverse(&sample()).expect("regular");
        assert!((sample() * inv - Matrix4::identity()).norm() < 1e-14);
    }

    #[test]
    fn determinant_agrees_with_nalgebra_and_changes_sign_with_a_row_exchange() {
        let mut a = sample();
        let reference = a.determinant();
        assert!((determinant(&a) - reference).abs() < 1e-13);
        a.swap_rows(1, 3);
        assert!((determinant(&a) + reference).abs() < 1e-13);
    }

    #[test]
    fn singular_and_nan_are_refused() {
        let b = Vector4::new(1.0, 0.0, 0.0, 0.0);
        assert!(solve(&Matrix4::zeros(), &b).is_none());
        assert!(solve(&Matrix4::from_element(f64::NAN), &b).is_none());
        let tiny = Matrix4::identity() * 1e-200;
        assert!(solve(&tiny, &b).is_some());
    }
}
