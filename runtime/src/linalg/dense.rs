//! Matrices whose size is known only at run time, in plain loops. Every operation performs the same steps, in the
//! same order, as the operation on matrices of a static size. Results therefore agree bit for bit. Takes and gives
//! lists of entries; allocates.

use super::elimination::{is_usable, weight};
use super::{even_degrees, held_scales};
use crate::Real;
use nalgebra::SMatrix;

/// A list of numbers whose length is known only at run time. Up to 12 do not allocate.
pub type Reals = smallvec::SmallVec<[f64; 12]>;

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

    /// The identity.
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

    /// As a static matrix, truncated or filled with zeros.
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

    /// Combines two matrices of the same size, entry by entry.
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

    /// The product: the weighted columns of the first matrix, summed in order.
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

    /// The transpose times another matrix.
    pub fn tr_mul(&self, other: &Self) -> Self {
        Self::from_fn(self.cols, other.cols, |i, j| {
            dot_columns(self.column(i), other.column(j))
        })
    }

    /// The storage of an entry.
    #[inline]
    fn place(&mut self, i: usize, j: usize) -> Option<&mut T> {
        match i < self.rows && j < self.cols {
            true => self.data.get_mut(j * self.rows + i),
            false => None,
        }
    }

    /// Sets an entry; ignores indices outside of the matrix.
    #[inline]
    pub fn set(&mut self, i: usize, j: usize, x: T) {
        if let Some(place) = self.place(i, j) {
            *place = x;
        }
    }

    /// A column of numbers.
    pub fn column_of(data: Vec<T>) -> Self {
        Dense {
            rows: data.len(),
            cols: 1,
            data,
        }
    }

    /// A matrix with all entries equal to `x`.
    pub fn repeat(rows: usize, cols: usize, x: T) -> Self {
        Self::from_fn(rows, cols, |_, _| x)
    }

    /// All NaN.
    pub fn unknown(rows: usize, cols: usize) -> Self {
        Self::repeat(rows, cols, T::from_f64(f64::NAN))
    }

    /// The sum.
    pub fn plus(&self, other: &Self) -> Self {
        self.zip(other, |x, y| x + y)
    }

    /// The difference.
    pub fn minus(&self, other: &Self) -> Self {
        self.zip(other, |x, y| x - y)
    }

    /// The difference to the identity.
    pub fn minus_one(&self) -> Self {
        self.minus(&Self::identity(self.rows, self.cols))
    }

    /// Every entry times a number.
    pub fn scaled(&self, factor: T) -> Self {
        self.map(|x| x * factor)
    }

    /// The sum of the squares of all entries.
    pub fn squares(&self) -> T {
        self.data.iter().fold(T::zero(), |sum, x| sum + *x * *x)
    }

    /// Whether every entry is finite.
    pub fn is_finite(&self) -> bool {
        self.data.iter().all(|x| x.is_finite())
    }

    /// The columns, one after the other.
    pub fn columns(&self) -> Vec<Vec<T>> {
        (0..self.cols).map(|j| self.column(j).to_vec()).collect()
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

/// Systems of linear equations.
impl<T: Real> Dense<T> {
    /// Solves for several right sides at once and also returns the determinant, of the leading `size` rows and
    /// columns, like `eliminate_leading` for static sizes.
    fn eliminated(&self, right: &Self, size: usize) -> Option<(Self, T)> {
        let size = size.min(self.rows).min(self.cols);
        let sizes = [self.rows, self.cols, right.cols, size];
        let inputs = || [self.data.as_slice(), &right.data].concat();
        if let Some(whole) = T::whole(eliminated, &sizes, &inputs, right.data.len() + 2) {
            let (data, last) = whole.split_at(right.data.len());
            let &[det, found] = last else {
                return None;
            };
            let solution = Self {
                data: data.to_vec(),
                ..right.clone()
            };
            return (found == T::one()).then_some((solution, det));
        }
        let (mut a, mut x) = (self.clone(), right.clone());
        let mut det = T::one();
        for k in 0..size {
            let mut pivot = k;
            let mut best = weight(a.at(k, k));
            for i in k + 1..size {
                let candidate = weight(a.at(i, k));
                if candidate.exceeds(best) {
                    best = candidate;
                    pivot = i;
                }
            }
            if !is_usable(best) {
                return None;
            }
            if pivot != k {
                a.swap_rows(k, pivot);
                x.swap_rows(k, pivot);
                det = -det;
            }
            det *= a.at(k, k);
            let reciprocal = T::one() / a.at(k, k);
            let factors: Vec<T> = (k + 1..size).map(|i| a.at(i, k) * reciprocal).collect();
            a.take(k, &factors, k + 1..size);
            x.take(k, &factors, 0..x.cols);
        }
        for j in 0..x.cols {
            for k in (0..size).rev() {
                let mut sum = x.at(k, j);
                for i in k + 1..size {
                    sum -= a.at(k, i) * x.at(i, j);
                }
                x.set(k, j, sum / a.at(k, k));
            }
        }
        Some((x, det))
    }

    fn swap_rows(&mut self, i: usize, k: usize) {
        for column in self.data.chunks_mut(self.rows.max(1)) {
            column.swap(i, k);
        }
    }

    /// Subtracts a multiple of row `k` from each row below it.
    fn take(&mut self, k: usize, factors: &[T], columns: core::ops::Range<usize>) {
        for j in columns {
            let above = self.at(k, j);
            let from = j * self.rows + k + 1;
            let below = self.data.iter_mut().skip(from).zip(factors);
            for (x, factor) in below {
                *x -= *factor * above;
            }
        }
    }

    /// The determinant; zero if no pivot is found.
    pub fn determinant(&self) -> T {
        let at = |i: usize, j: usize| self.at(i, j);
        match self.rows {
            0 => T::one(),
            1 => at(0, 0),
            2 => at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0),
            3 => {
                at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1))
                    + at(0, 1) * (at(1, 2) * at(2, 0) - at(1, 0) * at(2, 2))
                    + at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0))
            }
            n => self
                .eliminated(&Self::zeros(n, 0), n)
                .map_or_else(T::zero, |(_, det)| det),
        }
    }

    /// The adjugate of two or three rows: as [`adjugate`](super::adjugate).
    pub fn adjugate(&self) -> Self {
        match self.rows {
            2 => Self::of(&super::adjugate(&self.fixed::<2, 2>())),
            3 => Self::of(&super::adjugate(&self.fixed::<3, 3>())),
            n => Self::unknown(n, n),
        }
    }

    /// The inverse, or `None` for a matrix without a usable pivot.
    pub fn inverse(&self) -> Option<Self> {
        self.solved(&Self::identity(self.rows, self.rows))
    }

    /// The solution of `A X = B`, or `None` under the conditions of the inverse.
    pub fn solved(&self, right: &Self) -> Option<Self> {
        self.eliminated(right, self.rows).map(|(x, _)| x)
    }

    /// The solution of the leading `size` equations in as many unknowns; the others are zero. With constraints, rows
    /// and columns are first scaled to equal size.
    pub fn leading_solved(&self, right: &Self, size: usize) -> Option<Self> {
        let mut scale = vec![T::one(); self.rows];
        let leading = scale.get_mut(..size)?;
        if held_scales(leading, |i, j| self.at(i, j)) {
            let scaled = Self::from_fn(self.rows, self.cols, |i, j| {
                self.at(i, j) * scale[i] * scale[j]
            });
            let right = Self::from_fn(right.rows, right.cols, |i, j| right.at(i, j) * scale[i]);
            let (x, _) = scaled.eliminated(&right, size)?;
            return Some(Self::from_fn(x.rows, x.cols, |i, j| match i < size {
                true => x.at(i, j) * scale[i],
                false => T::zero(),
            }));
        }
        let (x, _) = self.eliminated(right, size)?;
        Some(Self::from_fn(x.rows, x.cols, |i, j| match i < size {
            true => x.at(i, j),
            false => T::zero(),
        }))
    }

    /// The inverse of a matrix whose rows and columns are first scaled to equal size, by powers of two.
    pub fn balanced_inverse(&self) -> Option<Self> {
        let n = self.rows;
        let scale: Vec<T> = (0..n).map(|i| self.at(i, i).balance()).collect();
        let scaled = |a: &Self| {
            let mut out = a.clone();
            for (column, s) in out.data.chunks_mut(n.max(1)).zip(&scale) {
                for (x, r) in column.iter_mut().zip(&scale) {
                    *x = *x * *r * *s;
                }
            }
            out
        };
        let inverse = scaled(self).inverse()?;
        Some(scaled(&inverse))
    }

    /// The solution of `A x = b`, rows and columns brought to one size first.
    pub fn balanced_solution(&self, b: &[T]) -> Option<Vec<T>> {
        let n = self.rows;
        let scale: Vec<T> = (0..n).map(|i| self.at(i, i).balance()).collect();
        let at = |i: usize| scale.get(i).copied().unwrap_or_else(T::one);
        let scaled = Self::from_fn(n, n, |i, j| self.at(i, j) * at(i) * at(j));
        let right = b.iter().zip(&scale).map(|(x, s)| *x * *s).collect();
        let x = scaled.solved(&Self::column_of(right))?;
        Some(x.data.iter().zip(&scale).map(|(x, s)| *x * *s).collect())
    }

    /// The inverse, by cofactors if these are accurate enough, like [`small_inverse`](super::small_inverse).
    pub fn small_inverse(&self) -> Option<Self> {
        match self.rows {
            2 => super::small_inverse(&self.fixed::<2, 2>()).map(|x| Self::of(&x)),
            3 => super::small_inverse(&self.fixed::<3, 3>()).map(|x| Self::of(&x)),
            _ => self.inverse(),
        }
    }

    /// The solution of `A X = B`: as [`small_solve`](super::small_solve).
    pub fn small_solve(&self, right: &Self) -> Option<Self> {
        let by_cofactors = match self.rows {
            2 => super::cofactors::by_cofactors(&self.fixed::<2, 2>()).map(|x| Self::of(&x)),
            3 => super::cofactors::by_cofactors(&self.fixed::<3, 3>()).map(|x| Self::of(&x)),
            _ => None,
        };
        match by_cofactors {
            Some(x) => Some(x.times(right)),
            None => self.solved(right),
        }
    }
}

/// [`Dense::eliminated`] as a function of numbers: the matrix and the right sides; the solutions, the determinant, and 1 if
/// there are any.
fn eliminated(sizes: &[usize], inputs: &[f64], outputs: &mut [f64]) {
    let &[rows, cols, sides, size] = sizes else {
        return;
    };
    let part = |from: usize, cols: usize| Dense {
        rows,
        cols,
        data: inputs.get(from..from + rows * cols).unwrap_or(&[]).to_vec(),
    };
    let found = part(0, cols).eliminated(&part(rows * cols, sides), size);
    if let (Some((x, det)), Some((flag, rest))) = (found, outputs.split_last_mut()) {
        let made = x.data.into_iter().chain([det]);
        rest.iter_mut().zip(made).for_each(|(slot, x)| *slot = x);
        *flag = 1.0;
    }
}

/// Operations for matrix groups.
impl<T: Real> Dense<T> {
    /// The product in the order of group elements: summed from zero, entry by entry.
    pub fn product(&self, other: &Self) -> Self {
        let mut c = Self::zeros(self.rows, other.cols);
        for j in 0..other.cols {
            for k in 0..self.cols {
                let x = other.at(k, j);
                for i in 0..self.rows {
                    if let Some(c) = c.place(i, j) {
                        *c += self.at(i, k) * x;
                    }
                }
            }
        }
        c
    }

    /// One Newton step towards the nearest orthogonal matrix.
    pub fn orthonormalised(&self) -> Self {
        let excess = self.transpose().product(self).minus_one();
        self.minus(&self.product(&excess).scaled(T::from_f64(0.5)))
    }

    /// The skew matrix of its coordinates: for `i < j`, row by row, `-x` at (i, j) and `+x` at (j, i).
    pub fn skew_from(n: usize, coordinates: &[T]) -> Self {
        let mut skew = Self::zeros(n, n);
        let mut rest = coordinates.iter();
        for i in 0..n {
            for j in i + 1..n {
                if let Some(x) = rest.next() {
                    skew.set(i, j, -*x);
                    skew.set(j, i, *x);
                }
            }
        }
        skew
    }

    /// The coordinates of a skew matrix.
    pub fn skew_coordinates(&self) -> Vec<T> {
        let n = self.rows;
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        pairs.map(|(i, j)| self.at(j, i)).collect()
    }

    /// `A - 1` for a matrix whose columns have length 1, like [`less_identity`](super::less_identity).
    pub fn less_identity(&self) -> Self {
        let mut out = self.clone();
        for i in 0..self.rows {
            let moved = self.at(i, i) - T::one();
            let others = (0..self.rows).filter(|k| *k != i).map(|k| self.at(k, i));
            let square = others.fold(moved * moved, |sum, x| sum + x * x);
            out.set(i, i, square * T::from_f64(-0.5));
        }
        out
    }

    /// Coefficients of `det(ν + M + λ S)`: as [`pencil_coefficients`](super::pencil_coefficients).
    pub fn pencil_coefficients(&self, s: &Self) -> Self {
        let n = self.rows;
        let mut out = Self::zeros(n, n);
        let mut parts = vec![Self::zeros(n, n); n];
        if let Some(first) = parts.first_mut() {
            *first = Self::identity(n, n);
        }
        for k in 1..=n {
            let sign = if k % 2 == 0 { T::one() } else { -T::one() };
            for j in (0..=k).rev() {
                let own = parts
                    .get(j)
                    .map_or_else(|| Self::zeros(n, n), |p| s.times(p));
                let product = match j.checked_sub(1).and_then(|i| parts.get(i)) {
                    Some(below) => own.plus(&self.times(below)),
                    None => own,
                };
                let c = -product.trace() / T::from_f64(k as f64);
                if j > 0 {
                    out.set(j - 1, n - k, sign * c);
                }
                if let Some(part) = parts.get_mut(j) {
                    *part = product.plus(&Self::identity(n, n).scaled(c));
                }
            }
        }
        out
    }

    /// The coefficients of a pencil that do not vanish.
    pub fn spectrum(&self) -> Vec<T> {
        let at = even_degrees(self.rows);
        at.map(|(i, j)| self.at(i, j)).collect()
    }
}

/// Short columns use a different order of summation.
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

/// Eight parallel sums, then the rest.
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
mod tests;
