//! Factors small square matrices in place with partial pivoting. Matrices are lists in column-major order. The
//! operations are the same whether the size is known at compile time or at run time. Takes a matrix; gives its factors
//! with reciprocal pivots, and solutions.

// Loops index rows and columns of one list.
#![allow(clippy::needless_range_loop)]

use crate::Real;

/// The size by which pivots are chosen. Comparisons use the lane in which it is smallest.
fn weight<T: Real>(x: T) -> T {
    x * x
}

/// Factors a matrix of size `n`. Returns false if a pivot is zero or not finite.
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

/// Computes `x = A^-1 x` with a factored matrix.
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

/// Whether every pivot of the factored matrix `a` exceeds `floor` times the largest entry of the same column of `of`.
pub(super) fn are_above<T: Real>(n: usize, a: &[T], of: &[T], floor: f64) -> bool {
    (0..n).all(|k| {
        let column = &of[n * k..n * (k + 1)];
        let largest = crate::scalar::largest(column.iter().map(|x| x.magnitude()));
        let reciprocal = a[n * k + k];
        let part = floor * largest;
        part * part * (reciprocal * reciprocal).greatest() < 1.0
    })
}
