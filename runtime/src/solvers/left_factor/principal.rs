//! Tests whether a solution is the principal one: the spectrum of `A = Omega C^T` must be in the right half plane.
//! Takes `A`; gives a single answer for all lanes.

use crate::Real;
use crate::linalg::inverse;
use nalgebra::SMatrix;

/// The largest number of steps of the matrix sign iteration. With scaling, twenty suffice for a spectrum 1e-6 off the
/// axis.
const STEPS: usize = 40;

/// The rounding tolerance for eigenvalues left of the axis, relative to the size of the matrix.
const SHIFT: f64 = 1e-10;

/// Whether every eigenvalue has a positive real part, in every lane.
#[inline]
pub(super) fn is_principal<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> bool {
    // A positive definite symmetric part suffices. This is the common case, up to some tenths of the bound.
    has_positive_symmetric_part(a) || (0..T::LANES).all(|lane| has_positive_spectrum(a, lane))
}

/// Eliminates without row exchanges. All pivots of a symmetric matrix are positive if and only if it is positive
/// definite.
#[inline]
fn has_positive_symmetric_part<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> bool {
    let mut s = a + a.transpose();
    for k in 0..N {
        let pivot = s[(k, k)];
        let smallest = pivot.least();
        if smallest <= 0.0 || smallest.is_nan() {
            return false;
        }
        let reciprocal = T::one() / pivot;
        for j in k + 1..N {
            let factor = s[(j, k)] * reciprocal;
            for i in j..N {
                let entry = s[(i, k)];
                s[(i, j)] -= entry * factor;
            }
        }
    }
    true
}

/// `sign(A)` is the identity if and only if the spectrum is in the right half plane. Its trace is the number of
/// eigenvalues in the right half plane minus the number of others (Roberts, Int. J. Control 32, 1980).
#[cold]
#[inline(never)]
fn has_positive_spectrum<T: Real, const N: usize>(a: &SMatrix<T, N, N>, lane: usize) -> bool {
    let mut z = a.map(|x| x.lane(lane));
    // The zero eigenvalue of a flat body counts as positive.
    z += SMatrix::identity() * (SHIFT * z.norm());
    for _ in 0..STEPS {
        let Some(back) = inverse(&z) else {
            return false;
        };
        let scale = (back.norm() / z.norm()).sqrt();
        let next = (z * scale + back / scale) * 0.5;
        let change = (next - z).norm();
        z = next;
        if change <= 1e-9 * z.norm() {
            break;
        }
    }
    // If all eigenvalues are in the right half plane, the trace is N; otherwise it is at most N - 2.
    z.trace() > N as f64 - 1.0
}
