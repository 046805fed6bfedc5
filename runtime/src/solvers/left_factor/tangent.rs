//! Solves the linear equation `X A + A^T X = G` for a skew `X`, by elimination with partial pivoting. Takes `A`; gives
//! a factorisation that can be reused for several right sides.

use crate::Real;
use crate::linalg::{is_usable, weight};
use nalgebra::SMatrix;

/// The largest number of unknowns: the number of pairs of eight axes.
const MOST: usize = super::factor::LARGEST * (super::factor::LARGEST - 1) / 2;

/// The factored operator in the coordinates `X_ij`, `i < j`, row by row.
pub(super) struct Tangent<T, const N: usize> {
    rows: [[T; MOST]; MOST],
    pivots: [usize; MOST],
}

/// The index of the pair `i < j`.
#[inline(always)]
const fn place<const N: usize>(i: usize, j: usize) -> usize {
    i * (2 * N - i - 1) / 2 + (j - i - 1)
}

impl<T: Real, const N: usize> Tangent<T, N> {
    const UNKNOWNS: usize = N * (N - 1) / 2;

    /// Uninitialised work arrays.
    #[inline]
    pub(super) fn blank() -> Self {
        Self {
            rows: [[T::zero(); MOST]; MOST],
            pivots: [0; MOST],
        }
    }

    /// Factors in place; returns false if the operator is singular or not finite.
    #[inline]
    pub(super) fn factorise(&mut self, a: &SMatrix<T, N, N>) -> bool {
        let Self { rows, pivots } = self;
        for row in rows.iter_mut().take(Self::UNKNOWNS) {
            row[..Self::UNKNOWNS].fill(T::zero());
        }
        for i in 0..N {
            for j in i + 1..N {
                let row = &mut rows[place::<N>(i, j)];
                for k in 0..N {
                    let (to_i, to_j) = (a[(k, i)], a[(k, j)]);
                    if i < k {
                        row[place::<N>(i, k)] += to_j;
                    } else if k < i {
                        row[place::<N>(k, i)] -= to_j;
                    }
                    if k < j {
                        row[place::<N>(k, j)] += to_i;
                    } else if j < k {
                        row[place::<N>(j, k)] -= to_i;
                    }
                }
            }
        }
        for k in 0..Self::UNKNOWNS {
            let (mut pivot, mut best) = (k, weight(rows[k][k]));
            for (i, row) in rows.iter().enumerate().take(Self::UNKNOWNS).skip(k + 1) {
                let candidate = weight(row[k]);
                if candidate.exceeds(best) {
                    (pivot, best) = (i, candidate);
                }
            }
            if !is_usable(best) {
                return false;
            }
            pivots[k] = pivot;
            rows.swap(k, pivot);
            let (above, below) = rows.split_at_mut(k + 1);
            let head = &mut above[k];
            let reciprocal = T::one() / head[k];
            for row in below.iter_mut().take(Self::UNKNOWNS - k - 1) {
                let factor = row[k] * reciprocal;
                row[k] = factor;
                for j in k + 1..Self::UNKNOWNS {
                    row[j] -= factor * head[j];
                }
            }
            // Stored as inverses, so that each solve multiplies.
            head[k] = reciprocal;
        }
        true
    }

    /// The skew `X` for a skew right side.
    #[inline]
    pub(super) fn solve(&self, g: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        let mut x = [T::zero(); MOST];
        for i in 0..N {
            for j in i + 1..N {
                x[place::<N>(i, j)] = g[(i, j)];
            }
        }
        // Factorisation exchanged whole rows, so the right side is permuted before it is reduced.
        for k in 0..Self::UNKNOWNS {
            x.swap(k, self.pivots[k]);
        }
        for i in 1..Self::UNKNOWNS {
            let mut sum = x[i];
            for (entry, known) in self.rows[i].iter().zip(&x).take(i) {
                sum -= *entry * *known;
            }
            x[i] = sum;
        }
        for i in (0..Self::UNKNOWNS).rev() {
            let mut sum = x[i];
            let row = self.rows[i].iter().zip(&x);
            for (entry, known) in row.take(Self::UNKNOWNS).skip(i + 1) {
                sum -= *entry * *known;
            }
            x[i] = sum * self.rows[i][i];
        }
        let mut out = SMatrix::zeros();
        for i in 0..N {
            for j in i + 1..N {
                let value = x[place::<N>(i, j)];
                out[(i, j)] = value;
                out[(j, i)] = -value;
            }
        }
        out
    }
}
