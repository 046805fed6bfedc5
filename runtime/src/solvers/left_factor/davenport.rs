//! Solves the equation on SO(3) for any left factor, by a 4 x 4 eigenvalue problem for the quaternion. Takes `C` and
//! the vector `v` of `hat(v) = h hat(N)`; gives the principal rotation.
//!
//! The problem is `(K(C) + L(v)) q = k q`, with Davenport's matrix `K` of attitude determination and a skew matrix `L`.
//! `k = tr(Omega C^T)` is the largest real eigenvalue. Newton's method for the quartic descends to it from above, as in
//! QUEST (Shuster and Oh, J. Guidance and Control 4, 1981). A column of the adjugate is an eigenvector, and Newton's
//! method on the group removes the remaining rounding error. `C` needs no preparation, so it may change from step to
//! step.

use super::reach::{farthest_of, fastest_of};
use super::{LeftFactor, Refusal, Unsolved};
use crate::linalg::{axial_of_difference, solve};
use crate::solvers::Method;
use crate::{Group, Real, Rotation};
use nalgebra::{Matrix3, Matrix4, SMatrix, Vector3, Vector4};

/// The largest number of Newton steps for the eigenvalue. From the bound of the norm, about eight suffice.
const STEPS: usize = 60;

/// The largest number of steps on the group. One or two suffice, except near the bound, where the eigenvalue is double.
const POLISHING: usize = 40;

/// A residual counts as zero below this many roundings of the factor.
const CONVERGED_ROUNDINGS: f64 = 8.0;

/// If the residual stops decreasing below this many roundings, the cause is rounding.
const STAGNATED_ROUNDINGS: f64 = 100.0;

/// The principal solution `Omega` of `Omega C^T - C Omega^T = hat(v)`.
///
/// # Errors
/// [`Unsolved`] if some lane is beyond the bound of the principal solution, with the exact bound ratio.
#[inline]
pub fn davenport<T: Real>(c: &Matrix3<T>, v: &Vector3<T>) -> Result<Rotation<T>, Unsolved> {
    let start = match eigenvector(c, v) {
        Some(q) => q,
        None => return Err(refuse(c, v, f64::NAN)),
    };
    let size = c
        .iter()
        .chain(v.iter())
        .fold(0.0, |m: f64, x| m.max(x.magnitude()));
    let unit = T::EPSILON * 2.0 * size;
    let mut omega = start;
    let mut previous = f64::INFINITY;
    let mut rest = T::order();
    for _ in 0..POLISHING {
        let a = omega.matrix() * c.transpose();
        let f = axial_of_difference(&a) - v;
        let residual = f.iter().fold(0.0, |m: f64, x| {
            let size = x.greatest().max(-x.least());
            if size.is_nan() { f64::NAN } else { m.max(size) }
        });
        let done = residual <= CONVERGED_ROUNDINGS * unit
            || (residual <= STAGNATED_ROUNDINGS * unit && residual >= 0.5 * previous);
        if done && rest == 0 {
            return Ok(omega);
        }
        if done {
            rest -= 1;
        }
        // hat(x) A + A^T hat(x) = hat((tr A - A) x).
        let tangent = Matrix3::from_diagonal_element(a.trace()) - a;
        let Some(x) = solve(&tangent, &-f) else {
            return Err(refuse(c, v, residual));
        };
        omega = Rotation::identity().retract(x.as_slice()) * omega;
        previous = residual;
        if residual.is_nan() {
            break;
        }
    }
    Err(refuse(c, v, previous))
}

/// Like [`davenport`], with the solver `method`. All other solvers prepare the factor in each call.
///
/// # Errors
/// [`Unsolved`]; for other solvers also if the matrix is not a left factor.
#[inline]
pub fn rotation_at<T: Real>(
    c: &Matrix3<T>,
    v: &Vector3<T>,
    method: Method,
) -> Result<Rotation<T>, Unsolved> {
    if method == Method::Davenport {
        return davenport(c, v);
    }
    match LeftFactor::new(*c) {
        Ok(factor) => factor.rotation(v, method),
        Err(_) => Err(Unsolved {
            method,
            refusal: Refusal::DoesNotApply,
            ..refuse(c, v, f64::NAN)
        }),
    }
}

/// The rotation of the eigenvector of the largest real eigenvalue.
#[inline]
fn eigenvector<T: Real>(c: &Matrix3<T>, v: &Vector3<T>) -> Option<Rotation<T>> {
    let z = axial_of_difference(c);
    let symmetric = c + c.transpose();
    let trace = c.trace();
    let lower = symmetric - Matrix3::from_diagonal_element(trace) + crate::linalg::hat(v);
    let n = Matrix4::from_fn(|i, j| match (i, j) {
        (0, 0) => trace,
        (0, j) => z[j - 1] - v[j - 1],
        (i, 0) => z[i - 1] + v[i - 1],
        (i, j) => lower[(i - 1, j - 1)],
    });
    // Computes the characteristic polynomial and the adjugate together (Faddeev); the trace of n is zero.
    let one = Matrix4::<T>::identity();
    let c2 = -(n * n).trace() * T::from_f64(0.5);
    let b3 = n * n + one * c2;
    let c1 = -(n * b3).trace() / T::from_f64(3.0);
    let b4 = n * b3 + one * c1;
    let c0 = -(n * b4).trace() * T::from_f64(0.25);
    // tr(Omega C^T) is at most the sum of the singular values.
    let square = c.iter().fold(T::zero(), |s, x| s + *x * *x);
    let mut k = (square * T::from_f64(3.0)).sqrt();
    for _ in 0..STEPS {
        let kk = k * k;
        let value = (kk + c2) * kk + c1 * k + c0;
        let slope = (T::from_f64(4.0) * kk + c2 + c2) * k + c1;
        let falls = slope.least();
        if falls <= 0.0 || falls.is_nan() {
            // The derivative vanishes before the polynomial, so a real eigenvalue is missing or double.
            break;
        }
        let step = value / slope;
        k -= step;
        let (size, moved) = (k.magnitude(), step.greatest().max(-step.least()));
        if moved.is_nan() {
            return None;
        }
        if moved <= 8.0 * T::EPSILON * size {
            break;
        }
    }
    let adjugate = ((one * k + n) * k + b3) * k + b4;
    // Selects the longest column in each lane; all columns are multiples of the eigenvector.
    let length = |x: &Vector4<T>| x.dot(x);
    let mut best: Vector4<T> = adjugate.column(0).into_owned();
    for j in 1..4 {
        let other: Vector4<T> = adjugate.column(j).into_owned();
        let mask = (length(&other) - length(&best)).where_positive(T::one());
        best += (other - best) * mask;
    }
    let root = length(&best).sqrt();
    let q = best * (T::one() / root);
    q.iter().all(|x| x.is_finite()).then(|| {
        let [[w, x, y, z]] = q.data.0;
        Rotation::normalised([w, x, y, z])
    })
}

#[cold]
#[inline(never)]
fn refuse<T: Real>(c: &Matrix3<T>, v: &Vector3<T>, residual: f64) -> Unsolved {
    let hat: SMatrix<T, 3, 3> = crate::linalg::hat(v);
    let (ratio, lane) = farthest_of(c, &hat);
    let refusal = if !v.iter().all(|x| x.is_finite()) {
        Refusal::NotFinite
    } else if ratio <= 1.0 {
        Refusal::NotConverged
    } else {
        Refusal::BeyondBound
    };
    Unsolved {
        method: Method::Davenport,
        refusal,
        ratio,
        fastest: fastest_of(c, &hat, lane),
        lane: u8::try_from(lane).unwrap_or(u8::MAX),
        residual,
        h: None,
        largest_step: None,
    }
}
