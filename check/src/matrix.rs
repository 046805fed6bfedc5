//! Small matrices of numbers with derivatives, by rows. The result is missing if sizes do not fit.

use crate::number::Number;
use std::rc::Rc;

/// A matrix; a number has one row and one column, a vector one column.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub cols: usize,
    /// The entries, row by row. Copies of a matrix share them.
    pub entries: Rc<Vec<Number>>,
}

impl Matrix {
    /// The matrix with these entries, by row and column.
    pub fn from_entries(
        rows: usize,
        cols: usize,
        mut of: impl FnMut(usize, usize) -> Number,
    ) -> Self {
        let mut entries = Vec::with_capacity(rows * cols);
        for i in 0..rows {
            for j in 0..cols {
                entries.push(of(i, j));
            }
        }
        Self::of_rows(rows, cols, entries)
    }

    /// The matrix with these entries, row by row.
    #[must_use]
    pub fn of_rows(rows: usize, cols: usize, entries: Vec<Number>) -> Self {
        Self {
            rows,
            cols,
            entries: Rc::new(entries),
        }
    }

    /// The entries, row by row, to be changed.
    pub fn entries_mut(&mut self) -> &mut [Number] {
        Rc::make_mut(&mut self.entries).as_mut_slice()
    }

    /// A number.
    #[must_use]
    pub fn number(n: Number) -> Self {
        Self::of_rows(1, 1, vec![n])
    }

    /// The identity.
    #[must_use]
    pub fn identity(n: usize) -> Self {
        Self::from_entries(n, n, |i, j| Number::exact(f64::from(u8::from(i == j))))
    }

    /// Its value, if it is a number.
    #[must_use]
    pub fn as_number(&self) -> Option<&Number> {
        match (self.rows, self.cols) {
            (1, 1) => self.entries.first(),
            _ => None,
        }
    }

    /// The entry in this row and column, or zero outside the matrix.
    #[must_use]
    pub fn at(&self, i: usize, j: usize) -> Number {
        let inside = i < self.rows && j < self.cols;
        let entry = self.entries.get(i * self.cols + j).filter(|_| inside);
        entry.cloned().unwrap_or_default()
    }

    fn size(&self) -> (usize, usize) {
        (self.rows, self.cols)
    }

    /// Applies a function to each entry.
    #[must_use]
    pub fn map(&self, of: impl Fn(&Number) -> Number) -> Self {
        Self::of_rows(self.rows, self.cols, self.entries.iter().map(of).collect())
    }

    /// The sum of two matrices of the same size.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Option<Self> {
        let both = self.entries.iter().zip(other.entries.iter());
        let sum = || both.map(|(a, b)| a.plus(b)).collect();
        (self.size() == other.size()).then(|| Self::of_rows(self.rows, self.cols, sum()))
    }

    /// The opposite.
    #[must_use]
    pub fn negated(&self) -> Self {
        self.map(|x| x.clone().negated())
    }

    /// The transpose.
    #[must_use]
    pub fn transposed(&self) -> Self {
        Self::from_entries(self.cols, self.rows, |i, j| self.at(j, i))
    }

    /// The product; numbers multiply everything.
    #[must_use]
    pub fn times(&self, other: &Self) -> Option<Self> {
        if let Some(a) = self.as_number().filter(|_| other.rows != 1) {
            return Some(other.map(|x| a.times(x)));
        }
        if let Some(b) = other.as_number().filter(|_| self.cols != 1) {
            return Some(self.map(|x| x.times(b)));
        }
        (self.cols == other.rows).then(|| {
            Self::from_entries(self.rows, other.cols, |i, j| {
                let mut sum = Number::default();
                for k in 0..self.cols {
                    let a = self.entries.get(i * self.cols + k);
                    let b = other.entries.get(k * other.cols + j);
                    if let (Some(a), Some(b)) = (a, b)
                        && !a.is_zero()
                        && !b.is_zero()
                    {
                        sum.add_product(a, b);
                    }
                }
                sum
            })
        })
    }

    /// The sum of the diagonal.
    #[must_use]
    pub fn trace(&self) -> Number {
        let each = (0..self.rows.min(self.cols)).map(|i| self.at(i, i));
        each.fold(Number::default(), |sum, x| sum.plus(&x))
    }

    /// The determinant of a square matrix.
    #[must_use]
    pub fn determinant(&self) -> Option<Number> {
        if self.rows != self.cols {
            return None;
        }
        Some(match self.rows {
            0 => Number::exact(1.0),
            n if n <= 4 => (0..n).fold(Number::default(), |sum, j| {
                let minor = self.without(0, j).determinant().unwrap_or_default();
                let term = self.at(0, j).times(&minor);
                match j % 2 {
                    0 => sum.plus(&term),
                    _ => sum.minus(&term),
                }
            }),
            _ => self.eliminated(&Self::identity(self.rows)).1,
        })
    }

    fn without(&self, row: usize, col: usize) -> Self {
        let skip = |i: usize, past: usize| i + usize::from(i >= past);
        Self::from_entries(self.rows - 1, self.cols - 1, |i, j| {
            self.at(skip(i, row), skip(j, col))
        })
    }

    /// The inverse of a square matrix.
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        if self.rows != self.cols {
            return None;
        }
        if self.rows > 3 {
            return Some(self.eliminated(&Self::identity(self.rows)).0);
        }
        let determinant = self.determinant()?;
        Some(Self::from_entries(self.rows, self.rows, |i, j| {
            let minor = self.without(j, i).determinant().unwrap_or_default();
            let signed = if (i + j) % 2 == 0 {
                minor
            } else {
                minor.negated()
            };
            signed.over(&determinant)
        }))
    }

    /// The solution of a linear system by elimination, and the determinant.
    fn eliminated(&self, right: &Self) -> (Self, Number) {
        let n = self.rows;
        let row = |m: &Self, i: usize| -> Vec<Number> { (0..m.cols).map(|j| m.at(i, j)).collect() };
        let mut left: Vec<Vec<Number>> = (0..n).map(|i| row(self, i)).collect();
        let mut out: Vec<Vec<Number>> = (0..n).map(|i| row(right, i)).collect();
        let mut determinant = Number::exact(1.0);
        for k in 0..n {
            let size = |i: &usize| left[*i][k].value.abs();
            let best = (k..n).max_by(|a, b| size(a).total_cmp(&size(b)));
            let best = best.unwrap_or(k);
            if best != k {
                left.swap(k, best);
                out.swap(k, best);
                determinant = determinant.negated();
            }
            let pivot = left[k][k].clone();
            determinant = determinant.times(&pivot);
            for list in [&mut left[k], &mut out[k]] {
                list.iter_mut().for_each(|x| *x = x.over(&pivot));
            }
            for i in (0..n).filter(|i| *i != k) {
                let factor = left[i][k].clone();
                if factor.is_zero() {
                    continue;
                }
                for both in [&mut left, &mut out] {
                    let own = both[k].clone();
                    let each = both[i].iter_mut().zip(&own);
                    each.for_each(|(x, y)| *x = x.minus(&factor.times(y)));
                }
            }
        }
        let entries = out.into_iter().flatten().collect();
        (Self::of_rows(n, right.cols, entries), determinant)
    }
}
