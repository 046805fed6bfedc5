//! Rigid motions as 4 x 4 homogeneous matrices `[R x; 0 1]`: their blocks, and the elements of their
//! Lie algebra.

use super::hat;
use crate::Real;
use nalgebra::{Matrix3, Matrix4, SVector, Vector3};

/// The upper left block of a homogeneous matrix: the rotation.
#[inline]
#[must_use]
pub fn motion_rotation<T: Real>(a: &Matrix4<T>) -> Matrix3<T> {
    a.fixed_view::<3, 3>(0, 0).into_owned()
}

/// The upper right column of a homogeneous matrix: the translation.
#[inline]
#[must_use]
pub fn motion_translation<T: Real>(a: &Matrix4<T>) -> Vector3<T> {
    a.fixed_view::<3, 1>(0, 3).into_owned()
}

/// The element `[hat(ω) v; 0 0]` of the Lie algebra with coordinates `(ω, v)`.
#[inline]
#[must_use]
pub fn twist<T: Real>(x: &SVector<T, 6>) -> Matrix4<T> {
    let [[a, b, c, d, e, f]] = x.data.0;
    let turn = hat(&Vector3::new(a, b, c));
    let mut matrix = Matrix4::repeat(T::zero());
    matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&turn);
    matrix
        .fixed_view_mut::<3, 1>(0, 3)
        .copy_from(&Vector3::new(d, e, f));
    matrix
}
