//! Matrices over the integers modulo a prime, stored by rows, for exact random points. Plain loops: the macro's
//! engine is compiled without optimisation, and iterators would cost ten times as much.

use super::{add, inverse, mul, negate};
use crate::work;

/// A matrix over the field, stored by rows.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Matrix {
    pub(crate) rows: usize,
    pub(crate) cols: usize,
    pub(crate) data: Vec<u64>,
}

impl Matrix {
    pub(crate) fn from_fn(rows: usize, cols: usize, f: impl Fn(usize, usize) -> u64) -> Matrix {
        let mut data = Vec::with_capacity(rows * cols);
        let mut i = 0;
        while i < rows {
            let mut j = 0;
            while j < cols {
                data.push(f(i, j));
                j += 1;
            }
            i += 1;
        }
        Matrix { rows, cols, data }
    }

    pub(crate) fn number(x: u64) -> Matrix {
        Matrix {
            rows: 1,
            cols: 1,
            data: vec![x],
        }
    }

    pub(crate) fn identity(n: usize) -> Matrix {
        let mut out = Matrix::zeros(n, n);
        let data = out.data.as_mut_slice();
        let mut i = 0;
        while i < n {
            data[i * n + i] = 1;
            i += 1;
        }
        out
    }

    #[inline(always)]
    pub(crate) fn at(&self, i: usize, j: usize) -> u64 {
        let (data, k) = (self.data.as_slice(), i * self.cols + j);
        if k < data.len() { data[k] } else { 0 }
    }

    pub(crate) fn plus(mut self, b: &Matrix) -> Matrix {
        let (own, other) = (self.data.as_mut_slice(), b.data.as_slice());
        let mut k = 0;
        while k < own.len() && k < other.len() {
            own[k] = add(own[k], other[k]);
            k += 1;
        }
        self
    }

    pub(crate) fn scaled(mut self, x: u64) -> Matrix {
        let own = self.data.as_mut_slice();
        let mut k = 0;
        while k < own.len() {
            own[k] = mul(x, own[k]);
            k += 1;
        }
        self
    }

    /// The product over the common number of columns and rows.
    pub(crate) fn times(&self, b: &Matrix) -> Matrix {
        if self.data.len() == 1 {
            return b.clone().scaled(self.data[0]);
        }
        if b.data.len() == 1 {
            return self.clone().scaled(b.data[0]);
        }
        work::take(self.data.len() * b.cols);
        let (left, right) = (self.data.as_slice(), b.data.as_slice());
        let mut data = vec![0; self.rows * b.cols];
        let out = data.as_mut_slice();
        let mut i = 0;
        while i < self.rows {
            let mut k = 0;
            while k < self.cols && k < b.rows {
                let x = left[i * self.cols + k];
                let mut j = 0;
                while x != 0 && j < b.cols {
                    let at = i * b.cols + j;
                    out[at] = add(out[at], mul(x, right[k * b.cols + j]));
                    j += 1;
                }
                k += 1;
            }
            i += 1;
        }
        Matrix {
            rows: self.rows,
            cols: b.cols,
            data,
        }
    }

    pub(crate) fn transposed(self) -> Matrix {
        if self.rows == 1 || self.cols == 1 {
            return Matrix {
                rows: self.cols,
                cols: self.rows,
                data: self.data,
            };
        }
        Matrix::from_fn(self.cols, self.rows, |i, j| self.at(j, i))
    }

    /// Inverse and determinant; `None` for a singular matrix.
    pub(crate) fn inverted(&self) -> Option<(Matrix, u64)> {
        let n = self.rows;
        work::take(2 * n * n * n);
        let (mut a, mut b, mut det) = (self.clone(), Matrix::identity(n), 1);
        for c in 0..n {
            let p = (c..n).find(|r| a.at(*r, c) != 0)?;
            if p != c {
                det = negate(det);
                for k in 0..n {
                    a.data.swap(c * n + k, p * n + k);
                    b.data.swap(c * n + k, p * n + k);
                }
            }
            let d = a.at(c, c);
            det = mul(det, d);
            let d = inverse(d)?;
            for k in 0..n {
                a.data[c * n + k] = mul(a.at(c, k), d);
                b.data[c * n + k] = mul(b.at(c, k), d);
            }
            for r in (0..n).filter(|r| *r != c) {
                let f = negate(a.at(r, c));
                for k in 0..n {
                    a.data[r * n + k] = add(a.at(r, k), mul(f, a.at(c, k)));
                    b.data[r * n + k] = add(b.at(r, k), mul(f, b.at(c, k)));
                }
            }
        }
        Some((b, det))
    }

    pub(crate) fn zeros(rows: usize, cols: usize) -> Matrix {
        Matrix {
            rows,
            cols,
            data: vec![0; rows * cols],
        }
    }

    /// Whether every entry is zero.
    pub(crate) fn vanishes(&self) -> bool {
        self.data.iter().all(|x| *x == 0)
    }

    /// `tr(self^T b)`, for matrices of equal shape.
    pub(crate) fn pairing(&self, b: &Matrix) -> u64 {
        let pairs = self.data.iter().zip(&b.data);
        pairs.fold(0, |s, (x, y)| add(s, mul(*x, *y)))
    }

    /// `tr(self^T b)`, where `b` is given by its nonzero entries, which are 1 or -1. The cost is the number of these
    /// entries, for any size of the matrix.
    pub(crate) fn paired(&self, b: &[(usize, usize, i64)]) -> u64 {
        paired(&self.data, self.cols, b)
    }
}

/// Like [`Matrix::paired`], for entries stored by rows with `cols` columns.
pub(crate) fn paired(data: &[u64], cols: usize, b: &[(usize, usize, i64)]) -> u64 {
    b.iter().fold(0, |sum, (i, j, x)| {
        let own = data.get(i * cols + j).copied().unwrap_or(0);
        add(sum, if *x < 0 { negate(own) } else { own })
    })
}
