//! The innermost loops of deposit and gather, for one row of cells. Deposit adds the masses of particles to the
//! `K x K` nodes around each particle; gather reads derivatives from these nodes. Takes the rows of nodes that the
//! splines of the row of cells cover. The loops use indices, since iterator adaptors are not inlined.

use super::position::Position;
use super::sorted::Particle;
use super::spline::{Basis, Splines};
use crate::Real;

/// Adds the masses of the particles of one row of cells to `K` rows of the padded grid.
#[inline(always)]
pub(super) fn scatter<T: Real, const D: usize, const K: usize>(
    places: &mut [T],
    width: usize,
    particles: &[Particle<T, D>],
) where
    Splines<K>: Basis<K>,
{
    let mut rest = places;
    let rows: [&mut [T]; K] = core::array::from_fn(|_| {
        let (row, behind) = core::mem::take(&mut rest).split_at_mut(width);
        rest = behind;
        row
    });
    for particle in particles {
        let across = Splines::<K>::values(particle.fraction[0]);
        if D == 1 {
            for i in 0..K {
                rows[i][0] += particle.mass * across[i];
            }
            continue;
        }
        let mut along = Splines::<K>::values(particle.fraction[D - 1]);
        for weight in &mut along {
            *weight *= particle.mass;
        }
        let column = particle.column();
        for i in 0..K {
            let row = rows[i].get_mut(column..column + K);
            if let Some(row) = row.and_then(|row| row.first_chunk_mut::<K>()) {
                for j in 0..K {
                    row[j] += across[i] * along[j];
                }
            }
        }
    }
}

/// The derivatives at the particles of one row of cells, from `K` rows of the padded grid.
#[inline(always)]
pub(super) fn gather<T: Real, A: Position<T, D>, const D: usize, const K: usize>(
    places: &[T],
    width: usize,
    density: &[T; D],
    particles: &[Particle<T, D>],
    out: &mut [A],
) where
    Splines<K>: Basis<K>,
{
    let mut rest = places;
    let rows: [&[T]; K] = core::array::from_fn(|_| {
        let (row, behind) = rest.split_at(width);
        rest = behind;
        row
    });
    for particle in particles {
        let slopes = Splines::<K>::slopes(particle.fraction[0]);
        let mut sum = [T::zero(); D];
        if D == 1 {
            for i in 0..K {
                sum[0] += rows[i][0] * slopes[i];
            }
        } else {
            let across = Splines::<K>::values(particle.fraction[0]);
            let along = Splines::<K>::values(particle.fraction[D - 1]);
            let along_slopes = Splines::<K>::slopes(particle.fraction[D - 1]);
            let column = particle.column();
            for i in 0..K {
                let row = rows[i].get(column..column + K);
                if let Some(row) = row.and_then(|row| row.first_chunk::<K>()) {
                    let (mut value, mut change) = (T::zero(), T::zero());
                    for j in 0..K {
                        value += row[j] * along[j];
                        change += row[j] * along_slopes[j];
                    }
                    sum[0] += slopes[i] * value;
                    sum[D - 1] += across[i] * change;
                }
            }
        }
        for d in 0..D {
            sum[d] *= density[d] * particle.mass;
            if particle.is_mirrored(d) {
                sum[d] = -sum[d];
            }
        }
        if let Some(place) = out.get_mut(particle.number()) {
            *place = A::of(sum);
        }
    }
}

/// Interpolates values at the nodes to the particles of one row of cells, from `K` rows of the padded grid.
#[inline(always)]
pub(super) fn interpolate<T: Real, const D: usize, const K: usize>(
    places: &[T],
    width: usize,
    particles: &[Particle<T, D>],
    out: &mut [T],
) where
    Splines<K>: Basis<K>,
{
    for particle in particles {
        let across = Splines::<K>::values(particle.fraction[0]);
        let mut sum = T::zero();
        for (row, weight) in places.chunks_exact(width).zip(across) {
            if D == 1 {
                sum += row[0] * weight;
                continue;
            }
            let along = Splines::<K>::values(particle.fraction[D - 1]);
            let column = particle.column();
            let own = row.get(column..column + K).unwrap_or_default();
            let each = own.iter().zip(along);
            sum += each.fold(T::zero(), |sum, (value, along)| sum + *value * along) * weight;
        }
        if let Some(place) = out.get_mut(particle.number()) {
            *place = sum;
        }
    }
}
