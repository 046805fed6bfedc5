//! The input and the result of a fit by least squares. Parameters can be on a manifold.

use crate::error::{Invalid, clause};
use nalgebra::{DMatrix, DVector};
use std::{error::Error, fmt};

/// A singular value of J with unit columns below this leaves a combination of parameters undetermined.
pub const UNDETERMINED: f64 = 1e-10;

/// Residuals as functions of parameters.
pub trait Residuals {
    /// A point of the manifold of parameters.
    type Parameters: Clone;
    /// The reason why an evaluation failed.
    type Error: Error + 'static;

    /// The number n of local coordinates of the parameters.
    fn dimension(&self) -> usize;

    /// The residuals, always the same number m >= n of them, divided by their standard deviations if these differ.
    ///
    /// # Errors
    ///
    /// The residuals are not defined for these parameters. The fit then takes a shorter step.
    fn residuals(&self, at: &Self::Parameters) -> Result<DVector<f64>, Self::Error>;

    /// The derivative of the residuals in local coordinates at the parameters, m x n.
    ///
    /// # Errors
    ///
    /// The residuals are not defined for these parameters.
    fn jacobian(&self, at: &Self::Parameters) -> Result<DMatrix<f64>, Self::Error>;

    /// The parameters with local coordinates `by` (n numbers) at `at`.
    fn moved(&self, at: &Self::Parameters, by: &[f64]) -> Self::Parameters;
}

/// Fitted parameters.
#[derive(Clone, Debug)]
pub struct Fit<P> {
    /// The parameters.
    pub parameters: P,
    /// The moves from the start to the parameters, in order, each in local coordinates where it begins.
    pub moves: Vec<DVector<f64>>,
    /// The norm of the residuals.
    pub residual: f64,
    /// The iterations, including rejected steps.
    pub iterations: usize,
    /// The inverse of J^T J, n x n. It is the covariance if the residuals have variance 1.
    pub inverse: DMatrix<f64>,
    /// The variance of the residuals, |r|^2 / (m - n). None if there are as many residuals as parameters.
    pub variance: Option<f64>,
}

impl<P> Fit<P> {
    /// The covariance of the local coordinates, variance times inverse.
    #[must_use]
    pub fn covariance(&self) -> Option<DMatrix<f64>> {
        self.variance.map(|variance| variance * &self.inverse)
    }

    /// The standard errors of the local coordinates.
    #[must_use]
    pub fn standard_errors(&self) -> Option<Vec<f64>> {
        self.covariance()
            .map(|covariance| covariance.diagonal().iter().map(|x| x.sqrt()).collect())
    }

    /// The correlations of the local coordinates, with ones on the diagonal.
    #[must_use]
    pub fn correlation(&self) -> DMatrix<f64> {
        let c = &self.inverse;
        DMatrix::from_fn(c.nrows(), c.ncols(), |i, j| match i == j {
            true => 1.0,
            false => c[(i, j)] / (c[(i, i)].sqrt() * c[(j, j)].sqrt()),
        })
    }
}

/// Why a fit failed.
#[derive(Clone, Debug, PartialEq)]
pub enum FitError<E> {
    /// The residuals or their derivative cannot be used.
    Invalid(Invalid),
    /// The residuals could not be evaluated.
    Residuals(E),
    /// The residuals do not depend on a combination of parameters.
    Undetermined {
        /// The combination, n numbers with norm 1 in local coordinates.
        combination: Vec<f64>,
        /// The smallest singular value of J with unit columns, relative to the largest.
        ratio: f64,
    },
    /// The method did not converge.
    NoConvergence {
        /// The norm of the residuals where it stopped.
        residual: f64,
        /// The largest cosine of the angle between the residuals and a column of J. It is zero at a minimum.
        cosine: f64,
        /// The iterations.
        iterations: usize,
    },
}

impl<E: fmt::Display> fmt::Display for FitError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => why.fmt(f),
            Self::Residuals(source) => write!(
                f,
                "The residuals failed: {}. Start from other parameters.",
                clause(source)
            ),
            Self::Undetermined { combination, ratio } => {
                write!(f, "The data do not determine the combination")?;
                let largest = combination
                    .iter()
                    .fold(0.0_f64, |most, x| most.max(x.abs()));
                let terms = combination
                    .iter()
                    .enumerate()
                    .filter(|(_, x)| x.abs() > 1e-3 * largest);
                for (i, x) in terms {
                    write!(f, " {x:+.3} * parameter {i}")?;
                }
                write!(
                    f,
                    " (singular value {ratio:e}). Fix one of these parameters, or add data."
                )
            }
            Self::NoConvergence {
                residual,
                cosine,
                iterations,
            } => write!(
                f,
                "The fit did not converge in {iterations} iterations: the residual is {residual:e}, at a cosine of {cosine:e}. Start from other parameters."
            ),
        }
    }
}

impl<E: Error + 'static> Error for FitError<E> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Residuals(source) => Some(source),
            _ => None,
        }
    }
}

impl<E> From<Invalid> for FitError<E> {
    fn from(why: Invalid) -> Self {
        Self::Invalid(why)
    }
}
