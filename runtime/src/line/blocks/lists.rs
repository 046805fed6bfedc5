//! Elimination for blocks that are large or whose size is known only at run time. Blocks are slices of lists, factored
//! with pivots.

use super::Blocks;
use crate::Real;
use crate::line::pivots;

/// Computes `out -= a x` for matrices with `n` rows; `x` and `out` have equally many columns.
#[inline(always)]
fn take<T: Real>(n: usize, a: &[T], x: &[T], out: &mut [T]) {
    for (x, out) in x.chunks_exact(n).zip(out.chunks_exact_mut(n)) {
        for (a, x) in a.chunks_exact(n).zip(x) {
            for (out, a) in out.iter_mut().zip(a) {
                *out -= *a * *x;
            }
        }
    }
}

impl<T: Real> Blocks<T> {
    /// Whether every pivot of a site exceeds `floor` times the largest entry of the same column of its original block.
    fn is_above(&self, n: usize, site: usize, floor: f64) -> bool {
        let here = n * n * site..n * n * (site + 1);
        floor <= 0.0 || pivots::are_above(n, &self.own[here], &self.scratch, floor)
    }

    /// Factors the matrix. If a pivot is not above `floor` times its own columns, the error is the first such site.
    pub(super) fn factor_lists(&mut self, n: usize, floor: f64) -> Result<(), usize> {
        let size = n * n;
        let open = self.open();
        for i in 0..open {
            let here = size * i..size * (i + 1);
            self.scratch.copy_from_slice(&self.own[here.clone()]);
            if i > 0 {
                let there = size * (i - 1)..size * i;
                take(
                    n,
                    &self.before[here.clone()],
                    &self.after[there],
                    &mut self.own[here.clone()],
                );
            }
            let (left, own) = (
                &mut self.own[here.clone()],
                &mut self.pivots[n * i..n * (i + 1)],
            );
            if !pivots::factor(n, left, own) {
                return Err(i);
            }
            if i + 1 < open {
                for column in self.after[here].chunks_exact_mut(n) {
                    pivots::solve(n, left, own, column);
                }
            }
            if !self.is_above(n, i, floor) {
                return Err(i);
            }
        }
        match !self.closed || self.factor_border(n) {
            true if self.is_above(n, self.sites - 1, floor) => Ok(()),
            _ => Err(self.sites - 1),
        }
    }

    /// Computes the coupling of the last site of a ring to the other sites.
    fn factor_border(&mut self, n: usize) -> bool {
        let size = n * n;
        let (open, last) = (self.open(), self.sites - 1);
        let mut border = core::mem::take(&mut self.border);
        border.fill(T::zero());
        border[..size].copy_from_slice(&self.before[..size]);
        let end = size * (open - 1)..size * open;
        let here = size * last..size * (last + 1);
        for (x, y) in border[end.clone()].iter_mut().zip(&self.after[end.clone()]) {
            *x += *y;
        }
        for k in 0..n {
            self.eliminate(n, &mut border, |i| size * i + n * k..size * i + n * (k + 1));
        }
        self.scratch.copy_from_slice(&self.own[here.clone()]);
        take(
            n,
            &self.before[here.clone()],
            &border[end],
            &mut self.own[here.clone()],
        );
        take(
            n,
            &self.after[here.clone()],
            &border[..size],
            &mut self.own[here.clone()],
        );
        self.border = border;
        pivots::factor(
            n,
            &mut self.own[here],
            &mut self.pivots[n * last..n * (last + 1)],
        )
    }

    /// Solves on the open chain; `at` gives the range of a site's entries in `x`.
    fn eliminate(&mut self, n: usize, x: &mut [T], at: impl Fn(usize) -> core::ops::Range<usize>) {
        let size = n * n;
        let open = self.open();
        for i in 0..open {
            let here = size * i..size * (i + 1);
            if i > 0 {
                self.scratch[..n].copy_from_slice(&x[at(i - 1)]);
                take(
                    n,
                    &self.before[here.clone()],
                    &self.scratch[..n],
                    &mut x[at(i)],
                );
            }
            let own = &self.pivots[n * i..n * (i + 1)];
            pivots::solve(n, &self.own[here], own, &mut x[at(i)]);
        }
        for i in (0..open.saturating_sub(1)).rev() {
            self.scratch[..n].copy_from_slice(&x[at(i + 1)]);
            take(
                n,
                &self.after[size * i..size * (i + 1)],
                &self.scratch[..n],
                &mut x[at(i)],
            );
        }
    }

    /// Computes `x = A^-1 x` with the last factored matrix.
    pub(super) fn solve_lists(&mut self, n: usize, x: &mut [T]) {
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
        pivots::solve(n, &self.own[here], chosen, own);
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
