//! Momenta of matrix groups, by frame. Takes and gives covectors of the Lie algebra as matrices: skew for SO(n), any
//! for GL(n).

use super::Coadjoint;
use crate::Real;
use crate::scalar::of_scalars;
use nalgebra::SMatrix;

/// A node momentum in the body frame, an n x n matrix: it pairs with a body velocity `X` as `tr(M^T X)/2` for SO(n),
/// where it is skew, and as `tr(M^T X)` for GL(n).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMomentumMatrix<const N: usize, T = f64>(pub SMatrix<T, N, N>);

/// A node momentum in the space frame, an n x n matrix paired like [`BodyMomentumMatrix`]; free motion conserves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpatialMomentumMatrix<const N: usize, T = f64>(pub SMatrix<T, N, N>);

of_scalars!(BodyMomentumMatrix<N> { 0 });
of_scalars!(SpatialMomentumMatrix<N> { 0 });

impl<const N: usize, T: Real> BodyMomentumMatrix<N, T> {
    /// This momentum in the space frame.
    #[inline]
    pub fn to_space<G: Coadjoint<T, Covector = SMatrix<T, N, N>>>(
        &self,
        element: &G,
    ) -> SpatialMomentumMatrix<N, T> {
        SpatialMomentumMatrix(element.covector_to_space(&self.0))
    }
}

impl<const N: usize, T: Real> SpatialMomentumMatrix<N, T> {
    /// This momentum in the body frame.
    #[inline]
    pub fn to_body<G: Coadjoint<T, Covector = SMatrix<T, N, N>>>(
        &self,
        element: &G,
    ) -> BodyMomentumMatrix<N, T> {
        BodyMomentumMatrix(element.covector_to_body(&self.0))
    }
}
