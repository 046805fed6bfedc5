//! A symmetric, positive definite operator on the sites of a mesh, by rows: areas of cells, and what flows between pairs
//! of sites. Made by its owner at every update; gives a row applied to values.

use crate::Real;

/// `(H x)_a = A_a x_a + sum_b w_ab (x_a - x_b)`, with `w_ab` not negative.
#[derive(Clone, Debug)]
pub struct Rows<T> {
    /// Where each row begins, and the last one ends.
    pub(super) start: Vec<u32>,
    /// The sites that each site is coupled to,
    pub(super) columns: Vec<u32>,
    /// and `-w_ab`.
    pub(super) entries: Vec<T>,
    /// Diagonal entries, and one over them.
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

    /// Once the diagonal is complete.
    pub(super) fn invert_diagonal(&mut self) {
        for (inverse, diagonal) in self.inverse.iter_mut().zip(&self.diagonal) {
            *inverse = T::one() / *diagonal;
        }
    }

    /// Which entries belong to a site.
    #[inline(always)]
    pub(super) fn range(&self, a: usize) -> core::ops::Range<usize> {
        self.start[a] as usize..self.start[a + 1] as usize
    }

    /// A row applied to `x`.
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
