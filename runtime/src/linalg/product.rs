//! Products of small square matrices, and one Newton step towards an orthogonal one. Takes matrices whose size is
//! known at compile time; gives matrices. Loops run along columns, so that they vectorise.

use crate::Real;
use nalgebra::{ArrayStorage, SMatrix};

/// The product, column by column: short loops whose length is known at compile time.
#[inline(always)]
pub fn product<T: Real, const N: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, N>,
) -> SMatrix<T, N, N> {
    let (a, b) = (&a.data.0, &b.data.0);
    let mut c = [[T::zero(); N]; N];
    for (c, b) in c.iter_mut().zip(b) {
        for (a, x) in a.iter().zip(b) {
            for (c, a) in c.iter_mut().zip(a) {
                *c += *a * *x;
            }
        }
    }
    SMatrix::from_data(ArrayStorage(c))
}

/// One Newton step towards the nearest orthogonal matrix, `A (3 - A^T A)/2`: it squares the defect.
#[inline]
pub fn orthonormalised<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let excess = product(&a.transpose(), a) - SMatrix::identity();
    a - product(a, &excess) * T::from_f64(0.5)
}
