//! The interface between the algorithms and a discrete system.

use crate::error::{self, Invalid};
use nalgebra::{DMatrix, DVector};
use std::error::Error;

/// A step of a discrete system, with its derivative in local coordinates.
///
/// A state can be a point of any manifold. Local coordinates at a state are numbers near zero; [`Flow::moved`] maps
/// them to a nearby state. Lengths and angles of the algorithms are Euclidean in these coordinates.
pub trait Flow {
    /// A point of the manifold.
    type State: Clone;
    /// The reason why a step failed.
    type Error: Error + 'static;

    /// The number n of local coordinates.
    fn dimension(&self) -> usize;

    /// One step of size `h`.
    ///
    /// # Errors
    ///
    /// The step does not exist, or its solver failed.
    fn step(&self, at: &Self::State, h: f64) -> Result<Self::State, Self::Error>;

    /// One step of size `h` and its derivative, n x n. Columns belong to coordinates at `at`, rows to coordinates at
    /// the image.
    ///
    /// # Errors
    ///
    /// The step does not exist, or its solver failed.
    fn tangent(&self, at: &Self::State, h: f64)
    -> Result<(Self::State, DMatrix<f64>), Self::Error>;

    /// The state with local coordinates `by` (n numbers) at `at`.
    fn moved(&self, at: &Self::State, by: &[f64]) -> Self::State;

    /// The n local coordinates of `to` at `from`. This is the inverse of `moved`, at least to first order.
    fn difference(&self, from: &Self::State, to: &Self::State) -> Vec<f64>;
}

/// An energy and its conserved quantities at one state.
#[derive(Clone, Debug)]
pub struct First {
    /// The energy.
    pub energy: f64,
    /// Its gradient in local coordinates, n numbers.
    pub gradient: DVector<f64>,
    /// The conserved quantities, m numbers.
    pub conserved: DVector<f64>,
    /// Their gradients in local coordinates: m rows, n columns.
    pub gradients: DMatrix<f64>,
}

/// An energy with conserved quantities, as functions of a state and one parameter p.
///
/// Critical points of the energy at fixed conserved quantities are the relative equilibria of a system; see Marsden
/// and Ratiu, *Introduction to Mechanics and Symmetry*.
pub trait Energy {
    /// A point of the manifold.
    type State: Clone;
    /// The reason why an evaluation failed.
    type Error: Error + 'static;

    /// The number n of local coordinates.
    fn dimension(&self) -> usize;

    /// The number m of conserved quantities.
    fn constraints(&self) -> usize;

    /// The energy and the conserved quantities with their gradients.
    ///
    /// # Errors
    ///
    /// The functions are not defined at this state.
    fn first(&self, at: &Self::State, p: f64) -> Result<First, Self::Error>;

    /// The Hessian, n x n, of the energy plus the sum of `multipliers[i]` times conserved quantity i, in the
    /// coordinates of `moved(at, .)`.
    ///
    /// # Errors
    ///
    /// The functions are not defined at this state.
    fn second(
        &self,
        at: &Self::State,
        p: f64,
        multipliers: &[f64],
    ) -> Result<DMatrix<f64>, Self::Error>;

    /// The derivatives with respect to p: of the gradient of the same sum (n numbers), and of the conserved quantities
    /// (m numbers).
    ///
    /// # Errors
    ///
    /// The functions are not defined at this state.
    fn in_parameter(
        &self,
        at: &Self::State,
        p: f64,
        multipliers: &[f64],
    ) -> Result<(DVector<f64>, DVector<f64>), Self::Error>;

    /// The state with local coordinates `by` (n numbers) at `at`.
    fn moved(&self, at: &Self::State, by: &[f64]) -> Self::State;

    /// The n local coordinates of `to` at `from`.
    fn difference(&self, from: &Self::State, to: &Self::State) -> Vec<f64>;

    /// The directions of symmetry at a state: n rows, one column for each generator of the group. Null directions of
    /// the second variation in their span do not count as degenerate. The default is a matrix without columns.
    fn symmetries(&self, _at: &Self::State) -> DMatrix<f64> {
        DMatrix::zeros(self.dimension(), 0)
    }
}

/// A step and its tangent, checked for shape and finite numbers. `failed` makes an error of a failed step.
pub(crate) fn checked_tangent<F: Flow, E: From<Invalid>>(
    flow: &F,
    at: &F::State,
    h: f64,
    failed: impl FnOnce(F::Error) -> E,
) -> Result<(F::State, DMatrix<f64>), E> {
    let (next, tangent) = flow.tangent(at, h).map_err(failed)?;
    let n = flow.dimension();
    error::matrix("tangent of a step", &tangent, (n, n))?;
    Ok((next, tangent))
}

/// The coordinates of `to` at `from`, checked for length and finite numbers.
pub(crate) fn checked_difference<F: Flow>(
    flow: &F,
    from: &F::State,
    to: &F::State,
) -> Result<DVector<f64>, Invalid> {
    let difference = DVector::from_vec(flow.difference(from, to));
    error::vector("difference of two states", &difference, flow.dimension()).map(|()| difference)
}
