//! Measures corrections of velocities: by the largest of all, and part by part relative to the length of each part. Takes
//! velocities, corrections and scales; gives sizes by which an iteration ends.
//!
//! A part is one field or one rotation of one site. Its length is the largest of its scaled components. The equation of
//! a part contains the other parts of the same site and of its neighbours, whose rounding it inherits. So the length is
//! at least [`SHARE`] of theirs. Sites farther away do not count: their velocities do not occur in the equation, so its
//! residual can be rounding of small terms although large velocities elsewhere are rounded.

use super::root::Lists;
use super::unknown::{Unknown, starts};
use crate::Real;
use crate::scalar::larger;

/// If a correction is below this fraction of the velocity, the next one, about its square, is rounding.
pub(super) const LAST: f64 = 1e-8;

/// A residual counts as zero if it is at most this many roundings of both sides.
pub(super) const ROUNDINGS: f64 = 32.0;

/// The shortest length of a part, as a fraction of the longest part of the same site and its neighbours: about a thousand
/// roundings. The residual usually shows that a part is only rounding of longer ones. It does not if terms of the longer
/// parts cancel within a momentum; corrections of up to an eighth of this length then count as rounding.
const SHARE: f64 = 1e-13;

/// The shortest length of a part, as a fraction of the longest part of all. Squares of sizes do not overflow.
const LEAST: f64 = 1e-60;

/// Parts move alike if the smallest change, relative to the length of the part, is at least this fraction of the largest.
const ALIKE: f64 = 0.25;

/// Scales from a diagonal block. Scaled velocities have a common unit, the square root of an action.
#[inline(always)]
pub(super) fn scales_of<T: Real>(n: usize, tangent: &[T], scales: &mut [f64]) {
    for k in 0..n {
        let own = tangent[n * k + k].magnitude();
        let row = (0..n).fold(0.0_f64, |most, j| most.max(tangent[n * j + k].magnitude()));
        let size = if own > 0.0 { own } else { row };
        scales[k] = if size > 0.0 { size.sqrt() } else { 1.0 };
    }
}

/// The largest scaled entry; NaN if any entry is NaN.
#[inline(always)]
pub(super) fn largest<T: Real>(x: &[T], scales: &[f64]) -> f64 {
    const SIDE_BY_SIDE: usize = 4;
    let size = |x: T, scale: f64| {
        (
            x.greatest().abs().max(x.least().abs()) * scale,
            x.magnitude(),
        )
    };
    // Independent maxima, so that the processor computes them in parallel.
    let (mut most, mut lost) = ([0.0_f64; SIDE_BY_SIDE], false);
    let mut see = |k: usize, (size, magnitude): (f64, f64)| {
        lost |= size.is_nan() | magnitude.is_nan();
        most[k] = if size > most[k] { size } else { most[k] };
    };
    let (x, x_left) = x.as_chunks::<SIDE_BY_SIDE>();
    let (scales, scales_left) = scales.as_chunks::<SIDE_BY_SIDE>();
    for (x, scales) in x.iter().zip(scales) {
        for k in 0..SIDE_BY_SIDE {
            see(k, size(x[k], scales[k]));
        }
    }
    for (x, scale) in x_left.iter().zip(scales_left) {
        see(0, size(*x, *scale));
    }
    match lost {
        true => f64::NAN,
        false => most.into_iter().fold(0.0, larger),
    }
}

/// The size, in scaled units, of corrections that are only rounding of rotations. In a short step the momenta are small
/// differences of rotated vectors.
#[inline(always)]
pub(super) fn of_turns<T: Real>(unknowns: &[Unknown], scales: &[f64]) -> f64 {
    let mut most = 0.0_f64;
    if unknowns.iter().any(|unknown| unknown.turns()) {
        for scales in scales.chunks_exact(components(unknowns)) {
            for (start, unknown) in starts(unknowns).filter(|(_, unknown)| unknown.turns()) {
                for scale in &scales[start..start + unknown.components()] {
                    most = most.max(*scale);
                }
            }
        }
    }
    ROUNDINGS * T::EPSILON * most
}

/// The number of components of a site.
#[inline(always)]
fn components(unknowns: &[Unknown]) -> usize {
    let sum: usize = unknowns.iter().map(|unknown| unknown.components()).sum();
    sum.max(1)
}

/// Whether this number of components consists of several parts.
#[inline(always)]
pub(super) fn are_several(unknowns: &[Unknown], count: usize) -> bool {
    unknowns
        .first()
        .is_some_and(|unknown| count > unknown.components())
}

/// Measures the parts of the velocity, and sets the weights of corrections relative to `size`, the longest part. Returns
/// false if a weight differs from the previous one by more than a factor of two.
///
/// Rounding of a rotation, which a correction cannot remove, must not exceed [`LAST`] of its length.
#[inline(always)]
pub(super) fn weigh<T: Real>(
    unknowns: &[Unknown],
    ring: bool,
    size: f64,
    lists: &mut Lists<'_, T>,
) -> bool {
    let n = components(unknowns);
    let all = lists
        .velocity
        .chunks_exact(n)
        .zip(lists.scales.chunks_exact(n));
    for ((velocity, scales), lengths) in all.zip(lists.lengths.chunks_exact_mut(n)) {
        for (start, unknown) in starts(unknowns) {
            let own = start..start + unknown.components();
            for lane in 0..T::LANES {
                let mut length = 0.0;
                for (x, scale) in velocity[own.clone()].iter().zip(&scales[own.clone()]) {
                    length = larger(length, x.lane(lane).abs() * scale);
                    if unknown.turns() {
                        length = larger(length, ROUNDINGS * T::EPSILON / LAST * scale);
                    }
                }
                lengths[start].set_lane(lane, T::One::from_f64(length));
            }
        }
    }
    let lengths = &*lists.lengths;
    let sites = lengths.len() / n;
    let longest = |site: usize, lane: usize| {
        let own = starts(unknowns).map(|(start, _)| lengths[n * site + start].lane(lane));
        own.fold(0.0, larger)
    };
    let mut alike = true;
    for lane in 0..T::LANES {
        let end = |site: usize| if ring { longest(site, lane) } else { 0.0 };
        let first = if sites > 0 { longest(0, lane) } else { 0.0 };
        let (mut before, mut here) = (end(sites.saturating_sub(1)), first);
        for site in 0..sites {
            let after = match site + 1 < sites {
                true => longest(site + 1, lane),
                false => end(0),
            };
            let least = larger(SHARE * larger(here, larger(before, after)), LEAST * size);
            (before, here) = (here, after);
            for (start, unknown) in starts(unknowns) {
                let first = n * site + start;
                let length = larger(lengths[first].lane(lane), least);
                let ratio = if length > 0.0 { size / length } else { 1.0 };
                for i in first..first + unknown.components() {
                    let weight = ratio * lists.scales[i];
                    let known = lists.weights[i].lane(lane);
                    alike &= weight <= 2.0 * known && known <= 2.0 * weight;
                    lists.weights[i].set_lane(lane, T::One::from_f64(weight));
                }
            }
        }
    }
    alike
}

/// The largest weighed entry of each part, by `entry`. A part counts only if its residual exceeds rounding: in its own
/// equation, no correction improves it.
#[inline(always)]
fn each_part<T: Real>(
    unknowns: &[Unknown],
    lists: &Lists<'_, T>,
    entry: impl Fn(usize) -> T,
    mut see: impl FnMut(f64),
) {
    let n = components(unknowns);
    for site in 0..lists.weights.len() / n {
        for (start, unknown) in starts(unknowns) {
            let own = n * site + start..n * site + start + unknown.components();
            if !lists.rounded[own.clone()].iter().all(|rounded| *rounded) {
                see(own.fold(0.0, |most, i| {
                    let x = entry(i) * lists.weights[i];
                    larger(most, x.greatest().abs().max(x.least().abs()))
                }));
            }
        }
    }
}

/// The largest weighed entry of the last correction.
#[inline(always)]
pub(super) fn weighed<T: Real>(unknowns: &[Unknown], lists: &Lists<'_, T>) -> f64 {
    let mut most = 0.0;
    let entry = |i: usize| lists.correction[i];
    each_part(unknowns, lists, entry, |size| most = larger(most, size));
    most
}

/// The largest weighed entry of the changes in a stage before the last correction, and whether they moved all parts
/// alike.
#[inline(always)]
pub(super) fn weighed_before<T: Real>(unknowns: &[Unknown], lists: &Lists<'_, T>) -> (f64, bool) {
    let (mut most, mut least) = (0.0, f64::INFINITY);
    let entry = |i: usize| lists.velocity[i] - lists.from[i] - lists.correction[i];
    each_part(unknowns, lists, entry, |size| {
        most = larger(most, size);
        least = least.min(size);
    });
    (most, least >= ALIKE * most)
}

#[cfg(test)]
mod tests {
    use crate::Real;
    use crate::line::{AnyBand, field, root};
    use crate::scalar::DoubleDouble;
    use nalgebra::{Matrix2, Vector2};

    /// Numbers between 0 and 1.
    fn drawn(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005);
        *state = state.wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The factor of the products of velocities in the momenta below.
    const K: f64 = 30.0;

    /// The momentum of a velocity `v` whose neighbours have the squares of velocities `w`: the kinetic energy is
    /// `v^2/2 + K v^2 w/2`.
    fn momentum<T: Real>(v: T, w: T) -> T {
        v + T::from_f64(K) * v * w
    }

    /// The error of a momentum in roundings of its terms, which have the same sign.
    fn off(known: f64, v: f64, w: DoubleDouble) -> f64 {
        let left = momentum(DoubleDouble::from(v), w) - DoubleDouble::from(known);
        left.value().abs() / (f64::EPSILON / 2.0 * known.abs())
    }

    /// A residual may be 32 roundings of both sides, and has at most three of its own evaluation.
    const MOST: f64 = 67.0;

    #[test]
    fn a_small_part_is_solved_to_rounding_of_its_own_terms() {
        let mut state = 1;
        for case in 0..20_000 {
            let size = 10.0_f64.powf(-9.0 * drawn(&mut state));
            let known = Vector2::new(size * (0.5 + drawn(&mut state)), 3.0 * drawn(&mut state));
            let momenta = |v: &Vector2<f64>| {
                let (x, y) = (v[0] * v[0], v[1] * v[1]);
                let both = 2.0 * K * v[0] * v[1];
                let p = Vector2::new(momentum(v[0], y), momentum(v[1], x));
                (p, Matrix2::new(1.0 + K * y, both, both, 1.0 + K * x))
            };
            let parts = [field(1), field(1)];
            let v = root(&known, parts, |v| momenta(v).0, momenta).expect("a root");
            for i in 0..2 {
                let w = DoubleDouble::from(v[1 - i]);
                let off = off(known[i], v[i], w * w);
                assert!(off <= MOST, "{case}, {known} {v}: {off} of {i}");
            }
        }
    }

    /// A ring of which one half moves slowly.
    #[test]
    fn slow_sites_are_solved_to_rounding_of_their_own_terms() {
        const SITES: usize = 8;
        let mut state = 1;
        for case in 0..2_000 {
            let size = 10.0_f64.powf(-9.0 * drawn(&mut state));
            let mut band = AnyBand::<f64>::new(1, SITES, true, false);
            for (i, known) in band.known_mut().iter_mut().enumerate() {
                let own = if i < SITES / 2 { size } else { 1.0 };
                *known = own * (0.5 + drawn(&mut state));
            }
            let beside = |i: usize| [(i + 1) % SITES, (i + SITES - 1) % SITES];
            let solved = band.solve(1, [0, SITES], |sums| {
                for i in 0..SITES {
                    let [v, next, last] =
                        [i, beside(i)[0], beside(i)[1]].map(|k| sums.velocity(1, k)[0]);
                    let w = next * next + last * last;
                    sums.put(1, i, &[momentum(v, w)]);
                    sums.put_derivative(i, &[1.0 + K * w]);
                }
                for i in 0..SITES {
                    for k in beside(i) {
                        let both = 2.0 * K * sums.velocity(1, i)[0] * sums.velocity(1, k)[0];
                        sums.add_derivative(i, k, &[both]);
                    }
                }
            });
            assert!(solved.is_ok(), "{case}: {solved:?}");
            let found = band.velocities().to_vec();
            for i in 0..SITES {
                let [a, b] = beside(i).map(|k| DoubleDouble::from(found[k]));
                let off = off(band.known_mut()[i], found[i], a * a + b * b);
                assert!(off <= MOST, "{case}, {found:?}: {off} of {i}");
            }
        }
    }
}
