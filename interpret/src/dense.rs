//! Matrices whose size is known when a model is read. Their operations take the steps of nalgebra's
//! static ones, in the same order, so that results agree to the last bit.

use clebsch::Real;
use nalgebra::SMatrix;

/// A matrix, column after column.
#[derive(Clone, Debug, PartialEq)]
pub struct Dense<T> {
    /// Rows.
    pub rows: usize,
    /// Columns.
    pub cols: usize,
    /// The entries, column after column.
    pub data: Vec<T>,
}

impl<T: Real> Dense<T> {
    /// The matrix with these entries.
    pub fn from_fn(rows: usize, cols: usize, entry: impl Fn(usize, usize) -> T) -> Self {
        let mut data = Vec::with_capacity(rows * cols);
        for j in 0..cols {
            data.extend((0..rows).map(|i| entry(i, j)));
        }
        Dense { rows, cols, data }
    }

    /// All zeros.
    pub fn zeros(rows: usize, cols: usize) -> Self {
        Self::from_fn(rows, cols, |_, _| T::zero())
    }

    /// Ones on the diagonal.
    pub fn identity(rows: usize, cols: usize) -> Self {
        Self::from_fn(rows, cols, |i, j| if i == j { T::one() } else { T::zero() })
    }

    /// A static matrix.
    pub fn of<const R: usize, const C: usize>(a: &SMatrix<T, R, C>) -> Self {
        Dense {
            rows: R,
            cols: C,
            data: a.as_slice().to_vec(),
        }
    }

    /// An entry; zero outside.
    #[inline]
    pub fn at(&self, i: usize, j: usize) -> T {
        match i < self.rows && j < self.cols {
            true => self.data.get(j * self.rows + i).copied(),
            false => None,
        }
        .unwrap_or_else(T::zero)
    }

    /// As a static matrix, cut or filled with zeros.
    #[inline]
    pub fn fixed<const R: usize, const C: usize>(&self) -> SMatrix<T, R, C> {
        SMatrix::from_fn(|i, j| self.at(i, j))
    }

    /// Whether both have the same size.
    pub fn fits(&self, other: &Self) -> bool {
        (self.rows, self.cols) == (other.rows, other.cols)
    }

    /// Entry by entry.
    #[inline]
    pub fn map(&self, f: impl Fn(T) -> T) -> Self {
        Dense {
            rows: self.rows,
            cols: self.cols,
            data: self.data.iter().map(|x| f(*x)).collect(),
        }
    }

    /// Entry by entry of two of the same size.
    #[inline]
    pub fn zip(&self, other: &Self, f: impl Fn(T, T) -> T) -> Self {
        Dense {
            rows: self.rows,
            cols: self.cols,
            data: (self.data.iter().zip(&other.data))
                .map(|(x, y)| f(*x, *y))
                .collect(),
        }
    }

    /// The transpose.
    pub fn transpose(&self) -> Self {
        Self::from_fn(self.cols, self.rows, |i, j| self.at(j, i))
    }

    /// The sum of the diagonal.
    pub fn trace(&self) -> T {
        let mut sum = T::zero();
        for i in 0..self.rows {
            sum += self.at(i, i);
        }
        sum
    }

    /// The product: columns of the first, weighted, one after the other.
    pub fn times(&self, other: &Self) -> Self {
        let (rows, cols, one) = (self.rows, other.cols, T::one());
        let mut data: Vec<T> = Vec::with_capacity(rows * cols);
        for j in 0..cols {
            let start = data.len();
            let weight = other.at(0, j);
            data.extend((0..rows).map(|i| one * self.at(i, 0) * weight));
            for k in 1..self.cols {
                let weight = other.at(k, j);
                for i in 0..rows {
                    if let Some(y) = data.get_mut(start + i) {
                        *y = one * self.at(i, k) * weight + one * *y;
                    }
                }
            }
        }
        Dense { rows, cols, data }
    }

    /// The transpose times another.
    pub fn tr_mul(&self, other: &Self) -> Self {
        Self::from_fn(self.cols, other.cols, |i, j| {
            dot_columns(self.column(i), other.column(j))
        })
    }

    fn column(&self, j: usize) -> &[T] {
        let from = j * self.rows;
        self.data.get(from..from + self.rows).unwrap_or_default()
    }

    /// The sum of the products of entries.
    pub fn dot(&self, other: &Self) -> T {
        if self.cols == 1 {
            return dot_columns(self.column(0), other.column(0));
        }
        let columns = 0..self.cols;
        columns.fold(T::zero(), |sum, j| {
            dot_long(sum, self.column(j), other.column(j))
        })
    }
}

/// Short columns have an order of their own.
fn dot_columns<T: Real>(a: &[T], b: &[T]) -> T {
    match (a, b) {
        ([a0, a1], [b0, b1]) => *a0 * *b0 + *a1 * *b1,
        ([a0, a1, a2], [b0, b1, b2]) => *a0 * *b0 + *a1 * *b1 + *a2 * *b2,
        ([a0, a1, a2, a3], [b0, b1, b2, b3]) => {
            let (mut a, mut b) = (*a0 * *b0, *a1 * *b1);
            a += *a2 * *b2;
            b += *a3 * *b3;
            a + b
        }
        _ => dot_long(T::zero(), a, b),
    }
}

/// Eight sums side by side, then the rest.
fn dot_long<T: Real>(mut sum: T, a: &[T], b: &[T]) -> T {
    let mut parts = [T::zero(); 8];
    let (long, rest) = (a.chunks_exact(8), a.len() - a.len() % 8);
    for (x, y) in long.zip(b.chunks_exact(8)) {
        for (part, (x, y)) in parts.iter_mut().zip(x.iter().zip(y)) {
            *part += *x * *y;
        }
    }
    let [p0, p1, p2, p3, p4, p5, p6, p7] = parts;
    sum += p0 + p4;
    sum += p1 + p5;
    sum += p2 + p6;
    sum += p3 + p7;
    for (x, y) in a.iter().zip(b).skip(rest) {
        sum += *x * *y;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::Dense;
    use nalgebra::SMatrix;

    fn compare<const R: usize, const K: usize, const C: usize>() {
        let entry = |seed: usize| {
            move |i: usize, j: usize| ((7 * i + 13 * j + 29 * seed) as f64 * 0.731).sin() * 1.7
        };
        let a = SMatrix::<f64, R, K>::from_fn(entry(1));
        let b = SMatrix::<f64, K, C>::from_fn(entry(2));
        let c = SMatrix::<f64, R, K>::from_fn(entry(3));
        let (da, db, dc) = (Dense::of(&a), Dense::of(&b), Dense::of(&c));
        assert_eq!(da.times(&db), Dense::of(&(a * b)));
        assert_eq!(da.tr_mul(&dc), Dense::of(&a.tr_mul(&c)));
        assert_eq!(da.dot(&dc), a.dot(&c));
        assert_eq!(da.transpose(), Dense::of(&a.transpose()));
    }

    #[test]
    fn products_agree_with_static_ones_to_the_last_bit() {
        compare::<1, 1, 1>();
        compare::<2, 2, 1>();
        compare::<2, 3, 4>();
        compare::<4, 4, 4>();
        compare::<5, 1, 1>();
        compare::<6, 6, 6>();
        compare::<8, 8, 8>();
        compare::<9, 2, 5>();
        compare::<28, 1, 3>();
    }
}
