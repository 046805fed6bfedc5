//! Direct products of copies of a group, for coupled bodies.
//! Takes arrays of elements; the algebra coordinates are those of the factors, one after another.

use super::Group;

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

    #[inline]
    fn retract(&self, xi: &[T]) -> Self {
        let mut moved = *self;
        for (factor, part) in moved.iter_mut().zip(xi.chunks(G::DIMENSION.max(1))) {
            *factor = factor.retract(part);
        }
        moved
    }

    #[inline]
    fn distance_from_group(&self) -> f64 {
        self.iter()
            .map(Group::distance_from_group)
            .fold(0.0, f64::max)
    }
}
