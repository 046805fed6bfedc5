//! Elements with a position that steps add to: fields and rigid motions. Positions and momenta are stored as two
//! numbers, so that steps of any size add up without loss. Takes an element, its velocity in the body frame and the
//! rounding remainder; gives element and remainder after the edge.

use super::{Coadjoint, Group};
use crate::Real;
use nalgebra::SMatrix;

/// A group whose elements have a position: the value of a field, the translation of a rigid motion.
///
/// The exact position of an element is the stored position plus a remainder, which is below the rounding of the
/// stored position. Without the remainder, rounding errors of a motion in small steps accumulate in one direction,
/// and so do the errors of every conserved moment about a fixed point.
pub trait Placed<T>: Group<T> {
    /// The displacement from one position to another, in the axes of space.
    type Way: Copy;

    /// The displacement along the edge of this velocity (body frame).
    fn way(&self, velocity: &Self) -> Self::Way;

    /// The element at the end of the edge, `self . velocity`, and its remainder; `rest` belongs to `self`.
    fn moved(&self, velocity: &Self, rest: &Self::Way) -> (Self, Self::Way);

    /// The velocity (body frame) from this element to the `next` one, given the remainders of both.
    fn velocity_between(&self, rest: &Self::Way, next: &Self, next_rest: &Self::Way) -> Self;
}

/// Momenta of rigid motions about the body's own origin, in the axes of space: `(R a, R l)` of the body's `(a, l)`.
/// They do not depend on the position, so the spin is equally accurate far from the origin and near it.
pub trait AboutBody<T>: Placed<T> + Coadjoint<T> {
    /// A covector of the body frame in the axes of space.
    fn covector_turned(&self, body: &Self::Covector) -> Self::Covector;

    /// A covector in the axes of space, about the body's origin, in the body frame.
    fn covector_turned_back(&self, turned: &Self::Covector) -> Self::Covector;

    /// The change of a covector in the axes of space about the body's origin, if the origin moves along
    /// the edge of this velocity: `(-way × l, 0)`.
    fn gained_along(&self, velocity: &Self, turned: &Self::Covector) -> Self::Covector;
}

/// `value + rest + added` as a value and its remainder, by Knuth's two-sum.
#[inline(always)]
#[must_use]
pub fn added<T: Real, const R: usize, const C: usize>(
    value: &SMatrix<T, R, C>,
    rest: &SMatrix<T, R, C>,
    added: &SMatrix<T, R, C>,
) -> (SMatrix<T, R, C>, SMatrix<T, R, C>) {
    let added = added + rest;
    let sum = value + added;
    let taken = sum - value;
    let lost = (value - (sum - taken)) + (added - taken);
    (sum, lost)
}

/// Like `added`, for a single number.
#[inline(always)]
#[must_use]
pub fn added_number<T: Real>(value: T, rest: T, amount: T) -> (T, T) {
    let one = SMatrix::<T, 1, 1>::new;
    let (sum, lost) = added(&one(value), &one(rest), &one(amount));
    (sum[0], lost[0])
}

/// `(next + next_rest) - (place + rest)`.
#[inline(always)]
pub(super) fn between<T: Real, const R: usize, const C: usize>(
    (place, rest): (&SMatrix<T, R, C>, &SMatrix<T, R, C>),
    (next, next_rest): (&SMatrix<T, R, C>, &SMatrix<T, R, C>),
) -> SMatrix<T, R, C> {
    (next - place) + (next_rest - rest)
}
