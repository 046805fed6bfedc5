//! The linear part of the solution: from `kappa` and `u` to the quaternion of `Omega`.
//! Takes `(d - hat u) c = u` with `d = I - kappa`; gives `(det, n)` with `c = n / det`.

use super::Poinsot;
use crate::Real;

/// Vectors of the solver are plain arrays: three numbers in registers.
#[inline(always)]
pub(super) fn dot<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3]) -> T {
    (a * x + b * y) + c * z
}

#[inline(always)]
pub(super) fn cross<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3]) -> [T; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// `(I v) x v`, in units of the body. For a diagonal tensor it is a product of differences of
/// moments, which does not cancel when they are nearly equal.
#[inline(always)]
pub(super) fn gyroscopic<T: Real, const DIAGONAL: bool>(body: &Poinsot<T>, v: [T; 3]) -> [T; 3] {
    if DIAGONAL {
        let ([p, q, r], [x, y, z]) = (body.differences, v);
        [(p * y) * z, (q * z) * x, (r * x) * y]
    } else {
        cross(body.inertia_times::<DIAGONAL>(v), v)
    }
}

/// What the linear solve needs of the body, `kappa` and `a = |u|^2`; constant in free motion.
///
/// `adj(d - hat u) u = (adj d + a) u + (d u) x u`, `det(d - hat u) = det d + u . d u`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pencil<T> {
    /// Diagonal entries of `d`.
    d_moments: [T; 3],
    /// Diagonal entries of `adj d + a`.
    adjugate_moments: [T; 3],
    /// Entries (2,3), (3,1), (1,2) of `adj d`.
    adjugate_products: [T; 3],
    /// `det d`.
    determinant: T,
}

impl<T: Real> Pencil<T> {
    #[inline(always)]
    pub(super) fn new<const DIAGONAL: bool>(body: &Poinsot<T>, kappa: T, a: T) -> Self {
        let [x, y, z] = body.moments.map(|moment| moment - kappa);
        let (yz, zx, xy) = (y * z, z * x, x * y);
        if DIAGONAL {
            return Self {
                d_moments: [x, y, z],
                adjugate_moments: [yz + a, zx + a, xy + a],
                adjugate_products: [T::zero(); 3],
                determinant: x * yz,
            };
        }
        let [f, g, h] = body.products;
        let (p, q, r) = (yz - f * f, zx - g * g, xy - h * h);
        let (s, t) = (g * f - z * h, h * f - y * g);
        Self {
            d_moments: [x, y, z],
            adjugate_moments: [p + a, q + a, r + a],
            adjugate_products: [h * g - x * f, t, s],
            determinant: (x * p + h * s) + g * t,
        }
    }

    /// `det` and `n`; the quaternion of `Omega` is `(det, n)` over its length.
    #[inline(always)]
    pub(super) fn solve<const DIAGONAL: bool>(&self, body: &Poinsot<T>, u: [T; 3]) -> (T, [T; 3]) {
        let gyro = gyroscopic::<T, DIAGONAL>(body, u);
        let ([x, y, z], [dx, dy, dz]) = (u, self.d_moments);
        let [p, q, r] = self.adjugate_moments;
        if DIAGONAL {
            let det = (self.determinant + dx * (x * x)) + (dy * (y * y) + dz * (z * z));
            return (det, [p * x + gyro[0], q * y + gyro[1], r * z + gyro[2]]);
        }
        let ([f, g, h], [s, t, v]) = (body.products, self.adjugate_products);
        let du = [
            (dx * x + h * y) + g * z,
            (h * x + dy * y) + f * z,
            (g * x + f * y) + dz * z,
        ];
        let n = [
            (p * x + v * y) + (t * z + gyro[0]),
            (v * x + q * y) + (s * z + gyro[1]),
            (t * x + s * y) + (r * z + gyro[2]),
        ];
        (self.determinant + dot(u, du), n)
    }
}
