//! Block-tridiagonal matrices of lines, and of rings, where the first site and the last are neighbours too.
//! Takes blocks, site by site; gives factors and solutions, in a number of operations that grows with the
//! number of sites.
//!
//! A ring is solved by bordering: its last site is taken out, the others are an open line, what they do to
//! the last one is one block. Pivots are chosen within blocks.

// Rows and columns of one list.
#![allow(clippy::needless_range_loop)]

use super::pivots;
use crate::Real;

/// A matrix of blocks of size `n`, each column after column, and its factors.
#[derive(Clone, Debug)]
pub(super) struct Blocks<T> {
    n: usize,
    sites: usize,
    /// Whether the first site and the last are neighbours besides.
    closed: bool,
    /// The blocks of a site with itself, with the one before, with the one after.
    own: Vec<T>,
    before: Vec<T>,
    after: Vec<T>,
    /// Of each site what is left of its block when those before are eliminated, factored; and that times `after`.
    left: Vec<T>,
    pivots: Vec<usize>,
    onward: Vec<T>,
    /// Of a ring: what the last site does to each other one.
    border: Vec<T>,
    scratch: Vec<T>,
    /// The site whose block had no pivot.
    without_pivot: Option<usize>,
}

/// `out -= a x`, matrices of `n` rows, `x` and `out` of as many columns as they have.
#[inline(always)]
fn take<T: Real>(n: usize, a: &[T], x: &[T], out: &mut [T]) {
    for (x, out) in x.chunks_exact(n).zip(out.chunks_exact_mut(n)) {
        for k in 0..n {
            let factor = x[k];
            for i in 0..n {
                out[i] -= a[n * k + i] * factor;
            }
        }
    }
}

impl<T: Real> Blocks<T> {
    /// All zeros.
    pub fn new(n: usize, sites: usize, ring: bool) -> Self {
        // The neighbours of two sites are each other on either side; that of one is itself.
        let closed = ring && sites > 2;
        let list = || vec![T::zero(); n * n * sites];
        Self {
            n,
            sites,
            closed,
            own: list(),
            before: list(),
            after: list(),
            left: list(),
            pivots: vec![0; n * sites],
            onward: list(),
            border: if closed { list() } else { Vec::new() },
            scratch: vec![T::zero(); n],
            without_pivot: None,
        }
    }

    /// Back to zeros.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.own.fill(T::zero());
        self.before.fill(T::zero());
        self.after.fill(T::zero());
    }

    /// Where a block begins.
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

    /// Adds to the block of a site and of a neighbour.
    #[inline(always)]
    pub fn add(&mut self, row: usize, column: usize, block: &[T]) {
        let (list, from) = self.place(row, column);
        for (x, y) in list[from..].iter_mut().zip(block) {
            *x += *y;
        }
    }

    /// The block of a site with itself.
    pub fn own(&self, site: usize) -> &[T] {
        let size = self.n * self.n;
        &self.own[size * site..size * (site + 1)]
    }

    /// Makes the equation of a site `x = 0`, which no other one sees.
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

    /// The same of one component of a site.
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

    /// The site whose block had no pivot when the matrix was factored last.
    pub fn without_pivot(&self) -> Option<usize> {
        self.without_pivot
    }

    /// How many sites the open line has that is eliminated first.
    fn open(&self) -> usize {
        self.sites - usize::from(self.closed)
    }

    /// Whether the pivots of a site are more than this part of the columns of its own block.
    #[inline(always)]
    fn is_above(&self, n: usize, site: usize, floor: f64) -> bool {
        let size = n * n;
        let (own, left) = (
            &self.own[size * site..size * (site + 1)],
            &self.left[size * site..size * (site + 1)],
        );
        let mut columns = (0..n).map(|k| (k, &own[n * k..n * (k + 1)]));
        columns.all(|(k, column)| {
            let largest = crate::scalar::largest(column.iter().map(|x| x.magnitude()));
            left[n * k + k].magnitude() > floor * largest
        })
    }

    /// Factors; where a block has no pivot, or none above `floor` times its own columns, the site.
    #[inline(always)]
    pub fn factor(&mut self, n: usize, floor: f64) -> Result<(), usize> {
        let done = self.factor_all(n, floor);
        self.without_pivot = done.err();
        done
    }

    #[inline(always)]
    fn factor_all(&mut self, n: usize, floor: f64) -> Result<(), usize> {
        let size = n * n;
        let open = self.open();
        self.left.copy_from_slice(&self.own);
        for i in 0..open {
            let here = size * i..size * (i + 1);
            if i > 0 {
                let there = size * (i - 1)..size * i;
                take(
                    n,
                    &self.before[here.clone()],
                    &self.onward[there],
                    &mut self.left[here.clone()],
                );
            }
            let (left, own) = (
                &mut self.left[here.clone()],
                &mut self.pivots[n * i..n * (i + 1)],
            );
            if !pivots::factor(n, left, own) {
                return Err(i);
            }
            if i + 1 < open {
                self.onward[here.clone()].copy_from_slice(&self.after[here.clone()]);
                for column in self.onward[here].chunks_exact_mut(n) {
                    pivots::solve(n, left, own, column);
                }
            }
            if floor > 0.0 && !self.is_above(n, i, floor) {
                return Err(i);
            }
        }
        match !self.closed || self.factor_border(n) {
            true if floor <= 0.0 || self.is_above(n, self.sites - 1, floor) => Ok(()),
            _ => Err(self.sites - 1),
        }
    }

    /// What the last site of a ring and the others do to one another.
    #[inline(always)]
    fn factor_border(&mut self, n: usize) -> bool {
        let size = n * n;
        let (open, last) = (self.open(), self.sites - 1);
        let mut border = core::mem::take(&mut self.border);
        border.fill(T::zero());
        border[..size].copy_from_slice(&self.before[..size]);
        let end = size * (open - 1)..size * open;
        for (x, y) in border[end.clone()].iter_mut().zip(&self.after[end.clone()]) {
            *x += *y;
        }
        for k in 0..n {
            self.eliminate(n, &mut border, |i| size * i + n * k..size * i + n * (k + 1));
        }
        let here = size * last..size * (last + 1);
        take(
            n,
            &self.before[here.clone()],
            &border[end],
            &mut self.left[here.clone()],
        );
        take(
            n,
            &self.after[here.clone()],
            &border[..size],
            &mut self.left[here.clone()],
        );
        self.border = border;
        pivots::factor(
            n,
            &mut self.left[here],
            &mut self.pivots[n * last..n * (last + 1)],
        )
    }

    /// The solution on the open line; `at` is where the part of a site stands.
    #[inline(always)]
    fn eliminate(&mut self, n: usize, x: &mut [T], at: impl Fn(usize) -> core::ops::Range<usize>) {
        let size = n * n;
        let open = self.open();
        for i in 0..open {
            let here = size * i..size * (i + 1);
            if i > 0 {
                self.scratch.copy_from_slice(&x[at(i - 1)]);
                take(n, &self.before[here.clone()], &self.scratch, &mut x[at(i)]);
            }
            let own = &self.pivots[n * i..n * (i + 1)];
            pivots::solve(n, &self.left[here], own, &mut x[at(i)]);
        }
        for i in (0..open.saturating_sub(1)).rev() {
            self.scratch.copy_from_slice(&x[at(i + 1)]);
            take(
                n,
                &self.onward[size * i..size * (i + 1)],
                &self.scratch,
                &mut x[at(i)],
            );
        }
    }

    /// `x = A^-1 x` of the matrix that was factored last.
    #[inline(always)]
    pub fn solve(&mut self, n: usize, x: &mut [T]) {
        self.eliminate(n, x, |i| n * i..n * (i + 1));
        if !self.closed {
            return;
        }
        let size = n * n;
        let (open, last) = (self.open(), self.sites - 1);
        let here = size * last..size * (last + 1);
        let (others, own) = x.split_at_mut(n * last);
        take(
            n,
            &self.before[here.clone()],
            &others[n * (open - 1)..],
            own,
        );
        take(n, &self.after[here.clone()], &others[..n], own);
        let chosen = &self.pivots[n * last..n * (last + 1)];
        pivots::solve(n, &self.left[here], chosen, own);
        for i in 0..open {
            take(
                n,
                &self.border[size * i..size * (i + 1)],
                own,
                &mut others[n * i..n * (i + 1)],
            );
        }
    }
}
