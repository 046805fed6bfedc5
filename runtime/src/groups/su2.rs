//! Unit quaternions, the group SU(2): rotations with a sign. Takes four numbers; gives elements
//! that multiply, and the rotations they cover.

use super::so3::hamilton;
use super::{Coadjoint, Group, NotARotation, Rotation};
use crate::Real;
use crate::linalg::left_multiplication;
use crate::scalar::of_scalars;
use core::ops::Mul;
use nalgebra::{Matrix4, Vector3};

/// A unit quaternion `(w, x, y, z)`, from body to space: it turns a body vector `v`, read as a
/// quaternion, into `q v q*`. Unlike for a [`Rotation`], `q` and `-q` are different elements.
///
/// The coordinates `ξ` of its Lie algebra are an angular velocity, and denote the quaternion `ξ/2` without
/// real part (thesis section 2.5, the Cayley-Klein form).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitQuaternion<T = f64>(Rotation<T>);

of_scalars!(UnitQuaternion { 0 });

impl<T: Real> UnitQuaternion<T> {
    /// The neutral element, `1`.
    #[inline]
    pub fn identity() -> Self {
        Self(Rotation::identity())
    }

    /// The element with these components.
    ///
    /// # Errors
    /// [`NotARotation`] when `|q|^2` differs from 1 by more than 1e-9 or is not finite; within
    /// that it is normalised.
    pub fn from_components(q: [T; 4]) -> Result<Self, NotARotation> {
        Rotation::from_quaternion(q).map(Self)
    }

    /// The components `(w, x, y, z)`.
    #[inline]
    pub fn components(&self) -> [T; 4] {
        self.0.quaternion()
    }

    /// The real part.
    #[inline(always)]
    pub fn real(&self) -> T {
        let [w, ..] = self.components();
        w
    }

    /// The imaginary part, the coefficients of i, j and k.
    #[inline(always)]
    pub fn imaginary(&self) -> Vector3<T> {
        let [_, x, y, z] = self.components();
        Vector3::new(x, y, z)
    }

    /// The matrix of the left multiplication by it, 4 x 4 and orthogonal.
    #[inline]
    pub fn matrix(&self) -> Matrix4<T> {
        left_multiplication(self.components())
    }

    /// The rotation that it represents, body -> space; `-q` represents the same rotation.
    #[inline]
    pub fn rotation(&self) -> Rotation<T> {
        self.0
    }

    /// `q / |q|`, for any nonzero `q`.
    #[inline]
    pub(crate) fn normalised(q: [T; 4]) -> Self {
        Self(Rotation::normalised(q))
    }

    /// The element whose components a rotation stores.
    #[inline(always)]
    pub(crate) fn covering(rotation: Rotation<T>) -> Self {
        Self(rotation)
    }

    /// `self* . other`, whose length is 1 up to the rounding of both.
    #[inline(always)]
    pub(crate) fn to(&self, other: &Self) -> Self {
        let [w, x, y, z] = self.components();
        let product = hamilton([w, -x, -y, -z], other.components());
        Self(Rotation::from_unit(product))
    }

    /// The inverse, which is the conjugate.
    #[inline]
    pub fn inverse(&self) -> Self {
        Self(self.0.inverse())
    }
}

impl<T: Real> Mul for UnitQuaternion<T> {
    type Output = Self;

    /// Hamilton's product; unit to rounding however long the chain of products.
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl<T: Real> Group<T> for UnitQuaternion<T> {
    const DIMENSION: usize = 3;

    super::own_operations!();

    /// `self . (1 + ξ/2)/|1 + ξ/2|`, the Cayley map: it covers the Cayley map of the rotations.
    #[inline]
    fn retract(&self, xi: &[T]) -> Self {
        Self(self.0.retract(xi))
    }

    #[inline(always)]
    fn combined(weights: &[f64], element: impl Fn(usize) -> Self) -> Self {
        Self(Rotation::combined(weights, |i| element(i).0))
    }

    #[inline]
    fn distance_from_group(&self) -> f64 {
        Group::<T>::distance_from_group(&self.0)
    }

    #[inline(always)]
    fn compared(&self, xi: &[T], out: &mut [[T; 2]]) {
        self.0.compared(xi, out);
        let real = self.real();
        for lane in 0..T::LANES {
            if let (Some(first), false) = (out.first_mut(), real.lane(lane) > 0.0) {
                for x in first {
                    x.set_lane(lane, T::One::from_f64(f64::INFINITY));
                }
            }
        }
    }

    #[inline(always)]
    fn is_within(&self, reach: &[f64]) -> bool {
        self.0.is_within(reach) & (self.real().exceeds(T::zero()))
    }
}

impl<T: Real> Coadjoint<T> for UnitQuaternion<T> {
    type Covector = Vector3<T>;

    /// `q mu q*`. For a fixed spatial momentum `m`, the fibres of `q -> q* m q` form the Hopf fibration.
    #[inline]
    fn covector_to_space(&self, body: &Vector3<T>) -> Vector3<T> {
        self.0.rotate(body)
    }

    /// `q* m q`.
    #[inline]
    fn covector_to_body(&self, spatial: &Vector3<T>) -> Vector3<T> {
        self.0.inverse_rotate(spatial)
    }
}
