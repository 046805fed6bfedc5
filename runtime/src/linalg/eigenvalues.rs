//! Eigenvalues of a symmetric 3x3 matrix, for validation (never on the stepping path).
//! Takes the matrix; gives the three eigenvalues in ascending order.

use nalgebra::Matrix3;

/// The eigenvalues in ascending order, by cyclic Jacobi rotations.
///
/// Only the lower triangle is read. Jacobi's method is chosen over the closed form because it is
/// accurate relative to the largest entry also for (nearly) equal eigenvalues. NaN in gives NaN.
pub fn symmetric_eigenvalues(a: &Matrix3<f64>) -> [f64; 3] {
    let [[xx, yx, zx], [_, yy, zy], [_, _, zz]] = a.data.0;
    let mut diagonal = [xx, yy, zz];
    // Entry i couples the two axes other than i.
    let mut off = [zy, zx, yx];
    // Convergence is quadratic: 3x3 needs about five sweeps.
    for _ in 0..30 {
        if off == [0.0; 3] {
            break;
        }
        for k in 0..3 {
            let (p, q) = ((k + 1) % 3, (k + 2) % 3);
            if off[k] == 0.0 {
                continue;
            }
            let slope = (diagonal[q] - diagonal[p]) / (2.0 * off[k]);
            let tangent = slope.signum() / (slope.abs() + slope.hypot(1.0));
            let cosine = 1.0 / tangent.hypot(1.0);
            let sine = tangent * cosine;
            diagonal[p] -= tangent * off[k];
            diagonal[q] += tangent * off[k];
            off[k] = 0.0;
            let (at_p, at_q) = (off[q], off[p]);
            off[q] = cosine * at_p - sine * at_q;
            off[p] = sine * at_p + cosine * at_q;
        }
    }
    diagonal.sort_by(f64::total_cmp);
    diagonal
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::determinant;

    #[test]
    fn known_spectra() {
        assert_eq!(
            symmetric_eigenvalues(&Matrix3::from_diagonal(&[3.0, -1.0, 2.0].into())),
            [-1.0, 2.0, 3.0]
        );
        let ones = symmetric_eigenvalues(&Matrix3::from_element(1.0));
        assert!(ones[0].abs() < 1e-15 && ones[1].abs() < 1e-15 && (ones[2] - 3.0).abs() < 1e-15);
    }

    #[test]
    fn trace_and_determinant_are_kept() {
        #[rustfmt::skip]
        let a = Matrix3::new(
            1.0, 0.3, -0.2,
            0.3, 2.0, 0.7,
            -0.2, 0.7, -0.5,
        );
        let e = symmetric_eigenvalues(&a);
        assert!((e.iter().sum::<f64>() - a.trace()).abs() < 1e-14);
        assert!((e.iter().product::<f64>() - determinant(&a)).abs() < 1e-14);
    }
}
