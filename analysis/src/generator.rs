//! The generator of a one-parameter family of matrices: the limit of log(M(h)) / h for small h.

use crate::error::Invalid;
use crate::linear::LinearError;
use nalgebra::DMatrix;
use nalgebra::linalg::balancing::{balance_parlett_reinsch, unbalance};

/// Largest norm of M(h) - 1 at which the extrapolation begins.
const NEAR: f64 = 0.1;

/// Halvings of h before the search for a small tangent ends.
const HALVINGS: usize = 80;

/// Rows of the table of extrapolation.
const ROWS: usize = 12;

pub(crate) struct Generator {
    pub matrix: DMatrix<f64>,
    /// An estimate of the largest error of an entry, in coordinates that balance the matrix.
    pub error: f64,
}

/// The generator by Richardson extrapolation over h, h/2, h/4 and so on, in powers of h, or of h^2 for a reversible
/// step. The table grows until rounding stops it. Its entry of least estimated error is the result.
pub(crate) fn generator<E>(
    mut tangent: impl FnMut(f64) -> Result<DMatrix<f64>, LinearError<E>>,
    h: f64,
    reversible: bool,
) -> Result<Generator, LinearError<E>> {
    let mut h = h;
    let mut m = tangent(h)?;
    let n = m.nrows();
    let one = DMatrix::identity(n, n);
    // Units may give the entries of the tangent different sizes. Balanced coordinates give a better norm.
    let mut balanced = &m - &one;
    let scale = balanced.amax().max(f64::MIN_POSITIVE);
    balanced /= scale;
    let d = balance_parlett_reinsch(&mut balanced);
    let to_balanced = |m: DMatrix<f64>| {
        let mut m = m;
        unbalance(&mut m, &d.map(|x| 1.0 / x));
        m
    };
    m = to_balanced(m);
    for _ in 0..HALVINGS {
        if (&m - &one).norm() <= NEAR {
            break;
        }
        h /= 2.0;
        m = to_balanced(tangent(h)?);
    }
    let distance = (&m - &one).norm();
    if distance > NEAR {
        return Err(LinearError::NoLimit { h, distance });
    }
    let mut best: Option<Generator> = None;
    let mut row: Vec<DMatrix<f64>> = Vec::new();
    for level in 0..ROWS {
        if level > 0 {
            h /= 2.0;
            m = to_balanced(tangent(h)?);
        }
        let logarithm = logarithm(&m).ok_or(Invalid::NotFinite {
            what: "logarithm of the tangent",
        })?;
        let mut next = vec![logarithm / h];
        for (j, before) in row.iter().enumerate() {
            let factor = 2.0_f64.powi((j as i32 + 1) * if reversible { 2 } else { 1 });
            let better = &next[j] + (&next[j] - before) / (factor - 1.0);
            next.push(better);
        }
        if let (Some(new), Some(old)) = (next.last(), row.last()) {
            // Rounding of the tangent leaves this error, even where two rows agree by chance.
            let rounding = f64::EPSILON / h.abs();
            let error = (new - old).amax().max(rounding);
            if best.as_ref().is_none_or(|best| error < best.error) {
                best = Some(Generator {
                    matrix: new.clone(),
                    error,
                });
            } else if best.as_ref().is_some_and(|best| error > 100.0 * best.error) {
                break;
            }
        }
        row = next;
    }
    let mut best = best.ok_or(Invalid::NotFinite { what: "generator" })?;
    unbalance(&mut best.matrix, &d);
    Ok(best)
}

/// The logarithm of a matrix near the identity, 2 artanh((M - 1) (M + 1)^-1). For a symplectic M, every term of the
/// series is a Hamiltonian matrix.
fn logarithm(m: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = m.nrows();
    let one = DMatrix::identity(n, n);
    // Both factors commute.
    let y = (m + &one).lu().solve(&(m - &one))?;
    let square = &y * &y;
    let mut power = y.clone();
    let mut sum = y;
    for k in 1..20 {
        power *= &square;
        let term = &power / (2 * k + 1) as f64;
        sum += &term;
        if term.amax() <= f64::EPSILON * f64::EPSILON * sum.amax() {
            break;
        }
    }
    sum.iter().all(|x| x.is_finite()).then_some(2.0 * sum)
}
