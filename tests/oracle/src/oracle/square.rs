//! Square matrices and vectors of the oracle, generic over its numbers: products, traces, determinants, inverses and the hat map
//! from nested arrays in row-major order. The code is deliberately plain, with no special cases by shape and no algebraic
//! identities.

use super::dual::Number;
use std::ops::{Add, Mul, Neg, Sub};

/// An `N` by `N` matrix, row-major.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Square<T, const N: usize>(pub [[T; N]; N]);

impl<T: Number, const N: usize> Square<T, N> {
    /// The matrix whose entry in row `i` and column `j` is `entry(i, j)`.
    pub fn from_entries(entry: impl Fn(usize, usize) -> T) -> Self {
        let mut entries = [[T::constant(0.0); N]; N];
        // Loops, because an array function with a closure would be compiled again for every caller.
        for (i, row) in entries.iter_mut().enumerate() {
            for (j, place) in row.iter_mut().enumerate() {
                *place = entry(i, j);
            }
        }
        Self(entries)
    }

    /// The identity.
    #[must_use]
    pub fn identity() -> Self {
        Self::from_entries(|i, j| T::constant(if i == j { 1.0 } else { 0.0 }))
    }

    /// A constant matrix.
    #[must_use]
    pub fn constant(values: &Square<f64, N>) -> Self {
        Self::from_entries(|i, j| T::constant(values.0[i][j]))
    }

    /// The transpose.
    #[must_use]
    pub fn transpose(&self) -> Self {
        Self::from_entries(|i, j| self.0[j][i])
    }

    /// Every entry times a scalar.
    #[must_use]
    pub fn scaled(&self, factor: T) -> Self {
        Self::from_entries(|i, j| self.0[i][j] * factor)
    }

    /// The matrix times a column.
    #[must_use]
    pub fn apply(&self, column: &[T; N]) -> [T; N] {
        let mut result = *column;
        for (entry, row) in result.iter_mut().zip(&self.0) {
            *entry = dot(row, column);
        }
        result
    }

    /// The sum of the diagonal.
    #[must_use]
    pub fn trace(&self) -> T {
        (0..N).fold(T::constant(0.0), |sum, i| sum + self.0[i][i])
    }

    /// The second invariant `(tr(A)² - tr(A²))/2`.
    #[must_use]
    pub fn second_invariant(&self) -> T {
        let trace = self.trace();
        (trace * trace - (*self * *self).trace()) * T::constant(0.5)
    }

    /// The determinant, by elimination with row exchanges.
    #[must_use]
    pub fn determinant(&self) -> T {
        let (determinant, _) = self.eliminate();
        determinant
    }

    /// The inverse, by elimination with row exchanges; non-finite if the matrix is singular.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let (_, inverse) = self.eliminate();
        inverse
    }

    /// Determinant and inverse by Gauss-Jordan elimination with partial pivoting.
    fn eliminate(&self) -> (T, Self) {
        let mut left = self.0;
        let mut right = Self::identity().0;
        let mut determinant = T::constant(1.0);
        for column in 0..N {
            let mut pivot = column;
            for row in column + 1..N {
                if left[row][column].value().abs() > left[pivot][column].value().abs() {
                    pivot = row;
                }
            }
            if pivot != column {
                left.swap(pivot, column);
                right.swap(pivot, column);
                determinant = -determinant;
            }
            let head = left[column][column];
            determinant = determinant * head;
            for j in 0..N {
                left[column][j] = left[column][j] / head;
                right[column][j] = right[column][j] / head;
            }
            for row in 0..N {
                if row != column {
                    let factor = left[row][column];
                    let (source, inverse_source) = (left[column], right[column]);
                    for j in 0..N {
                        left[row][j] = left[row][j] - factor * source[j];
                        right[row][j] = right[row][j] - factor * inverse_source[j];
                    }
                }
            }
        }
        (determinant, Self(right))
    }
}

impl<T: Number, const N: usize> Mul for Square<T, N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::from_entries(|i, j| {
            (0..N).fold(T::constant(0.0), |sum, k| {
                sum + self.0[i][k] * other.0[k][j]
            })
        })
    }
}

impl<T: Number, const N: usize> Add for Square<T, N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::from_entries(|i, j| self.0[i][j] + other.0[i][j])
    }
}

impl<T: Number, const N: usize> Sub for Square<T, N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::from_entries(|i, j| self.0[i][j] - other.0[i][j])
    }
}

impl<T: Number, const N: usize> Neg for Square<T, N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::from_entries(|i, j| -self.0[i][j])
    }
}

/// A constant column.
#[must_use]
pub fn constant_column<T: Number, const N: usize>(values: &[f64; N]) -> [T; N] {
    values.map(T::constant)
}

/// The sum of the products of the entries.
#[must_use]
pub fn dot<T: Number, const N: usize>(a: &[T; N], b: &[T; N]) -> T {
    (0..N).fold(T::constant(0.0), |sum, i| sum + a[i] * b[i])
}

/// The cross product.
#[must_use]
pub fn cross<T: Number>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The matrix of `w -> v × w`.
#[must_use]
pub fn hat<T: Number>(v: &[T; 3]) -> Square<T, 3> {
    let zero = T::constant(0.0);
    Square([
        [zero, -v[2], v[1]],
        [v[2], zero, -v[0]],
        [-v[1], v[0], zero],
    ])
}

/// The axial vector of the skew part `(A - Aᵀ)/2`.
#[must_use]
pub fn vee<T: Number>(a: &Square<T, 3>) -> [T; 3] {
    let half = T::constant(0.5);
    [
        half * (a.0[2][1] - a.0[1][2]),
        half * (a.0[0][2] - a.0[2][0]),
        half * (a.0[1][0] - a.0[0][1]),
    ]
}

/// The matrix `a bᵀ`.
#[must_use]
pub fn outer<T: Number, const N: usize>(a: &[T; N], b: &[T; N]) -> Square<T, N> {
    Square::from_entries(|i, j| a[i] * b[j])
}
