//! The linear part of the solution: from `kappa` and `u` to the quaternion of `Omega`.
//! Takes `(d - hat u) c = u` with `d = I - kappa`; gives `(det, n)` with `c = n / det`.

use super::Poinsot;
use crate::Real;

/// Vectors of the solver are plain arrays: three numbers in registers.
#[inline(always)]
pub(in crate::solvers) fn dot<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3]) -> T {
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

/// The data of the linear solve, from the body, `kappa` and `a = |u|^2`; constant in free motion.
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

crate::saved!([] Pencil { d_moments, adjugate_moments, adjugate_products, determinant });

impl<T: Real> Pencil<T> {
    pub(super) fn new(body: &Poinsot<T>, kappa: T, a: T) -> Self {
        let [x, y, z] = body.moments.map(|moment| moment - kappa);
        let [f, g, h] = body.products;
        let (p, q, r) = (y * z - f * f, z * x - g * g, x * y - h * h);
        let (s, t) = (g * f - z * h, h * f - y * g);
        Self {
            d_moments: [x, y, z],
            adjugate_moments: [p + a, q + a, r + a],
            adjugate_products: [h * g - x * f, t, s],
            determinant: (x * p + h * s) + g * t,
        }
    }

    /// Diagonal entries of `d`.
    pub(super) fn d_moments(&self) -> [T; 3] {
        self.d_moments
    }

    /// `det` and `n`; the quaternion of `Omega` is `(det, n)` over its length.
    #[inline(always)]
    pub(super) fn solve(&self, body: &Poinsot<T>, u: [T; 3]) -> (T, [T; 3]) {
        let gyro = gyroscopic::<T, false>(body, u);
        let ([x, y, z], [dx, dy, dz]) = (u, self.d_moments);
        let ([f, g, h], [s, t, v]) = (body.products, self.adjugate_products);
        let du = [
            (dx * x + h * y) + g * z,
            (h * x + dy * y) + f * z,
            (g * x + f * y) + dz * z,
        ];
        let [p, q, r] = self.adjugate_moments;
        let n = [
            (p * x + v * y) + (t * z + gyro[0]),
            (v * x + q * y) + (s * z + gyro[1]),
            (t * x + s * y) + (r * z + gyro[2]),
        ];
        (self.determinant + dot(u, du), n)
    }
}

/// Like `Pencil`, for one free trajectory in principal axes with the middle moment second.
///
/// Along it `|u|^2` and `u . adj(I) u` are constant, so `u_1^2` and `u_3^2`, and therefore the determinant, are linear
/// in `u_2^2`. Since the second moment is the middle one, both linear functions decrease, with slopes of at most 1, and
/// rounding is not amplified.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Orbit<T> {
    /// Diagonal entries of `adj d + a`.
    adjugate: [T; 3],
    /// `det(d - hat u)`: the constant, and the factor of `u_2^2`.
    determinant: [T; 2],
    /// Twice the differences of the moments.
    doubled: [T; 3],
}

crate::saved!([] Orbit { adjugate, determinant, doubled });

impl<T: Real> Orbit<T> {
    /// The trajectory through `u`.
    pub(super) fn new(body: &Poinsot<T>, pencil: &Pencil<T>, u: [T; 3]) -> Self {
        let ([i, j, k], [p, q, r]) = (body.moments, body.differences);
        let one = T::one();
        // Three equal moments: every component is constant.
        let differ = (q * q).where_positive(one);
        let per_spread = differ / (j * (differ * q + (one - differ)));
        let slopes = [i * p * per_spread, one, k * r * per_spread];
        let factor = dot(pencil.d_moments, slopes);
        let now = pencil.determinant + dot(pencil.d_moments, u.map(|x| x * x));
        Self {
            adjugate: pencil.adjugate_moments,
            determinant: [now - factor * (u[1] * u[1]), factor],
            doubled: body.differences.map(|x| x + x),
        }
    }

    /// Diagonal entries of `adj d + a`.
    pub(super) fn adjugate(&self) -> [T; 3] {
        self.adjugate
    }

    /// `det(d - hat u)`: the constant, and the factor of `u_2^2`.
    pub(super) fn determinant(&self) -> [T; 2] {
        self.determinant
    }

    /// See [`Pencil::solve`].
    #[inline(always)]
    pub(super) fn solve(&self, body: &Poinsot<T>, u: [T; 3]) -> (T, [T; 3]) {
        let ([x, y, z], [p, q, r]) = (u, self.adjugate);
        let ([a, b, c], [constant, factor]) = (body.differences, self.determinant);
        let det = constant + factor * (y * y);
        let n = [
            p * x + a * (y * z),
            q * y + b * (z * x),
            r * z + c * (x * y),
        ];
        (det, n)
    }

    /// Twice `(I n) x n`.
    #[inline(always)]
    pub(super) fn push(&self, [x, y, z]: [T; 3]) -> [T; 3] {
        let [p, q, r] = self.doubled;
        [p * (y * z), q * (z * x), r * (x * y)]
    }
}

/// `det^2 + |n|^2`.
#[inline(always)]
pub(super) fn square_sum<T: Real>(det: T, [x, y, z]: [T; 3]) -> T {
    (x * x + y * y) + (z * z + det * det)
}
