//! Differences from the identity: how far a matrix with unit columns is from the identity, with all digits even if it
//! is near. Takes matrices whose entries are rounded to 1e-16; gives the difference with an error relative to its own
//! size.

use crate::Real;
use nalgebra::SMatrix;

/// `A - 1` of a matrix `A` whose columns have length 1. The diagonal follows from the other entries, since
/// `A_ii - 1 = -|A e_i - e_i|²/2`; the plain difference would contain the rounding error of `A_ii`.
///
/// Off the diagonal, an entry of order h has full relative precision; on the diagonal, an entry of order h² has an
/// error of h² times rounding. The formula does not have poles: the identity holds for every angle.
#[inline]
#[must_use]
pub fn less_identity<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let mut out = *a;
    for i in 0..N {
        out[(i, i)] = half_square(a, i);
    }
    out
}

/// `-|A e_i - e_i|²/2`.
#[inline(always)]
fn half_square<T: Real, const N: usize>(a: &SMatrix<T, N, N>, i: usize) -> T {
    let moved = a[(i, i)] - T::one();
    let others = (0..N).filter(|k| *k != i).map(|k| a[(k, i)]);
    let square = others.fold(moved * moved, |sum, x| sum + x * x);
    square * T::from_f64(-0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::groups::{Group, Orthogonal, Rotation};
    use nalgebra::Vector3;

    /// `tr(1 - R)` is `4 sin²(|v|/2)` for a rotation by `|v|`.
    #[test]
    fn the_trace_keeps_its_digits_at_every_angle() {
        for angle in [
            1e-12,
            1e-9,
            1e-7,
            1e-4,
            0.1,
            1.0,
            2.0,
            3.0,
            std::f64::consts::PI,
        ] {
            let v = Vector3::new(2.0, -3.0, 6.0) * (angle / 7.0);
            let r = Rotation::<f64>::exp(&v).matrix();
            let expected = 4.0 * (angle / 2.0).sin().powi(2);
            let found = -less_identity(&r).trace();
            // A few roundings of entries of the same size.
            assert!((found / expected - 1.0).abs() < 1e-14, "{angle}: {found}");
            let apart = less_identity(&r) - (r - SMatrix::identity());
            assert!(apart.amax() < 1e-15, "{angle}: {apart}");
        }
    }

    #[test]
    fn matrices_of_other_sizes_keep_theirs() {
        for step in [1e-10, 1e-6, 1e-2, 1.0] {
            let a = Orthogonal::<4, f64>::identity()
                .retract(&[0.3, -0.2, 0.5, 0.1, 0.4, -0.6].map(|x: f64| x * step));
            let d = less_identity(&a.matrix());
            // Orthogonality of the difference: D + D^T = -D^T D.
            let defect = d + d.transpose() + d.transpose() * d;
            assert!(defect.amax() < 1e-15 * step.min(1.0), "{step}: {defect}");
        }
    }
}
