//! Matrices of any size over the oracle's numbers, row-major; a scalar is 1 x 1, a vector is one column. Implements the operations
//! of the language by their definitions, with no special cases by shape.

use crate::oracle::dual::Number;

/// A matrix.
#[derive(Clone, Debug)]
pub struct Grid<T> {
    /// Rows.
    pub rows: usize,
    /// Columns.
    pub cols: usize,
    /// Entries, row by row.
    pub data: Vec<T>,
}

impl<T: Number> Grid<T> {
    /// The matrix with these entries.
    pub fn from_entries(rows: usize, cols: usize, entry: impl Fn(usize, usize) -> T) -> Self {
        let data = (0..rows * cols)
            .map(|k| entry(k / cols, k % cols))
            .collect();
        Self { rows, cols, data }
    }

    /// A scalar.
    pub fn number(x: T) -> Self {
        Self::from_entries(1, 1, |_, _| x)
    }

    /// The identity.
    #[must_use]
    pub fn identity(n: usize) -> Self {
        Self::from_entries(n, n, |i, j| T::constant(f64::from(u8::from(i == j))))
    }

    /// A constant matrix.
    #[must_use]
    pub fn constant(values: &Grid<f64>) -> Self {
        Self::from_entries(values.rows, values.cols, |i, j| {
            T::constant(values.at(i, j))
        })
    }

    /// An entry; NaN outside the matrix.
    #[must_use]
    pub fn at(&self, i: usize, j: usize) -> T {
        let inside = i < self.rows && j < self.cols;
        let entry = self.data.get(i * self.cols + j).filter(|_| inside);
        entry.copied().unwrap_or_else(|| T::constant(f64::NAN))
    }

    /// The only entry of a 1 x 1 matrix; otherwise NaN.
    #[must_use]
    pub fn scalar(&self) -> T {
        match self.data.as_slice() {
            [x] => *x,
            _ => T::constant(f64::NAN),
        }
    }

    /// Applies a function to every entry.
    #[must_use]
    pub fn each(&self, change: impl Fn(T) -> T) -> Self {
        Self::from_entries(self.rows, self.cols, |i, j| change(self.at(i, j)))
    }

    /// Multiplies by a scalar.
    #[must_use]
    pub fn scaled(&self, x: T) -> Self {
        self.each(|entry| entry * x)
    }

    /// The sum; NaN if the shapes differ.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let (rows, cols) = (self.rows.max(other.rows), self.cols.max(other.cols));
        Self::from_entries(rows, cols, |i, j| self.at(i, j) + other.at(i, j))
    }

    /// The product; either factor may be a scalar.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        if self.data.len() == 1 {
            return other.scaled(self.scalar());
        }
        if other.data.len() == 1 {
            return self.scaled(other.scalar());
        }
        let inner = self.cols.max(other.rows);
        Self::from_entries(self.rows, other.cols, |i, j| {
            (0..inner).fold(T::constant(0.0), |sum, k| {
                sum + self.at(i, k) * other.at(k, j)
            })
        })
    }

    /// The transpose.
    #[must_use]
    pub fn transposed(&self) -> Self {
        Self::from_entries(self.cols, self.rows, |i, j| self.at(j, i))
    }

    /// The sum of the diagonal.
    #[must_use]
    pub fn trace(&self) -> T {
        (0..self.rows).fold(T::constant(0.0), |sum, i| sum + self.at(i, i))
    }

    /// The determinant, by expansion along the first row without division, so that singular matrices have derivatives.
    #[must_use]
    pub fn determinant(&self) -> T {
        match self.rows {
            0 => T::constant(1.0),
            n => (0..n).fold(T::constant(0.0), |sum, j| {
                let minor = Self::from_entries(n - 1, n - 1, |r, c| {
                    self.at(r + 1, if c < j { c } else { c + 1 })
                });
                let term = self.at(0, j) * minor.determinant();
                if j % 2 == 0 { sum + term } else { sum - term }
            }),
        }
    }

    /// The inverse, by elimination with row exchanges.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let n = self.rows;
        let (mut left, mut right) = (self.clone(), Self::identity(n));
        for column in 0..n {
            let size = |row: usize| left.at(row, column).value().abs();
            let larger = |best, row| if size(row) > size(best) { row } else { best };
            let pivot = (column..n).fold(column, larger);
            for j in 0..n {
                left.data.swap(pivot * n + j, column * n + j);
                right.data.swap(pivot * n + j, column * n + j);
            }
            let head = left.at(column, column);
            for j in 0..n {
                left.data[column * n + j] = left.at(column, j) / head;
                right.data[column * n + j] = right.at(column, j) / head;
            }
            for row in (0..n).filter(|row| *row != column) {
                let factor = left.at(row, column);
                for j in 0..n {
                    left.data[row * n + j] = left.at(row, j) - factor * left.at(column, j);
                    right.data[row * n + j] = right.at(row, j) - factor * right.at(column, j);
                }
            }
        }
        right
    }

    /// A block of the matrix.
    #[must_use]
    pub fn block(&self, rows: usize, cols: usize, from: (usize, usize)) -> Self {
        Self::from_entries(rows, cols, |i, j| self.at(i + from.0, j + from.1))
    }

    /// The skew matrix of a 3-vector: `hat(v) w = v x w`.
    #[must_use]
    pub fn hat(&self) -> Self {
        let [x, y, z] = [0, 1, 2].map(|i| self.at(i, 0));
        let o = T::constant(0.0);
        let rows = [[o, -z, y], [z, o, -x], [-y, x, o]];
        Self::from_entries(3, 3, |i, j| rows[i][j])
    }

    /// The axial vector of the skew part of a 3 x 3 matrix.
    #[must_use]
    pub fn vee(&self) -> Self {
        let half = T::constant(0.5);
        let pairs = [(2, 1), (0, 2), (1, 0)];
        Self::from_entries(3, 1, |i, _| {
            let (a, b) = pairs[i];
            half * (self.at(a, b) - self.at(b, a))
        })
    }

    /// The left-multiplication matrix of a quaternion `w + v` on `(1, i, j, k)`.
    #[must_use]
    pub fn quaternion(w: T, v: [T; 3]) -> Self {
        let [x, y, z] = v;
        let rows = [[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]];
        Self::from_entries(4, 4, |i, j| rows[i][j])
    }

    /// Real and imaginary part of the quaternion closest to a 4 x 4 matrix.
    #[must_use]
    pub fn quaternion_parts(&self) -> (T, [T; 3]) {
        let unit = |k: usize| {
            let o = |on: bool| T::constant(f64::from(u8::from(on)));
            Self::quaternion(o(k == 0), [1, 2, 3].map(|i| o(i == k)))
        };
        let part = |k: usize| {
            let products = self.data.iter().zip(unit(k).data);
            let sum = products.fold(T::constant(0.0), |s, (a, b)| s + *a * b);
            sum * T::constant(0.25)
        };
        (part(0), [1, 2, 3].map(part))
    }

    /// The rotation of a unit quaternion: `v -> q v q*`, column by column.
    #[must_use]
    pub fn covered(&self) -> Self {
        let columns = [0, 1, 2].map(|k| {
            let v = [0, 1, 2].map(|i| T::constant(f64::from(u8::from(i == k))));
            let turned = self
                .times(&Self::quaternion(T::constant(0.0), v))
                .times(&self.transposed());
            turned.quaternion_parts().1
        });
        Self::from_entries(3, 3, |i, j| columns[j][i])
    }
}
