//! Coefficients of `det(ν + M + λ S)`: the eigenvalues of a pencil of matrices, as polynomials.
//! Takes two square matrices; gives the coefficients by powers of `M`, `ν` and `λ`.

use crate::Real;
use nalgebra::SMatrix;

/// Coefficients of `det(ν + M + λ S)` in which `M` occurs: entry `(j - 1, i)` is the coefficient of
/// `ν^i λ^(N - j - i)` of degree `j` in `M`; entries with `j + i > N` are zero. Uses the recursion of Faddeev and
/// Le Verrier, whose rounding error grows with the size: call it for matrices of a few rows.
#[must_use]
pub fn pencil_coefficients<T: Real, const N: usize>(
    m: &SMatrix<T, N, N>,
    s: &SMatrix<T, N, N>,
) -> SMatrix<T, N, N> {
    let mut out = SMatrix::zeros();
    // The coefficients of the adjugate of degree j in M, starting with the identity.
    let mut parts = [SMatrix::<T, N, N>::zeros(); N];
    if let Some(first) = parts.first_mut() {
        *first = SMatrix::identity();
    }
    for k in 1..=N {
        let sign = if k % 2 == 0 { T::one() } else { -T::one() };
        // From the highest degree down: each coefficient needs itself and the next lower one.
        for j in (0..=k).rev() {
            let own = parts.get(j).map_or_else(SMatrix::zeros, |p| s * p);
            let product = match j.checked_sub(1).and_then(|i| parts.get(i)) {
                Some(below) => own + m * below,
                None => own,
            };
            let c = -product.trace() / T::from_f64(k as f64);
            if j > 0 {
                out[(j - 1, N - k)] = sign * c;
            }
            if let Some(part) = parts.get_mut(j) {
                *part = product + SMatrix::identity() * c;
            }
        }
    }
    out
}

/// The nonzero entries of [`pencil_coefficients`] for a skew `M` and a symmetric `S`, as (row, column): the entries
/// of even degree in `M`.
pub fn even_degrees(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (2..=n)
        .step_by(2)
        .flat_map(move |j| (0..=n - j).map(move |i| (j - 1, i)))
}

/// How many entries [`even_degrees`] gives.
#[must_use]
pub const fn even_count(n: usize) -> usize {
    let (mut count, mut j) = (0, 2);
    while j <= n {
        count += n - j + 1;
        j += 2;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::determinant;

    #[test]
    fn they_are_those_of_the_determinant() {
        let m =
            SMatrix::<f64, 4, 4>::from_fn(|i, j| ((3 * i + 5 * j + i * j) % 7) as f64 / 7.0 - 0.4);
        let s = SMatrix::<f64, 4, 4>::from_fn(|i, j| ((i + 2 * j + 1) % 5) as f64 / 5.0);
        let c = pencil_coefficients(&m, &s);
        let without = |nu: f64, lambda: f64| determinant(&(SMatrix::identity() * nu + s * lambda));
        for (nu, lambda) in [(1.0, 0.0), (0.3, -0.7), (-1.2, 0.4), (0.0, 1.0)] {
            let mut sum = without(nu, lambda);
            for j in 1..=4usize {
                for i in 0..=4 - j {
                    sum += c[(j - 1, i)] * nu.powi(i as i32) * lambda.powi((4 - j - i) as i32);
                }
            }
            let whole = determinant(&(SMatrix::identity() * nu + m + s * lambda));
            // A few hundred operations on numbers of order one.
            assert!((sum - whole).abs() < 1e-14, "{nu} {lambda}: {sum} {whole}");
        }
    }

    #[test]
    fn odd_degrees_vanish_for_skew_and_symmetric() {
        let a = SMatrix::<f64, 5, 5>::from_fn(|i, j| ((7 * i + 3 * j) % 11) as f64 / 11.0);
        let c = pencil_coefficients(&(a - a.transpose()), &(a + a.transpose()));
        let even: Vec<(usize, usize)> = even_degrees(5).collect();
        assert_eq!(even.len(), even_count(5));
        for i in 0..5 {
            for j in 0..5 {
                // The other coefficients are of order one.
                let zero = c[(i, j)].abs() < 1e-13;
                assert_eq!(zero, !even.contains(&(i, j)), "({i}, {j}): {}", c[(i, j)]);
            }
        }
    }
}
