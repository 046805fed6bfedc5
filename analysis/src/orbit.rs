//! Periodic orbits of a step, and their stability.
//!
//! A periodic orbit of n steps is a fixed point of n steps: z with Phi^n(z) = z. The period T = n h is fixed. In a
//! Hamiltonian system, periodic orbits come in families over the period, so that this is well posed up to the phase
//! and symmetries. See Meyer and Offin, *Introduction to Hamiltonian Dynamical Systems and the N-Body Problem*.

use crate::eigen::{Eigen, EigenError, eigen, pairing_defect};
use crate::error::{self, Invalid, clause};
use crate::flow::{Flow, checked_difference, checked_tangent};
use crate::newton::{Equations, Search, newton};
use nalgebra::{DMatrix, DVector};
use std::{error::Error, fmt};

/// A periodic orbit.
#[derive(Clone, Debug)]
pub struct Orbit<S> {
    /// A state on the orbit.
    pub state: S,
    /// The norm of the coordinates of the state after n steps, at the state.
    pub residual: f64,
    /// The iterations of Newton's method.
    pub iterations: usize,
    /// The largest norm of the coordinates of a state of the orbit, at `state`. An equilibrium is an orbit of size
    /// zero.
    pub size: f64,
    /// The derivative of n steps at the state.
    pub monodromy: DMatrix<f64>,
    /// The Floquet multipliers, which are the eigenvalues of the monodromy matrix, with estimates of errors. Two
    /// multipliers at 1 belong to the phase and the energy. They are defective, with errors near 1e-8.
    pub floquet: Eigen,
    /// The pairing defect of the multipliers, see [`pairing_defect`].
    pub pairing_defect: f64,
}

/// Why no periodic orbit was found.
#[derive(Clone, Debug, PartialEq)]
pub enum OrbitError<E> {
    /// An argument, or a value of the flow, cannot be used.
    Invalid(Invalid),
    /// A step failed.
    Step {
        /// The number of the step, from 0.
        step: usize,
        /// The reason.
        source: E,
    },
    /// Newton's method did not reach the tolerance.
    NoConvergence {
        /// The residual where it stopped.
        residual: f64,
        /// The tolerance.
        tolerance: f64,
        /// The iterations.
        iterations: usize,
        /// The steps that did not reduce the residual.
        rejected: usize,
        /// The coordinates at the start of the state where it stopped.
        stopped: Vec<f64>,
    },
    /// The multipliers could not be computed.
    Eigen(EigenError),
}

impl<E: fmt::Display> fmt::Display for OrbitError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => why.fmt(f),
            Self::Step { step, source } => {
                write!(
                    f,
                    "Step {step} of the orbit failed: {}. Use more steps for the period, or start elsewhere.",
                    clause(source)
                )
            }
            Self::NoConvergence {
                residual,
                tolerance,
                iterations,
                rejected,
                ..
            } => write!(
                f,
                "No periodic orbit: after {iterations} iterations and {rejected} shortened steps the residual is {residual:e}, above {tolerance:e}. Start closer to an orbit, or change the period."
            ),
            Self::Eigen(why) => why.fmt(f),
        }
    }
}

impl<E: Error + 'static> Error for OrbitError<E> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Step { source, .. } => Some(source),
            Self::Eigen(source) => Some(source),
            _ => None,
        }
    }
}

impl<E> From<Invalid> for OrbitError<E> {
    fn from(why: Invalid) -> Self {
        Self::Invalid(why)
    }
}

impl<E> From<EigenError> for OrbitError<E> {
    fn from(why: EigenError) -> Self {
        Self::Eigen(why)
    }
}

struct Return<'a, F> {
    flow: &'a F,
    h: f64,
    steps: usize,
}

impl<F: Flow> Return<'_, F> {
    /// The largest norm of the coordinates of a state of the trajectory, at its first state.
    fn size(&self, at: &F::State) -> Result<f64, OrbitError<F::Error>> {
        let mut size = 0.0_f64;
        let mut state = at.clone();
        for step in 0..self.steps {
            state = self
                .flow
                .step(&state, self.h)
                .map_err(|source| OrbitError::Step { step, source })?;
            size = size.max(checked_difference(self.flow, at, &state)?.norm());
        }
        Ok(size)
    }
}

impl<F: Flow> Equations for Return<'_, F> {
    type State = F::State;
    type Error = OrbitError<F::Error>;

    fn residual(&self, at: &F::State) -> Result<DVector<f64>, Self::Error> {
        let mut state = at.clone();
        for step in 0..self.steps {
            state = self
                .flow
                .step(&state, self.h)
                .map_err(|source| OrbitError::Step { step, source })?;
        }
        Ok(checked_difference(self.flow, at, &state)?)
    }

    /// The derivative takes the coordinates at the end as coordinates at the start. Both agree on the orbit.
    fn linearised(&self, at: &F::State) -> Result<(DVector<f64>, DMatrix<f64>), Self::Error> {
        let n = self.flow.dimension();
        let mut product = DMatrix::identity(n, n);
        let mut state = at.clone();
        for step in 0..self.steps {
            let (next, tangent) = checked_tangent(self.flow, &state, self.h, |source| {
                OrbitError::Step { step, source }
            })?;
            product = tangent * product;
            state = next;
        }
        error::finite("derivative of the orbit", product.as_slice())?;
        Ok((
            checked_difference(self.flow, at, &state)?,
            product - DMatrix::identity(n, n),
        ))
    }

    fn moved(&self, at: &F::State, by: &DVector<f64>) -> F::State {
        self.flow.moved(at, by.as_slice())
    }
}

/// The periodic orbit of `steps` steps of size `h` near `start`, by damped Newton's method with steps of least norm.
///
/// If the trajectory from the start has a size above 1, the tolerance is relative to this size. With few steps for a
/// period, the phase of a discrete orbit is not free. The method then takes more iterations.
///
/// # Errors
///
/// An argument cannot be used, a step fails, or the method does not converge.
pub fn orbit<F: Flow>(
    flow: &F,
    start: &F::State,
    h: f64,
    steps: usize,
    search: &Search,
) -> Result<Orbit<F::State>, OrbitError<F::Error>> {
    error::step_size(h)?;
    error::number("steps of the period", steps, usize::MAX)?;
    error::number("coordinates", flow.dimension(), usize::MAX)?;
    search.check()?;
    let problem = Return { flow, h, steps };
    let tolerance = search.tolerance * problem.size(start)?.max(1.0);
    let ended = newton(
        &problem,
        start.clone(),
        &Search {
            tolerance,
            ..*search
        },
    )?;
    if !ended.converged {
        return Err(OrbitError::NoConvergence {
            residual: ended.residual,
            tolerance,
            iterations: ended.iterations,
            rejected: ended.rejected,
            stopped: flow.difference(start, &ended.state),
        });
    }
    let (difference, derivative) = problem.linearised(&ended.state)?;
    let n = flow.dimension();
    let monodromy = derivative + DMatrix::identity(n, n);
    let size = problem.size(&ended.state)?;
    let mut floquet = eigen(&monodromy)?;
    // The product of tangents has a rounding in each factor, with random signs.
    let roundings = n as f64 * (1.0 + (steps as f64).sqrt());
    floquet.errors = floquet.errors_for(roundings * f64::EPSILON * floquet.norm);
    let pairing_defect = pairing_defect(&floquet.values);
    let (state, iterations) = (ended.state, ended.iterations);
    Ok(Orbit {
        state,
        residual: difference.norm(),
        iterations,
        size,
        monodromy,
        floquet,
        pairing_defect,
    })
}
