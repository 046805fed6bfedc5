//! Eigenvalues and eigenvectors of real matrices that are not symmetric.
//!
//! The QR iteration of a real Schur form can stall on Hamiltonian matrices, whose eigenvalues come as ±λ. This module
//! computes a complex Schur form of the balanced matrix with a bound on its iterations. If it fails, or if the form
//! does not reproduce the matrix, the module tries again after a shift and after fixed orthogonal similarities.
//!
//! A double eigenvalue without two eigenvectors has an error of about the square root of the rounding: 1e-8 for a
//! matrix of size one. Tangents of symplectic maps have such eigenvalues at 1, from the phase and the energy of a
//! periodic orbit. [`Eigen::errors`] reports this; products of pairs and sums of such eigenvalues are more accurate.

use crate::error::Invalid;
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector, Schur};
use std::fmt;

/// Similarities and shifts that are tried.
const TRIES: usize = 6;

/// The largest backward error of a Schur form, in roundings of its norm for each row.
const BACKWARD: f64 = 100.0;

/// Eigenvalues and eigenvectors of a real n x n matrix.
#[derive(Clone, Debug)]
pub struct Eigen {
    /// The n eigenvalues, by descending absolute value; of a complex pair, the one with positive imaginary part first.
    /// Complex eigenvalues come in exact pairs.
    pub values: Vec<Complex<f64>>,
    /// Unit eigenvectors as columns, in the order of the values.
    pub vectors: DMatrix<Complex<f64>>,
    /// An estimate of the error of each eigenvalue from rounding.
    pub errors: Vec<f64>,
    /// The condition number of each eigenvalue in balanced coordinates: 1 at best, very large near a defective one.
    pub conditions: Vec<f64>,
    /// The Frobenius norm of the balanced matrix.
    pub(crate) norm: f64,
}

/// Why eigenvalues could not be computed.
#[derive(Clone, Debug, PartialEq)]
pub enum EigenError {
    /// The matrix is not square or not finite.
    Invalid(Invalid),
    /// The iteration did not converge after any similarity or shift.
    NoConvergence {
        /// The rows of the matrix.
        rows: usize,
        /// The number of similarities and shifts that were tried.
        tries: usize,
    },
}

impl fmt::Display for EigenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => why.fmt(f),
            Self::NoConvergence { rows, tries } => write!(
                f,
                "The eigenvalues of a matrix with {rows} rows did not converge in {tries} tries. Use units in which its numbers are closer to one."
            ),
        }
    }
}

impl std::error::Error for EigenError {}

impl From<Invalid> for EigenError {
    fn from(why: Invalid) -> Self {
        Self::Invalid(why)
    }
}

impl Eigen {
    /// An estimate of the error of each eigenvalue if the norm of the error of the matrix is `perturbation`.
    ///
    /// The estimate of an eigenvalue with k - 1 others within its first-order error is of order `perturbation^(1/k)`.
    #[must_use]
    pub fn errors_for(&self, perturbation: f64) -> Vec<f64> {
        let relative = perturbation / self.norm.max(f64::MIN_POSITIVE);
        let error = |(value, condition): (&Complex<f64>, &f64)| {
            let first = condition * perturbation;
            match self
                .values
                .iter()
                .filter(|other| (*other - value).norm() <= first)
                .count()
            {
                0 | 1 => first,
                near => first.min(2.0 * self.norm * relative.powf(1.0 / near as f64)),
            }
        };
        self.values
            .iter()
            .zip(&self.conditions)
            .map(error)
            .collect()
    }
}

/// The eigenvalues and eigenvectors of a real square matrix, for up to a few hundred rows.
///
/// # Errors
///
/// The matrix is not square, has a number that is not finite, or the iteration does not converge.
pub fn eigen(a: &DMatrix<f64>) -> Result<Eigen, EigenError> {
    let n = a.nrows();
    crate::error::matrix("matrix", a, (n, n))?;
    let scale = a.amax();
    if n == 0 || scale == 0.0 {
        return Ok(Eigen {
            values: vec![Complex::default(); n],
            vectors: DMatrix::identity(n, n),
            errors: vec![0.0; n],
            conditions: vec![1.0; n],
            norm: 0.0,
        });
    }
    let mut balanced = a / scale;
    let d = balance_parlett_reinsch(&mut balanced);
    let norm = balanced.norm();
    let complex = balanced.map(|x| Complex::new(x, 0.0));
    let Some((q, t)) = (0..TRIES).find_map(|number| schur(&complex, norm, number)) else {
        return Err(EigenError::NoConvergence {
            rows: n,
            tries: TRIES,
        });
    };
    let (mut values, mut vectors, mut conditions) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..n {
        let (right, left) = (&q * right(&t, k, norm), &q * left(&t, k, norm).conjugate());
        let product = left.dotc(&right);
        let condition = left.norm() * right.norm() / product.norm();
        let correction = left.dotc(&(&complex * &right - &right * t[(k, k)])) / product;
        // The correction is at most the backward error of the Schur form, unless the eigenvalue is defective.
        let trusted = correction.norm() <= BACKWARD * n as f64 * f64::EPSILON * norm * condition;
        let simple = condition < 1e6 && trusted;
        values.push(
            scale
                * if simple {
                    t[(k, k)] + correction
                } else {
                    t[(k, k)]
                },
        );
        conditions.push(condition.max(1.0));
        let scaled = DVector::from_fn(n, |i, _| right[i] * d[i]);
        vectors.push(scaled.unscale(scaled.norm()));
    }
    let mut result = Eigen {
        values,
        vectors: DMatrix::from_columns(&vectors),
        errors: vec![0.0; n],
        conditions,
        norm: scale * norm,
    };
    result.pair();
    result.errors = result.errors_for(f64::EPSILON * n as f64 * result.norm);
    Ok(result)
}

/// The unitary and the triangular factor of a Schur form.
type Factors = (DMatrix<Complex<f64>>, DMatrix<Complex<f64>>);

/// The factors of the Schur form, from the similarity or shift with this number.
fn schur(a: &DMatrix<Complex<f64>>, norm: f64, number: usize) -> Option<Factors> {
    let n = a.nrows();
    // Zero eigenvalues put zeros on the diagonal, where the relative test of the iteration never ends. A shift helps.
    let shift = if number % 2 == 1 {
        Complex::new(norm, 0.0)
    } else {
        Complex::default()
    };
    let turn = match number / 2 {
        0 => DMatrix::identity(n, n),
        seed => DMatrix::from_fn(n, n, |i, j| {
            Complex::new(
                ((i * i + 3 * j + 1) as f64 * (seed as f64).sqrt() * 1.618).sin()
                    + ((i * j) as f64).cos(),
                0.0,
            )
        })
        .qr()
        .q(),
    };
    let moved = turn.adjoint() * a * &turn + DMatrix::from_diagonal_element(n, n, shift);
    let (q, mut t) = Schur::try_new(moved, f64::EPSILON, 60 * n + 200)?.unpack();
    t.fill_lower_triangle(Complex::default(), 1);
    t -= DMatrix::from_diagonal_element(n, n, shift);
    let q = turn * q;
    let backward = (a * &q - &q * &t).norm();
    let unitary = (q.adjoint() * &q - DMatrix::identity(n, n)).norm();
    let enough = BACKWARD * n as f64 * f64::EPSILON;
    (backward <= enough * norm && unitary <= enough).then_some((q, t))
}

/// A difference of two diagonal entries, kept away from zero.
fn apart(difference: Complex<f64>, norm: f64) -> Complex<f64> {
    let least = f64::EPSILON * norm;
    if difference.norm() < least {
        Complex::new(least, 0.0)
    } else {
        difference
    }
}

/// The eigenvector of a triangular matrix to its diagonal entry k.
fn right(t: &DMatrix<Complex<f64>>, k: usize, norm: f64) -> DVector<Complex<f64>> {
    let mut x = DVector::from_element(t.nrows(), Complex::default());
    x[k] = Complex::new(1.0, 0.0);
    for i in (0..k).rev() {
        let sum: Complex<f64> = (i + 1..=k).map(|j| t[(i, j)] * x[j]).sum();
        x[i] = -sum / apart(t[(i, i)] - t[(k, k)], norm);
        shrink(&mut x);
    }
    x
}

/// The left eigenvector, a row that is returned as a column, of a triangular matrix to its diagonal entry k.
fn left(t: &DMatrix<Complex<f64>>, k: usize, norm: f64) -> DVector<Complex<f64>> {
    let mut w = DVector::from_element(t.nrows(), Complex::default());
    w[k] = Complex::new(1.0, 0.0);
    for j in k + 1..t.nrows() {
        let sum: Complex<f64> = (k..j).map(|i| w[i] * t[(i, j)]).sum();
        w[j] = -sum / apart(t[(j, j)] - t[(k, k)], norm);
        shrink(&mut w);
    }
    w
}

/// Keeps a vector from overflow. Its length does not matter.
fn shrink(x: &mut DVector<Complex<f64>>) {
    let norm = x.norm();
    if norm > 1e100 {
        x.unscale_mut(norm);
    }
}

/// The largest distance of a product of two multipliers from 1, over the multipliers, each with its best partner. The
/// multipliers of a symplectic map come in pairs with product 1, so that this is an error. Zero without multipliers.
#[must_use]
pub fn pairing_defect(multipliers: &[Complex<f64>]) -> f64 {
    let best = |a: &Complex<f64>| {
        multipliers
            .iter()
            .map(|b| (a * b - 1.0).norm())
            .fold(f64::INFINITY, f64::min)
    };
    multipliers
        .iter()
        .map(best)
        .fold(0.0, |most: f64, x| if x.is_nan() { x } else { most.max(x) })
}
