//! Rotations of space, stored as unit quaternions, and their momenta. Takes quaternions, matrices
//! or rotation vectors; gives rotations body -> space.

use super::{Coadjoint, Group, squares};
use crate::Real;
use crate::scalar::lane_view::{in_lanes, set_all};
use crate::scalar::{larger, largest, of_scalars};
use core::fmt;
use core::ops::Mul;
use nalgebra::{Matrix3, Vector3};

/// A rotation, by convention from body to space: `v_space = R v_body`.
///
/// Stored as a unit quaternion `(w, x, y, z)`, so it can never shear; `q` and `-q` are the same
/// rotation. Equality compares the four numbers.
///
/// The alignment keeps each half of the quaternion within one cache line, wherever the state of a stepper is stored.
/// The processor cannot forward a pair across two lines from the store of one step to the next load. A step of a free
/// body would then take half as long again.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct Rotation<T = f64> {
    q: [T; 4],
}

of_scalars!(Rotation { q });
in_lanes!(Rotation { q });

/// Whether all pairs are equal; compares all of them, because steppers call this at each step, and one branch is
/// cheaper than one branch per number.
#[inline(always)]
fn all_equal<T: PartialEq, const N: usize>(a: &[T; N], b: &[T; N]) -> bool {
    a.iter().zip(b).fold(true, |all, (x, y)| all & (x == y))
}

impl<T: PartialEq> PartialEq for Rotation<T> {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        all_equal(&self.q, &other.q)
    }
}

/// A matrix or quaternion that is not a rotation, with the number that shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum NotARotation {
    /// An entry is NaN or infinite.
    NotFinite,
    /// The largest entry of `A^T A - 1` (for a quaternion `| |q|^2 - 1 |`) is too large.
    NotOrthogonal {
        /// That entry, in absolute value.
        defect: f64,
    },
    /// The matrix is orthogonal, but its determinant is -1.
    Reflection,
}

impl fmt::Display for NotARotation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => write!(f, "not a rotation: an entry is NaN or infinite"),
            Self::NotOrthogonal { defect } => write!(
                f,
                "not a rotation: not orthogonal, off by {defect:.3e} (allowed: {ALLOWED_DEFECT:e})"
            ),
            Self::Reflection => write!(
                f,
                "not a rotation: the determinant is -1 (a reflection); flip one axis"
            ),
        }
    }
}

impl std::error::Error for NotARotation {}

/// Input data typed with ten digits are accepted and made orthonormal; larger defects are treated as mistakes.
const ALLOWED_DEFECT: f64 = 1e-9;

/// Hamilton's product, without any normalisation.
#[inline(always)]
pub(crate) fn hamilton<T: Real>([a, b, c, d]: [T; 4], [w, x, y, z]: [T; 4]) -> [T; 4] {
    [
        (a * w - b * x) - (c * y + d * z),
        (a * x + b * w) + (c * z - d * y),
        (a * y + c * w) + (d * x - b * z),
        (a * z + d * w) + (b * y - c * x),
    ]
}

#[inline(always)]
pub(super) fn norm_squared<T: Real>([w, x, y, z]: [T; 4]) -> T {
    (w * w + x * x) + (y * y + z * z)
}

/// The quaternion times a number.
#[inline(always)]
pub(super) fn times<T: Real>([w, x, y, z]: [T; 4], scale: T) -> [T; 4] {
    [w * scale, x * scale, y * scale, z * scale]
}

impl<T: Real> Rotation<T> {
    /// The identity rotation.
    #[inline]
    pub fn identity() -> Self {
        let o = T::zero();
        Self {
            q: [T::one(), o, o, o],
        }
    }

    /// Its Rodrigues vector, along the axis and as long as the tangent of half the angle: of a rotation
    /// `Q` with this vector `c`, `(1 + Q)^-1` is `(1 - hat(c))/2`.
    #[inline(always)]
    pub fn rodrigues(&self) -> Vector3<T> {
        let [w, x, y, z] = self.q;
        let scale = T::one() / w;
        Vector3::new(x * scale, y * scale, z * scale)
    }

    /// The rotation of the unit quaternion `(w, x, y, z)`.
    ///
    /// # Errors
    /// [`NotARotation`] when `|q|^2` differs from 1 by more than 1e-9 or is not finite; within
    /// that it is normalised.
    pub fn from_quaternion(q: [T; 4]) -> Result<Self, NotARotation> {
        let square = norm_squared(q);
        if !square.is_finite() {
            return Err(NotARotation::NotFinite);
        }
        let defect = largest_real_part(square - T::one());
        // Written so that NaN is rejected: products of finite entries may overflow.
        let near = defect <= ALLOWED_DEFECT;
        if !near {
            return Err(NotARotation::NotOrthogonal { defect });
        }
        Ok(Self::normalised(q))
    }

    /// The rotation of a matrix with orthonormal columns and determinant +1.
    ///
    /// # Errors
    /// [`NotARotation`] when an entry of `A^T A - 1` exceeds 1e-9, the determinant is negative or
    /// an entry is not finite; within that the matrix is replaced by a nearby rotation.
    pub fn from_matrix(a: &Matrix3<T>) -> Result<Self, NotARotation> {
        if !a.iter().all(|x| x.is_finite()) {
            return Err(NotARotation::NotFinite);
        }
        let gram = a.transpose() * *a - Matrix3::identity();
        let defect = largest(gram.iter().map(|x| largest_real_part(*x)));
        // Written so that NaN is rejected: products of finite entries may overflow.
        let near = defect <= ALLOWED_DEFECT;
        if !near {
            return Err(NotARotation::NotOrthogonal { defect });
        }
        if crate::linalg::determinant(a).least() < 0.0 {
            return Err(NotARotation::Reflection);
        }
        Ok(Self::normalised(quaternion_of(a)))
    }

    /// `q / |q|`, for any nonzero `q`.
    #[inline(always)]
    pub(crate) fn normalised(q: [T; 4]) -> Self {
        // Root and quotient run side by side; `1 / root` would wait for the root.
        let square = norm_squared(q);
        let root = square.sqrt();
        let scale = root * (T::one() / square);
        Self { q: times(q, scale) }
    }

    /// A quaternion that the caller knows to be unit.
    #[inline(always)]
    pub(crate) fn from_unit(q: [T; 4]) -> Self {
        Self { q }
    }

    /// Writes the rotation of one lane.
    #[inline(always)]
    pub(crate) fn set_one(&mut self, lane: usize, one: Rotation<T::One>) {
        set_all(&mut self.q, lane, one.q);
    }

    /// The product without renormalisation: each call may change `|q|` by one rounding, so renormalise from time to
    /// time if you multiply often.
    #[inline(always)]
    pub(crate) fn compose_raw(&self, other: &Self) -> Self {
        Self {
            q: hamilton(self.q, other.q),
        }
    }

    /// The quaternion times a number.
    #[inline(always)]
    pub(crate) fn scaled(&self, scale: T) -> Self {
        Self {
            q: times(self.q, scale),
        }
    }

    /// The factor that takes a nearly unit quaternion back to length 1: one Newton step for
    /// `1/|q|`, which needs neither division nor root.
    #[inline(always)]
    pub(crate) fn repair(&self) -> T {
        T::from_f64(1.5) - T::from_f64(0.5) * norm_squared(self.q)
    }

    /// This rotation, rescaled to `|q| = 1` up to rounding; `|q|` must already be close to 1.
    #[inline(always)]
    pub(crate) fn renormalised(&self) -> Self {
        let scale = self.repair();
        Self {
            q: times(self.q, scale),
        }
    }

    /// The unit quaternion `(w, x, y, z)`.
    #[inline(always)]
    pub fn quaternion(&self) -> [T; 4] {
        self.q
    }

    /// The 3x3 matrix, body -> space.
    #[inline(always)]
    pub fn matrix(&self) -> Matrix3<T> {
        let [w, x, y, z] = self.q;
        let one = T::one();
        let (x2, y2, z2) = (x + x, y + y, z + z);
        let (xx, yy, zz) = (x * x2, y * y2, z * z2);
        let (xy, xz, yz) = (x * y2, x * z2, y * z2);
        let (wx, wy, wz) = (w * x2, w * y2, w * z2);
        #[rustfmt::skip]
        let matrix = Matrix3::new(
            one - (yy + zz), xy - wz, xz + wy,
            xy + wz, one - (xx + zz), yz - wx,
            xz - wy, yz + wx, one - (xx + yy),
        );
        matrix
    }

    /// `R v`: a body vector in the space frame.
    #[inline(always)]
    pub fn rotate(&self, v: &Vector3<T>) -> Vector3<T> {
        let [w, x, y, z] = self.q;
        turn(w, [x, y, z], v)
    }

    /// `R^T v`: a spatial vector in the body frame.
    #[inline(always)]
    pub fn inverse_rotate(&self, v: &Vector3<T>) -> Vector3<T> {
        let [w, x, y, z] = self.q;
        turn(w, [-x, -y, -z], v)
    }

    /// The inverse rotation, space -> body.
    #[inline]
    pub fn inverse(&self) -> Self {
        let [w, x, y, z] = self.q;
        Self { q: [w, -x, -y, -z] }
    }

    /// The rotation about `v` by the angle `|v|` radians: the exponential of `hat(v)`.
    ///
    /// Small angles use the Taylor series, so that derivative parts are also right at `v = 0`.
    pub fn exp(v: &Vector3<T>) -> Self {
        let quarter = T::from_f64(0.25);
        // Half the angle, squared.
        let square = v.dot(v) * quarter;
        let (cosine, sinc) = if square.is_below(1e-2) {
            half_angle_series(square)
        } else if square.exceeds(T::zero()) {
            let half = square.sqrt();
            (half.cos(), half.sin() / half)
        } else {
            // If some lanes are at rest, add less than rounding, so that the square root has a derivative.
            let lift = T::from_f64(T::EPSILON * T::EPSILON);
            let half = (square + lift).sqrt();
            (half.cos(), half.sin() / half)
        };
        let scale = sinc * T::from_f64(0.5);
        let [[x, y, z]] = v.data.0;
        Self::normalised([cosine, x * scale, y * scale, z * scale])
    }
}

/// `v + 2 w (p x v) + 2 p x (p x v)`.
#[inline(always)]
fn turn<T: Real>(w: T, [x, y, z]: [T; 3], v: &Vector3<T>) -> Vector3<T> {
    let [[a, b, c]] = v.data.0;
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (s, t, u) = (y2 * c - z2 * b, z2 * a - x2 * c, x2 * b - y2 * a);
    Vector3::new(
        (a + w * s) + (y * u - z * t),
        (b + w * t) + (z * s - x * u),
        (c + w * u) + (x * t - y * s),
    )
}

/// `cos` and `sin(x)/x` as series in the square of the half angle, which is below 1e-2.
fn half_angle_series<T: Real>(square: T) -> (T, T) {
    let (mut cosine, mut sinc) = (T::one(), T::one());
    let (mut even, mut odd) = (T::one(), T::one());
    // 1e-2^12 / 24! is below 1e-47: enough for double-double.
    for k in 1..=12_i64 {
        even = -even * square * T::from_ratio(1, 2 * k * (2 * k - 1));
        odd = -odd * square * T::from_ratio(1, 2 * k * (2 * k + 1));
        cosine += even;
        sinc += odd;
    }
    (cosine, sinc)
}

/// The largest absolute real part of all lanes.
fn largest_real_part<T: Real>(x: T) -> f64 {
    larger(x.greatest().abs(), x.least().abs())
}

/// A quaternion, not normalised, of an orthogonal matrix (Shepperd, 1978): the columns of `4 q q^T` are linear in the
/// matrix, and each lane takes its longest column.
fn quaternion_of<T: Real>(a: &Matrix3<T>) -> [T; 4] {
    let [[a11, a21, a31], [a12, a22, a32], [a13, a23, a33]] = a.data.0;
    let one = T::one();
    let (ww, xx) = (one + a11 + a22 + a33, one + a11 - a22 - a33);
    let (yy, zz) = (one - a11 + a22 - a33, one - a11 - a22 + a33);
    let (wx, wy, wz) = (a32 - a23, a13 - a31, a21 - a12);
    let (xy, xz, yz) = (a12 + a21, a13 + a31, a23 + a32);
    let (mut longest, mut chosen) = (ww, [ww, wx, wy, wz]);
    for (square, column) in [
        (xx, [wx, xx, xy, xz]),
        (yy, [wy, xy, yy, yz]),
        (zz, [wz, xz, yz, zz]),
    ] {
        // A choice lane by lane: the mask is exactly 0 or 1, without derivatives.
        let mask = (square - longest).where_positive(one);
        let blend = |new: T, old: T| mask * new + (one - mask) * old;
        longest = blend(square, longest);
        for (old, new) in chosen.iter_mut().zip(column) {
            *old = blend(new, *old);
        }
    }
    chosen
}

impl<T: Real> Mul for Rotation<T> {
    type Output = Self;

    /// The composition: `(a * b).rotate(v) = a.rotate(b.rotate(v))`. The result is unit to
    /// rounding however long the chain of products.
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // The first-order correction of both norms, which need not wait for the product.
        let excess = norm_squared(self.q) + norm_squared(other.q);
        let scale = T::from_f64(2.0) - T::from_f64(0.5) * excess;
        Self {
            q: times(hamilton(self.q, other.q), scale),
        }
    }
}

/// `product(1 + xi/2)`, normalised; `product` multiplies by a unit quaternion.
#[inline(always)]
fn turned_by<T: Real>(xi: &[T], product: impl Fn([T; 4]) -> [T; 4]) -> Rotation<T> {
    let half = T::from_f64(0.5);
    let at = |i: usize| xi.get(i).map_or_else(T::zero, |x| *x * half);
    let [x, y, z] = [at(0), at(1), at(2)];
    let turned = product([T::one(), x, y, z]);
    // (1 + e)^(-1/2) is 1 - e/2 up to 3 e^2/8: for small corrections, root and quotient are
    // not waited for. The element itself is unit.
    let excess = x * x + y * y + z * z;
    if T::order() == 0 && (excess * excess).is_below(T::EPSILON) {
        let scale = T::one() - excess * half;
        return Rotation {
            q: times(turned, scale),
        };
    }
    Rotation::normalised(turned)
}

impl<T: Real> Group<T> for Rotation<T> {
    const DIMENSION: usize = 3;

    super::own_operations!();

    /// `self . cay(hat(xi))`, the Cayley map `(1 - hat(xi)/2)^-1 (1 + hat(xi)/2)`: it agrees with
    /// the exponential to second order and needs no trigonometry.
    #[inline(always)]
    fn retract(&self, xi: &[T]) -> Self {
        turned_by(xi, |cayley| hamilton(self.q, cayley))
    }

    /// `cay(hat(xi)) . self`.
    #[inline(always)]
    fn retract_from_left(&self, xi: &[T]) -> Self {
        turned_by(xi, |cayley| hamilton(cayley, self.q))
    }

    /// The weighted sum of the quaternions, normalised.
    #[inline(always)]
    fn combined(weights: &[f64], element: impl Fn(usize) -> Self) -> Self {
        let mut q = [T::zero(); 4];
        // Adds the first element last, because it was computed last.
        for (i, weight) in weights.iter().enumerate().rev() {
            let weight = T::from_f64(*weight);
            for (sum, x) in q.iter_mut().zip(element(i).q) {
                *sum += x * weight;
            }
        }
        // (1 + e)^(-1/2) to second order, as in `turned_by`.
        let half = T::from_f64(0.5);
        let excess = norm_squared(q) - T::one();
        let largest = largest_real_part(excess);
        if T::order() == 0 && largest * largest * largest < T::EPSILON {
            let scale = T::one() - half * excess + T::from_f64(0.375) * (excess * excess);
            return Self { q: times(q, scale) };
        }
        Self::normalised(q)
    }

    #[inline]
    fn distance_from_group(&self) -> f64 {
        (norm_squared(self.q) - T::one()).magnitude()
    }

    #[inline(always)]
    fn compared(&self, xi: &[T], out: &mut [[T; 2]]) {
        let [w, x, y, z] = self.q;
        let over = T::from_f64(2.0) / w;
        let own = Vector3::new(x * over, y * over, z * over);
        if let Some(first) = out.first_mut() {
            *first = squares(&own, xi);
        }
    }

    #[inline(always)]
    fn is_within(&self, reach: &[f64]) -> bool {
        let [w, x, y, z] = self.q;
        let reach = reach.first().copied().unwrap_or(0.0);
        let quarter = T::from_f64(0.25 * reach * reach);
        (x * x + y * y + z * z - quarter * (w * w)).nowhere_positive()
    }
}

impl<T: Real> Coadjoint<T> for Rotation<T> {
    type Covector = Vector3<T>;

    /// `R mu`.
    #[inline]
    fn covector_to_space(&self, body: &Vector3<T>) -> Vector3<T> {
        self.rotate(body)
    }

    /// `R^T m`.
    #[inline]
    fn covector_to_body(&self, spatial: &Vector3<T>) -> Vector3<T> {
        self.inverse_rotate(spatial)
    }
}

/// Angular momentum in body axes, at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMomentum<T = f64>(pub Vector3<T>);

/// Angular momentum in spatial axes, at a node; free motion conserves it.
#[derive(Clone, Copy, Debug)]
pub struct SpatialMomentum<T = f64>(pub Vector3<T>);

of_scalars!(BodyMomentum { 0 });
of_scalars!(SpatialMomentum { 0 });
in_lanes!(SpatialMomentum { 0 });

impl<T: PartialEq> PartialEq for SpatialMomentum<T> {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        let ([a], [b]) = (&self.0.data.0, &other.0.data.0);
        all_equal(a, b)
    }
}

impl<T: Real> BodyMomentum<T> {
    /// `m = R mu`, for a rotation or a unit quaternion.
    #[inline]
    pub fn to_space<G>(&self, attitude: &G) -> SpatialMomentum<T>
    where
        G: Coadjoint<T, Covector = Vector3<T>>,
    {
        SpatialMomentum(attitude.covector_to_space(&self.0))
    }
}

impl<T: Real> SpatialMomentum<T> {
    /// Writes the momentum of one lane.
    #[inline(always)]
    pub(crate) fn set_one(&mut self, lane: usize, one: SpatialMomentum<T::One>) {
        let ([all], [ones]) = (&mut self.0.data.0, one.0.data.0);
        set_all(all, lane, ones);
    }

    /// `mu = R^T m`, for a rotation or a unit quaternion.
    #[inline]
    pub fn to_body<G>(&self, attitude: &G) -> BodyMomentum<T>
    where
        G: Coadjoint<T, Covector = Vector3<T>>,
    {
        BodyMomentum(attitude.covector_to_body(&self.0))
    }
}
