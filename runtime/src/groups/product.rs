//! Direct products of groups, for coupled bodies: arrays of one group, tuples of several.
//! Takes arrays or tuples of elements; the algebra coordinates of the factors follow one another.

use super::{Coordinate, Group, Part};
use crate::scalar::largest;

impl<T, G: Group<T>, const COUNT: usize> Group<T> for [G; COUNT] {
    const DIMENSION: usize = COUNT * G::DIMENSION;

    #[inline]
    fn identity() -> Self {
        [G::identity(); COUNT]
    }

    #[inline]
    fn compose(&self, other: &Self) -> Self {
        let mut product = *self;
        for (left, right) in product.iter_mut().zip(other) {
            *left = left.compose(right);
        }
        product
    }

    #[inline]
    fn inverse(&self) -> Self {
        self.map(|factor| factor.inverse())
    }

    #[inline(always)]
    fn retract(&self, xi: &[T]) -> Self {
        let mut moved = *self;
        for (factor, part) in moved.iter_mut().zip(xi.chunks(G::DIMENSION.max(1))) {
            *factor = factor.retract(part);
        }
        moved
    }

    #[inline(always)]
    fn retract_from_left(&self, xi: &[T]) -> Self {
        let mut moved = *self;
        for (factor, part) in moved.iter_mut().zip(xi.chunks(G::DIMENSION.max(1))) {
            *factor = factor.retract_from_left(part);
        }
        moved
    }

    #[inline(always)]
    fn combined(weights: &[f64], element: impl Fn(usize) -> Self) -> Self {
        // `array::from_fn` is not inlined if the function is long.
        let mut all = [G::identity(); COUNT];
        for (k, x) in all.iter_mut().enumerate() {
            *x = G::combined(weights, |i| element(i)[k]);
        }
        all
    }

    fn coordinate(index: usize) -> Coordinate {
        let each = G::DIMENSION.max(1);
        G::coordinate(index % each).in_factor(index / each)
    }

    #[inline]
    fn distance_from_group(&self) -> f64 {
        largest(self.iter().map(Group::distance_from_group))
    }

    const PARTS: usize = COUNT * G::PARTS;

    fn part_of(index: usize) -> usize {
        let each = G::DIMENSION.max(1);
        index / each * G::PARTS + G::part_of(index % each)
    }

    fn is_pure(part: usize) -> bool {
        G::is_pure(part % G::PARTS.max(1))
    }

    fn is_open(part: usize) -> bool {
        G::is_open(part % G::PARTS.max(1))
    }

    #[inline(always)]
    fn compared(&self, xi: &[T], out: &mut [[T; 2]]) {
        for (i, (factor, own)) in (self.iter().zip(out.chunks_mut(G::PARTS.max(1)))).enumerate() {
            factor.compared(xi.get(i * G::DIMENSION..).unwrap_or(&[]), own);
        }
    }

    #[inline(always)]
    fn is_within(&self, reach: &[f64]) -> bool {
        let mut all = true;
        for (i, factor) in self.iter().enumerate() {
            let own = reach.get(i * G::PARTS..).unwrap_or(&[]);
            all &= factor.is_within(own);
        }
        all
    }
}

/// The product of different groups.
macro_rules! product_of {
    ($($group:ident $index:tt),+) => {
        impl<T, $($group: Group<T>),+> Group<T> for ($($group,)+) {
            const DIMENSION: usize = 0 $(+ $group::DIMENSION)+;

            #[inline]
            fn identity() -> Self {
                ($($group::identity(),)+)
            }

            #[inline]
            fn compose(&self, other: &Self) -> Self {
                ($(self.$index.compose(&other.$index),)+)
            }

            #[inline]
            fn inverse(&self) -> Self {
                ($(self.$index.inverse(),)+)
            }

            #[inline]
            fn retract(&self, xi: &[T]) -> Self {
                let mut rest = xi;
                let mut part = |count: usize| {
                    let (part, others) = rest.split_at(count.min(rest.len()));
                    rest = others;
                    part
                };
                ($(self.$index.retract(part($group::DIMENSION)),)+)
            }

            #[inline]
            fn retract_from_left(&self, xi: &[T]) -> Self {
                let mut rest = xi;
                let mut part = |count: usize| {
                    let (part, others) = rest.split_at(count.min(rest.len()));
                    rest = others;
                    part
                };
                ($(self.$index.retract_from_left(part($group::DIMENSION)),)+)
            }

            #[inline(always)]
            fn combined(weights: &[f64], element: impl Fn(usize) -> Self) -> Self {
                ($($group::combined(weights, |i| element(i).$index),)+)
            }

            fn coordinate(index: usize) -> Coordinate {
                let mut rest = index;
                $(
                    if rest < $group::DIMENSION {
                        return $group::coordinate(rest).in_factor($index);
                    }
                    rest -= $group::DIMENSION;
                )+
                let _ = rest;
                Coordinate::of(Part::axis(index))
            }

            #[inline]
            fn distance_from_group(&self) -> f64 {
                largest([$(self.$index.distance_from_group()),+])
            }

            const PARTS: usize = 0 $(+ $group::PARTS)+;

            fn part_of(index: usize) -> usize {
                let (mut rest, mut before) = (index, 0);
                $(
                    if rest < $group::DIMENSION {
                        return before + $group::part_of(rest);
                    }
                    rest -= $group::DIMENSION;
                    before += $group::PARTS;
                )+
                let _ = rest;
                before
            }

            fn is_pure(part: usize) -> bool {
                let mut rest = part;
                $(
                    if rest < $group::PARTS {
                        return $group::is_pure(rest);
                    }
                    rest -= $group::PARTS;
                )+
                let _ = rest;
                true
            }

            fn is_open(part: usize) -> bool {
                let mut rest = part;
                $(
                    if rest < $group::PARTS {
                        return $group::is_open(rest);
                    }
                    rest -= $group::PARTS;
                )+
                let _ = rest;
                false
            }

            #[inline(always)]
            fn compared(&self, xi: &[T], out: &mut [[T; 2]]) {
                let (mut left, mut rest) = (xi, out);
                $(
                    let (own, others) = rest.split_at_mut($group::PARTS.min(rest.len()));
                    let (own_xi, others_xi) = left.split_at($group::DIMENSION.min(left.len()));
                    self.$index.compared(own_xi, own);
                    (left, rest) = (others_xi, others);
                )+
                let _ = (left, rest);
            }

            #[inline(always)]
            fn is_within(&self, reach: &[f64]) -> bool {
                let (mut all, mut rest) = (true, reach);
                $(
                    let (own, others) = rest.split_at($group::PARTS.min(rest.len()));
                    all &= self.$index.is_within(own);
                    rest = others;
                )+
                let _ = rest;
                all
            }
        }
    };
}

product_of!(A 0, B 1);
product_of!(A 0, B 1, C 2);
product_of!(A 0, B 1, C 2, D 3);
product_of!(A 0, B 1, C 2, D 3, E 4);
product_of!(A 0, B 1, C 2, D 3, E 4, F 5);
