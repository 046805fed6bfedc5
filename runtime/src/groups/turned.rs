//! The product of a rotation with a rotation whose quaternion has not been normalised yet. Takes both; gives the
//! product's action on vectors and its matrix after one division, its quaternion after a root as well.

use super::so3::{hamilton, norm_squared, times};
use super::{Rotation, UnitQuaternion};
use crate::Real;
use nalgebra::{Matrix3, Vector3};

/// A rotation with an unnormalised quaternion: later operations of a step can start before its length is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnedRotation<T = f64> {
    /// The quaternion, of any length.
    q: [T; 4],
    /// Twice the inverse of its square.
    scale: T,
}

impl<T: Real> Rotation<T> {
    /// `self . omega`, `omega` a quaternion of any length but zero. Corrects the accumulated
    /// rounding of the length of `self`, to first order.
    #[inline(always)]
    pub(crate) fn turned(&self, omega: [T; 4]) -> TurnedRotation<T> {
        let q = self.quaternion();
        let correction = T::from_f64(2.0) - norm_squared(q);
        TurnedRotation {
            q: hamilton(q, omega),
            scale: (correction + correction) / norm_squared(omega),
        }
    }

    /// Like `turned`, if the inverse of the squared length of `omega` is known.
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
    /// The inverse rotation of a vector, space -> body: `v + s (E^T v)`; only the last operation waits for `s`, which
    /// needs a division. For one vector less than the matrix, for several more.
    #[inline(always)]
    pub fn inverse_rotate(&self, v: &Vector3<T>) -> Vector3<T> {
        let ([w, x, y, z], s) = (self.q, self.scale);
        let (xx, yy, zz) = (x * x, y * y, z * z);
        let (xy, xz, yz) = (x * y, x * z, y * z);
        let (wx, wy, wz) = (w * x, w * y, w * z);
        // By columns of `E`.
        let first = [-(yy + zz), xy + wz, xz - wy];
        let second = [xy - wz, -(xx + zz), yz + wx];
        let third = [xz + wy, yz - wx, -(xx + yy)];
        let [v] = v.data.0;
        let turned = |at: usize, [a, b, c]: [T; 3]| v[at] + s * ((a * v[0] + b * v[1]) + c * v[2]);
        Vector3::new(turned(0, first), turned(1, second), turned(2, third))
    }
}

#[cfg(test)]
mod tests {
    use crate::Rotation;
    use nalgebra::Vector3;

    #[test]
    fn a_rotation_on_its_way_is_the_product() {
        let r = Rotation::exp(&Vector3::new(0.4, -1.1, 0.7));
        // A quaternion of any length, here (1, 2, -3, 5)/4.
        let omega = [0.25, 0.5, -0.75, 1.25];
        let square = omega.iter().map(|x| x * x).sum::<f64>();
        let unit = omega.map(|x| x / square.sqrt());
        let product = (r * Rotation::from_quaternion(unit).expect("a unit quaternion")).matrix();
        let v = Vector3::new(0.3, 2.0, -1.5);
        for turned in [r.turned(omega), r.turned_at(omega, 1.0 / square)] {
            // Some ten roundings of numbers below 3.
            assert!((turned.matrix() - product).norm() < 1e-14);
            assert!((turned.rotation().matrix() - product).norm() < 1e-14);
            assert!((turned.inverse_rotate(&v) - product.transpose() * v).norm() < 1e-14);
        }
    }
}
