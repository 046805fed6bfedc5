//! Rigid motions of space, the group SE(3), and their momenta. Takes rotations and translations or
//! homogeneous matrices; gives motions body -> space.

use super::placed::{added, between};
use super::{
    AboutBody, Coadjoint, Coordinate, Group, NotARotation, Part, Placed, Rotation, squares,
};
use crate::Real;
use crate::scalar::{largest, of_scalars};
use core::fmt;
use core::ops::Mul;
use nalgebra::{Matrix4, SVector, Vector3};

/// A rigid motion, by convention from body to space: `p_space = R p_body + x`.
///
/// The coordinates of its Lie algebra are `(ω, v)`, three angular and three linear. They denote the
/// matrix `[hat(ω) v; 0 0]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion<T = f64> {
    /// `R`, body -> space.
    pub rotation: Rotation<T>,
    /// `x`, the position of the body's origin in space.
    pub translation: Vector3<T>,
}

of_scalars!(RigidMotion {
    rotation,
    translation
});

/// A matrix that is not a rigid motion, with the number that shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum NotARigidMotion {
    /// Its upper left block.
    Rotation(NotARotation),
    /// Its last row is not `(0, ..., 0, 1)`, or its last column is not finite.
    LastRow {
        /// The largest deviation of an entry.
        defect: f64,
    },
}

impl fmt::Display for NotARigidMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rotation(why) => write!(f, "not a rigid motion: upper left block: {why}"),
            Self::LastRow { defect } => write!(
                f,
                "not a rigid motion: the last row is not (0, ..., 0, 1) or the last column is not finite, off by {defect:.3e}"
            ),
        }
    }
}

impl std::error::Error for NotARigidMotion {}

impl<T: Real> RigidMotion<T> {
    /// The identity motion.
    #[inline]
    pub fn identity() -> Self {
        Self {
            rotation: Rotation::identity(),
            translation: Vector3::repeat(T::zero()),
        }
    }

    /// The motion of a homogeneous matrix `[R x; 0 1]`.
    ///
    /// # Errors
    /// [`NotARigidMotion`] if the block is not a rotation to 1e-9, or the last row is not exactly
    /// `(0, 0, 0, 1)`.
    pub fn from_matrix(a: &Matrix4<T>) -> Result<Self, NotARigidMotion> {
        let translation = Vector3::new(a.m14, a.m24, a.m34);
        let row = [a.m41, a.m42, a.m43, a.m44 - T::one()];
        let defect = largest(row.iter().map(|x| x.magnitude()));
        let finite = translation.iter().chain(&row).all(|x| x.is_finite());
        if defect != 0.0 || !finite {
            return Err(NotARigidMotion::LastRow {
                defect: if finite { defect } else { f64::NAN },
            });
        }
        let block = a.fixed_view::<3, 3>(0, 0).into_owned();
        let rotation = Rotation::from_matrix(&block).map_err(NotARigidMotion::Rotation)?;
        Ok(Self {
            rotation,
            translation,
        })
    }

    /// The homogeneous matrix `[R x; 0 1]`.
    #[inline]
    pub fn matrix(&self) -> Matrix4<T> {
        let (r, x) = (self.rotation.matrix(), self.translation);
        let (o, i) = (T::zero(), T::one());
        #[rustfmt::skip]
        let matrix = Matrix4::new(
            r.m11, r.m12, r.m13, x.x,
            r.m21, r.m22, r.m23, x.y,
            r.m31, r.m32, r.m33, x.z,
            o, o, o, i,
        );
        matrix
    }

    /// The inverse motion, space -> body.
    #[inline]
    pub fn inverse(&self) -> Self {
        Self {
            rotation: self.rotation.inverse(),
            translation: -self.rotation.inverse_rotate(&self.translation),
        }
    }
}

#[inline(always)]
fn stacked<T: Real>(angular: Vector3<T>, linear: Vector3<T>) -> SVector<T, 6> {
    let ([[a, b, c]], [[d, e, f]]) = (angular.data.0, linear.data.0);
    SVector::<T, 6>::new(a, b, c, d, e, f)
}

impl<T: Real> Mul for RigidMotion<T> {
    type Output = Self;

    /// The composition: first `other`, then `self`.
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self {
            rotation: self.rotation * other.rotation,
            translation: self.translation + self.rotation.rotate(&other.translation),
        }
    }
}

impl<T: Real> Group<T> for RigidMotion<T> {
    const DIMENSION: usize = 6;

    super::own_operations!();

    /// `(R^T R', R^T (x' - x))`: nearby positions are subtracted first, so the result is not rounded to their
    /// distance from the origin.
    #[inline]
    fn body_velocity(&self, next: &Self) -> Self {
        let way = next.translation - self.translation;
        Self {
            rotation: self.rotation.body_velocity(&next.rotation),
            translation: self.rotation.inverse_rotate(&way),
        }
    }

    /// `(R' R^T, x' - R' R^T x)`, the translation by differences: `(x' - x) - (R' - R) R^T x`.
    #[inline]
    fn spatial_velocity(&self, next: &Self) -> Self {
        let way = next.translation - self.translation;
        let turned = next.rotation.matrix() - self.rotation.matrix();
        let seen_from_body = self.rotation.inverse_rotate(&self.translation);
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
        let (angular, linear) = ([at(0), at(1), at(2)], Vector3::new(at(3), at(4), at(5)));
        *self
            * Self {
                rotation: Rotation::identity().retract(&angular),
                translation: linear,
            }
    }

    /// `(cay(ω) R, x + ω × x + v)`: equal to first order, and without a rotation of its own.
    #[inline]
    fn retract_from_left(&self, xi: &[T]) -> Self {
        let at = |i: usize| xi.get(i).copied().unwrap_or_else(T::zero);
        let (angular, linear) = ([at(0), at(1), at(2)], Vector3::new(at(3), at(4), at(5)));
        let x = &self.translation;
        Self {
            rotation: self.rotation.retract_from_left(&angular),
            translation: x + (Vector3::from(angular).cross(x) + linear),
        }
    }

    #[inline(always)]
    fn combined(weights: &[f64], element: impl Fn(usize) -> Self) -> Self {
        let mut translation = Vector3::repeat(T::zero());
        for (i, weight) in weights.iter().enumerate().rev() {
            translation += element(i).translation * T::from_f64(*weight);
        }
        Self {
            rotation: Rotation::combined(weights, |i| element(i).rotation),
            translation,
        }
    }

    fn coordinate(index: usize) -> Coordinate {
        Coordinate::of(Part::of_motion(index))
    }

    #[inline]
    fn distance_from_group(&self) -> f64 {
        Group::<T>::distance_from_group(&self.rotation)
    }

    const PARTS: usize = 2;

    fn part_of(index: usize) -> usize {
        usize::from(index >= 3)
    }

    fn is_pure(part: usize) -> bool {
        part == 0
    }

    #[inline(always)]
    fn compared(&self, xi: &[T], out: &mut [[T; 2]]) {
        let (angular, linear) = xi.split_at(3.min(xi.len()));
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

impl<T: Real> Coadjoint<T> for RigidMotion<T> {
    type Covector = SVector<T, 6>;

    /// `(R a + x × R l, R l)` of the covector `(a, l)`.
    #[inline]
    fn covector_to_space(&self, body: &SVector<T, 6>) -> SVector<T, 6> {
        let [[a0, a1, a2, l0, l1, l2]] = body.data.0;
        let linear = self.rotation.rotate(&Vector3::new(l0, l1, l2));
        let angular = self.rotation.rotate(&Vector3::new(a0, a1, a2));
        stacked(angular + self.translation.cross(&linear), linear)
    }

    /// `(R^T (a - x × l), R^T l)` of the covector `(a, l)`.
    #[inline]
    fn covector_to_body(&self, spatial: &SVector<T, 6>) -> SVector<T, 6> {
        let [[a0, a1, a2, l0, l1, l2]] = spatial.data.0;
        let linear = Vector3::new(l0, l1, l2);
        let angular = Vector3::new(a0, a1, a2) - self.translation.cross(&linear);
        stacked(
            self.rotation.inverse_rotate(&angular),
            self.rotation.inverse_rotate(&linear),
        )
    }
}

impl<T: Real> Placed<T> for RigidMotion<T> {
    type Way = Vector3<T>;

    #[inline(always)]
    fn way(&self, velocity: &Self) -> Vector3<T> {
        self.rotation.rotate(&velocity.translation)
    }

    #[inline(always)]
    fn moved(&self, velocity: &Self, rest: &Vector3<T>) -> (Self, Vector3<T>) {
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
    fn velocity_between(&self, rest: &Vector3<T>, next: &Self, next_rest: &Vector3<T>) -> Self {
        let way = between((&self.translation, rest), (&next.translation, next_rest));
        Self {
            rotation: self.rotation.body_velocity(&next.rotation),
            translation: self.rotation.inverse_rotate(&way),
        }
    }
}

/// The angular and the linear part.
#[inline(always)]
fn parts<T: Real>(covector: &SVector<T, 6>) -> (Vector3<T>, Vector3<T>) {
    let [[a, b, c, d, e, f]] = covector.data.0;
    (Vector3::new(a, b, c), Vector3::new(d, e, f))
}

impl<T: Real> AboutBody<T> for RigidMotion<T> {
    #[inline]
    fn covector_turned(&self, body: &SVector<T, 6>) -> SVector<T, 6> {
        let (angular, linear) = parts(body);
        stacked(
            self.rotation.rotate(&angular),
            self.rotation.rotate(&linear),
        )
    }

    #[inline]
    fn covector_turned_back(&self, turned: &SVector<T, 6>) -> SVector<T, 6> {
        let (angular, linear) = parts(turned);
        let back = |x| self.rotation.inverse_rotate(x);
        stacked(back(&angular), back(&linear))
    }

    #[inline]
    fn gained_along(&self, velocity: &Self, turned: &SVector<T, 6>) -> SVector<T, 6> {
        let (_, linear) = parts(turned);
        let moment = linear.cross(&self.way(velocity));
        stacked(moment, Vector3::repeat(T::zero()))
    }
}

/// Angular and linear momentum in body axes, about the body's origin, at a node: the impulse of
/// Kirchhoff and Lamb, three angular and then three linear components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyImpulse<T = f64>(pub SVector<T, 6>);

/// Angular and linear momentum in space axes, about the body's own origin, at a node. A state stores this momentum
/// because it does not depend on the position of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedImpulse<T = f64>(pub SVector<T, 6>);

/// Angular and linear momentum in space axes, about the origin of space, at a node; free motion conserves both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpatialImpulse<T = f64>(pub SVector<T, 6>);

of_scalars!(BodyImpulse { 0 });
of_scalars!(CarriedImpulse { 0 });
of_scalars!(SpatialImpulse { 0 });

impl<T: Real> CarriedImpulse<T> {
    /// This impulse about the origin of space.
    #[inline]
    pub fn to_space(&self, motion: &RigidMotion<T>) -> SpatialImpulse<T> {
        let (angular, linear) = parts(&self.0);
        let moment = motion.translation.cross(&linear);
        SpatialImpulse(stacked(angular + moment, linear))
    }

    /// This impulse in body axes.
    #[inline]
    pub fn to_body(&self, motion: &RigidMotion<T>) -> BodyImpulse<T> {
        BodyImpulse(motion.covector_turned_back(&self.0))
    }
}

impl<T: Real> BodyImpulse<T> {
    /// This impulse in space axes, about the body's origin.
    #[inline]
    pub fn carried(&self, motion: &RigidMotion<T>) -> CarriedImpulse<T> {
        CarriedImpulse(motion.covector_turned(&self.0))
    }

    /// This impulse in space axes, about the origin of space.
    #[inline]
    pub fn to_space(&self, motion: &RigidMotion<T>) -> SpatialImpulse<T> {
        SpatialImpulse(motion.covector_to_space(&self.0))
    }
}

impl<T: Real> SpatialImpulse<T> {
    /// This impulse in body axes.
    #[inline]
    pub fn to_body(&self, motion: &RigidMotion<T>) -> BodyImpulse<T> {
        BodyImpulse(motion.covector_to_body(&self.0))
    }
}
