//! What the tangent of a step depends on besides the velocity and the parameters: values at the
//! node. A proof made at one node holds at others as long as these stay near.
//! Takes values of a node; gives the same in bounds, and whether they are near others.

use crate::Real;
use crate::saved::{Saved, Words};
use crate::scalar::{Enclosure, OfScalars, larger, largest};
use nalgebra::SMatrix;

/// How far the values of a node may be from those at hand for a proof to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Whether rotations may be any.
    pub(super) turned: bool,
    /// By what part of its largest entry every other value may change.
    pub(super) share: f64,
}

impl Spread {
    /// The node at hand only.
    pub(super) const HERE: Self = Self {
        turned: false,
        share: 0.0,
    };

    /// Any rotations, other values near.
    pub(super) const TURNED: Self = Self {
        turned: true,
        share: 0.25,
    };

    /// As near to one node as that.
    pub(super) const fn drifted(share: f64) -> Self {
        Self {
            turned: false,
            share,
        }
    }

    /// What both allow.
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            turned: self.turned && other.turned,
            share: self.share.min(other.share),
        }
    }
}

/// Values at a node, one inside the other: `(a, (b, []))`.
pub trait NodeValues: OfScalars {
    /// Whether there are any.
    const ANY: bool;

    /// Zeros in their place.
    #[must_use]
    fn blank() -> Self;

    /// One lane of the values, and of all that are as near as `spread` says.
    fn enclosed<const K: usize>(&self, lane: usize, spread: Spread) -> Self::Over<Enclosure<K>>;

    /// Whether these are as near to `others` as that, in every lane.
    fn is_near(&self, others: &Self, spread: Spread) -> bool;
}

/// A matrix with entries between -1 and 1: a rotation, or a quaternion's left multiplication.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn<M>(pub M);

impl<M: OfScalars> OfScalars for Turn<M> {
    type Scalar = M::Scalar;
    type Over<U: Real> = Turn<M::Over<U>>;

    fn over<U: Real>(&self, change: &mut impl FnMut(M::Scalar) -> U) -> Self::Over<U> {
        Turn(self.0.over(change))
    }
}

impl<M: Saved> Saved for Turn<M> {
    fn words(&mut self, words: &mut Words) {
        self.0.words(words);
    }
}

impl Saved for Spread {
    fn words(&mut self, words: &mut Words) {
        self.turned.words(words);
        self.share.words(words);
    }
}

impl<T: Real> NodeValues for [T; 0] {
    const ANY: bool = false;

    fn blank() -> Self {
        []
    }

    fn enclosed<const K: usize>(&self, _: usize, _: Spread) -> [Enclosure<K>; 0] {
        []
    }

    #[inline(always)]
    fn is_near(&self, _: &Self, _: Spread) -> bool {
        true
    }
}

impl<A: NodeValues, B: NodeValues<Scalar = A::Scalar>> NodeValues for (A, B) {
    const ANY: bool = true;

    fn blank() -> Self {
        (A::blank(), B::blank())
    }

    fn enclosed<const K: usize>(&self, lane: usize, spread: Spread) -> Self::Over<Enclosure<K>> {
        (self.0.enclosed(lane, spread), self.1.enclosed(lane, spread))
    }

    #[inline(always)]
    fn is_near(&self, others: &Self, spread: Spread) -> bool {
        self.0.is_near(&others.0, spread) && self.1.is_near(&others.1, spread)
    }
}

impl<T: Real, const R: usize, const C: usize> NodeValues for SMatrix<T, R, C> {
    const ANY: bool = true;

    fn blank() -> Self {
        Self::zeros()
    }

    fn enclosed<const K: usize>(&self, lane: usize, spread: Spread) -> SMatrix<Enclosure<K>, R, C> {
        let size = |x: &T| x.lane(lane).abs();
        let most = largest(self.iter().map(size));
        self.map(|x| Enclosure::around(x.lane(lane), spread.share * most))
    }

    #[inline]
    fn is_near(&self, others: &Self, spread: Spread) -> bool {
        let mut near = true;
        for lane in 0..T::LANES {
            let mut most = [0.0; R];
            for other in &others.data.0 {
                for (most, y) in most.iter_mut().zip(other) {
                    *most = larger(*most, y.lane(lane).abs());
                }
            }
            let most = spread.share * most.into_iter().fold(0.0, larger);
            // Every entry by itself: NaN is not near.
            for (x, y) in self.iter().zip(others) {
                near &= (x.lane(lane) - y.lane(lane)).abs() <= most;
            }
        }
        near
    }
}

impl<T: Real, const R: usize, const C: usize> NodeValues for Turn<SMatrix<T, R, C>> {
    const ANY: bool = true;

    fn blank() -> Self {
        Turn(SMatrix::zeros())
    }

    fn enclosed<const K: usize>(
        &self,
        lane: usize,
        spread: Spread,
    ) -> Turn<SMatrix<Enclosure<K>, R, C>> {
        match spread.turned {
            true => Turn(SMatrix::repeat(Enclosure::around(0.0, 1.0))),
            false => Turn(self.0.enclosed(lane, spread)),
        }
    }

    #[inline]
    fn is_near(&self, others: &Self, spread: Spread) -> bool {
        spread.turned || self.0.is_near(&others.0, spread)
    }
}
