//! How far an invariant has moved: relative to its natural scale, or absolute if that scale is zero. Takes its value
//! and its scale at every step; gives the largest and the last deviation.

use crate::card::Card;
use crate::saved::{Saved, Words};
use crate::scalar::{Real, greater, larger};
use nalgebra::SMatrix;

/// The drift of one component of one invariant since the run began.
///
/// The **natural scale** of an invariant, exact or bounded, is the sum of the absolute values of its
/// terms, maximised over the nodes of the run. Rounding errors are proportional to the terms and not
/// to their sum. For example, an angular momentum `R m + x × p` about a fixed origin has the rounding
/// of `|m| + |x| |p|`. This size grows with the distance of the body while the sum is constant. The
/// maximum is needed since a body released from rest has zero momentum and kinetic energy at node 0.
/// A product counts as the product of the lengths of its factors. The terms of the energy are the
/// kinetic and the potential energy.
///
/// If a momentum is much smaller than the impulse that forces give it in a step, the impulse is its
/// size: at equilibrium, impulses cancel up to rounding.
///
/// If the natural scale is zero at every node, the drift is the change itself, in the unit of the
/// invariant. This is the case for the momentum of a body that stays at rest without forces. A scale
/// below the smallest normal number counts as zero. [`Drift::is_absolute`] reports this case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// `max |I_k - I_0| / scale` over the checked nodes, or `max |I_k - I_0|` if the scale is zero; NaN if a value or
    /// a scale was NaN.
    pub worst: f64,
    /// `(I_k - I_0) / scale` at the last checked node, with its sign, or `I_k - I_0` if the scale is zero.
    pub last: f64,
    /// The natural scale of the component, in its own unit.
    pub scale: f64,
    /// The first checked node where `|I_k - I_0|` exceeds both the scale at the start and a tenth of the scale at the
    /// node: from this node on, the value is unrelated to the initial value. `None` also if the scale at the start is
    /// zero.
    pub lost: Option<u64>,
}

impl Drift {
    /// The drift of a deviation `I_k - I_0`, with its sign: divided by the natural scale, or unchanged
    /// if the scale is zero. NaN if either number is NaN.
    #[inline]
    #[must_use]
    pub fn of(deviation: f64, scale: f64) -> f64 {
        if scale.abs() < f64::MIN_POSITIVE {
            deviation
        } else {
            deviation / scale
        }
    }

    /// Whether the drift is the change itself, because the natural scale is zero.
    #[must_use]
    pub fn is_absolute(&self) -> bool {
        self.scale.abs() < f64::MIN_POSITIVE
    }
}

/// A momentum below `1 / SHARE` of an impulse counts as rounding of the impulse. Rounding adds up like a random walk,
/// and after 1e12 steps is still smaller. A larger momentum is its own scale, even if strong impulses nearly cancel.
const SHARE: f64 = 1e9;

/// A momentum for use in scales. If all entries in `count` rows from row `from` on are much smaller than the impulse
/// at a node, replaces each of them by the size of the impulse: a remainder of impulses that cancel is only rounding.
#[doc(hidden)]
#[must_use]
pub fn not_less<T: Real, const R: usize, const C: usize>(
    momentum: SMatrix<T, R, C>,
    (from, count): (usize, usize),
    impulse: T,
) -> SMatrix<T, R, C> {
    let mut taken = momentum;
    let fills = fills(momentum.rows(from, count).iter().copied(), impulse);
    for entry in taken.rows_mut(from, count).iter_mut() {
        *entry = filled(*entry, fills, impulse);
    }
    taken
}

/// 1 in the lanes where all these entries are much smaller than the impulse, otherwise 0. Also 0 if all entries are
/// zero or the impulse is not finite.
#[doc(hidden)]
pub fn fills<T: Real>(entries: impl Iterator<Item = T>, impulse: T) -> T {
    let one = T::one();
    let most = entries.map(T::abs).fold(T::zero(), greater);
    let moves = most.where_positive(one);
    let less = (impulse - T::from_f64(SHARE) * most).where_positive(moves);
    (T::from_f64(f64::MAX) - impulse).where_positive(less)
}

/// The entry, or the impulse if `fills` is 1.
#[doc(hidden)]
pub fn filled<T: Real>(entry: T, fills: T, impulse: T) -> T {
    fills.where_positive(impulse) + (T::one() - fills).where_positive(entry)
}

/// The scale of a constraint rate is at least this share of the terms of the constraint per step. A drift of 1e-12 is
/// then a few roundings of the constraint, the accuracy of a position.
const PART: f64 = 1e-3;

/// The positions of a constraint rate and of the constraint itself among the components of invariants.
#[derive(Clone, Debug)]
pub(super) struct HeldRate {
    rate: usize,
    held: usize,
    count: usize,
}

impl HeldRate {
    /// The constraint rates of a model.
    pub(super) fn all(card: &Card) -> Vec<HeldRate> {
        let mut starts = Vec::new();
        let mut at = 0;
        for v in card.invariants {
            starts.push((v.name, at, v.rows));
            at += v.rows;
        }
        let of = |(name, rate, count): &(&str, usize, usize)| {
            let multiplier = name.strip_prefix("constraint_rate_")?;
            let held = format!("constraint_{multiplier}");
            let (_, held, _) = starts
                .iter()
                .find(|(n, _, rows)| *n == held && rows == count)?;
            Some(HeldRate {
                rate: *rate,
                held: *held,
                count: *count,
            })
        };
        starts.iter().filter_map(of).collect()
    }

    /// Raises the scales of the rate to the fraction [`PART`] of the constraint's scale per step `h`.
    pub(super) fn not_less(&self, scales: &mut [f64], h: f64) {
        for i in 0..self.count {
            let held = scales.get(self.held + i).copied();
            if let (Some(held), Some(rate)) = (held, scales.get_mut(self.rate + i)) {
                *rate = larger(*rate, PART * held / h.abs());
            }
        }
    }
}

/// The deviations of one component so far. Its scale is known at the end of the run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Deviation {
    /// The value at the start.
    start: f64,
    /// The largest `|I_k - I_0|`.
    largest: f64,
    /// The last `I_k - I_0`.
    last: f64,
    /// The largest sum of the absolute values of the terms.
    scale: f64,
    /// The sum at the start.
    first: f64,
    /// The first node at which the deviation exceeded both the scale at the start and a fraction of the terms there.
    lost: Option<u64>,
}

/// If a deviation is below this fraction of the terms, the value does not count as lost: the start may be near
/// equilibrium, where the terms are small.
const LOST: f64 = 0.1;

impl Saved for Deviation {
    fn words(&mut self, words: &mut Words) {
        let Self {
            start,
            largest,
            last,
            scale,
            first,
            lost,
        } = self;
        [start, largest, last, scale, first]
            .into_iter()
            .for_each(|x| x.words(words));
        let mut node = lost.unwrap_or(u64::MAX);
        node.words(words);
        *lost = (node != u64::MAX).then_some(node);
    }
}

impl Deviation {
    /// No deviation yet, from the value and the size of its terms at the start.
    pub(super) fn none(start: f64, terms: f64) -> Self {
        Self {
            start,
            largest: 0.0,
            last: 0.0,
            scale: terms,
            first: terms,
            lost: None,
        }
    }

    /// Takes in the value at a node, and the size of its terms there.
    #[inline]
    pub(super) fn record(&mut self, node: u64, value: f64, terms: f64) {
        self.last = value - self.start;
        self.largest = larger(self.largest, self.last.abs());
        self.scale = larger(self.scale, terms);
        let moved = self.last.abs();
        if moved > self.first && moved > LOST * terms && self.first >= f64::MIN_POSITIVE {
            self.lost = self.lost.or(Some(node));
        }
    }

    /// The drift up to here.
    pub(super) fn drift(&self) -> Drift {
        Drift {
            worst: Drift::of(self.largest, self.scale),
            last: Drift::of(self.last, self.scale),
            scale: self.scale,
            lost: self.lost,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Deviation, Drift};

    /// The drift after these deviations, for terms of constant size.
    fn after(terms: f64, deviations: &[f64]) -> Drift {
        let mut seen = Deviation::none(0.0, terms);
        (1..)
            .zip(deviations)
            .for_each(|(node, d)| seen.record(node, *d, terms));
        seen.drift()
    }

    #[test]
    fn relative_to_a_scale_and_absolute_without_one() {
        let drift = after(4.0, &[2.0, -6.0, 1.0]);
        assert_eq!((drift.worst, drift.last), (1.5, 0.25));
        assert!(!drift.is_absolute());
        // Zero, and scales too small to divide by: 1 / 1e-310 is infinite.
        for scale in [0.0, -0.0, 1e-310] {
            let drift = after(scale, &[0.0, -1e-15, 1e-16]);
            assert_eq!((drift.worst, drift.last), (1e-15, 1e-16));
            assert!(drift.is_absolute());
            assert_eq!(after(scale, &[0.0]).worst, 0.0);
        }
    }

    #[test]
    fn the_scale_is_the_largest_of_the_run() {
        // A motion from rest: the terms vanish at the start and are largest in the middle.
        let mut seen = Deviation::none(10.0, 0.0);
        for (value, terms) in [(10.5, 1.0), (9.0, 8.0), (10.25, 4.0)] {
            seen.record(1, value, terms);
        }
        let drift = seen.drift();
        assert_eq!((drift.worst, drift.last), (0.125, 0.03125));
        assert_eq!(drift.scale, 8.0);
        assert!(!drift.is_absolute());
    }

    #[test]
    fn a_value_that_leaves_its_scale_is_lost_at_a_node() {
        // The terms grow with the deviation, as in a collision that a step did not see.
        let after = |all: &[(f64, f64)]| {
            let mut seen = Deviation::none(-1.0, 1.0);
            (1..)
                .zip(all)
                .for_each(|(node, (value, terms))| seen.record(node, *value, *terms));
            seen.drift().lost
        };
        assert_eq!(
            after(&[(-1.0, 1.0), (-1.5, 1e3), (5e8, 6e8), (-1.0, 1.0)]),
            Some(3)
        );
        // Large terms that cancel: the deviation is small beside them.
        assert_eq!(after(&[(3.0, 1e3), (-2.0, 3.0)]), None);
        assert_eq!(Deviation::none(0.0, 0.0).drift().lost, None);
    }

    #[test]
    fn nan_enters_anywhere_and_stays() {
        for deviations in [
            [f64::NAN, 0.0, 9.0],
            [0.0, f64::NAN, 9.0],
            [9.0, 0.0, f64::NAN],
        ] {
            for scale in [0.0, 4.0] {
                assert!(after(scale, &deviations).worst.is_nan());
            }
        }
        assert!(after(f64::NAN, &[0.0]).worst.is_nan());
        let mut seen = Deviation::none(0.0, 1.0);
        seen.record(1, 0.0, f64::NAN);
        seen.record(2, 0.0, 1.0);
        assert!(seen.drift().worst.is_nan());
    }
}
