//! A small matrix factored once for several right sides. Takes a square matrix; gives solutions.
//! For sizes 3, 6 and 9 it uses blocks of three rows without pivoting if possible, otherwise
//! elimination with pivots.

use super::elimination::vanishes;
use super::{Dense, Reals, solve_scaled};
use crate::Real;
use crate::saved::{Saved, Words};
use nalgebra::{SMatrix, SVector};

/// The factors of a matrix of which the leading `size` rows and columns count.
#[derive(Clone, Copy, Debug)]
pub struct Factors<T, const D: usize> {
    /// Columns: block `L U` factors whose pivot blocks are replaced by their inverses, or the matrix itself.
    columns: [[T; D]; D],
    size: usize,
    blocks: bool,
}

impl<const D: usize> Saved for Factors<f64, D> {
    fn words(&mut self, words: &mut Words) {
        let Self {
            columns,
            size,
            blocks,
        } = self;
        columns.words(words);
        *size = words.count(*size, D);
        blocks.words(words);
    }
}

impl<T: Real, const D: usize> Factors<T, D> {
    /// Empty factors, which solve no equation.
    #[must_use]
    pub fn none() -> Self {
        Self {
            columns: [[T::zero(); D]; D],
            size: D,
            blocks: false,
        }
    }

    /// Factors a matrix.
    #[inline(always)]
    pub fn set(&mut self, matrix: &SMatrix<T, D, D>, size: usize) {
        self.columns = matrix.data.0;
        self.size = size;
        let held = || (0..size.min(D)).any(|i| vanishes(matrix[(i, i)]));
        self.blocks = in_blocks::<D>(size) && !held() && factor(&mut self.columns);
        if !self.blocks {
            self.columns = matrix.data.0;
        }
    }

    /// The absolute value of an entry in a lane, if the matrix itself is stored, otherwise zero. It is stored if the
    /// diagonal contains zeros.
    #[must_use]
    pub fn entry(&self, i: usize, j: usize, lane: usize) -> f64 {
        match self.blocks {
            true => 0.0,
            false => self.columns[j][i].lane(lane).abs(),
        }
    }

    /// The solution of `A x = b`; `None` without a usable pivot.
    #[inline(always)]
    #[must_use]
    pub fn solve(&self, b: &SVector<T, D>) -> Option<SVector<T, D>> {
        if self.blocks {
            return Some(SVector::from_column_slice(&substitute(
                &self.columns,
                b.data.0[0],
            )));
        }
        with_pivots(&self.columns, b, self.size)
    }
}

/// A pivot block of three may be singular though the matrix is not. Which pivots are chosen does
/// not depend on units.
#[cold]
#[inline(never)]
fn with_pivots<T: Real, const D: usize>(
    columns: &[[T; D]; D],
    b: &SVector<T, D>,
    size: usize,
) -> Option<SVector<T, D>> {
    let scale: [T; D] = core::array::from_fn(|i| columns[i][i].balance());
    solve_scaled(|i, j| columns[j][i], b, &scale, size)
}

/// Whether blocks of three rows may be used: bodies in space have three coordinates, rigid motions six.
#[inline(always)]
fn in_blocks<const D: usize>(size: usize) -> bool {
    size == D && D.is_multiple_of(3) && D <= 9
}

/// `[column][row]`, with the pivot blocks replaced by their inverses; also whether all of these exist.
#[inline(always)]
fn factor<T: Real, const D: usize>(a: &mut [[T; D]; D]) -> bool {
    let mut sum = T::zero();
    for p in (0..D).step_by(3) {
        let pivot = inverse(a, p);
        sum += pivot[0][0] + pivot[1][1] + pivot[2][2];
        for (column, entries) in pivot.iter().enumerate() {
            a[p + column][p..p + 3].copy_from_slice(entries);
        }
        for column in a.iter_mut().skip(p + 3) {
            let [x, y, z] = [column[p], column[p + 1], column[p + 2]];
            for row in 0..3 {
                column[p + row] = pivot[0][row] * x + pivot[1][row] * y + pivot[2][row] * z;
            }
        }
        for j in p + 3..D {
            for i in p + 3..D {
                let taken =
                    a[p][i] * a[j][p] + a[p + 1][i] * a[j][p + 1] + a[p + 2][i] * a[j][p + 2];
                a[j][i] -= taken;
            }
        }
    }
    // The quotient by a determinant that vanishes is not finite.
    sum.is_finite()
}

/// The inverse of the block of three rows at `p`, by cofactors; not finite if the block is singular.
#[inline(always)]
fn inverse<T: Real, const D: usize>(a: &[[T; D]; D], p: usize) -> [[T; 3]; 3] {
    let at = |row: usize, column: usize| a[p + column][p + row];
    let minor = |i: usize, j: usize| {
        let (r, s) = ((i + 1) % 3, (i + 2) % 3);
        let (u, v) = ((j + 1) % 3, (j + 2) % 3);
        at(r, u) * at(s, v) - at(r, v) * at(s, u)
    };
    let first = [minor(0, 0), minor(0, 1), minor(0, 2)];
    let det = at(0, 0) * first[0] + at(0, 1) * first[1] + at(0, 2) * first[2];
    let scale = T::one() / det;
    [
        first.map(|x| x * scale),
        [minor(1, 0), minor(1, 1), minor(1, 2)].map(|x| x * scale),
        [minor(2, 0), minor(2, 1), minor(2, 2)].map(|x| x * scale),
    ]
}

#[inline(always)]
fn substitute<T: Real, const D: usize>(a: &[[T; D]; D], mut x: [T; D]) -> [T; D] {
    for p in (0..D).step_by(3) {
        let mut right = [x[p], x[p + 1], x[p + 2]];
        for q in 0..p {
            for (row, entry) in right.iter_mut().enumerate() {
                *entry -= a[q][p + row] * x[q];
            }
        }
        for row in 0..3 {
            x[p + row] = a[p][p + row] * right[0]
                + a[p + 1][p + row] * right[1]
                + a[p + 2][p + row] * right[2];
        }
    }
    for p in (0..D).step_by(3).rev() {
        for j in p + 3..D {
            for row in 0..3 {
                let taken = a[j][p + row] * x[j];
                x[p + row] -= taken;
            }
        }
    }
    x
}

/// Factors of a matrix over plain numbers whose size is known only at run time.
#[derive(Debug)]
pub struct DenseFactors {
    /// As in [`Factors`].
    columns: Dense<f64>,
    in_blocks: bool,
    blocks: bool,
}

impl Clone for DenseFactors {
    fn clone(&self) -> Self {
        DenseFactors {
            columns: self.columns.clone(),
            in_blocks: self.in_blocks,
            blocks: self.blocks,
        }
    }

    // Copies into the existing lists, without a new allocation.
    fn clone_from(&mut self, source: &Self) {
        (self.columns.rows, self.columns.cols) = (source.columns.rows, source.columns.cols);
        self.columns.data.clone_from(&source.columns.data);
        (self.in_blocks, self.blocks) = (source.in_blocks, source.blocks);
    }
}

impl Saved for DenseFactors {
    fn words(&mut self, words: &mut Words) {
        let Self {
            columns,
            // Decided by the sizes of the model.
            in_blocks: _,
            blocks,
        } = self;
        columns.words(words);
        blocks.words(words);
    }
}

impl DenseFactors {
    /// Empty factors, which solve no equation. `in_blocks` allows blocks of three rows.
    #[must_use]
    pub fn none(size: usize, in_blocks: bool) -> Self {
        Self {
            columns: Dense::zeros(size, size),
            in_blocks: in_blocks && size.is_multiple_of(3) && size <= 9,
            blocks: false,
        }
    }

    /// Forgets the matrix.
    pub fn forget(&mut self) {
        self.columns.data.fill(0.0);
        self.blocks = false;
    }

    /// Factors a matrix.
    pub fn set(&mut self, matrix: &Dense<f64>) {
        let n = matrix.rows;
        let held = || (0..n).any(|i| vanishes(matrix.at(i, i)));
        (self.columns.rows, self.columns.cols) = (n, matrix.cols);
        self.columns.data.clone_from(&matrix.data);
        self.blocks = self.in_blocks
            && !held()
            && match n {
                3 => self.factored::<3>(matrix),
                6 => self.factored::<6>(matrix),
                _ => self.factored::<9>(matrix),
            };
    }

    /// Factors a matrix in blocks. The matrix remains if that is not possible.
    fn factored<const D: usize>(&mut self, matrix: &Dense<f64>) -> bool {
        let mut columns = matrix.fixed::<D, D>();
        let done = factor(&mut columns.data.0);
        if done {
            self.columns.data.copy_from_slice(columns.as_slice());
        }
        done
    }

    /// The absolute value of an entry, if the matrix itself is stored, otherwise zero.
    #[must_use]
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        match self.blocks {
            true => 0.0,
            false => self.columns.at(i, j).abs(),
        }
    }

    /// The solution of `A x = b`; `None` without a usable pivot.
    #[must_use]
    pub fn solve(&self, b: &[f64]) -> Option<Reals> {
        fn substituted<const D: usize>(columns: &Dense<f64>, b: &[f64]) -> Reals {
            let right = core::array::from_fn(|i| b.get(i).copied().unwrap_or(0.0));
            Reals::from_slice(&substitute(&columns.fixed::<D, D>().data.0, right))
        }
        fn eliminated<const D: usize>(columns: &Dense<f64>, b: &[f64]) -> Option<Reals> {
            let right = SVector::from_fn(|i, _| b.get(i).copied().unwrap_or(0.0));
            let size = columns.rows;
            let x = with_pivots(&columns.fixed::<D, D>().data.0, &right, size)?;
            Some(x.iter().copied().take(size).collect())
        }
        match (self.blocks, self.columns.rows) {
            (true, 3) => Some(substituted::<3>(&self.columns, b)),
            (true, 6) => Some(substituted::<6>(&self.columns, b)),
            (true, _) => Some(substituted::<9>(&self.columns, b)),
            (false, ..=3) => eliminated::<3>(&self.columns, b),
            (false, 4..=6) => eliminated::<6>(&self.columns, b),
            (false, 7..=12) => eliminated::<12>(&self.columns, b),
            (false, _) => self.columns.balanced_solution(b).map(Reals::from_vec),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::solve_leading;

    fn of<const D: usize>(a: &SMatrix<f64, D, D>, size: usize) -> Factors<f64, D> {
        let mut factors = Factors::none();
        factors.set(a, size);
        factors
    }

    #[test]
    fn blocks_solve_as_elimination_does() {
        // A dominant diagonal: the condition is below 4, both solve to a few roundings.
        let a = SMatrix::<f64, 9, 9>::from_fn(|i, j| {
            if i == j {
                3.0
            } else {
                ((7 * i + 3 * j) % 11) as f64 / 44.0 - 0.125
            }
        });
        let b = SVector::<f64, 9>::from_fn(|i, _| i as f64 - 3.5);
        let x = of(&a, 9).solve(&b).expect("regular");
        assert!((a * x - b).amax() < 1e-14);
        assert!((x - solve_leading(&a, &b, 9).expect("regular")).amax() < 1e-14);
    }

    #[test]
    fn a_singular_pivot_block_is_no_singular_matrix() {
        let one = SMatrix::<f64, 3, 3>::identity();
        let mut a = SMatrix::<f64, 6, 6>::zeros();
        a.fixed_view_mut::<3, 3>(0, 3).copy_from(&one);
        a.fixed_view_mut::<3, 3>(3, 0).copy_from(&one);
        let b = SVector::<f64, 6>::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
        let x = of(&a, 6).solve(&b).expect("regular");
        assert_eq!(x, SVector::<f64, 6>::new(4.0, 5.0, 6.0, 1.0, 2.0, 3.0));
        assert!(of(&SMatrix::<f64, 6, 6>::zeros(), 6).solve(&b).is_none());
    }

    #[test]
    fn units_that_are_powers_of_four_change_no_bit() {
        let a = SMatrix::<f64, 12, 12>::from_fn(|i, j| {
            ((7 * i + 5 * j) % 13) as f64 / 13.0 + if i == j { 0.3 } else { 0.0 }
        });
        let b = SVector::<f64, 12>::from_fn(|i, _| i as f64 - 3.5);
        let unit = |i: usize| f64::from([-40, 2, 36][i % 3]).exp2();
        let scaled = SMatrix::<f64, 12, 12>::from_fn(|i, j| a[(i, j)] * unit(i) * unit(j));
        let right = SVector::<f64, 12>::from_fn(|i, _| b[i] * unit(i));
        let x = of(&a, 12).solve(&b).expect("regular");
        assert!((a * x - b).amax() < 1e-12);
        let y = of(&scaled, 12).solve(&right).expect("regular");
        assert_eq!(x, SVector::<f64, 12>::from_fn(|i, _| y[i] * unit(i)));
    }

    #[test]
    fn surplus_rows_are_left_out() {
        let a = SMatrix::<f64, 4, 4>::from_diagonal_element(2.0);
        let b = SVector::<f64, 4>::repeat(2.0);
        let x = of(&a, 2).solve(&b).expect("regular");
        assert_eq!(x, SVector::<f64, 4>::new(1.0, 1.0, 0.0, 0.0));
    }
}
