//! Numbers in rows and columns.

/// A column-major matrix.
#[derive(Clone, PartialEq, Debug)]
pub struct Array<N> {
    rows: usize,
    cols: usize,
    data: Vec<N>,
}

impl<N: Copy> Array<N> {
    /// The array with these entries by row and column.
    pub fn from_fn(rows: usize, cols: usize, mut entry: impl FnMut(usize, usize) -> N) -> Self {
        let mut data = Vec::with_capacity(rows * cols);
        for j in 0..cols {
            data.extend((0..rows).map(|i| entry(i, j)));
        }
        Array { rows, cols, data }
    }

    /// One number.
    pub fn number(x: N) -> Self {
        Array {
            rows: 1,
            cols: 1,
            data: vec![x],
        }
    }

    /// The array with these column-major numbers; `None` if the count differs.
    #[must_use]
    pub fn from_columns(rows: usize, cols: usize, data: Vec<N>) -> Option<Self> {
        (data.len() == rows * cols).then_some(Array { rows, cols, data })
    }

    /// The number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The number of columns.
    #[must_use]
    pub fn cols(&self) -> usize {
        self.cols
    }

    /// The numbers, column after column.
    #[must_use]
    pub fn columns(&self) -> &[N] {
        &self.data
    }

    /// The numbers, row after row.
    pub fn by_rows(&self) -> impl Iterator<Item = N> {
        (0..self.rows).flat_map(move |i| (0..self.cols).map(move |j| self.at(i, j)))
    }

    /// An entry.
    ///
    /// # Panics
    /// If the entry is outside the array. A verified kernel never reads such an entry.
    #[must_use]
    pub fn at(&self, i: usize, j: usize) -> N {
        assert!(
            i < self.rows && j < self.cols,
            "entry ({i}, {j}) of {} x {}",
            self.rows,
            self.cols
        );
        self.data[j * self.rows + i]
    }

    /// The entry, if there is one.
    #[must_use]
    pub fn get(&self, i: usize, j: usize) -> Option<N> {
        (i < self.rows && j < self.cols).then(|| self.data[j * self.rows + i])
    }

    /// Sets an entry; does nothing outside the array.
    pub fn set(&mut self, i: usize, j: usize, x: N) {
        if i < self.rows && j < self.cols {
            self.data[j * self.rows + i] = x;
        }
    }

    /// A column.
    #[must_use]
    pub fn column(&self, j: usize) -> &[N] {
        &self.data[j * self.rows..(j + 1) * self.rows]
    }

    /// Exchanges two rows.
    pub fn swap_rows(&mut self, i: usize, k: usize) {
        for column in self.data.chunks_mut(self.rows.max(1)) {
            column.swap(i, k);
        }
    }

    /// Entry by entry.
    pub fn map(&self, f: impl FnMut(N) -> N) -> Self {
        Array {
            rows: self.rows,
            cols: self.cols,
            data: self.data.iter().copied().map(f).collect(),
        }
    }

    /// Entry by entry of two arrays of the same size.
    pub fn zip(&self, other: &Self, mut f: impl FnMut(N, N) -> N) -> Self {
        let pairs = self.data.iter().zip(&other.data);
        Array {
            rows: self.rows,
            cols: self.cols,
            data: pairs.map(|(x, y)| f(*x, *y)).collect(),
        }
    }
}
