//! Quaternions as 4 x 4 matrices of left multiplication on `(1, i, j, k)`: products of quaternions
//! are products of matrices, the conjugate is the transpose.

use crate::Real;
use nalgebra::{Matrix3, Matrix4, Vector3};

/// The left multiplication by the quaternion `w + x i + y j + z k`, given as `(w, x, y, z)`.
#[inline]
#[must_use]
pub fn left_multiplication<T: Real>([w, x, y, z]: [T; 4]) -> Matrix4<T> {
    #[rustfmt::skip]
    let matrix = Matrix4::new(
        w, -x, -y, -z,
        x, w, -z, y,
        y, z, w, -x,
        z, -y, x, w,
    );
    matrix
}

/// The left multiplication by a vector, read as a quaternion without real part.
#[inline]
#[must_use]
pub fn pure_quaternion<T: Real>(v: &Vector3<T>) -> Matrix4<T> {
    left_multiplication([T::zero(), v.x, v.y, v.z])
}

/// The quaternion nearest to a 4 x 4 matrix: a quarter of its pairings with the four units.
#[inline(always)]
fn nearest<T: Real>(a: &Matrix4<T>) -> [T; 4] {
    let quarter = T::from_f64(0.25);
    let [c0, c1, c2, c3] = a.data.0;
    [
        (c0[0] + c1[1]) + (c2[2] + c3[3]),
        (c0[1] - c1[0]) + (c2[3] - c3[2]),
        (c0[2] - c2[0]) + (c3[1] - c1[3]),
        (c0[3] - c3[0]) + (c1[2] - c2[1]),
    ]
    .map(|x| x * quarter)
}

/// The real part of a quaternion's matrix, `tr(A)/4`; for any other matrix, the real part of the nearest quaternion.
#[inline]
#[must_use]
pub fn quaternion_real<T: Real>(a: &Matrix4<T>) -> T {
    nearest(a)[0]
}

/// The imaginary part of a quaternion's matrix; for any other matrix, the imaginary part of the nearest quaternion.
#[inline]
#[must_use]
pub fn quaternion_imaginary<T: Real>(a: &Matrix4<T>) -> Vector3<T> {
    let [_, x, y, z] = nearest(a);
    Vector3::new(x, y, z)
}

/// The rotation `v -> q v q*` of a unit quaternion's matrix.
#[inline]
#[must_use]
pub fn quaternion_rotation<T: Real>(a: &Matrix4<T>) -> Matrix3<T> {
    let [w, x, y, z] = nearest(a);
    let v = Vector3::new(x, y, z);
    let two = T::from_f64(2.0);
    let diagonal = Matrix3::from_diagonal_element(w * w - v.dot(&v));
    diagonal + v * v.transpose() * two + super::hat(&v) * (two * w)
}
