//! Matrix Lie groups for the solvers, one file per group, and their products. Takes group elements and algebra
//! coordinates; gives group elements.

mod additive;
mod coordinate;
mod linear;
mod matrix_momentum;
mod orthogonal;
mod placed;
mod product;
pub mod se2;
pub mod se3;
pub mod so3;
mod su2;
mod turned;

pub use additive::{Additive, FieldMomentum};
pub use coordinate::{Coordinate, Part};
pub use linear::{Linear, NotInvertible, invertible_map};
pub use matrix_momentum::{BodyMomentumMatrix, SpatialMomentumMatrix};
pub use orthogonal::{Orthogonal, nearest_rotation};
pub use placed::{AboutBody, Placed, added, added_number};
pub use se2::{BodyPlaneImpulse, CarriedPlaneImpulse, PlaneMotion, SpatialPlaneImpulse};
pub use se3::{BodyImpulse, CarriedImpulse, NotARigidMotion, RigidMotion, SpatialImpulse};
pub use so3::{BodyMomentum, NotARotation, Rotation, SpatialMomentum};
pub use su2::UnitQuaternion;
pub use turned::TurnedRotation;

use crate::scalar::Real;
use nalgebra::SMatrix;

/// Forwards operations of [`Group`] to the inherent methods with the same names.
macro_rules! own_operations {
    () => {
        #[inline]
        fn identity() -> Self {
            Self::identity()
        }

        #[inline]
        fn compose(&self, other: &Self) -> Self {
            *self * *other
        }

        #[inline]
        fn inverse(&self) -> Self {
            self.inverse()
        }
    };
}
use own_operations;

/// A Lie group with the operations that an iteration on it needs.
///
/// Laws that every implementation satisfies to rounding: associativity, neutral element, inverses, and
/// `g.retract(xi) = g . (1 + hat(xi) + O(xi^2))`.
pub trait Group<T>: Copy {
    /// Dimension of the Lie algebra, the number of coordinates [`Group::retract`] reads.
    const DIMENSION: usize;

    /// The neutral element.
    fn identity() -> Self;

    /// The product `self . other`.
    fn compose(&self, other: &Self) -> Self;

    /// The inverse element.
    fn inverse(&self) -> Self;

    /// The velocity of the edge from this node to the `next` one in the frame of the body,
    /// `self^-1 . next`.
    #[inline]
    fn body_velocity(&self, next: &Self) -> Self {
        self.inverse().compose(next)
    }

    /// The velocity in the space frame, `next . self^-1`.
    #[inline]
    fn spatial_velocity(&self, next: &Self) -> Self {
        next.compose(&self.inverse())
    }

    /// `self . retraction(xi)`: the element perturbed on the right (body side) by the algebra
    /// coordinates `xi`. Coordinates that are missing count as zero, surplus ones are ignored.
    fn retract(&self, xi: &[T]) -> Self;

    /// The element perturbed on the left (space side) by the coordinates `xi`: `(1 + hat(xi) +
    /// O(xi^2)) . g`. Missing and surplus coordinates are treated as in [`Group::retract`].
    #[inline]
    fn retract_from_left(&self, xi: &[T]) -> Self {
        Self::identity().retract(xi).compose(self)
    }

    /// An element near the combination of `element(0)`, `element(1)`, ... entry by entry, with weights whose sum is
    /// one. It extrapolates velocities that vary smoothly along a trajectory. If a group cannot compute it cheaply,
    /// it returns the first element.
    #[inline(always)]
    fn combined(_weights: &[f64], element: impl Fn(usize) -> Self) -> Self {
        element(0)
    }

    /// The meaning of the coordinate with this index, for error messages.
    fn coordinate(index: usize) -> Coordinate {
        Coordinate::of(Part::axis(index))
    }

    /// The distance by which rounding has moved the element off the group, in the units of its entries.
    fn distance_from_group(&self) -> f64;

    /// The number of parts of the coordinates, each measured by its own length, because angles and translations
    /// cannot be added.
    const PARTS: usize = 1;

    /// The part that a coordinate belongs to.
    #[must_use]
    fn part_of(_index: usize) -> usize {
        0
    }

    /// Whether the coordinates of a part are pure numbers, as angles are. Parts that are lengths come after the
    /// angles of the same element.
    #[must_use]
    fn is_pure(_part: usize) -> bool {
        true
    }

    /// Whether the coordinates of a part lack a natural scale, as for fields and linear maps: the equations may then
    /// vary over any length.
    #[must_use]
    fn is_open(_part: usize) -> bool {
        false
    }

    /// The squared lengths of the coordinates `x` of the element relative to the neutral element,
    /// `identity().retract(x)`, and their squared distances from `xi`, part by part, in every lane. They are infinite
    /// or NaN if such coordinates do not exist. Missing coordinates of `xi` count as zero.
    fn compared(&self, xi: &[T], out: &mut [[T; 2]]);

    /// Whether the length of each part is at most its entry of `reach`, in every lane.
    fn is_within(&self, reach: &[f64]) -> bool;
}

/// The squares of the length of an array, row by row, and of its distance from `xi`.
#[inline(always)]
fn squares<T: Real, const R: usize, const C: usize>(own: &SMatrix<T, R, C>, xi: &[T]) -> [T; 2] {
    let (mut length, mut off) = (T::zero(), T::zero());
    for i in 0..R {
        for j in 0..C {
            let x = own[(i, j)];
            let apart = xi.get(C * i + j).map_or(x, |y| x - *y);
            length += x * x;
            off += apart * apart;
        }
    }
    [length, off]
}

/// How covectors of the Lie algebra, that is momenta, transform between body and space.
pub trait Coadjoint<T>: Group<T> {
    /// A covector: a vector for SO(3), an n x n matrix for matrix groups.
    type Covector: Copy;

    /// A covector of the body frame in the space frame: `<m, g X g^-1> = <mu, X>`.
    fn covector_to_space(&self, body: &Self::Covector) -> Self::Covector;

    /// A covector of the space frame in the body frame.
    fn covector_to_body(&self, spatial: &Self::Covector) -> Self::Covector;
}
