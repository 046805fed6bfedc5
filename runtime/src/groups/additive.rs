//! Numbers, vectors and matrices under addition: the values of a field at a node, and its increments.
//! Takes arrays; gives group elements whose product is the sum, and the momenta that belong to them.

use super::placed::{added, between};
use super::{Coadjoint, Coordinate, Group, Part, Placed, squares};
use crate::Real;
use crate::scalar::of_scalars;
use nalgebra::SMatrix;

/// The value of a field with `R` rows and `C` columns (one column for a vector, one entry for a
/// number), or its increment over an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Additive<const R: usize, const C: usize, T = f64> {
    array: SMatrix<T, R, C>,
}

of_scalars!(Additive < R, C > { array });

/// The momentum of a field at a node, of the shape of the field, paired with its rate of change as
/// `tr(p^T X')`. There is one frame only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldMomentum<const R: usize, const C: usize, T = f64>(pub SMatrix<T, R, C>);

of_scalars!(FieldMomentum < R, C > { 0 });

impl<const R: usize, const C: usize, T: Real> Additive<R, C, T> {
    /// Zero.
    #[inline]
    pub fn identity() -> Self {
        Self::new(SMatrix::zeros())
    }

    /// The value with these entries.
    #[inline]
    pub fn new(array: SMatrix<T, R, C>) -> Self {
        Self { array }
    }

    /// The entries.
    #[inline]
    pub fn matrix(&self) -> SMatrix<T, R, C> {
        self.array
    }

    /// The opposite value.
    #[inline]
    pub fn inverse(&self) -> Self {
        Self::new(-self.array)
    }
}

impl<const R: usize, const C: usize, T: Real> core::ops::Add for Additive<R, C, T> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.array + other.array)
    }
}

impl<const R: usize, const C: usize, T: Real> Group<T> for Additive<R, C, T> {
    const DIMENSION: usize = R * C;

    #[inline]
    fn identity() -> Self {
        Self::identity()
    }

    #[inline]
    fn compose(&self, other: &Self) -> Self {
        *self + *other
    }

    #[inline]
    fn inverse(&self) -> Self {
        self.inverse()
    }

    #[inline]
    fn body_velocity(&self, next: &Self) -> Self {
        Self::new(next.array - self.array)
    }

    #[inline]
    fn spatial_velocity(&self, next: &Self) -> Self {
        Self::new(next.array - self.array)
    }

    /// `self + X`, `X` the array of the coordinates, row by row.
    #[inline]
    fn retract(&self, xi: &[T]) -> Self {
        let entry = |i: usize, j: usize| xi.get(C * i + j).copied().unwrap_or_else(T::zero);
        Self::new(self.array + SMatrix::from_fn(entry))
    }

    #[inline]
    fn combined(weights: &[f64], element: impl Fn(usize) -> Self) -> Self {
        let terms = weights.iter().enumerate();
        Self::new(terms.fold(SMatrix::zeros(), |sum, (i, weight)| {
            sum + element(i).array * T::from_f64(*weight)
        }))
    }

    fn coordinate(index: usize) -> Coordinate {
        Coordinate::of(Part::entry(index, C))
    }

    fn distance_from_group(&self) -> f64 {
        let all = self.array.iter().fold(true, |all, x| all & x.is_finite());
        if all { 0.0 } else { f64::NAN }
    }

    /// Increments have the unit of the field.
    fn is_pure(_: usize) -> bool {
        false
    }

    /// The length of all entries together.
    fn is_open(_part: usize) -> bool {
        true
    }

    #[inline(always)]
    fn compared(&self, xi: &[T], out: &mut [[T; 2]]) {
        if let Some(first) = out.first_mut() {
            *first = squares(&self.array, xi);
        }
    }

    #[inline]
    fn is_within(&self, reach: &[f64]) -> bool {
        let reach = reach.first().copied().unwrap_or(0.0);
        (self.square() - T::from_f64(reach * reach)).nowhere_positive()
    }
}

impl<const R: usize, const C: usize, T: Real> Additive<R, C, T> {
    #[inline]
    fn square(&self) -> T {
        self.array.iter().fold(T::zero(), |sum, x| sum + *x * *x)
    }
}

impl<const R: usize, const C: usize, T: Real> Coadjoint<T> for Additive<R, C, T> {
    type Covector = SMatrix<T, R, C>;

    #[inline]
    fn covector_to_space(&self, body: &SMatrix<T, R, C>) -> SMatrix<T, R, C> {
        *body
    }

    #[inline]
    fn covector_to_body(&self, spatial: &SMatrix<T, R, C>) -> SMatrix<T, R, C> {
        *spatial
    }
}

impl<const R: usize, const C: usize, T: Real> Placed<T> for Additive<R, C, T> {
    type Way = SMatrix<T, R, C>;

    #[inline(always)]
    fn way(&self, velocity: &Self) -> SMatrix<T, R, C> {
        velocity.array
    }

    #[inline(always)]
    fn moved(&self, velocity: &Self, rest: &Self::Way) -> (Self, Self::Way) {
        let (array, rest) = added(&self.array, rest, &velocity.array);
        (Self { array }, rest)
    }

    #[inline]
    fn velocity_between(&self, rest: &Self::Way, next: &Self, next_rest: &Self::Way) -> Self {
        Self::new(between((&self.array, rest), (&next.array, next_rest)))
    }
}

#[cfg(test)]
mod tests {
    use super::Additive;
    use crate::Group;
    use nalgebra::Vector2;

    #[test]
    fn values_are_extrapolated_entry_by_entry() {
        // Three values of a parabola determine the next one.
        let at = |t: f64| Additive::new(Vector2::new(1.0 + t, t * t - 3.0));
        let made = Additive::combined(&[3.0, -3.0, 1.0], |i| at(5.0 - i as f64));
        assert_eq!(made.matrix(), at(6.0).matrix());
    }
}
