//! The product of a rotation with one whose quaternion has not been normalised yet.
//! Takes both; gives the product's action on vectors and its matrix after one division, its quaternion after a root as well.

use super::so3::{hamilton, norm_squared, times};
use super::{Rotation, UnitQuaternion};
use crate::Real;
use core::ops::Mul;
use nalgebra::{Matrix3, Vector3};

/// A rotation on its way: what follows a step may begin before its length is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnedRotation<T = f64> {
    /// The quaternion, of any length.
    q: [T; 4],
    /// Twice the inverse of its square.
    scale: T,
}

impl<T: Real> Rotation<T> {
    /// `self . omega`, `omega` a quaternion of any length but zero. Rounding that the length of
    /// `self` has gathered is taken out, to first order.
    #[inline(always)]
    pub(crate) fn turned(&self, omega: [T; 4]) -> TurnedRotation<T> {
        let q = self.quaternion();
        let correction = T::from_f64(2.0) - norm_squared(q);
        TurnedRotation {
            q: hamilton(q, omega),
            scale: (correction + correction) / norm_squared(omega),
        }
    }

    /// The same where the inverse of the square of the length of `omega` is known.
    #[inline(always)]
    pub(crate) fn turned_at(&self, omega: [T; 4], per_square: T) -> TurnedRotation<T> {
        let q = self.quaternion();
        let correction = T::from_f64(2.0) - norm_squared(q);
        TurnedRotation {
            q: hamilton(q, omega),
            scale: (correction + correction) * per_square,
        }
    }
}

impl<T: Real> TurnedRotation<T> {
    /// The rotation, of unit length.
    #[inline(always)]
    pub fn rotation(&self) -> Rotation<T> {
        let scale = (T::from_f64(0.5) * self.scale).sqrt();
        Rotation::from_unit(times(self.q, scale))
    }

    /// The unit quaternion, of this sign.
    #[inline(always)]
    pub fn unit_quaternion(&self) -> UnitQuaternion<T> {
        UnitQuaternion::covering(self.rotation())
    }

    /// The 3x3 matrix, body -> space, as it acts on vectors.
    #[inline(always)]
    pub fn turning(&self) -> Turning<T> {
        let ([w, x, y, z], scale) = (self.q, self.scale);
        let (xx, yy, zz) = (x * x, y * y, z * z);
        let (xy, xz, yz) = (x * y, x * z, y * z);
        let (wx, wy, wz) = (w * x, w * y, w * z);
        #[rustfmt::skip]
        let deviation = [
            [-(yy + zz), xy - wz, xz + wy],
            [xy + wz, -(xx + zz), yz - wx],
            [xz - wy, yz + wx, -(xx + yy)],
        ];
        Turning { deviation, scale }
    }

    /// The 3x3 matrix, body -> space.
    #[inline(always)]
    pub fn matrix(&self) -> Matrix3<T> {
        let ([w, x, y, z], s) = (self.q, self.scale);
        let one = T::one();
        let (xx, yy, zz) = (x * x, y * y, z * z);
        let (xy, xz, yz) = (x * y, x * z, y * z);
        let (wx, wy, wz) = (w * x, w * y, w * z);
        #[rustfmt::skip]
        let matrix = Matrix3::new(
            one - s * (yy + zz), s * (xy - wz), s * (xz + wy),
            s * (xy + wz), one - s * (xx + zz), s * (yz - wx),
            s * (xz - wy), s * (yz + wx), one - s * (xx + yy),
        );
        matrix
    }
}

/// The matrix `1 + s E` of a rotation, body -> space, which acts on a vector without being formed:
/// `v + s (E v)`, where only the last step waits for the division that `s` is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning<T = f64> {
    /// `E`, by rows.
    deviation: [[T; 3]; 3],
    scale: T,
}

impl<T: Real> Turning<T> {
    /// The inverse rotation of a vector, space -> body.
    #[inline(always)]
    pub fn tr_mul(&self, v: &Vector3<T>) -> Vector3<T> {
        let ([[a, b, c], [d, e, f], [g, h, i]], s) = (self.deviation, self.scale);
        let [[x, y, z]] = v.data.0;
        Vector3::new(
            x + s * ((a * x + d * y) + g * z),
            y + s * ((b * x + e * y) + h * z),
            z + s * ((c * x + f * y) + i * z),
        )
    }
}

impl<T: Real> Mul<Vector3<T>> for Turning<T> {
    type Output = Vector3<T>;

    /// The rotation of a vector, body -> space.
    #[inline(always)]
    fn mul(self, v: Vector3<T>) -> Vector3<T> {
        let ([[a, b, c], [d, e, f], [g, h, i]], s) = (self.deviation, self.scale);
        let [[x, y, z]] = v.data.0;
        Vector3::new(
            x + s * ((a * x + b * y) + c * z),
            y + s * ((d * x + e * y) + f * z),
            z + s * ((g * x + h * y) + i * z),
        )
    }
}
