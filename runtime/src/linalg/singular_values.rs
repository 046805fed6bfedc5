//! Singular values of a small matrix, for the test whether a linear map is still invertible (never
//! on the ordinary path of a step). Takes the matrix; gives the smallest over the largest.

use nalgebra::SMatrix;

/// The smallest singular value over the largest, between 0 and 1; NaN when an entry is.
///
/// One-sided Jacobi rotations give small singular values with full relative precision; the eigenvalues of `A^T A`
/// would lose all values below `1e-8` of the largest.
pub fn singular_ratio<const N: usize>(a: &SMatrix<f64, N, N>) -> f64 {
    ratio(&mut a.data.0.clone())
}

/// Like `singular_ratio`, for a matrix given by its columns.
pub fn singular_ratio_of(mut columns: Vec<Vec<f64>>) -> f64 {
    ratio(&mut columns)
}

fn ratio<C: AsRef<[f64]> + AsMut<[f64]> + Clone>(columns: &mut [C]) -> f64 {
    let entries = || columns.iter().flat_map(|c| c.as_ref());
    if !entries().all(|x| x.is_finite()) {
        return f64::NAN;
    }
    // Scaling to size one prevents overflow of squares.
    let largest = entries().fold(0.0, |m: f64, x| m.max(x.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    let all = columns.iter_mut().flat_map(|c| c.as_mut());
    all.for_each(|x| *x /= largest);
    let dot = |x: &[f64], y: &[f64]| -> f64 { x.iter().zip(y).map(|(x, y)| x * y).sum() };
    // Convergence is quadratic; five sweeps do for such sizes.
    for _ in 0..30 {
        let mut turned = false;
        let count = columns.len();
        for p in 0..count {
            for q in p + 1..count {
                let (x, y) = (columns[p].clone(), columns[q].clone());
                let (x, y) = (x.as_ref(), y.as_ref());
                let (xx, yy, xy) = (dot(x, x), dot(y, y), dot(x, y));
                if xy.abs() <= f64::EPSILON * (xx * yy).sqrt() {
                    continue;
                }
                turned = true;
                let slope = (yy - xx) / (2.0 * xy);
                let tangent = slope.signum() / (slope.abs() + slope.hypot(1.0));
                let cosine = 1.0 / tangent.hypot(1.0);
                let sine = tangent * cosine;
                for (u, (x, y)) in columns[p].as_mut().iter_mut().zip(x.iter().zip(y)) {
                    *u = cosine * x - sine * y;
                }
                for (v, (x, y)) in columns[q].as_mut().iter_mut().zip(x.iter().zip(y)) {
                    *v = sine * x + cosine * y;
                }
            }
        }
        if !turned {
            break;
        }
    }
    let lengths = columns.iter().map(|c| dot(c.as_ref(), c.as_ref()).sqrt());
    let (least, most) = lengths.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), x| {
        (a.min(x), b.max(x))
    });
    least / most
}

#[cfg(test)]
mod tests {
    use super::singular_ratio;
    use nalgebra::{Matrix3, Rotation3, Vector3};

    #[test]
    fn small_ratios_are_found_between_any_frames() {
        let left = Rotation3::new(Vector3::new(0.3, -0.7, 0.5)).into_inner();
        let right = Rotation3::new(Vector3::new(-1.1, 0.2, 0.9)).into_inner();
        for ratio in [1.0_f64, 0.3, 1e-5, 1e-10, 1e-13] {
            let a = left
                * Matrix3::from_diagonal(&Vector3::new(3.0, 3.0 * ratio, 3.0 * ratio.sqrt()))
                * right;
            // The entries themselves are rounded: two frames of nine entries each, and six products.
            let off = (singular_ratio(&a) - ratio).abs();
            assert!(off <= 16.0 * f64::EPSILON, "{ratio:e}: {off:e}");
        }
    }

    #[test]
    fn scales_and_singular_matrices() {
        assert_eq!(singular_ratio(&Matrix3::<f64>::zeros()), 0.0);
        assert_eq!(singular_ratio(&(Matrix3::identity() * 1e-200)), 1.0);
        assert_eq!(singular_ratio(&(Matrix3::identity() * 1e200)), 1.0);
        assert!(singular_ratio(&Matrix3::from_element(1.0)) < 1e-15);
        assert!(singular_ratio(&Matrix3::from_element(f64::NAN)).is_nan());
    }
}
