//! Loops over sites. Each value depends only on data from before the loop, so results are bitwise independent of the
//! order of sites and the number of threads. Threads need the feature `rayon`.

use super::part::Part;
use crate::Real;
use core::convert::Infallible;
use core::ops::Range;
use nalgebra::SMatrix;
#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// The number of threads that share a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Threads(pub usize);

#[cfg(feature = "rayon")]
/// The least number of sites for a thread; with fewer, waking the thread costs more than it saves.
const FEWEST: usize = 2048;

impl Threads {
    /// A single thread.
    pub const ONE: Threads = Threads(1);

    #[cfg(feature = "rayon")]
    /// The number of sites for each thread; `None` if one thread suffices.
    fn share(self, sites: usize) -> Option<usize> {
        let parts = self.0.min(sites / FEWEST);
        (parts > 1).then(|| sites.div_ceil(parts).next_multiple_of(super::part::LANES))
    }
}

/// `out[i] = value(i)` for every site.
#[inline]
pub fn fill<P: Part>(threads: Threads, out: P, value: impl Fn(usize) -> P::One + Sync + Copy) {
    let value = |i| Ok::<_, Infallible>(value(i));
    let Ok(()) = try_fill(threads, out, value);
}

/// Like `fill`, for computations that can fail at a site. If one fails, other sites may or may not be filled.
///
/// # Errors
/// The error of the site with the smallest number.
#[inline]
pub fn try_fill<P: Part, E: Send>(
    threads: Threads,
    out: P,
    value: impl Fn(usize) -> Result<P::One, E> + Sync + Copy,
) -> Result<(), (usize, E)> {
    try_in_parts(threads, out, |first, mut part| {
        let all = 0..part.count();
        try_fill_part(first, &mut part, all, &value)
    })
}

/// Splits the sites among threads and calls `done` for each part, with the number of its first site.
#[inline(always)]
pub(super) fn try_in_parts<P: Part, E: Send>(
    threads: Threads,
    all: P,
    done: impl Fn(usize, P) -> Result<(), (usize, E)> + Sync,
) -> Result<(), (usize, E)> {
    #[cfg(feature = "rayon")]
    if let Some(share) = threads.share(all.count()) {
        return try_shared(share, all, &done);
    }
    let _ = threads;
    done(0, all)
}

/// A part of a loop that may run on any thread.
#[cfg(feature = "rayon")]
type Task<'a> = Box<dyn FnOnce() + Send + 'a>;

/// Runs tasks on the threads of the pool. This function is not generic, so a model compiles the code of `rayon` once and not once
/// for each of its loops.
#[cfg(feature = "rayon")]
fn run_all(tasks: Vec<Task<'_>>) {
    tasks.into_par_iter().for_each(|task| task());
}

/// Calls `done` on several threads for parts of `share` sites each.
#[cfg(feature = "rayon")]
#[inline(never)]
fn try_shared<P: Part, E: Send>(
    share: usize,
    all: P,
    done: &(impl Fn(usize, P) -> Result<(), (usize, E)> + Sync),
) -> Result<(), (usize, E)> {
    let mut made: Vec<_> = (0..all.count().div_ceil(share)).map(|_| Ok(())).collect();
    let (mut tasks, mut rest, mut first): (Vec<Task<'_>>, _, _) = (Vec::new(), all, 0);
    for made in &mut made {
        let here = share.min(rest.count());
        let (part, others) = rest.split(here);
        tasks.push(Box::new(move || *made = done(first, part)));
        (rest, first) = (others, first + share);
    }
    run_all(tasks);
    made.into_iter().collect()
}

#[inline(always)]
pub(super) fn try_fill_part<P: Part, E>(
    first: usize,
    out: &mut P,
    sites: Range<usize>,
    value: &impl Fn(usize) -> Result<P::One, E>,
) -> Result<(), (usize, E)> {
    for i in sites {
        match value(first + i) {
            Ok(found) => out.put(i, found),
            Err(e) => return Err((first + i, e)),
        }
    }
    Ok(())
}

/// Tests the sites from `first` up to, but not including, `last`, and stops at the first failure.
///
/// # Errors
/// The error of the site with the smallest number.
pub fn try_each<E>(
    first: usize,
    last: usize,
    test: impl Fn(usize) -> Result<(), E>,
) -> Result<(), (usize, E)> {
    (first..last).try_for_each(|i| test(i).map_err(|e| (i, e)))
}

/// For every site computes `(value, kept[i]) = change(i, kept[i])` and stores the value in `out[i]`. If `change`
/// returns `None` at a site, `kept` is meaningless afterwards.
///
/// # Errors
/// The smallest site for which `change` returns `None`.
#[inline]
pub fn update<P: Part, K: Part>(
    threads: Threads,
    out: P,
    kept: K,
    change: impl Fn(usize, K::One) -> Option<(P::One, K::One)> + Sync + Copy,
) -> Result<(), usize> {
    let made = try_in_parts(threads, Two(out, kept), |first, Two(mut out, mut kept)| {
        let all = 0..out.count();
        update_part(first, &mut out, &mut kept, all, &change)
    });
    made.map_err(|(site, ())| site)
}

#[inline(always)]
pub(super) fn update_part<P: Part, K: Part>(
    first: usize,
    out: &mut P,
    kept: &mut K,
    sites: Range<usize>,
    change: &impl Fn(usize, K::One) -> Option<(P::One, K::One)>,
) -> Result<(), (usize, ())> {
    for i in sites {
        let (value, after) = change(first + i, kept.get(i)).ok_or((first + i, ()))?;
        out.put(i, value);
        kept.put(i, after);
    }
    Ok(())
}

/// Two lists over the same sites, processed together.
pub(super) struct Two<P, K>(pub(super) P, pub(super) K);

impl<P: Part, K: Part> Part for Two<P, K> {
    type One = (P::One, K::One);

    fn count(&self) -> usize {
        self.0.count()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let ((a, c), (b, d)) = (self.0.split(at), self.1.split(at));
        (Two(a, b), Two(c, d))
    }

    fn get(&self, site: usize) -> Self::One {
        (self.0.get(site), self.1.get(site))
    }

    fn put(&mut self, site: usize, (value, kept): Self::One) {
        self.0.put(site, value);
        self.1.put(site, kept);
    }
}

/// Sums the values in the order of the sites, with Neumaier's compensation.
pub fn sum<T: Real>(sites: usize, value: impl Fn(usize) -> T) -> T {
    total(sites, |i| SMatrix::<T, 1, 1>::new(value(i)))[0]
}

/// Like `sum`, for vectors or matrices, component by component.
pub fn total<T: Real, const R: usize, const C: usize>(
    sites: usize,
    value: impl Fn(usize) -> SMatrix<T, R, C>,
) -> SMatrix<T, R, C> {
    let (mut total, mut rest) = (SMatrix::zeros(), SMatrix::zeros());
    for i in 0..sites {
        let x = value(i);
        let next: SMatrix<T, R, C> = total + x;
        let lost = total.zip_zip_map(&x, &next, |total: T, x: T, next: T| {
            match total.magnitude() >= x.magnitude() {
                true => (total - next) + x,
                false => (x - next) + total,
            }
        });
        (total, rest) = (next, rest + lost);
    }
    total + rest
}

#[cfg(test)]
mod tests {
    use super::{sum, total};
    use nalgebra::Vector2;

    #[test]
    fn sums_keep_what_large_terms_hide() {
        // The large values cancel; a plain sum would lose all the small ones.
        let values = [1.0, 1e20, 0.5, -1e20, 0.25];
        assert_eq!(sum(values.len(), |i| values[i]), 1.75);
        let both = total(values.len(), |i| Vector2::new(values[i], -2.0 * values[i]));
        assert_eq!(both, Vector2::new(1.75, -3.5));
        assert_eq!(sum(0, |_| f64::NAN), 0.0);
    }
}
