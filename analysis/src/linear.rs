//! Modes and stability at an equilibrium of a step.
//!
//! The tangent M(h) of a step at its fixed point has multipliers mu: the discrete system oscillates with frequency
//! arg(mu) / h and grows at the rate ln|mu| / h. The continuous system has the generator A, the limit of log(M(h)) / h.
//! Its eigenvalues are the exponents, with frequencies as imaginary and growth rates as real parts. See Hairer, Lubich
//! and Wanner, *Geometric Numerical Integration*, chapter IX.

use crate::eigen::{EigenError, eigen};
use crate::error::{self, Invalid, clause};
use crate::flow::{Flow, checked_difference, checked_tangent};
use crate::generator::{Generator, generator};
use crate::mode::{Mode, Verdict, modes, verdict};
use nalgebra::DMatrix;
use std::{error::Error, fmt};

/// The largest displacement by one step, in local coordinates, that counts as a fixed point.
pub const FIXED: f64 = 1e-7;

/// The linearised system at an equilibrium.
#[derive(Clone, Debug)]
pub struct Linear {
    /// The norm of the displacement of the state by one step, in local coordinates.
    pub residual: f64,
    /// The modes of the step, by descending growth, then by ascending frequency.
    pub modes: Vec<Mode>,
    /// The verdict on the step.
    pub verdict: Verdict,
    /// The modes of the continuous system, in the same order.
    pub limit_modes: Vec<Mode>,
    /// The verdict on the continuous system.
    pub limit_verdict: Verdict,
    /// The generator A, n x n, per unit of time.
    pub generator: DMatrix<f64>,
    /// An estimate of the largest error of an entry of A, in coordinates scaled so that rows and columns of A have
    /// similar norms.
    pub generator_error: f64,
}

/// Why the linearisation failed.
#[derive(Clone, Debug, PartialEq)]
pub enum LinearError<E> {
    /// An argument, or a value of the flow, cannot be used.
    Invalid(Invalid),
    /// A step failed.
    Step {
        /// The step size.
        h: f64,
        /// The reason.
        source: E,
    },
    /// The state is not a fixed point of the step.
    NotFixed {
        /// The displacement by one step.
        displacement: f64,
    },
    /// The tangent does not approach the identity for small steps.
    NoLimit {
        /// The smallest step size that was tried.
        h: f64,
        /// The norm of the tangent minus the identity.
        distance: f64,
    },
    /// The eigenvalues could not be computed.
    Eigen(EigenError),
}

impl<E: fmt::Display> fmt::Display for LinearError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => why.fmt(f),
            Self::Step { h, source } => write!(
                f,
                "The step of size {h} failed: {}. Use a smaller step size.",
                clause(source)
            ),
            Self::NotFixed { displacement } => write!(
                f,
                "The state is no equilibrium: a step moves it by {displacement:e}. Search for an equilibrium or a periodic orbit first."
            ),
            Self::NoLimit { h, distance } => write!(
                f,
                "The tangent of a step of size {h:e} is {distance:e} away from the identity. Check that the step tends to the identity for small step sizes."
            ),
            Self::Eigen(why) => why.fmt(f),
        }
    }
}

impl<E: Error + 'static> Error for LinearError<E> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Step { source, .. } => Some(source),
            Self::Eigen(source) => Some(source),
            _ => None,
        }
    }
}

impl<E> From<Invalid> for LinearError<E> {
    fn from(why: Invalid) -> Self {
        Self::Invalid(why)
    }
}

impl<E> From<EigenError> for LinearError<E> {
    fn from(why: EigenError) -> Self {
        Self::Eigen(why)
    }
}

/// The modes of a step of size `h` at the fixed point `at`, and of the continuous system.
///
/// `reversible` says that the step of size -h inverts the step of size h. The extrapolation to the continuous system
/// then uses even powers of h. If it is wrong, the generator is less accurate, and `generator_error` shows this.
///
/// # Errors
///
/// An argument cannot be used, a step fails, the state is not a fixed point, or eigenvalues do not converge.
pub fn linear<F: Flow>(
    flow: &F,
    at: &F::State,
    h: f64,
    reversible: bool,
) -> Result<Linear, LinearError<F::Error>> {
    let n = flow.dimension();
    error::step_size(h)?;
    error::number("coordinates", n, usize::MAX)?;
    let tangent = |h: f64| checked_tangent(flow, at, h, |source| LinearError::Step { h, source });
    let (next, step) = tangent(h)?;
    let residual = checked_difference(flow, at, &next)?.norm();
    if residual > FIXED {
        return Err(LinearError::NotFixed {
            displacement: residual,
        });
    }
    let multipliers = eigen(&step)?;
    let mode = |i: usize, error: f64| {
        let mu = multipliers.values[i];
        // Near zero, the logarithm of a multiplier is as uncertain as the multiplier relative to its size.
        let error = error / mu.norm() / h.abs();
        (mu, mu.norm().ln() / h, mu.arg() / h, error)
    };
    let step_modes = modes(&multipliers, &multipliers.errors, mode);
    let Generator { matrix, error } = generator(|h| Ok(tangent(h)?.1), h, reversible)?;
    let exponents = eigen(&matrix)?;
    let errors = exponents.errors_for(error * n as f64 + f64::EPSILON * matrix.norm());
    let limit_modes = modes(&exponents, &errors, |i, error| {
        let s = exponents.values[i];
        (s, s.re, s.im, error)
    });
    Ok(Linear {
        residual,
        verdict: verdict(&step_modes),
        modes: step_modes,
        limit_verdict: verdict(&limit_modes),
        limit_modes,
        generator: matrix,
        generator_error: error,
    })
}
