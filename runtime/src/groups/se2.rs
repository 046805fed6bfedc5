//! Rigid motions of the plane, the group SE(2), and their momenta. Takes rotations and translations
//! or homogeneous matrices; gives motions body -> plane.

use super::placed::{added, between};
use super::se3::NotARigidMotion;
use super::{AboutBody, Coadjoint, Coordinate, Group, Orthogonal, Part, Placed, squares};
use crate::Real;
use crate::scalar::{largest, of_scalars};
use core::ops::Mul;
use nalgebra::{Matrix2, Matrix3, SVector, Vector2};

/// A rigid motion of the plane, by convention from the body: `p_plane = R p_body + x`.
///
/// The coordinates of its Lie algebra are `(ω, v)`, one angular and two linear. They represent the matrix
/// `[ω i, v; 0 0]` with the quarter turn `i`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneMotion<T = f64> {
    /// `R`, body -> plane.
    pub rotation: Orthogonal<2, T>,
    /// `x`, the position of the body's origin in the plane.
    pub translation: Vector2<T>,
}

of_scalars!(PlaneMotion {
    rotation,
    translation
});

/// A vector rotated by a quarter turn.
fn quarter<T: Real>(v: &Vector2<T>) -> Vector2<T> {
    Vector2::new(-v.y, v.x)
}

impl<T: Real> PlaneMotion<T> {
    /// The identity.
    #[inline]
    pub fn identity() -> Self {
        Self {
            rotation: Orthogonal::identity(),
            translation: Vector2::repeat(T::zero()),
        }
    }

    /// The rotation by an angle about the origin of the plane, followed by the translation.
    #[inline]
    pub fn new(angle: T, translation: Vector2<T>) -> Self {
        let (sine, cosine) = (angle.sin(), angle.cos());
        Self {
            rotation: Orthogonal::nearby(&Matrix2::new(cosine, -sine, sine, cosine)),
            translation,
        }
    }

    /// The motion of a homogeneous matrix `[R x; 0 1]`.
    ///
    /// # Errors
    /// [`NotARigidMotion`] if the block is not a rotation to 1e-9, or the last row is not exactly
    /// `(0, 0, 1)`.
    pub fn from_matrix(a: &Matrix3<T>) -> Result<Self, NotARigidMotion> {
        let translation = Vector2::new(a.m13, a.m23);
        let row = [a.m31, a.m32, a.m33 - T::one()];
        let defect = largest(row.iter().map(|x| x.magnitude()));
        let finite = translation.iter().chain(&row).all(|x| x.is_finite());
        if defect != 0.0 || !finite {
            return Err(NotARigidMotion::LastRow {
                defect: if finite { defect } else { f64::NAN },
            });
        }
        let block = a.fixed_view::<2, 2>(0, 0).into_owned();
        let rotation = Orthogonal::from_matrix(&block).map_err(NotARigidMotion::Rotation)?;
        Ok(Self {
            rotation,
            translation,
        })
    }

    /// The homogeneous matrix `[R x; 0 1]`.
    #[inline]
    pub fn matrix(&self) -> Matrix3<T> {
        let (r, x) = (self.rotation.matrix(), self.translation);
        let (o, i) = (T::zero(), T::one());
        Matrix3::new(r.m11, r.m12, x.x, r.m21, r.m22, x.y, o, o, i)
    }

    /// The inverse motion, plane -> body.
    #[inline]
    pub fn inverse(&self) -> Self {
        Self {
            rotation: self.rotation.inverse(),
            translation: -self.rotation.matrix().tr_mul(&self.translation),
        }
    }
}

impl<T: Real> Mul for PlaneMotion<T> {
    type Output = Self;

    /// The composition: first `other`, then `self`.
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self {
            rotation: self.rotation * other.rotation,
            translation: self.translation + self.rotation.matrix() * other.translation,
        }
    }
}

impl<T: Real> Group<T> for PlaneMotion<T> {
    const DIMENSION: usize = 3;

    super::own_operations!();

    /// `(R^T R', R^T (x' - x))`: nearby positions are subtracted first, so the result is not rounded
    /// to their distance from the origin.
    #[inline]
    fn body_velocity(&self, next: &Self) -> Self {
        let way = next.translation - self.translation;
        Self {
            rotation: self.rotation.body_velocity(&next.rotation),
            translation: self.rotation.matrix().tr_mul(&way),
        }
    }

    /// `(R' R^T, x' - R' R^T x)`, the translation by differences: `(x' - x) - (R' - R) R^T x`.
    #[inline]
    fn spatial_velocity(&self, next: &Self) -> Self {
        let way = next.translation - self.translation;
        let turned = next.rotation.matrix() - self.rotation.matrix();
        let seen_from_body = self.rotation.matrix().tr_mul(&self.translation);
        Self {
            rotation: self.rotation.spatial_velocity(&next.rotation),
            translation: way - turned * seen_from_body,
        }
    }

    /// `self . [cay(ω) v; 0 1]`: it agrees with the exponential to first order and needs no
    /// trigonometry.
    #[inline]
    fn retract(&self, xi: &[T]) -> Self {
        let at = |i: usize| xi.get(i).copied().unwrap_or_else(T::zero);
        let half = at(0) * T::from_f64(0.5);
        let over = T::one() / (T::one() + half * half);
        let (cosine, sine) = ((T::one() - half * half) * over, (half + half) * over);
        *self
            * Self {
                rotation: Orthogonal::nearby(&Matrix2::new(cosine, -sine, sine, cosine)),
                translation: Vector2::new(at(1), at(2)),
            }
    }

    fn coordinate(index: usize) -> Coordinate {
        Coordinate::of(Part::of_plane_motion(index))
    }

    #[inline]
    fn distance_from_group(&self) -> f64 {
        Group::<T>::distance_from_group(&self.rotation)
    }

    const PARTS: usize = 2;

    fn part_of(index: usize) -> usize {
        usize::from(index >= 1)
    }

    fn is_pure(part: usize) -> bool {
        part == 0
    }

    #[inline(always)]
    fn compared(&self, xi: &[T], out: &mut [[T; 2]]) {
        let (angular, linear) = xi.split_at(1.min(xi.len()));
        self.rotation.compared(angular, out);
        if let Some(second) = out.get_mut(1) {
            *second = squares(&self.translation, linear);
        }
    }

    #[inline(always)]
    fn is_within(&self, reach: &[f64]) -> bool {
        let x = &self.translation;
        let linear = reach.get(1).copied().unwrap_or(0.0);
        let beyond = x.dot(x) - T::from_f64(linear * linear);
        self.rotation.is_within(reach) & beyond.nowhere_positive()
    }
}

impl<T: Real> Coadjoint<T> for PlaneMotion<T> {
    type Covector = SVector<T, 3>;

    /// `(a + x × R l, R l)` of the covector `(a, l)`.
    #[inline]
    fn covector_to_space(&self, body: &SVector<T, 3>) -> SVector<T, 3> {
        let linear = self.rotation.matrix() * Vector2::new(body.y, body.z);
        let moment = quarter(&self.translation).dot(&linear);
        SVector::<T, 3>::new(body.x + moment, linear.x, linear.y)
    }

    /// `(a - x × l, R^T l)` of the covector `(a, l)`.
    #[inline]
    fn covector_to_body(&self, spatial: &SVector<T, 3>) -> SVector<T, 3> {
        let linear = Vector2::new(spatial.y, spatial.z);
        let moment = quarter(&self.translation).dot(&linear);
        let seen = self.rotation.matrix().tr_mul(&linear);
        SVector::<T, 3>::new(spatial.x - moment, seen.x, seen.y)
    }
}

impl<T: Real> Placed<T> for PlaneMotion<T> {
    type Way = Vector2<T>;

    #[inline(always)]
    fn way(&self, velocity: &Self) -> Vector2<T> {
        self.rotation.matrix() * velocity.translation
    }

    #[inline(always)]
    fn moved(&self, velocity: &Self, rest: &Vector2<T>) -> (Self, Vector2<T>) {
        let (translation, rest) = added(&self.translation, rest, &self.way(velocity));
        let rotation = self.rotation * velocity.rotation;
        (
            Self {
                rotation,
                translation,
            },
            rest,
        )
    }

    #[inline]
    fn velocity_between(&self, rest: &Vector2<T>, next: &Self, next_rest: &Vector2<T>) -> Self {
        let way = between((&self.translation, rest), (&next.translation, next_rest));
        Self {
            rotation: self.rotation.body_velocity(&next.rotation),
            translation: self.rotation.matrix().tr_mul(&way),
        }
    }
}

impl<T: Real> AboutBody<T> for PlaneMotion<T> {
    #[inline]
    fn covector_turned(&self, body: &SVector<T, 3>) -> SVector<T, 3> {
        let linear = self.rotation.matrix() * Vector2::new(body.y, body.z);
        SVector::<T, 3>::new(body.x, linear.x, linear.y)
    }

    #[inline]
    fn covector_turned_back(&self, turned: &SVector<T, 3>) -> SVector<T, 3> {
        let linear = Vector2::new(turned.y, turned.z);
        let seen = self.rotation.matrix().tr_mul(&linear);
        SVector::<T, 3>::new(turned.x, seen.x, seen.y)
    }

    #[inline]
    fn gained_along(&self, velocity: &Self, turned: &SVector<T, 3>) -> SVector<T, 3> {
        let moment = quarter(&self.way(velocity)).dot(&Vector2::new(turned.y, turned.z));
        SVector::<T, 3>::new(-moment, T::zero(), T::zero())
    }
}

/// Angular and linear momentum in body axes, about the body's origin, at a node: one angular and then
/// two linear components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyPlaneImpulse<T = f64>(pub SVector<T, 3>);

/// Angular and linear momentum in the axes of the plane, about the body's own origin, at a node. A state stores this
/// momentum because it does not depend on the position of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedPlaneImpulse<T = f64>(pub SVector<T, 3>);

/// Angular and linear momentum in the axes of the plane, about its origin, at a node; free motion conserves both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpatialPlaneImpulse<T = f64>(pub SVector<T, 3>);

of_scalars!(BodyPlaneImpulse { 0 });
of_scalars!(CarriedPlaneImpulse { 0 });
of_scalars!(SpatialPlaneImpulse { 0 });

impl<T: Real> CarriedPlaneImpulse<T> {
    /// This impulse about the origin of the plane.
    #[inline]
    pub fn to_space(&self, motion: &PlaneMotion<T>) -> SpatialPlaneImpulse<T> {
        let linear = Vector2::new(self.0.y, self.0.z);
        let moment = quarter(&motion.translation).dot(&linear);
        SpatialPlaneImpulse(SVector::<T, 3>::new(self.0.x + moment, linear.x, linear.y))
    }

    /// This impulse in body axes.
    #[inline]
    pub fn to_body(&self, motion: &PlaneMotion<T>) -> BodyPlaneImpulse<T> {
        BodyPlaneImpulse(motion.covector_turned_back(&self.0))
    }
}

impl<T: Real> BodyPlaneImpulse<T> {
    /// This impulse in the axes of the plane, about the body's origin.
    #[inline]
    pub fn carried(&self, motion: &PlaneMotion<T>) -> CarriedPlaneImpulse<T> {
        CarriedPlaneImpulse(motion.covector_turned(&self.0))
    }

    /// This impulse in the axes of the plane, about the origin of the plane.
    #[inline]
    pub fn to_space(&self, motion: &PlaneMotion<T>) -> SpatialPlaneImpulse<T> {
        SpatialPlaneImpulse(motion.covector_to_space(&self.0))
    }
}

impl<T: Real> SpatialPlaneImpulse<T> {
    /// This impulse in body axes.
    #[inline]
    pub fn to_body(&self, motion: &PlaneMotion<T>) -> BodyPlaneImpulse<T> {
        BodyPlaneImpulse(motion.covector_to_body(&self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::PlaneMotion;
    use crate::Group;
    use nalgebra::Vector2;

    #[test]
    fn retractions_turn_by_twice_the_angle_whose_tangent_is_half_the_coordinate() {
        let start = PlaneMotion::new(0.3, Vector2::new(1.0, -2.0));
        for omega in [0.0, 1e-3, -0.4, 2.0] {
            let moved = start.retract(&[omega, 0.5, 0.25]);
            let turned = PlaneMotion::new(2.0 * f64::atan(0.5 * omega), Vector2::new(0.5, 0.25));
            let wanted = start * turned;
            // A few roundings of numbers below 3.
            let apart = moved.rotation.matrix() - wanted.rotation.matrix();
            assert!(apart.norm() < 4e-15, "{omega}");
            assert!(
                (moved.translation - wanted.translation).norm() < 4e-15,
                "{omega}"
            );
        }
    }
}
