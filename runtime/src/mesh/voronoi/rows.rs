//! A symmetric, positive definite operator on the sites of a mesh, stored by rows: cell areas, and couplings between
//! pairs of sites. Its owner recomputes it at every update. Gives the product of a row with values.

use crate::Real;

/// `(H x)_a = A_a x_a + sum_b w_ab (x_a - x_b)`, with nonnegative `w_ab`.
#[derive(Clone, Debug)]
pub struct Rows<T> {
    /// The start of each row, and the end of the last row.
    pub(super) start: Vec<u32>,
    /// The sites to which each site is coupled.
    pub(super) columns: Vec<u32>,
    /// The off-diagonal entries `-w_ab`.
    pub(super) entries: Vec<T>,
    /// The diagonal entries and their inverses.
    pub(super) diagonal: Vec<T>,
    pub(super) inverse: Vec<T>,
    /// Areas of the cells.
    pub(super) areas: Vec<T>,
}

impl<T: Real> Rows<T> {
    pub(super) fn new(sites: usize, entries: usize) -> Self {
        Self {
            start: vec![0; sites + 1],
            columns: vec![0; entries],
            entries: vec![T::zero(); entries],
            diagonal: vec![T::zero(); sites],
            inverse: vec![T::zero(); sites],
            areas: vec![T::zero(); sites],
        }
    }

    /// Inverts the diagonal; call this once it is complete.
    pub(super) fn invert_diagonal(&mut self) {
        for (inverse, diagonal) in self.inverse.iter_mut().zip(&self.diagonal) {
            *inverse = T::one() / *diagonal;
        }
    }

    /// The range of a row's entries.
    #[inline(always)]
    pub(super) fn range(&self, a: usize) -> core::ops::Range<usize> {
        self.start[a] as usize..self.start[a + 1] as usize
    }

    /// The product of a row with `x`.
    #[inline(always)]
    pub(super) fn row(&self, a: usize, x: &[T]) -> T {
        let range = self.range(a);
        let columns = &self.columns[range.clone()];
        let mut sum = self.diagonal[a] * x[a];
        for (&b, &entry) in columns.iter().zip(&self.entries[range]) {
            sum += entry * x[b as usize];
        }
        sum
    }
}
