//! The canonical two-form of T*SO(3), attitude included, in left-trivialised coordinates. Takes the Jacobian of a map in (xi, mu),
//! where Lambda varies by Lambda hat(xi), and the body momenta at both ends; gives the symplectic defect of the map.

use crate::handwritten::attitude::Vector;

/// Jacobian of a map of (xi, mu): rows are outputs, columns are inputs.
pub type Jacobian = [[f64; 6]; 6];

/// Matrix of d(mu . xi): d theta = delta mu_1 . xi_2 - delta mu_2 . xi_1 - mu . (xi_1 x xi_2). The last term appears because
/// left-invariant fields do not commute.
pub fn two_form(mu: &Vector) -> Jacobian {
    let mut w = [[0.0; 6]; 6];
    for i in 0..3 {
        w[i][i + 3] = -1.0;
        w[i + 3][i] = 1.0;
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        w[j][k] = -mu[i];
        w[k][j] = mu[i];
    }
    w
}

/// Largest entry of D^T W(mu') D - W(mu).
pub fn defect(jacobian: &Jacobian, before: &Vector, after: &Vector) -> f64 {
    let (old, new) = (two_form(before), two_form(after));
    let mut worst = 0.0_f64;
    for r in 0..6 {
        for c in 0..6 {
            let pulled: f64 = (0..36)
                .map(|n| jacobian[n / 6][r] * new[n / 6][n % 6] * jacobian[n % 6][c])
                .sum();
            // `max` would ignore a NaN.
            let off = (pulled - old[r][c]).abs();
            worst = if off.is_nan() {
                f64::INFINITY
            } else {
                worst.max(off)
            };
        }
    }
    worst
}

/// The defect for a product of copies of SO(3): block i belongs to momentum i, with coordinates in the order (xi_1, mu_1, xi_2,
/// mu_2, ...). Largest entry of D^T W(mu') D - W(mu); the Jacobian is row-major.
pub fn defect_of_product(jacobian: &[Vec<f64>], before: &[Vector], after: &[Vector]) -> f64 {
    let form = |momenta: &[Vector]| {
        let mut w = vec![vec![0.0; 6 * momenta.len()]; 6 * momenta.len()];
        for (block, mu) in momenta.iter().enumerate() {
            for (r, row) in two_form(mu).iter().enumerate() {
                for (c, x) in row.iter().enumerate() {
                    w[6 * block + r][6 * block + c] = *x;
                }
            }
        }
        w
    };
    pulled_back(jacobian, &form(before), &form(after))
}

/// The defect for SE(3): rotation and translation `G^-1 dG`, then the angular and the linear momentum.
pub fn defect_of_motion(jacobian: &[Vec<f64>], before: &[f64; 6], after: &[f64; 6]) -> f64 {
    let form = |mu: &[f64; 6]| {
        let mut w = vec![vec![0.0; 12]; 12];
        for i in 0..6 {
            w[i][i + 6] = -1.0;
            w[i + 6][i] = 1.0;
        }
        // -mu . [a, b] with [(w, v), (w', v')] = (w x w', w x v' - w' x v).
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            for (r, c, value) in [(j, k, mu[i]), (j, k + 3, mu[i + 3]), (j + 3, k, mu[i + 3])] {
                w[r][c] = -value;
                w[c][r] = value;
            }
        }
        w
    };
    pulled_back(jacobian, &form(before), &form(after))
}

/// The defect for SO(n): entries (j, i), i < j, row by row, of `Lambda^T dLambda` and of the momentum, paired entry by entry.
pub fn defect_of_rotations(n: usize, jacobian: &[Vec<f64>], before: &[f64], after: &[f64]) -> f64 {
    let planes: Vec<(usize, usize)> = (0..n)
        .flat_map(|i| (i + 1..n).map(move |j| (j, i)))
        .collect();
    let d = planes.len();
    // The entry (r, c) of the skew matrix with 1 at `plane` and -1 at its transpose.
    let entry = |plane: (usize, usize), r: usize, c: usize| {
        f64::from(i8::from((r, c) == plane) - i8::from((c, r) == plane))
    };
    let form = |mu: &[f64]| {
        let mut w = vec![vec![0.0; 2 * d]; 2 * d];
        for (a, row) in w.iter_mut().enumerate().take(d) {
            row[a + d] = -1.0;
            for (b, value) in row.iter_mut().enumerate().take(d) {
                // -<mu, [E_a, E_b]>.
                for (m, (r, c)) in mu.iter().zip(&planes) {
                    let product = |x: usize, y: usize| -> f64 {
                        (0..n)
                            .map(|k| entry(planes[x], *r, k) * entry(planes[y], k, *c))
                            .sum()
                    };
                    *value -= m * (product(a, b) - product(b, a));
                }
            }
        }
        for (a, row) in w.iter_mut().skip(d).enumerate() {
            row[a] = 1.0;
        }
        w
    };
    if before.len() != d || after.len() != d {
        return f64::INFINITY;
    }
    pulled_back(jacobian, &form(before), &form(after))
}

/// The defect for any group of dimension d, where `along(mu, a, b)` is mu . [E_a, E_b]. The coordinates are d body variations of
/// the element, then the d momentum components along them. Fields commute.
pub fn defect_on_group(
    jacobian: &[Vec<f64>],
    before: &[f64],
    after: &[f64],
    along: impl Fn(&[f64], usize, usize) -> f64,
) -> f64 {
    let form = |mu: &[f64]| {
        let d = mu.len();
        let mut w = vec![vec![0.0; 2 * d]; 2 * d];
        for a in 0..d {
            (w[a][a + d], w[a + d][a]) = (-1.0, 1.0);
            for (b, value) in w[a].iter_mut().enumerate().take(d) {
                *value = -along(mu, a, b);
            }
        }
        w
    };
    match before.len() == after.len() {
        true => pulled_back(jacobian, &form(before), &form(after)),
        false => f64::INFINITY,
    }
}

/// Largest entry of D^T W' D - W.
fn pulled_back(jacobian: &[Vec<f64>], old: &[Vec<f64>], new: &[Vec<f64>]) -> f64 {
    let size = old.len();
    if new.len() != size || jacobian.len() != size {
        return f64::INFINITY;
    }
    let mut worst = 0.0_f64;
    for r in 0..size {
        for c in 0..size {
            let mut off = -old[r][c];
            for (row, form) in jacobian.iter().zip(new) {
                let turned: f64 = form.iter().zip(jacobian).map(|(w, d)| w * d[c]).sum();
                off += row[r] * turned;
            }
            // `max` would ignore a NaN.
            worst = if off.is_nan() {
                f64::INFINITY
            } else {
                worst.max(off.abs())
            };
        }
    }
    worst
}
