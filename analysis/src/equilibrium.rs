//! Relative equilibria: critical points of an energy at fixed conserved quantities.
//!
//! A state is a critical point if dE + sum of lambda_i dC_i = 0 for some multipliers lambda. For a Hamiltonian with
//! symmetry, the multipliers are minus the velocities of the group along the motion. See Marsden and Ratiu,
//! *Introduction to Mechanics and Symmetry*.

use crate::error::{Invalid, clause};
use crate::flow::Energy;
use crate::kkt::Kkt;
use crate::newton::{Search, newton};
use crate::variation::{Variation, variation};
use nalgebra::DVector;
use std::{error::Error, fmt};

/// A critical point of the energy at fixed conserved quantities.
#[derive(Clone, Debug)]
pub struct Equilibrium<S> {
    /// The state.
    pub state: S,
    /// The m multipliers.
    pub multipliers: DVector<f64>,
    /// The energy.
    pub energy: f64,
    /// The norm of the equations: gradients and differences of conserved quantities together. The unit of energy is
    /// the largest second derivative or force at the start. The unit of a conserved quantity is the norm of its
    /// gradient there.
    pub residual: f64,
    /// The iterations of Newton's method.
    pub iterations: usize,
    /// The second variation with its verdict on stability.
    pub variation: Variation,
}

/// Why no critical point was found.
#[derive(Clone, Debug, PartialEq)]
pub enum EquilibriumError<E> {
    /// An argument, or a value of the energy, cannot be used.
    Invalid(Invalid),
    /// The energy could not be evaluated.
    Energy {
        /// The parameter.
        p: f64,
        /// The reason.
        source: E,
    },
    /// Newton's method did not reach the tolerance.
    NoConvergence {
        /// The parameter.
        p: f64,
        /// The residual where it stopped, in the units of [`Equilibrium::residual`].
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
}

impl<E: fmt::Display> fmt::Display for EquilibriumError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => why.fmt(f),
            Self::Energy { p, source } => write!(
                f,
                "The energy at parameter {p} failed: {}. Start elsewhere.",
                clause(source)
            ),
            Self::NoConvergence {
                p,
                residual,
                tolerance,
                iterations,
                rejected,
                ..
            } => write!(
                f,
                "No equilibrium at parameter {p}: after {iterations} iterations and {rejected} shortened steps the residual is {residual:e}, above {tolerance:e}. Start closer to an equilibrium, or check that the conserved quantities can have these values."
            ),
        }
    }
}

impl<E: Error + 'static> Error for EquilibriumError<E> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Energy { source, .. } => Some(source),
            _ => None,
        }
    }
}

impl<E> From<Invalid> for EquilibriumError<E> {
    fn from(why: Invalid) -> Self {
        Self::Invalid(why)
    }
}

/// The critical point near `start` where the m conserved quantities have the given `values`, at parameter `p`.
///
/// Newton's method finds minima, maxima and saddles alike. It is damped, and takes steps of least norm, so that
/// directions of symmetry do not matter.
///
/// # Errors
///
/// An argument cannot be used, the energy is not defined, or the method does not converge.
pub fn equilibrium<E: Energy>(
    energy: &E,
    start: &E::State,
    values: &[f64],
    p: f64,
    search: &Search,
) -> Result<Equilibrium<E::State>, EquilibriumError<E::Error>> {
    search.check()?;
    let (kkt, point) = Kkt::new(energy, values, start, p)?;
    let ended = newton(&kkt, point, search)?;
    if !ended.converged {
        return Err(EquilibriumError::NoConvergence {
            p,
            residual: ended.residual,
            tolerance: search.tolerance,
            iterations: ended.iterations,
            rejected: ended.rejected,
            stopped: energy.difference(start, &ended.state.state),
        });
    }
    let variation = variation(&kkt, &ended.state)?;
    let energy = kkt.first(&ended.state.state, p)?.energy;
    let multipliers = kkt.multipliers(&ended.state);
    Ok(Equilibrium {
        state: ended.state.state,
        multipliers,
        energy,
        residual: ended.residual,
        iterations: ended.iterations,
        variation,
    })
}
