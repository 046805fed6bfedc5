//! Singular values by one-sided Jacobi rotations.
//!
//! The method converges for every finite matrix in practice. It computes small singular values to high accuracy
//! (Demmel and Veselic, SIAM J. Matrix Anal. Appl. 13, 1992). Decisions about rank need this accuracy.

use nalgebra::{DMatrix, DVector};

/// Sweeps after which the rotations stop. Six to ten are usual.
const SWEEPS: usize = 60;

/// A = U diag(values) V^T with descending singular values.
pub(crate) struct Singular {
    /// As many rows as A; column j belongs to value j, and is zero if the value is zero.
    u: DMatrix<f64>,
    /// As many as A has columns. If A has fewer rows, the last values are zero.
    pub values: DVector<f64>,
    /// Square and orthogonal, with as many rows as A has columns.
    pub v: DMatrix<f64>,
}

impl Singular {
    /// Decomposes a finite matrix.
    pub fn new(a: &DMatrix<f64>) -> Self {
        let (rows, n) = a.shape();
        let scale = a.amax();
        let mut w = DMatrix::zeros(rows.max(n), n);
        if scale > 0.0 {
            w.rows_mut(0, rows).copy_from(&(a / scale));
        }
        let mut v = DMatrix::identity(n, n);
        for _ in 0..SWEEPS {
            if !sweep(&mut w, &mut v) {
                break;
            }
        }
        let norms: Vec<f64> = w.column_iter().map(|column| column.norm()).collect();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&i, &j| norms[j].total_cmp(&norms[i]));
        let mut u = DMatrix::zeros(rows, n);
        for (to, &from) in order.iter().enumerate() {
            if norms[from] > 0.0 {
                u.set_column(to, &(w.column(from).rows(0, rows) / norms[from]));
            }
        }
        let values = DVector::from_iterator(n, order.iter().map(|&j| scale * norms[j]));
        Self {
            u,
            values,
            v: v.select_columns(&order),
        }
    }

    /// The largest singular value, zero without columns.
    pub fn largest(&self) -> f64 {
        self.values.iter().fold(
            0.0,
            |most: f64, x| if x.is_nan() { *x } else { most.max(*x) },
        )
    }

    /// The number of singular values above `relative` times the largest one.
    pub fn rank(&self, relative: f64) -> usize {
        let least = relative * self.largest();
        self.values.iter().filter(|&&value| value > least).count()
    }

    /// The x of least norm that minimises |A x - b|, with singular values up to `relative` times the largest one taken
    /// as zero. With a positive `damping`, it minimises |A x - b|^2 + damping |x|^2.
    pub fn solve(&self, b: &DVector<f64>, relative: f64, damping: f64) -> DVector<f64> {
        let rank = self.rank(relative);
        let mut coefficients = self.u.tr_mul(b);
        for (j, c) in coefficients.iter_mut().enumerate() {
            let s = self.values[j];
            *c = if j < rank {
                *c / (s + damping / s)
            } else {
                0.0
            };
        }
        &self.v * coefficients
    }

    /// An orthonormal basis of the vectors that A maps to zero, up to `relative` times the largest singular value.
    pub fn kernel(&self, relative: f64) -> DMatrix<f64> {
        let rank = self.rank(relative);
        self.v.columns(rank, self.v.ncols() - rank).into_owned()
    }

    /// An orthonormal basis of the image of A, with the same decision about rank.
    pub fn image(&self, relative: f64) -> DMatrix<f64> {
        self.u.columns(0, self.rank(relative)).into_owned()
    }
}

/// Rotates every pair of columns of `w` until they are orthogonal. Returns whether any pair was not.
fn sweep(w: &mut DMatrix<f64>, v: &mut DMatrix<f64>) -> bool {
    let n = w.ncols();
    let enough = f64::EPSILON * (w.nrows() as f64).sqrt();
    let mut rotated = false;
    for i in 0..n {
        for j in i + 1..n {
            let (a, b) = (w.column(i).norm_squared(), w.column(j).norm_squared());
            let c = w.column(i).dot(&w.column(j));
            if c == 0.0 || c.abs() <= enough * a.sqrt() * b.sqrt() {
                continue;
            }
            rotated = true;
            let zeta = (b - a) / (2.0 * c);
            let t = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
            let cosine = 1.0 / t.hypot(1.0);
            rotate(w, i, j, cosine, cosine * t);
            rotate(v, i, j, cosine, cosine * t);
        }
    }
    rotated
}

/// Rotates columns i and j.
fn rotate(of: &mut DMatrix<f64>, i: usize, j: usize, cosine: f64, sine: f64) {
    let (mut x, mut y) = of.columns_range_pair_mut(i, j);
    for (x, y) in x.iter_mut().zip(y.iter_mut()) {
        (*x, *y) = (cosine * *x - sine * *y, sine * *x + cosine * *y);
    }
}
