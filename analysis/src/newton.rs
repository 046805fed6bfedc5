//! Newton's method for equations whose solutions are not isolated.
//!
//! The derivative J at a solution maps directions of symmetry to zero. Each step is the x of least norm that minimises
//! |J x + r|^2 + damping |x|^2, from the singular values of J. Values up to `rank` times the largest one count as zero.
//! The damping falls with the square of the residual r, so that the last steps converge quadratically (Fan and Yuan,
//! Computing 74, 2005). It grows while a step does not reduce the residual.

use crate::error::{self, Invalid};
use crate::singular::Singular;
use nalgebra::{DMatrix, DVector};

/// When Newton's method ends, and which directions it takes as singular.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// The norm of the residual to reach. After that, steps continue while they halve the residual.
    pub tolerance: f64,
    /// The largest number of iterations.
    pub iterations: usize,
    /// The largest singular value that counts as zero, relative to the largest one. A direction of symmetry has a
    /// singular value from rounding, near 1e-13. A small value that is not a symmetry should be above `rank`.
    pub rank: f64,
}

impl Default for Search {
    /// Tolerance 1e-9, 100 iterations, rank 1e-9.
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            iterations: 100,
            rank: 1e-9,
        }
    }
}

impl Search {
    pub(crate) fn check(&self) -> Result<(), Invalid> {
        let positive = |what, given: f64| match given > 0.0 && given < f64::INFINITY {
            true => Ok(()),
            false => Err(Invalid::Range {
                what,
                given,
                range: "above zero",
            }),
        };
        positive("tolerance", self.tolerance)?;
        positive("relative threshold of the rank", self.rank)?;
        error::number("iterations", self.iterations, usize::MAX)
    }
}

/// Equations on a manifold.
pub(crate) trait Equations {
    type State: Clone;
    type Error;
    fn residual(&self, at: &Self::State) -> Result<DVector<f64>, Self::Error>;
    fn linearised(&self, at: &Self::State) -> Result<(DVector<f64>, DMatrix<f64>), Self::Error>;
    fn moved(&self, at: &Self::State, by: &DVector<f64>) -> Self::State;
}

/// Where the method ended.
pub(crate) struct Ended<S> {
    pub state: S,
    pub residual: f64,
    pub iterations: usize,
    pub converged: bool,
    /// Steps that were tried and did not reduce the residual.
    pub rejected: usize,
}

/// Solves equations from a start. An error is one at the start or at an accepted state; a step to a state without
/// residual is shortened instead.
pub(crate) fn newton<P: Equations>(
    problem: &P,
    start: P::State,
    search: &Search,
) -> Result<Ended<P::State>, P::Error> {
    let mut state = start;
    let (mut r, mut j) = problem.linearised(&state)?;
    let first = r.norm();
    let mut damping = 1e-6;
    let mut rejected = 0;
    let mut iterations = 0;
    while iterations < search.iterations && r.norm() > 0.0 {
        let singular = Singular::new(&j);
        let before = r.norm();
        let unit = (singular.largest() * before / first).powi(2);
        let mut next = None;
        while next.is_none() && damping < 1e12 {
            let step = -singular.solve(&r, search.rank, damping * unit);
            if step.norm() == 0.0 || !step.norm().is_finite() {
                break;
            }
            let trial = problem.moved(&state, &step);
            next = problem
                .residual(&trial)
                .ok()
                .filter(|new| new.norm() < 0.9999 * before)
                .map(|new| (trial, new));
            match next {
                Some(_) => damping = (damping / 16.0).max(1e-12),
                None => {
                    rejected += 1;
                    damping = (damping * 16.0).max(1e-6);
                }
            }
            // A residual at the size of rounding cannot be reduced, however short the step is.
            if before <= search.tolerance {
                break;
            }
        }
        let Some((trial, new)) = next else { break };
        iterations += 1;
        state = trial;
        if new.norm() <= search.tolerance && new.norm() > 0.5 * before {
            r = new;
            break;
        }
        (r, j) = problem.linearised(&state)?;
    }
    let residual = r.norm();
    Ok(Ended {
        state,
        residual,
        iterations,
        converged: residual <= search.tolerance,
        rejected,
    })
}
