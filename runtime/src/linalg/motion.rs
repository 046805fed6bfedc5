//! Rigid motions as homogeneous matrices `[R x; 0 1]`: their blocks, and the elements of their Lie
//! algebra, in the plane and in space.

use super::hat;
use crate::Real;
use nalgebra::{Matrix2, Matrix3, Matrix4, SVector, Vector2, Vector3};

/// A homogeneous matrix.
pub trait Homogeneous {
    /// The matrix without its last row and column.
    type Block;
    /// The last column without its last entry.
    type Column;

    /// The upper left block.
    fn block(&self) -> Self::Block;

    /// The upper right column.
    fn column(&self) -> Self::Column;
}

impl<T: Real> Homogeneous for Matrix4<T> {
    type Block = Matrix3<T>;
    type Column = Vector3<T>;

    #[inline]
    fn block(&self) -> Matrix3<T> {
        self.fixed_view::<3, 3>(0, 0).into_owned()
    }

    #[inline]
    fn column(&self) -> Vector3<T> {
        self.fixed_view::<3, 1>(0, 3).into_owned()
    }
}

impl<T: Real> Homogeneous for Matrix3<T> {
    type Block = Matrix2<T>;
    type Column = Vector2<T>;

    #[inline]
    fn block(&self) -> Matrix2<T> {
        self.fixed_view::<2, 2>(0, 0).into_owned()
    }

    #[inline]
    fn column(&self) -> Vector2<T> {
        self.fixed_view::<2, 1>(0, 2).into_owned()
    }
}

/// The upper left block of a homogeneous matrix: the rotation.
#[inline]
#[must_use]
pub fn motion_rotation<M: Homogeneous>(a: &M) -> M::Block {
    a.block()
}

/// The upper right column of a homogeneous matrix: the translation.
#[inline]
#[must_use]
pub fn motion_translation<M: Homogeneous>(a: &M) -> M::Column {
    a.column()
}

/// Coordinates of a Lie algebra of rigid motions, an angular and a linear part.
pub trait Coordinates {
    /// The homogeneous matrix with these coordinates.
    type Matrix;

    /// `[hat(ω) v; 0 0]`.
    fn matrix(&self) -> Self::Matrix;
}

impl<T: Real> Coordinates for SVector<T, 6> {
    type Matrix = Matrix4<T>;

    #[inline]
    fn matrix(&self) -> Matrix4<T> {
        let [[a, b, c, d, e, f]] = self.data.0;
        let turn = hat(&Vector3::new(a, b, c));
        let mut matrix = Matrix4::repeat(T::zero());
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&turn);
        matrix
            .fixed_view_mut::<3, 1>(0, 3)
            .copy_from(&Vector3::new(d, e, f));
        matrix
    }
}

impl<T: Real> Coordinates for SVector<T, 3> {
    type Matrix = Matrix3<T>;

    #[inline]
    fn matrix(&self) -> Matrix3<T> {
        let [[a, d, e]] = self.data.0;
        let o = T::zero();
        Matrix3::new(o, -a, d, a, o, e, o, o, o)
    }
}

/// The element `[hat(ω) v; 0 0]` of the Lie algebra with coordinates `(ω, v)`; in the plane, `hat(ω)` is
/// `ω` times the quarter turn.
#[inline]
#[must_use]
pub fn twist<C: Coordinates>(x: &C) -> C::Matrix {
    x.matrix()
}
