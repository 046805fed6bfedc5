//! Particles sorted by their row of the grid; rows are numbered along the first direction. Within a row, particles
//! are in the order of their numbers, so the order of every sum over the particles of a row is fixed. The sort is a
//! counting sort in two passes; ranges of particles are sorted independently, by several threads or one after the
//! other.

use super::super::MeshError;
use super::axis::Axis;
use super::position::Position;
use crate::Real;
use core::ops::Range;

/// The data of a particle for deposit and gather.
#[derive(Clone, Copy, Debug)]
pub(super) struct Particle<T, const D: usize> {
    /// Position within its cell, from 0 to 1 along each direction.
    pub fraction: [T; D],
    /// Its mass.
    pub mass: T,
    /// Number of its cell along the last direction; the lowest bits mark the directions in which it is mirrored.
    column: u32,
    /// Its number, from the first of its range.
    number: u32,
}

impl<T: Real, const D: usize> Particle<T, D> {
    fn none() -> Self {
        Self {
            fraction: [T::zero(); D],
            mass: T::zero(),
            column: 0,
            number: 0,
        }
    }

    /// Number of its cell along the last direction.
    #[inline(always)]
    pub fn column(&self) -> usize {
        (self.column >> 2) as usize
    }

    /// Whether it is beyond a wall along a direction.
    #[inline(always)]
    pub fn is_mirrored(&self, d: usize) -> bool {
        self.column >> d & 1 == 1
    }

    /// Its number, from the first of its range.
    #[inline(always)]
    pub fn number(&self) -> usize {
        self.number as usize
    }
}

/// The particles of a field, sorted.
#[derive(Clone, Debug)]
pub(super) struct Sorted<T, const D: usize> {
    particles: Vec<Particle<T, D>>,
    /// The row of each particle, in the order of numbers.
    rows: Vec<u32>,
    /// The end of each row in each range, counted from the first particle of the range.
    ends: Vec<u32>,
    /// Particles of a range.
    share: usize,
    /// Rows.
    count: usize,
    /// The number of threads that share the particles.
    #[cfg(feature = "rayon")]
    threads: usize,
}

/// Maximum number of particles in a range, unless rows are so many that their ends would need more memory than
/// particles: the data of this many particles fit into the cache, where random access is cheap.
const RANGE: usize = 1 << 16;

/// A range of particles during the sort.
struct Part<'a, T, A, const D: usize> {
    first: usize,
    at: &'a [A],
    mass: &'a [T],
    rows: &'a mut [u32],
    ends: &'a mut [u32],
    out: &'a mut [Particle<T, D>],
}

impl<T: Real, const D: usize> Sorted<T, D> {
    /// Space for this many particles and rows.
    pub fn new(particles: usize, count: usize) -> Self {
        let mut made = Self {
            particles: vec![Particle::none(); particles],
            rows: vec![0; particles],
            ends: vec![],
            share: 1,
            count,
            #[cfg(feature = "rayon")]
            threads: 1,
        };
        made.share(1);
        made
    }

    /// Sets the number of threads that sort.
    pub fn share(&mut self, threads: usize) {
        let most = RANGE.max(4 * self.count);
        let all = self.particles.len();
        self.share = all.div_ceil(threads.max(1)).clamp(1, most);
        self.ends.resize(self.count * all.div_ceil(self.share), 0);
        #[cfg(feature = "rayon")]
        {
            self.threads = threads.max(1);
        }
    }

    /// The number of pieces of work for each thread; `None` for a single thread.
    #[cfg(feature = "rayon")]
    pub fn each(&self, pieces: usize) -> Option<usize> {
        (self.threads > 1).then(|| pieces.div_ceil(self.threads).max(1))
    }

    /// Particles of a range.
    pub fn range(&self) -> usize {
        self.share
    }

    /// Sorts.
    ///
    /// # Errors
    /// The first particle in the first range that is in no cell.
    pub fn sort<A: Position<T, D>>(
        &mut self,
        axes: &[Axis; D],
        at: &[A],
        mass: &[T],
    ) -> Result<(), MeshError> {
        let (share, count) = (self.share, self.count);
        #[cfg(feature = "rayon")]
        let each = self.each(self.particles.len().div_ceil(share));
        let parts = self.particles.chunks_mut(share).enumerate();
        let parts = parts
            .zip(self.rows.chunks_mut(share))
            .zip(self.ends.chunks_mut(count))
            .zip(at.chunks(share).zip(mass.chunks(share)));
        let parts = parts.map(|((((k, out), rows), ends), (at, mass))| Part {
            first: k * share,
            at,
            mass,
            rows,
            ends,
            out,
        });
        #[cfg(feature = "rayon")]
        if let Some(each) = each {
            use rayon::prelude::*;
            let groups = grouped(parts, each).into_par_iter();
            let all: Vec<_> = groups
                .map(|group| group.into_iter().try_for_each(|p| p.sort(axes)))
                .collect();
            return all.into_iter().collect();
        }
        let mut parts = parts;
        parts.try_for_each(|p| p.sort(axes))
    }

    /// The particles of a row, range by range.
    #[inline(always)]
    pub fn row(&self, row: usize) -> impl Iterator<Item = &[Particle<T, D>]> {
        let ranges = self.particles.chunks(self.share);
        ranges
            .zip(self.ends.chunks(self.count))
            .map(move |(range, ends)| range.get(within(ends, row)).unwrap_or_default())
    }

    /// The ranges, each with its rows in order.
    pub fn ranges(&self) -> impl Iterator<Item = Rows<'_, T, D>> {
        let ranges = self.particles.chunks(self.share);
        let both = ranges.zip(self.ends.chunks(self.count));
        both.map(|(particles, ends)| Rows { particles, ends })
    }
}

/// Groups of `each` pieces of work, one group for each thread. With `with_min_len` instead, rayon distributes an odd
/// number of pieces unevenly.
#[cfg(feature = "rayon")]
pub(super) fn grouped<P>(pieces: impl Iterator<Item = P>, each: usize) -> Vec<Vec<P>> {
    let mut pieces = pieces.peekable();
    let mut all = Vec::new();
    while pieces.peek().is_some() {
        all.push(pieces.by_ref().take(each).collect());
    }
    all
}

/// The particles of one range.
pub(super) struct Rows<'a, T, const D: usize> {
    particles: &'a [Particle<T, D>],
    ends: &'a [u32],
}

impl<T: Real, const D: usize> Rows<'_, T, D> {
    /// The particles of a row.
    #[inline(always)]
    pub fn row(&self, row: usize) -> &[Particle<T, D>] {
        let row = self.particles.get(within(self.ends, row));
        row.unwrap_or_default()
    }
}

/// The particles of a row, as indices in their range.
#[inline(always)]
fn within(ends: &[u32], row: usize) -> Range<usize> {
    let first = if row == 0 { 0 } else { ends[row - 1] };
    first as usize..ends[row] as usize
}

impl<T: Real, A: Position<T, D>, const D: usize> Part<'_, T, A, D> {
    /// Counts first, then places the particles.
    fn sort(self, axes: &[Axis; D]) -> Result<(), MeshError> {
        let density: [T; D] = core::array::from_fn(|d| axes[d].density());
        self.ends.fill(0);
        for (i, (at, row)) in self.at.iter().zip(self.rows.iter_mut()).enumerate() {
            let along = at.coordinates()[0] * density[0];
            let spot = axes[0].locate(along);
            let cell = spot.map_err(|why| why.of(self.first + i))?.cell;
            *row = cell as u32;
            self.ends[cell] += 1;
        }
        let mut first = 0;
        for end in self.ends.iter_mut() {
            (*end, first) = (first, first + *end);
        }
        let all = self.at.iter().zip(self.mass).zip(self.rows.iter());
        for (i, ((at, mass), row)) in all.enumerate() {
            let coordinates = at.coordinates();
            let mut particle = Particle {
                mass: *mass,
                number: i as u32,
                ..Particle::none()
            };
            for d in 0..D {
                let spot = axes[d].locate(coordinates[d] * density[d]);
                let spot = spot.map_err(|why| why.of(self.first + i))?;
                particle.fraction[d] = spot.fraction;
                particle.column |= u32::from(spot.mirrored) << d;
                if d > 0 {
                    particle.column |= (spot.cell as u32) << 2;
                }
            }
            let place = &mut self.ends[*row as usize];
            self.out[*place as usize] = particle;
            *place += 1;
        }
        Ok(())
    }
}

#[cfg(all(test, feature = "rayon"))]
mod tests {
    use super::{Sorted, grouped};

    #[test]
    fn work_is_shared_by_all_threads_whatever_its_pieces() {
        for threads in 2..6 {
            let mut sorted = Sorted::<f64, 2>::new(100, 10);
            sorted.share(threads);
            for pieces in threads..40 {
                let each = sorted.each(pieces).expect("several threads");
                let groups = grouped(0..pieces, each);
                assert!(groups.len() > threads / 2 && groups.len() <= threads);
                assert!(groups.into_iter().flatten().eq(0..pieces));
            }
        }
    }
}
