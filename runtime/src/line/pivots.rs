//! Small square matrices in lists, column after column, factored in place with partial pivoting: of a
//! size that is known when a model is built, or when it is read, in the same operations.
//! Takes a matrix; gives its factors, with the reciprocals of pivots, and solutions.

// Rows and columns of one list.
#![allow(clippy::needless_range_loop)]

use crate::Real;

/// By what pivots are chosen: their size in the lane where it is least.
fn weight<T: Real>(x: T) -> T {
    x * x
}

/// Factors a matrix of size `n`; false where no pivot is found, or it is not finite.
#[inline(always)]
pub(super) fn factor<T: Real>(n: usize, a: &mut [T], pivots: &mut [usize]) -> bool {
    for k in 0..n {
        let mut best = k;
        for i in k + 1..n {
            if weight(a[n * k + i]).exceeds(weight(a[n * k + best])) {
                best = i;
            }
        }
        pivots[k] = best;
        let size = weight(a[n * k + best]);
        if !crate::linalg::is_usable(size) {
            return false;
        }
        if best != k {
            for j in 0..n {
                a.swap(n * j + k, n * j + best);
            }
        }
        let reciprocal = T::one() / a[n * k + k];
        a[n * k + k] = reciprocal;
        for i in k + 1..n {
            a[n * k + i] *= reciprocal;
        }
        for j in k + 1..n {
            let above = a[n * j + k];
            for i in k + 1..n {
                let factor = a[n * k + i];
                a[n * j + i] -= factor * above;
            }
        }
    }
    true
}

/// `x = A^-1 x` of a matrix that is factored.
#[inline(always)]
pub(super) fn solve<T: Real>(n: usize, a: &[T], pivots: &[usize], x: &mut [T]) {
    for k in 0..n {
        if pivots[k] != k {
            x.swap(k, pivots[k]);
        }
    }
    for k in 0..n {
        for i in k + 1..n {
            let above = x[k];
            x[i] -= a[n * k + i] * above;
        }
    }
    for k in (0..n).rev() {
        x[k] *= a[n * k + k];
        for i in 0..k {
            let below = x[k];
            x[i] -= a[n * k + i] * below;
        }
    }
}

/// Whether the pivots of a matrix that is factored are more than this part of the columns of another.
pub(super) fn are_above<T: Real>(n: usize, a: &[T], of: &[T], floor: f64) -> bool {
    (0..n).all(|k| {
        let column = &of[n * k..n * (k + 1)];
        let largest = crate::scalar::largest(column.iter().map(|x| x.magnitude()));
        let reciprocal = a[n * k + k];
        let part = floor * largest;
        part * part * (reciprocal * reciprocal).greatest() < 1.0
    })
}
