//! Block-tridiagonal matrices of open chains and of rings, where the first and the last site are neighbours. Takes
//! blocks, site by site; gives factors and solutions, in time proportional to the number of sites.
//!
//! A ring is solved by bordering: the other sites form an open chain, which is eliminated first and contributes one
//! block to the last site. Pivoting stays within blocks.

mod lists;
mod small;
#[cfg(test)]
mod tests;

use crate::Real;
use small::Block;

/// The size of blocks, known at compile time or at run time. Both cases perform the same operations.
pub(super) trait Size: Copy {
    /// The number of rows.
    fn rows(self) -> usize;
    /// See [`Blocks::factor_and_solve`].
    fn factor_and_solve<T: Real>(
        self,
        blocks: &mut Blocks<T>,
        floor: f64,
        x: &mut [T],
    ) -> Result<(), usize>;
    /// See [`Blocks::solve`].
    fn solve<T: Real>(self, blocks: &mut Blocks<T>, x: &mut [T]);
}

/// Blocks with at most this many rows are arrays.
const SMALL: usize = 6;

/// A size known at compile time.
#[derive(Clone, Copy)]
pub(super) struct Fixed<const N: usize>;

impl<const N: usize> Size for Fixed<N> {
    #[inline(always)]
    fn rows(self) -> usize {
        N
    }

    fn factor_and_solve<T: Real>(
        self,
        blocks: &mut Blocks<T>,
        floor: f64,
        x: &mut [T],
    ) -> Result<(), usize> {
        if (1..=SMALL).contains(&N) {
            return small::factor_and_solve::<T, N>(blocks, floor, x);
        }
        blocks.factor_lists(N, floor)?;
        blocks.solve_lists(N, x);
        Ok(())
    }

    fn solve<T: Real>(self, blocks: &mut Blocks<T>, x: &mut [T]) {
        match (1..=SMALL).contains(&N) {
            true => small::solve::<T, N>(blocks, x),
            false => blocks.solve_lists(N, x),
        }
    }
}

/// A size known only at run time.
#[derive(Clone, Copy)]
pub(super) struct RuntimeSize(pub usize);

impl Size for RuntimeSize {
    #[inline(always)]
    fn rows(self) -> usize {
        self.0
    }

    fn factor_and_solve<T: Real>(
        self,
        blocks: &mut Blocks<T>,
        floor: f64,
        x: &mut [T],
    ) -> Result<(), usize> {
        match self.0 {
            1 => Fixed::<1>.factor_and_solve(blocks, floor, x),
            2 => Fixed::<2>.factor_and_solve(blocks, floor, x),
            3 => Fixed::<3>.factor_and_solve(blocks, floor, x),
            4 => Fixed::<4>.factor_and_solve(blocks, floor, x),
            5 => Fixed::<5>.factor_and_solve(blocks, floor, x),
            6 => Fixed::<6>.factor_and_solve(blocks, floor, x),
            n => {
                blocks.factor_lists(n, floor)?;
                blocks.solve_lists(n, x);
                Ok(())
            }
        }
    }

    fn solve<T: Real>(self, blocks: &mut Blocks<T>, x: &mut [T]) {
        match self.0 {
            1 => Fixed::<1>.solve(blocks, x),
            2 => Fixed::<2>.solve(blocks, x),
            3 => Fixed::<3>.solve(blocks, x),
            4 => Fixed::<4>.solve(blocks, x),
            5 => Fixed::<5>.solve(blocks, x),
            6 => Fixed::<6>.solve(blocks, x),
            n => blocks.solve_lists(n, x),
        }
    }
}

/// A matrix of blocks of size `n`, each in column-major order, and its factors.
#[derive(Clone, Debug)]
pub(super) struct Blocks<T> {
    n: usize,
    sites: usize,
    /// Whether the first and the last site are also neighbours.
    closed: bool,
    /// The diagonal block of each site. After factorisation: the remainder of the block after the previous sites are
    /// eliminated, inverted or factored.
    own: Vec<T>,
    /// The block that couples each site to the previous site.
    before: Vec<T>,
    /// The block that couples each site to the next site. After factorisation: the inverse of the remaining diagonal
    /// block times this block, except for the last site of an open chain.
    after: Vec<T>,
    inverted: Vec<bool>,
    pivots: Vec<usize>,
    /// For a ring, the effect of the last site on each other site.
    border: Vec<T>,
    scratch: Vec<T>,
    /// The site whose block had no pivot.
    without_pivot: Option<usize>,
}

impl<T: Real> Blocks<T> {
    /// A zero matrix.
    pub fn new(n: usize, sites: usize, ring: bool) -> Self {
        // In a ring of two sites both neighbours are the other site; in a ring of one, both are the site itself.
        let closed = ring && sites > 2;
        let list = || vec![T::zero(); n * n * sites];
        Self {
            n,
            sites,
            closed,
            own: list(),
            before: list(),
            after: list(),
            inverted: vec![false; sites],
            pivots: vec![0; n * sites],
            border: if closed { list() } else { Vec::new() },
            scratch: vec![T::zero(); n * n],
            without_pivot: None,
        }
    }

    /// The diagonal blocks.
    #[inline(always)]
    pub fn own_mut<const N: usize>(&mut self) -> &mut [Block<T, N>] {
        small::blocks_mut(&mut self.own)
    }

    /// Adds `block` to the block of site `row` and its neighbour `column`.
    #[inline(always)]
    pub fn add_block<const N: usize>(&mut self, row: usize, column: usize, block: &Block<T, N>) {
        let (list, _) = self.place(row, column);
        let own: &mut Block<T, N> = &mut small::blocks_mut(list)[row];
        for (column, added) in own.iter_mut().zip(block) {
            for (x, y) in column.iter_mut().zip(added) {
                *x += *y;
            }
        }
    }

    /// Sets the diagonal block of a site.
    #[inline(always)]
    pub fn put_own(&mut self, site: usize, block: &[T]) {
        let size = self.n * self.n;
        self.own[size * site..size * (site + 1)].copy_from_slice(block);
    }

    /// Sets the blocks that couple neighbours to zero.
    #[inline(always)]
    pub fn clear_neighbours(&mut self) {
        self.before.fill(T::zero());
        self.after.fill(T::zero());
    }

    /// Sets all blocks to zero.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.own.fill(T::zero());
        self.clear_neighbours();
    }

    /// Sets the blocks of a site: `row` contains the blocks with the previous site, with the site itself, and with the
    /// next site. Blocks beyond an open end stay zero. Do not use this for rings of one or two sites, whose neighbours
    /// coincide. The size `n` is an argument so that the compiler can use it where it is constant.
    #[inline(always)]
    pub fn put_row(&mut self, n: usize, site: usize, row: &[T]) {
        let size = n * n;
        let here = size * site..size * (site + 1);
        if self.closed || site > 0 {
            self.before[here.clone()].copy_from_slice(&row[..size]);
        }
        self.own[here.clone()].copy_from_slice(&row[size..2 * size]);
        if self.closed || site + 1 < self.sites {
            self.after[here].copy_from_slice(&row[2 * size..3 * size]);
        }
    }

    /// The list and the index at which a block starts.
    #[inline(always)]
    fn place(&mut self, row: usize, column: usize) -> (&mut [T], usize) {
        let n = self.n;
        let list = match () {
            () if row == column => &mut self.own,
            () if column == row + 1 => &mut self.after,
            () if row == column + 1 => &mut self.before,
            () if row == 0 => &mut self.before,
            () => &mut self.after,
        };
        (list, n * n * row)
    }

    /// Adds `block` to the block of site `row` and its neighbour `column`.
    #[inline(always)]
    pub fn add(&mut self, row: usize, column: usize, block: &[T]) {
        let (list, from) = self.place(row, column);
        for (x, y) in list[from..].iter_mut().zip(block) {
            *x += *y;
        }
    }

    /// The diagonal block of a site, before factorisation.
    pub fn own(&self, site: usize) -> &[T] {
        let size = self.n * self.n;
        &self.own[size * site..size * (site + 1)]
    }

    /// Replaces the equation of a site by `x = 0` and decouples it from all other equations.
    pub fn hold(&mut self, site: usize) {
        let (n, last) = (self.n, self.sites - 1);
        let size = n * n;
        let clear = |list: &mut Vec<T>, at: usize| list[size * at..size * (at + 1)].fill(T::zero());
        clear(&mut self.own, site);
        clear(&mut self.before, site);
        clear(&mut self.after, site);
        clear(&mut self.after, if site > 0 { site - 1 } else { last });
        clear(&mut self.before, if site < last { site + 1 } else { 0 });
        for k in 0..n {
            self.own[size * site + n * k + k] = T::one();
        }
    }

    /// Like `hold`, for one component of a site.
    pub fn hold_component(&mut self, site: usize, k: usize) {
        let (n, last) = (self.n, self.sites - 1);
        let size = n * n;
        let (before, after) = (
            if site > 0 { site - 1 } else { last },
            if site < last { site + 1 } else { 0 },
        );
        for j in 0..n {
            for list in [&mut self.own, &mut self.before, &mut self.after] {
                list[size * site + n * j + k] = T::zero();
            }
            self.own[size * site + n * k + j] = T::zero();
            self.after[size * before + n * k + j] = T::zero();
            self.before[size * after + n * k + j] = T::zero();
        }
        self.own[size * site + n * k + k] = T::one();
    }

    /// The site whose block had no pivot in the last factorisation.
    pub fn without_pivot(&self) -> Option<usize> {
        self.without_pivot
    }

    /// The number of sites of the open chain that is eliminated first.
    fn open(&self) -> usize {
        self.sites - usize::from(self.closed)
    }

    /// Factors the matrix in place and computes `x = A^-1 x`. If a pivot is not above `floor` times its own columns,
    /// the error is the first such site.
    #[inline(always)]
    pub fn factor_and_solve(
        &mut self,
        size: impl Size,
        floor: f64,
        x: &mut [T],
    ) -> Result<(), usize> {
        let done = size.factor_and_solve(self, floor, x);
        self.without_pivot = done.err();
        done
    }

    /// Computes `x = A^-1 x` with the last factored matrix.
    #[inline(always)]
    pub fn solve(&mut self, size: impl Size, x: &mut [T]) {
        size.solve(self, x);
    }
}
