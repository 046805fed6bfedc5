//! Principal frames of symmetric matrices of any size and scalar, for preparation only.
//! Takes the matrix; gives an orthogonal matrix that makes it diagonal to rounding.

use crate::Real;
use nalgebra::SMatrix;

/// Jacobi's method squares the off-diagonal entries in each sweep once they are small: seven sweeps reach double
/// precision for eight rows, nine reach double-double.
const SWEEPS: usize = 12;

/// 1 in the lanes where `x` is positive, 0 in the others.
fn positive<T: Real>(x: T) -> T {
    x.where_positive(T::one())
}

/// The frame `U` of a symmetric `A`: `U^T A U` is diagonal to rounding, lane by lane, by cyclic Jacobi rotations.
/// Only the upper triangle counts. The derivative parts are not the derivatives of the eigenvectors, so the caller's
/// result must not depend on the choice of frame.
pub fn principal_frame<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let one = T::one();
    let half = T::from_f64(0.5);
    let mut a = *a;
    let mut frame = SMatrix::<T, N, N>::identity();
    let scale = a.iter().fold(T::zero(), |s, x| s + *x * *x);
    let noise = scale * T::from_f64((0.01 * T::EPSILON) * (0.01 * T::EPSILON));
    for _ in 0..SWEEPS {
        let mut worked = false;
        for p in 0..N {
            for q in p + 1..N {
                let off = a[(p, q)];
                // 1 if the entry exceeds rounding.
                let active = positive(off * off - noise);
                if active.nowhere_positive() {
                    continue;
                }
                worked = true;
                let ratio =
                    half * (a[(q, q)] - a[(p, p)]) * active / (active * off + (one - active));
                let sign = one - (positive(-ratio) + positive(-ratio));
                let t = active * sign / (sign * ratio + (one + ratio * ratio).sqrt());
                let c = one / (one + t * t).sqrt();
                let s = t * c;
                for k in 0..N {
                    let (x, y) = (a[(k, p)], a[(k, q)]);
                    a[(k, p)] = c * x - s * y;
                    a[(k, q)] = s * x + c * y;
                }
                for k in 0..N {
                    let (x, y) = (a[(p, k)], a[(q, k)]);
                    a[(p, k)] = c * x - s * y;
                    a[(q, k)] = s * x + c * y;
                }
                for k in 0..N {
                    let (x, y) = (frame[(k, p)], frame[(k, q)]);
                    frame[(k, p)] = c * x - s * y;
                    frame[(k, q)] = s * x + c * y;
                }
            }
        }
        if !worked {
            break;
        }
    }
    // One Newton step takes out the rounding of the many rotations.
    let excess = frame.tr_mul(&frame) - SMatrix::identity();
    frame - frame * excess * half
}
