//! Elimination for blocks whose size is known at compile time. Blocks are arrays. A block of up to three rows is
//! inverted in closed form if its columns are far from linearly dependent; any other block is factored with pivots.

// Loops index rows and columns of arrays.
#![allow(clippy::needless_range_loop)]

use super::Blocks;
use crate::Real;
use crate::line::pivots;

/// A block in column-major order.
pub(in crate::line) type Block<T, const N: usize> = [[T; N]; N];

/// The closed form amplifies rounding by the product of the column lengths over the volume that the columns span. The
/// square of the inverse ratio must be at least this.
const VOLUME: f64 = 1.0 / 64.0;

/// The smallest squared fraction of a column that must remain after elimination. It is far above rounding level.
const LEFT: f64 = 1e-12;

#[inline(always)]
fn blocks<T, const N: usize>(list: &[T]) -> &[Block<T, N>] {
    list.as_chunks::<N>().0.as_chunks::<N>().0
}

#[inline(always)]
pub(super) fn blocks_mut<T, const N: usize>(list: &mut [T]) -> &mut [Block<T, N>] {
    list.as_chunks_mut::<N>().0.as_chunks_mut::<N>().0
}

/// `a x`.
#[inline(always)]
fn times<T: Real, const N: usize>(a: &Block<T, N>, x: &[T; N]) -> [T; N] {
    let mut out = a[0].map(|entry| entry * x[0]);
    for k in 1..N {
        for i in 0..N {
            out[i] += a[k][i] * x[k];
        }
    }
    out
}

/// `out -= a x`.
#[inline(always)]
fn take<T: Real, const N: usize>(a: &Block<T, N>, x: &[T; N], out: &mut [T; N]) {
    for k in 0..N {
        for i in 0..N {
            out[i] -= a[k][i] * x[k];
        }
    }
}

#[inline(always)]
fn dot<T: Real, const N: usize>(a: &[T; N], b: &[T; N]) -> T {
    let mut sum = a[0] * b[0];
    for k in 1..N {
        sum += a[k] * b[k];
    }
    sum
}

/// Inverts a block of up to three rows in closed form. Returns `None` unless, in every lane, the columns span a large
/// fraction of the volume that their lengths allow. If `own` is given, the result must also exceed the rounding of the
/// columns of `own`.
#[inline(always)]
fn inverse<T: Real, const N: usize>(
    a: &Block<T, N>,
    own: Option<&Block<T, N>>,
) -> Option<Block<T, N>> {
    let (rows, volume): (Block<T, N>, T) = match N {
        1 => ([[T::one(); N]; N], a[0][0]),
        2 => {
            let mut rows = [[T::zero(); N]; N];
            (rows[0][0], rows[0][1]) = (a[1][1], -a[1][0]);
            (rows[1][0], rows[1][1]) = (-a[0][1], a[0][0]);
            (rows, a[0][0] * a[1][1] - a[1][0] * a[0][1])
        }
        3 => {
            let cross = |x: &[T; N], y: &[T; N]| {
                let mut out = [T::zero(); N];
                out[0] = x[1] * y[2] - x[2] * y[1];
                out[1] = x[2] * y[0] - x[0] * y[2];
                out[2] = x[0] * y[1] - x[1] * y[0];
                out
            };
            let mut rows = [[T::zero(); N]; N];
            rows[0] = cross(&a[1], &a[2]);
            rows[1] = cross(&a[2], &a[0]);
            rows[2] = cross(&a[0], &a[1]);
            (rows, dot(&a[0], &rows[0]))
        }
        _ => return None,
    };
    let squares = a.map(|column| dot(&column, &column));
    let mut largest = squares[0];
    for square in &squares[1..] {
        largest *= *square;
    }
    // The comparison is false for NaN, and if squares overflow or underflow.
    let mut far = (volume * volume - largest * T::from_f64(VOLUME)).exceeds(T::zero());
    if let Some(own) = own {
        for k in 0..N {
            let before = dot(&own[k], &own[k]);
            far &= (squares[k] - before * T::from_f64(LEFT)).exceeds(T::zero());
        }
    }
    if !far {
        return None;
    }
    let reciprocal = T::one() / volume;
    let mut out = [[T::zero(); N]; N];
    for i in 0..N {
        for j in 0..N {
            out[j][i] = rows[i][j] * reciprocal;
        }
    }
    Some(out)
}

/// The factored matrix.
struct Factors<'a, T, const N: usize> {
    before: &'a [Block<T, N>],
    left: &'a [Block<T, N>],
    inverted: &'a [bool],
    pivots: &'a [[usize; N]],
    onward: &'a [Block<T, N>],
}

impl<'a, T: Real, const N: usize> Factors<'a, T, N> {
    #[inline(always)]
    fn of(all: &'a Blocks<T>) -> Self {
        Self {
            before: blocks(&all.before),
            left: blocks(&all.own),
            inverted: &all.inverted,
            pivots: all.pivots.as_chunks::<N>().0,
            onward: blocks(&all.after),
        }
    }

    /// Multiplies `x` by the inverse of a site's remaining block.
    #[inline(always)]
    fn undo(&self, site: usize, x: &mut [T; N]) {
        match self.inverted[site] {
            true => *x = times(&self.left[site], x),
            false => pivots::solve(N, self.left[site].as_flattened(), &self.pivots[site], x),
        }
    }

    /// Forward substitution on the open chain, for several right sides at once.
    #[inline(always)]
    fn forward<const K: usize>(&self, x: &mut [[[T; N]; K]]) {
        let mut last = [[T::zero(); N]; K];
        for (i, x) in x.iter_mut().enumerate() {
            for k in 0..K {
                if i > 0 {
                    take(&self.before[i], &last[k], &mut x[k]);
                }
                self.undo(i, &mut x[k]);
            }
            last = *x;
        }
    }

    /// Back substitution on the open chain.
    #[inline(always)]
    fn backward<const K: usize>(&self, x: &mut [[[T; N]; K]]) {
        let Some((last, before)) = x.split_last_mut() else {
            return;
        };
        let mut last = *last;
        for (x, onward) in before.iter_mut().zip(self.onward).rev() {
            for k in 0..K {
                take(onward, &last[k], &mut x[k]);
            }
            last = *x;
        }
    }
}

/// A site's remaining block, inverted or factored, and its inverse times the next block.
struct Settled<T, const N: usize> {
    left: Block<T, N>,
    inverted: bool,
    onward: Block<T, N>,
    value: [T; N],
}

/// Inverts or factors a site's remaining block. If `own` is given, the remainder must exceed the rounding of `own`.
#[inline(always)]
fn settle<T: Real, const N: usize>(
    left: Block<T, N>,
    own: Option<&Block<T, N>>,
    (floor, chosen): (f64, &mut [usize; N]),
    (onward, value): (&Block<T, N>, [T; N]),
) -> Option<Settled<T, N>> {
    match inverse(&left, own) {
        Some(left) => Some(Settled {
            left,
            inverted: true,
            onward: onward.map(|column| times(&left, &column)),
            value: times(&left, &value),
        }),
        None => pivoted(left, own, (floor, chosen), (*onward, value)),
    }
}

/// The variant with pivots. It is not inlined, so that the common case keeps its numbers in registers.
#[inline(never)]
fn pivoted<T: Real, const N: usize>(
    mut left: Block<T, N>,
    own: Option<&Block<T, N>>,
    (floor, chosen): (f64, &mut [usize; N]),
    (mut onward, mut value): (Block<T, N>, [T; N]),
) -> Option<Settled<T, N>> {
    if !pivots::factor(N, left.as_flattened_mut(), chosen) {
        return None;
    }
    if let Some(own) = own
        && !pivots::are_above(N, left.as_flattened(), own.as_flattened(), floor)
    {
        return None;
    }
    for column in onward.iter_mut().chain([&mut value]) {
        pivots::solve(N, left.as_flattened(), chosen, column);
    }
    Some(Settled {
        left,
        inverted: false,
        onward,
        value,
    })
}

/// Factors and solves. If a pivot is not above `floor` times its own columns, the error is the first such site.
pub(super) fn factor_and_solve<T: Real, const N: usize>(
    all: &mut Blocks<T>,
    floor: f64,
    x: &mut [T],
) -> Result<(), usize> {
    let (open, closed) = (all.open(), all.closed);
    let x = x.as_chunks_mut::<N>().0;
    {
        let before = blocks::<T, N>(&all.before);
        let (list, after) = (
            blocks_mut::<T, N>(&mut all.own),
            blocks_mut::<T, N>(&mut all.after),
        );
        let chosen = all.pivots.as_chunks_mut::<N>().0;
        let (mut earlier, mut found) = ([[T::zero(); N]; N], [T::zero(); N]);
        for i in 0..open {
            let own = list[i];
            let (mut block, mut value) = (own, x[i]);
            if i > 0 {
                for k in 0..N {
                    take(&before[i], &earlier[k], &mut block[k]);
                }
                take(&before[i], &found, &mut value);
            }
            let of_own = (floor > 0.0).then_some(&own);
            let how = (floor, &mut chosen[i]);
            let settled = settle(block, of_own, how, (&after[i], value)).ok_or(i)?;
            (list[i], x[i]) = (settled.left, settled.value);
            if i + 1 < open {
                after[i] = settled.onward;
            }
            all.inverted[i] = settled.inverted;
            (earlier, found) = (settled.onward, settled.value);
        }
    }
    if !closed {
        Factors::<T, N>::of(all).backward(x[..open].as_chunks_mut::<1>().0);
        return Ok(());
    }
    border::<T, N>(all, floor)?;
    close::<T, N>(all, x, true);
    Ok(())
}

/// Computes the coupling of the last site of a ring to the other sites.
fn border<T: Real, const N: usize>(all: &mut Blocks<T>, floor: f64) -> Result<(), usize> {
    let (open, last) = (all.open(), all.sites - 1);
    let mut list = core::mem::take(&mut all.border);
    list.fill(T::zero());
    let columns = blocks_mut::<T, N>(&mut list);
    columns[0] = blocks(&all.before)[0];
    let end: &Block<T, N> = &blocks(&all.after)[open - 1];
    for k in 0..N {
        for i in 0..N {
            columns[open - 1][k][i] += end[k][i];
        }
    }
    let factors = Factors::<T, N>::of(all);
    factors.forward(&mut columns[..open]);
    factors.backward(&mut columns[..open]);
    let own: Block<T, N> = blocks(&all.own)[last];
    let mut left = own;
    for k in 0..N {
        take(
            &blocks(&all.before)[last],
            &columns[open - 1][k],
            &mut left[k],
        );
        take(&blocks(&all.after)[last], &columns[0][k], &mut left[k]);
    }
    all.border = list;
    let chosen = &mut all.pivots.as_chunks_mut::<N>().0[last];
    let of_own = (floor > 0.0).then_some(&own);
    let none = ([[T::zero(); N]; N], [T::zero(); N]);
    let settled = settle(left, of_own, (floor, chosen), (&none.0, none.1)).ok_or(last)?;
    blocks_mut(&mut all.own)[last] = settled.left;
    all.inverted[last] = settled.inverted;
    Ok(())
}

/// Completes the solution on a ring; set `begun` if the forward substitution is done.
fn close<T: Real, const N: usize>(all: &Blocks<T>, x: &mut [[T; N]], begun: bool) {
    let (open, last) = (all.open(), all.sites - 1);
    let factors = Factors::<T, N>::of(all);
    let (others, own) = x.split_at_mut(last);
    let others = &mut others[..open];
    if !begun {
        factors.forward(others.as_chunks_mut::<1>().0);
    }
    factors.backward(others.as_chunks_mut::<1>().0);
    let own = &mut own[0];
    take(&factors.before[last], &others[open - 1], own);
    take(&blocks(&all.after)[last], &others[0], own);
    factors.undo(last, own);
    for (x, border) in others.iter_mut().zip(blocks(&all.border)) {
        take(border, own, x);
    }
}

/// Computes `x = A^-1 x` with the last factored matrix.
pub(super) fn solve<T: Real, const N: usize>(all: &Blocks<T>, x: &mut [T]) {
    let open = all.open();
    let x = x.as_chunks_mut::<N>().0;
    if all.closed {
        return close::<T, N>(all, x, false);
    }
    let factors = Factors::<T, N>::of(all);
    let columns = x[..open].as_chunks_mut::<1>().0;
    factors.forward(columns);
    factors.backward(columns);
}
