//! The isomorphism between vectors and skew matrices of so(3), and coordinates of so(n).
//! Takes a vector or a 3x3 matrix; gives the other, with `hat(v) w = v x w`.

use crate::Real;
use nalgebra::{Matrix3, SMatrix, Vector3};

/// The skew matrix of its coordinates: for `i < j`, row by row, `-x` at (i, j) and `+x` at (j, i).
/// Missing coordinates count as zero, surplus ones are ignored.
#[inline]
pub fn skew_from<T: Real, const N: usize>(coordinates: &[T]) -> SMatrix<T, N, N> {
    let mut skew = SMatrix::zeros();
    let mut rest = coordinates.iter();
    for i in 0..N {
        for j in i + 1..N {
            if let Some(x) = rest.next() {
                skew[(i, j)] = -*x;
                skew[(j, i)] = *x;
            }
        }
    }
    skew
}

/// The coordinates of a skew matrix, in the order of [`skew_from`], `N (N - 1)/2` of them.
#[inline]
pub fn skew_coordinates<T: Real, const N: usize>(
    skew: &SMatrix<T, N, N>,
) -> impl Iterator<Item = T> {
    (0..N).flat_map(move |i| (i + 1..N).map(move |j| skew[(j, i)]))
}

/// The skew matrix of the cross product: `hat(v) w = v x w`.
#[inline]
pub fn hat<T: Real>(v: &Vector3<T>) -> Matrix3<T> {
    let o = T::zero();
    let [[x, y, z]] = v.data.0;
    #[rustfmt::skip]
    let matrix = Matrix3::new(
        o, -z, y,
        z, o, -x,
        -y, x, o,
    );
    matrix
}

/// The axial vector of the skew part `(a - a^T)/2`: `vee(hat(v)) = v`.
#[inline]
pub fn vee<T: Real>(a: &Matrix3<T>) -> Vector3<T> {
    let half = T::from_f64(0.5);
    axial_of_difference(a).map(|x| x * half)
}

/// The axial vector of `a - a^T`, that is `2 vee(a)`: no halving, as momenta need it.
#[inline]
pub fn axial_of_difference<T: Real>(a: &Matrix3<T>) -> Vector3<T> {
    let [[_, a21, a31], [a12, _, a32], [a13, a23, _]] = a.data.0;
    Vector3::new(a32 - a23, a13 - a31, a21 - a12)
}

/// `hat(v) A`: the columns of `A` turned by `v x`.
#[inline(always)]
#[must_use]
pub fn crossed<T: Real>(v: &Vector3<T>, a: &Matrix3<T>) -> Matrix3<T> {
    let [x, y, z] = [v.x, v.y, v.z];
    Matrix3::from_fn(|i, j| {
        let [a, b, c] = [a[(0, j)], a[(1, j)], a[(2, j)]];
        match i {
            0 => y * c - z * b,
            1 => z * a - x * c,
            _ => x * b - y * a,
        }
    })
}

/// `A hat(v)`: the rows of `A` turned by `. x v`.
#[inline(always)]
#[must_use]
pub fn crossing<T: Real>(a: &Matrix3<T>, v: &Vector3<T>) -> Matrix3<T> {
    let [x, y, z] = [v.x, v.y, v.z];
    Matrix3::from_fn(|i, j| {
        let [a, b, c] = [a[(i, 0)], a[(i, 1)], a[(i, 2)]];
        match j {
            0 => b * z - c * y,
            1 => c * x - a * z,
            _ => a * y - b * x,
        }
    })
}

/// `tr(A) Id - A`: of a Poinsot matrix the moment of inertia.
#[inline(always)]
#[must_use]
pub fn trace_complement<T: Real>(a: &Matrix3<T>) -> Matrix3<T> {
    let [d, e, f] = [a.m11, a.m22, a.m33];
    #[rustfmt::skip]
    let complement = Matrix3::new(
        e + f, -a.m12, -a.m13,
        -a.m21, d + f, -a.m23,
        -a.m31, -a.m32, d + e,
    );
    complement
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hat_is_the_cross_product_and_vee_its_inverse() {
        let v = Vector3::new(0.3, -1.7, 2.9);
        let w = Vector3::new(-0.4, 0.6, 1.1);
        assert_eq!(hat(&v) * w, v.cross(&w));
        assert_eq!(vee(&hat(&v)), v);
        assert_eq!(axial_of_difference(&hat(&v)), v * 2.0);
    }
}
