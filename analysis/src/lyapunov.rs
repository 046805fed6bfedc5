//! Lyapunov exponents from the tangents of steps.
//!
//! The tangents act on an orthonormal frame, which a QR factorisation restores after every step. The exponents are the
//! mean logarithms of the diagonal of R (Benettin, Galgani, Giorgilli and Strelcyn, Meccanica 15, 1980).

use crate::error::{self, Invalid, failed_step};
use crate::flow::{Flow, checked_tangent};
use nalgebra::DMatrix;
use std::{error::Error, fmt};

/// Times at which running estimates are kept, at most.
const ESTIMATES: usize = 200;

/// Blocks whose means give the error.
const BLOCKS: usize = 20;

/// The exponents up to one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The time since the start.
    pub time: f64,
    /// The exponents over this time, per unit of time.
    pub exponents: Vec<f64>,
}

/// Lyapunov exponents of a trajectory.
#[derive(Clone, Debug)]
pub struct Lyapunov<S> {
    /// The exponents per unit of time, in descending order for long trajectories.
    pub exponents: Vec<f64>,
    /// The standard error of each exponent from the means of 20 blocks of steps. It assumes that blocks are
    /// independent. It is NaN for fewer than 40 steps, and it does not see a drift slower than the trajectory.
    pub errors: Vec<f64>,
    /// The exponents up to about 200 equally spaced times, for a plot of convergence.
    pub estimates: Vec<Estimate>,
    /// The state after the last step.
    pub last: S,
}

/// Why exponents could not be computed.
#[derive(Clone, Debug, PartialEq)]
pub enum LyapunovError<E> {
    /// An argument, or a tangent, cannot be used.
    Invalid(Invalid),
    /// A step failed.
    Step {
        /// The number of the step, from 0.
        step: usize,
        /// The reason.
        source: E,
    },
    /// A tangent maps a direction of the frame to zero, so that an exponent is minus infinity.
    Collapsed {
        /// The number of the step, from 0.
        step: usize,
        /// The number of the exponent, from 0.
        exponent: usize,
    },
}

impl<E: fmt::Display> fmt::Display for LyapunovError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => why.fmt(f),
            Self::Step { step, source } => failed_step(f, *step, source),
            Self::Collapsed { step, exponent } => write!(
                f,
                "The tangent of step {step} maps direction {exponent} of the frame to zero. Ask for at most {exponent} exponents."
            ),
        }
    }
}

impl<E: Error + 'static> Error for LyapunovError<E> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Step { source, .. } => Some(source),
            _ => None,
        }
    }
}

impl<E> From<Invalid> for LyapunovError<E> {
    fn from(why: Invalid) -> Self {
        Self::Invalid(why)
    }
}

/// The `count` largest Lyapunov exponents of the trajectory of `steps` steps of size `h`.
///
/// The exponents include the first steps, in which the frame aligns. Their effect falls like one over the time.
///
/// # Errors
///
/// An argument cannot be used, a step fails, or a tangent is singular.
pub fn lyapunov<F: Flow>(
    flow: &F,
    start: &F::State,
    h: f64,
    steps: usize,
    count: usize,
) -> Result<Lyapunov<F::State>, LyapunovError<F::Error>> {
    let n = flow.dimension();
    error::step_size(h)?;
    error::number("steps", steps, usize::MAX / ESTIMATES)?;
    error::number("exponents", count, n)?;
    let mut frame = DMatrix::<f64>::identity(n, count);
    let mut state = start.clone();
    let mut sums = vec![0.0; count];
    let mut estimates = Vec::new();
    let mut blocks: Vec<Vec<f64>> = Vec::new();
    let mut at_block = vec![0.0; count];
    let per_block = steps / BLOCKS;
    for step in 0..steps {
        let (next, tangent) = checked_tangent(flow, &state, h, |source| LyapunovError::Step {
            step,
            source,
        })?;
        frame = tangent * frame;
        error::finite("product of tangents", frame.as_slice())?;
        for (exponent, sum) in sums.iter_mut().enumerate() {
            let length = orthogonalised(&mut frame, exponent);
            if length == 0.0 {
                return Err(LyapunovError::Collapsed { step, exponent });
            }
            *sum += length.ln();
        }
        state = next;
        let done = step + 1;
        if done * ESTIMATES / steps != step * ESTIMATES / steps {
            let time = done as f64 * h;
            estimates.push(Estimate {
                time,
                exponents: sums.iter().map(|sum| sum / time).collect(),
            });
        }
        if per_block >= 2 && done % per_block == 0 && blocks.len() < BLOCKS {
            let time = per_block as f64 * h;
            blocks.push(
                sums.iter()
                    .zip(&at_block)
                    .map(|(sum, before)| (sum - before) / time)
                    .collect(),
            );
            at_block.clone_from(&sums);
        }
    }
    let time = steps as f64 * h;
    let errors = (0..count)
        .map(|i| standard_error(blocks.iter().map(|block| block[i])))
        .collect();
    Ok(Lyapunov {
        exponents: sums.iter().map(|sum| sum / time).collect(),
        errors,
        estimates,
        last: state,
    })
}

/// Makes column i a unit vector that is orthogonal to the columns before it. Returns its length before scaling, zero
/// if rounding is all that is left.
fn orthogonalised(frame: &mut DMatrix<f64>, i: usize) -> f64 {
    let mut column = frame.column(i).into_owned();
    let full = column.norm();
    // The second pass makes the column orthogonal to rounding.
    for _ in 0..2 {
        for j in 0..i {
            let along = frame.column(j).dot(&column);
            column.axpy(-along, &frame.column(j), 1.0);
        }
    }
    let length = column.norm();
    if length <= f64::MIN_POSITIVE || (i > 0 && length <= f64::EPSILON * f64::EPSILON * full) {
        return 0.0;
    }
    frame.set_column(i, &(column / length));
    length
}

/// The standard error of the mean of equally long blocks, NaN for fewer than two.
fn standard_error(means: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = means.clone().count() as f64;
    if count < 2.0 {
        return f64::NAN;
    }
    let mean = means.clone().sum::<f64>() / count;
    (means.map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0) / count).sqrt()
}
