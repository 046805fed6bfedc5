//! A model over any scalar: the same derivation for one body and for lanes of bodies.
//! Takes parameters and initial data as plain data; gives a stepper and its state.

use super::Stepper;
use crate::{OfScalars, ParameterError, Real, StartError};
use core::fmt::Debug;

/// What every emitted model is, whatever its scalar: generic code builds it from data, and goes over
/// from one scalar to another.
pub trait Model:
    Stepper<State: OfScalars<Scalar = <Self as Stepper>::Scalar>> + Clone + Debug + Send
{
    /// The parameters, as given.
    type Parameters: OfScalars<Scalar = Self::Scalar>;
    /// The initial data, as given.
    type Initial: OfScalars<Scalar = Self::Scalar>;
    /// What may be chosen about the steps; the order of a free body, nothing for most models.
    type Choice: Copy + Debug + Default + Send + Sync;

    /// Whether an ensemble steps its bodies side by side in lanes: explicit steps and those with a
    /// quartic gain by it. Iterations of which each body needs its own number do not.
    const SIDE_BY_SIDE: bool;

    /// The same model over another scalar.
    type Over<U: Real>: Model<
            Scalar = U,
            Parameters = <Self::Parameters as OfScalars>::Over<U>,
            Initial = <Self::Initial as OfScalars>::Over<U>,
            State = <Self::State as OfScalars>::Over<U>,
            Choice = Self::Choice,
        >;

    /// The model of these parameters.
    ///
    /// # Errors
    /// Names the parameter that is not admissible.
    fn of(parameters: Self::Parameters) -> Result<Self, ParameterError>;

    /// Its parameters.
    fn given(&self) -> &Self::Parameters;

    /// The state at node 0.
    ///
    /// # Errors
    /// Names the value that is not admissible.
    fn begin(&self, initial: Self::Initial) -> Result<Self::State, StartError>;

    /// A workspace for steps of `h`, of either sign, from `state`.
    ///
    /// # Errors
    /// When the first step could not be made.
    fn prepare(
        &self,
        state: &Self::State,
        h: Self::Scalar,
        choice: Self::Choice,
    ) -> Result<Self::Workspace, StartError>;
}
