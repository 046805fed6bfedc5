//! Least squares by the method of Levenberg and Marquardt, with parameters on a manifold.
//!
//! Each step minimises |r + J x|^2 + lambda |D x|^2. The diagonal D has the largest norms so far of the columns of J
//! (More, Lecture Notes in Mathematics 630, 1978). The factor lambda follows the ratio of actual to predicted reduction
//! (Nielsen, Technical University of Denmark, report IMM-REP-1999-05).

use crate::error;
use crate::fit::{Fit, FitError, Residuals, UNDETERMINED};
use crate::singular::Singular;
use nalgebra::{DMatrix, DVector};

/// Iterations, including rejected steps, before the fit fails.
const ITERATIONS: usize = 500;

/// Residuals this small, relative to those at the start or to the columns of J, are an exact fit up to rounding.
const EXACT: f64 = 1e-12;

/// The cosine of residuals and columns at which rounding may end the search. A reduction by cosine^2 must be far below
/// the rounding of |r|^2.
const ORTHOGONAL: f64 = 1e-7;

/// Residuals with their derivative at parameters.
struct Linearised<P> {
    at: P,
    r: DVector<f64>,
    j: DMatrix<f64>,
    /// The norms of the columns of J.
    norms: DVector<f64>,
}

/// The parameters near `start` with the least sum of squares of the residuals.
///
/// The method ends where no step reduces the residuals beyond rounding. There, all columns of J are orthogonal to the
/// residuals, or the residuals are zero up to rounding.
///
/// # Errors
///
/// The residuals cannot be used, do not determine the parameters, or the method does not converge.
pub fn fit<R: Residuals>(
    of: &R,
    start: &R::Parameters,
) -> Result<Fit<R::Parameters>, FitError<R::Error>> {
    let n = of.dimension();
    error::number("parameters", n, usize::MAX)?;
    let r = of.residuals(start).map_err(FitError::Residuals)?;
    error::number("residuals", r.len(), usize::MAX)?;
    error::vector("vector of residuals", &r, r.len())?;
    error::number("parameters", n, r.len())?;
    let first = r.norm();
    let mut here = linearised(of, start.clone(), r)?;
    let mut scales = here.norms.clone();
    let (mut lambda, mut growth) = (1e-3, 2.0);
    let mut moves = Vec::new();
    let mut iterations = 0;
    let converged = 'search: loop {
        scales = scales.sup(&here.norms);
        let cosine = cosine(&here);
        if cosine <= 4.0 * f64::EPSILON {
            break true;
        }
        let unit = scales.map(|x| if x > 0.0 { 1.0 / x } else { 0.0 });
        let scaled = &here.j * DMatrix::from_diagonal(&unit);
        let singular = Singular::new(&scaled);
        loop {
            if iterations >= ITERATIONS || lambda > 1e30 {
                let exact = here.r.norm() <= EXACT * first.max(scales.max());
                break 'search exact || cosine <= ORTHOGONAL;
            }
            iterations += 1;
            let y = -singular.solve(&here.r, f64::EPSILON, lambda);
            // |r|^2 - |r + J x|^2 without cancellation.
            let predicted = (&scaled * &y).norm_squared() + 2.0 * lambda * y.norm_squared();
            let step = y.component_mul(&unit);
            let trial = of.moved(&here.at, step.as_slice());
            let new = of
                .residuals(&trial)
                .ok()
                .filter(|new| error::vector("", new, here.r.len()).is_ok());
            let actual = new
                .as_ref()
                .map_or(f64::NAN, |new| (&here.r - new).dot(&(&here.r + new)));
            if let Some(new) = new.filter(|_| actual > 0.0) {
                lambda = (lambda * (1.0 - (2.0 * actual / predicted - 1.0).powi(3)).max(1.0 / 3.0))
                    .max(1e-15);
                growth = 2.0;
                moves.push(step);
                here = linearised(of, trial, new)?;
                break;
            }
            if predicted <= 4.0 * f64::EPSILON * here.r.norm_squared() && cosine <= ORTHOGONAL {
                break 'search true;
            }
            lambda *= growth;
            growth *= 2.0;
        }
    };
    let inverse = inverse(&here)?;
    let residual = here.r.norm();
    if !converged {
        return Err(FitError::NoConvergence {
            residual,
            cosine: cosine(&here),
            iterations,
        });
    }
    let more = here.r.len() - n;
    let variance = (more > 0).then(|| here.r.norm_squared() / more as f64);
    Ok(Fit {
        parameters: here.at,
        moves,
        residual,
        iterations,
        inverse,
        variance,
    })
}

fn linearised<R: Residuals>(
    of: &R,
    at: R::Parameters,
    r: DVector<f64>,
) -> Result<Linearised<R::Parameters>, FitError<R::Error>> {
    let j = of.jacobian(&at).map_err(FitError::Residuals)?;
    error::matrix("derivative of the residuals", &j, (r.len(), of.dimension()))?;
    let norms = DVector::from_iterator(j.ncols(), j.column_iter().map(|column| column.norm()));
    Ok(Linearised { at, r, j, norms })
}

/// The largest cosine of the angle between the residuals and a column of J.
fn cosine<P>(of: &Linearised<P>) -> f64 {
    let along = of.j.tr_mul(&of.r);
    let product = |(x, norm): (&f64, &f64)| if *norm > 0.0 { x.abs() / norm } else { 0.0 };
    let largest = along
        .iter()
        .zip(of.norms.iter())
        .map(product)
        .fold(0.0, |most: f64, x| if x.is_nan() { x } else { most.max(x) });
    if of.r.norm() > 0.0 {
        largest / of.r.norm()
    } else {
        0.0
    }
}

/// The inverse of J^T J, from J with unit columns.
fn inverse<P, E>(of: &Linearised<P>) -> Result<DMatrix<f64>, FitError<E>> {
    let n = of.j.ncols();
    if let Some(zero) = of.norms.iter().position(|&norm| norm == 0.0) {
        let combination = (0..n).map(|i| if i == zero { 1.0 } else { 0.0 }).collect();
        return Err(FitError::Undetermined {
            combination,
            ratio: 0.0,
        });
    }
    let unit = DMatrix::from_diagonal(&of.norms.map(|x| 1.0 / x));
    let singular = Singular::new(&(&of.j * &unit));
    let v = &unit * &singular.v;
    let ratio = singular.values[n - 1] / singular.largest();
    if ratio <= UNDETERMINED {
        return Err(FitError::Undetermined {
            combination: v.column(n - 1).normalize().as_slice().to_vec(),
            ratio,
        });
    }
    let inverse = DMatrix::from_diagonal(&singular.values.map(|s| 1.0 / (s * s)));
    Ok(&v * inverse * v.transpose())
}
