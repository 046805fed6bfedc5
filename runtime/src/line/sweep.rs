//! Loops over sites. Each site's value is computed from what stood before the loop, so that the order
//! of sites, and how threads share them, changes no bit. Threads need the feature `rayon`. What is done at a site is copied
//! into the loop: behind a reference that threads share, the compiler would read everything anew at each site.

use crate::Real;
use nalgebra::SMatrix;
#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// How many threads share a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Threads(pub usize);

#[cfg(feature = "rayon")]
/// Fewest sites that a thread is given: with fewer, waking it costs more than it saves.
const FEWEST: usize = 2048;

impl Threads {
    /// One.
    pub const ONE: Threads = Threads(1);

    #[cfg(feature = "rayon")]
    /// The length of the ranges of `sites` sites, if there are to be several.
    fn share(self, sites: usize) -> Option<usize> {
        let parts = self.0.min(sites / FEWEST);
        (parts > 1).then(|| sites.div_ceil(parts))
    }
}

/// `out[i] = value(i)` for every site.
#[inline]
pub fn fill<S: Send>(threads: Threads, out: &mut [S], value: impl Fn(usize) -> S + Sync + Copy) {
    #[cfg(feature = "rayon")]
    if let Some(share) = threads.share(out.len()) {
        let parts = out.par_chunks_mut(share).enumerate();
        return parts.for_each(|(k, part)| fill_part(k * share, part, value));
    }
    let _ = threads;
    fill_part(0, out, value);
}

#[inline(always)]
fn fill_part<S>(first: usize, out: &mut [S], value: impl Fn(usize) -> S) {
    for (i, place) in out.iter_mut().enumerate() {
        *place = value(first + i);
    }
}

/// The same where a site may fail: the first one that does, and why. Others may be filled or not.
///
/// # Errors
/// That of the site with the smallest number.
#[inline]
pub fn try_fill<S: Send, E: Send>(
    threads: Threads,
    out: &mut [S],
    value: impl Fn(usize) -> Result<S, E> + Sync + Copy,
) -> Result<(), (usize, E)> {
    #[cfg(feature = "rayon")]
    if let Some(share) = threads.share(out.len()) {
        let parts = out.par_chunks_mut(share).enumerate();
        let all: Vec<_> = parts
            .map(|(k, part)| try_fill_part(k * share, part, value))
            .collect();
        return all.into_iter().collect();
    }
    let _ = threads;
    try_fill_part(0, out, value)
}

#[inline(always)]
fn try_fill_part<S, E>(
    first: usize,
    out: &mut [S],
    value: impl Fn(usize) -> Result<S, E>,
) -> Result<(), (usize, E)> {
    for (i, place) in out.iter_mut().enumerate() {
        match value(first + i) {
            Ok(found) => *place = found,
            Err(e) => return Err((first + i, e)),
        }
    }
    Ok(())
}

/// The first of the sites from `first` to the one before `last` at which a test fails, and why.
///
/// # Errors
/// That of the site with the smallest number.
pub fn try_each<E>(
    first: usize,
    last: usize,
    test: impl Fn(usize) -> Result<(), E>,
) -> Result<(), (usize, E)> {
    (first..last).try_for_each(|i| test(i).map_err(|e| (i, e)))
}

/// `(value, kept[i]) = change(i, kept[i])`, the value put into `out[i]`, for every site. Says which
/// site is the first whose change is none; what is kept then is of no meaning.
///
/// # Errors
/// The number of that site.
#[inline]
pub fn update<S: Copy + Send, K: Copy + Send>(
    threads: Threads,
    out: &mut [S],
    kept: &mut [K],
    change: impl Fn(usize, K) -> Option<(S, K)> + Sync + Copy,
) -> Result<(), usize> {
    #[cfg(feature = "rayon")]
    if let Some(share) = threads.share(out.len()) {
        let parts = out.par_chunks_mut(share).zip(kept.par_chunks_mut(share));
        let all: Vec<_> = parts
            .enumerate()
            .map(|(k, (out, kept))| update_part(k * share, out, kept, change))
            .collect();
        return all.into_iter().collect();
    }
    let _ = threads;
    update_part(0, out, kept, change)
}

/// The loop goes on behind a site that does not change, of which the smallest number is kept: sites can then be changed
/// several at a time.
#[inline(always)]
fn update_part<S: Copy, K: Copy>(
    first: usize,
    out: &mut [S],
    kept: &mut [K],
    change: impl Fn(usize, K) -> Option<(S, K)>,
) -> Result<(), usize> {
    let mut none = u64::MAX;
    for (i, (place, keep)) in out.iter_mut().zip(kept).enumerate() {
        let made = change(first + i, *keep);
        none = none.min(match made.is_some() {
            true => u64::MAX,
            false => i as u64,
        });
        (*place, *keep) = made.unwrap_or((*place, *keep));
    }
    match none {
        u64::MAX => Ok(()),
        i => Err(first + i as usize),
    }
}

/// The sum of the values of sites, in the order of sites and in two numbers (Neumaier).
pub fn sum<T: Real>(sites: usize, value: impl Fn(usize) -> T) -> T {
    total(sites, |i| SMatrix::<T, 1, 1>::new(value(i)))[0]
}

/// The same of vectors or matrices, component by component.
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
        // The large ones cancel; of the small ones a plain sum keeps none.
        let values = [1.0, 1e20, 0.5, -1e20, 0.25];
        assert_eq!(sum(values.len(), |i| values[i]), 1.75);
        let both = total(values.len(), |i| Vector2::new(values[i], -2.0 * values[i]));
        assert_eq!(both, Vector2::new(1.75, -3.5));
        assert_eq!(sum(0, |_| f64::NAN), 0.0);
    }
}
