//! Where the straight line `(1 - s) Q + s Q V` from a linear map to the next meets `det = 0`.
//! Takes the velocity `V`; gives the first share `s` of the step.
//!
//! `det((1 - s) 1 + s V)` is a polynomial in `s`. Its coefficients in the Bernstein basis are the elementary
//! symmetric functions of the eigenvalues, each divided by its binomial coefficient. If they are positive, so is the
//! polynomial; bisection finds the first point where it is not.

use crate::linalg::{Dense, determinant};
use nalgebra::SMatrix;

/// One more than the largest size of a map.
const MOST: usize = 9;

/// Halvings after which an interval is a point.
const HALVINGS: u32 = 53;

/// A determinant counts as zero if it is at most this many roundings of the coefficients: each coefficient is a sum
/// of at most ten minors, and each halving adds one rounding. If a motion only touches zero, the determinant does not
/// change its sign.
const ROUNDINGS: f64 = 64.0;

/// The largest distance of a sign change from the point at which the determinant counts as zero, if both belong to
/// one zero. It is above the square root of `ROUNDINGS` roundings.
const SHARPER: f64 = 1e-6;

/// The first `s` from 0 to 1 at which the determinant is zero, or negative to rounding; also where
/// it only touches zero.
pub(super) fn contact<const N: usize>(velocity: &SMatrix<f64, N, N>) -> Option<f64> {
    by_minors(N, |k| symmetric(velocity, k))
}

/// Like `contact`, for a matrix whose size is known only at run time.
pub(super) fn contact_of(velocity: &Dense<f64>) -> Option<f64> {
    by_minors(velocity.rows, |k| symmetric_of(velocity, k))
}

/// Finds the first contact from the sums of the principal minors of `k` rows.
fn by_minors(n: usize, symmetric: impl Fn(usize) -> f64) -> Option<f64> {
    let mut coefficients = [0.0; MOST];
    let coefficients = coefficients.get_mut(..=n)?;
    let mut binomial = 1.0;
    for (k, c) in coefficients.iter_mut().enumerate() {
        *c = symmetric(k) / binomial;
        binomial *= (n - k) as f64 / (k + 1) as f64;
    }
    // Sums of positive numbers lose no digits, however small the numbers are.
    if coefficients.iter().all(|c| *c > 0.0) {
        return None;
    }
    let largest = coefficients.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    let zero = ROUNDINGS * f64::EPSILON * largest;
    let touched = first(coefficients, zero, 0.0, 1.0, 0)?;
    // If the sign changes, the point is more accurate.
    match first(coefficients, 0.0, 0.0, 1.0, 0) {
        Some(crossed) if crossed - touched < SHARPER => Some(crossed),
        _ => Some(touched),
    }
}

/// The sum of the principal minors of `k` rows.
fn symmetric<const N: usize>(a: &SMatrix<f64, N, N>, k: usize) -> f64 {
    let mut sum = 0.0;
    for rows in 0u32..1 << N {
        if rows.count_ones() as usize != k {
            continue;
        }
        let taken = |i: usize| rows >> i & 1 == 1;
        // The remaining rows come from the identity.
        let minor = SMatrix::<f64, N, N>::from_fn(|i, j| match (taken(i) && taken(j), i == j) {
            (true, _) => a[(i, j)],
            (false, true) => 1.0,
            (false, false) => 0.0,
        });
        sum += determinant(&minor);
    }
    sum
}

/// Like `symmetric`, for a matrix whose size is known only at run time.
fn symmetric_of(a: &Dense<f64>, k: usize) -> f64 {
    let (n, mut sum) = (a.rows, 0.0);
    for rows in 0u32..1 << n {
        if rows.count_ones() as usize != k {
            continue;
        }
        let taken = |i: usize| rows >> i & 1 == 1;
        // The remaining rows come from the identity.
        let minor = Dense::from_fn(n, n, |i, j| match (taken(i) && taken(j), i == j) {
            (true, _) => a.at(i, j),
            (false, true) => 1.0,
            (false, false) => 0.0,
        });
        sum += minor.determinant();
    }
    sum
}

/// The first point in an interval at which the polynomial with these coefficients does not exceed `zero`.
fn first(coefficients: &[f64], zero: f64, from: f64, to: f64, halved: u32) -> Option<f64> {
    if coefficients.iter().all(|c| *c > zero) {
        return None;
    }
    // The polynomial is not positive at the start of the interval, or the interval has become a point; NaN also ends here.
    if !coefficients.first().is_some_and(|c| *c > zero) || halved == HALVINGS {
        return Some(from);
    }
    let (mut left, mut right) = ([0.0; MOST], [0.0; MOST]);
    let count = coefficients.len();
    right.get_mut(..count)?.copy_from_slice(coefficients);
    for (i, l) in left.iter_mut().enumerate().take(count) {
        *l = right[0];
        for j in 0..count - 1 - i {
            right[j] = 0.5 * (right[j] + right[j + 1]);
        }
    }
    let middle = 0.5 * (from + to);
    first(&left[..count], zero, from, middle, halved + 1)
        .or_else(|| first(&right[..count], zero, middle, to, halved + 1))
}

#[cfg(test)]
mod tests {
    use crate::linalg::Dense;
    use nalgebra::{Matrix2, Matrix3, Rotation3, SMatrix, Vector3};

    fn contact<const N: usize>(velocity: &SMatrix<f64, N, N>) -> Option<f64> {
        let found = super::contact(velocity);
        assert_eq!(found, super::contact_of(&Dense::of(velocity)));
        found
    }

    fn diagonal(a: f64, b: f64, c: f64) -> Matrix3<f64> {
        // The same in a basis that is not orthogonal.
        let frame = Matrix3::new(1.0, 0.3, -0.2, 0.1, 1.2, 0.4, -0.5, 0.2, 0.9);
        let back = frame.try_inverse().unwrap();
        frame * Matrix3::from_diagonal(&Vector3::new(a, b, c)) * back
    }

    #[test]
    fn one_crossing_is_where_its_eigenvalue_says() {
        for negative in [-1e-3, -0.5, -1.0, -40.0] {
            let found = contact(&diagonal(negative, 1.5, 0.7)).unwrap();
            // (1 - s) + s λ = 0
            assert!(
                (found - 1.0 / (1.0 - negative)).abs() < 1e-13,
                "{negative}: {found}"
            );
        }
    }

    #[test]
    fn two_crossings_in_one_step_count() {
        let v = diagonal(-0.5, -3.0, 0.7);
        assert!(
            v.determinant() > 0.0,
            "the sign at the end does not show them"
        );
        assert!((contact(&v).unwrap() - 0.25).abs() < 1e-13);
        // A half turn of a plane touches det = 0 in the middle.
        let half = Rotation3::new(Vector3::new(0.0, 0.0, core::f64::consts::PI)).into_inner();
        assert!((contact(&half).unwrap() - 0.5).abs() < 1e-7);
    }

    #[test]
    fn motions_that_stay_invertible_pass() {
        assert_eq!(contact(&diagonal(2.5, 30.0, 0.01)), None);
        assert_eq!(
            contact(&SMatrix::<f64, 5, 5>::from_diagonal_element(7.0)),
            None
        );
        // A large turn other than a half turn does not have real eigenvalues in its plane.
        for angle in [0.5, 2.0, 3.1, 3.13] {
            let (s, c) = f64::sin_cos(angle);
            assert_eq!(contact(&Matrix2::new(c, -s, s, c)), None, "{angle}");
        }
        // A shear is far from the identity, but not near a singular matrix.
        assert_eq!(contact(&Matrix2::new(1.0, 50.0, 0.0, 1.0)), None);
    }

    #[test]
    fn a_singular_or_undefined_end_is_met() {
        let end = contact(&Matrix2::new(1.0, 2.0, 2.0, 4.0)).unwrap();
        assert!(end > 1.0 - 1e-12, "{end}");
        assert!(contact(&Matrix2::from_element(f64::NAN)).is_some());
    }
}
