//! Loops over several threads, with bitwise identical results for any number of threads. Collected items keep their
//! order; sums are computed in pieces of fixed length and added in order. Threads need the feature `rayon`.

use crate::Real;
use crate::line::Threads;
use core::ops::Range;
#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// The number of sites in a piece.
const PIECE: usize = 1024;

/// The smallest number of pieces for a thread; with fewer, waking the thread costs more than it saves.
#[cfg(feature = "rayon")]
const FEWEST: usize = 2;

impl Threads {
    /// The number of pieces for each thread; `None` if one thread suffices.
    #[cfg(feature = "rayon")]
    fn pieces_each(self, pieces: usize) -> Option<usize> {
        let parts = self.0.min(pieces / FEWEST);
        (parts > 1).then(|| pieces.div_ceil(parts))
    }

    /// Collects the results from parts of a range, in order; returns whether all parts succeed.
    pub(super) fn collect(
        self,
        range: Range<usize>,
        out: &mut Vec<u32>,
        find: impl Fn(Range<usize>, &mut Vec<u32>) -> bool + Sync,
    ) -> bool {
        #[cfg(feature = "rayon")]
        if let Some(each) = self.pieces_each(range.len().div_ceil(PIECE)) {
            let each = each * PIECE;
            let starts = range.clone().into_par_iter().step_by(each);
            let parts: Vec<_> = starts
                .map(|start| {
                    let mut found = Vec::new();
                    let good = find(start..range.end.min(start + each), &mut found);
                    (good, found)
                })
                .collect();
            return parts.into_iter().all(|(good, found)| {
                out.extend(found);
                good
            });
        }
        find(range, out)
    }
}

/// Sums over pieces of a list.
#[derive(Clone, Debug)]
pub(super) struct Sums<T> {
    threads: Threads,
    pieces: Vec<[T; 2]>,
}

impl<T: Real> Sums<T> {
    pub fn new(sites: usize) -> Self {
        Self {
            threads: Threads::ONE,
            pieces: vec![[T::zero(); 2]; sites.div_ceil(PIECE)],
        }
    }

    pub fn share(&mut self, threads: Threads) {
        self.threads = threads;
    }

    /// Computes two sums over all sites, and writes `one` and `other`. `each` is called for every piece, with the
    /// number of its first site.
    pub fn over(
        &mut self,
        one: &mut [T],
        other: &mut [T],
        each: impl Fn(usize, &mut [T], &mut [T]) -> [T; 2] + Sync,
    ) -> [T; 2] {
        let part = |first: usize, sums: &mut [[T; 2]], one: &mut [T], other: &mut [T]| {
            let pieces = one.chunks_mut(PIECE).zip(other.chunks_mut(PIECE));
            for (k, (sum, (one, other))) in sums.iter_mut().zip(pieces).enumerate() {
                *sum = each(first + k * PIECE, one, other);
            }
        };
        self.run(one, other, part);
        let mut sum = [T::zero(); 2];
        for piece in &self.pieces {
            sum[0] += piece[0];
            sum[1] += piece[1];
        }
        sum
    }

    fn run(
        &mut self,
        one: &mut [T],
        other: &mut [T],
        part: impl Fn(usize, &mut [[T; 2]], &mut [T], &mut [T]) + Sync,
    ) {
        #[cfg(feature = "rayon")]
        if let Some(each) = self.threads.pieces_each(self.pieces.len()) {
            let sums = self.pieces.par_chunks_mut(each).enumerate();
            let one = one.par_chunks_mut(each * PIECE);
            let other = other.par_chunks_mut(each * PIECE);
            return sums
                .zip(one)
                .zip(other)
                .for_each(|(((k, sums), one), other)| {
                    part(k * each * PIECE, sums, one, other);
                });
        }
        part(0, &mut self.pieces, one, other);
    }
}
