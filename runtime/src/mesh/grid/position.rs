//! The coordinates of a value of a field of particles, along a line and in the plane.

use crate::Real;
use nalgebra::SVector;

/// The value of a field of particles: a number along a line, a vector in the plane.
pub trait Position<T, const D: usize>: Copy + Send + Sync {
    /// Its coordinates.
    fn coordinates(&self) -> [T; D];

    /// The value with these coordinates.
    fn of(coordinates: [T; D]) -> Self;
}

impl<T: Real> Position<T, 1> for T {
    #[inline(always)]
    fn coordinates(&self) -> [T; 1] {
        [*self]
    }

    #[inline(always)]
    fn of([x]: [T; 1]) -> Self {
        x
    }
}

impl<T: Real> Position<T, 2> for SVector<T, 2> {
    #[inline(always)]
    fn coordinates(&self) -> [T; 2] {
        [self[0], self[1]]
    }

    #[inline(always)]
    fn of([x, y]: [T; 2]) -> Self {
        SVector::<T, 2>::new(x, y)
    }
}
