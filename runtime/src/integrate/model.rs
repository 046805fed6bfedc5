//! A model over any scalar: the same derivation for a single body and for bodies in lanes. Takes parameters and
//! initial data as plain data; gives a stepper and its state.

use super::Stepper;
use crate::{OfScalars, ParameterError, Real, StartError, validate};
use core::fmt::Debug;

/// An emitted model, generic over its scalar. Generic code builds it from data and changes its
/// scalar.
pub trait Model:
    Stepper<State: OfScalars<Scalar = <Self as Stepper>::Scalar>> + Clone + Debug + Send
{
    /// The given parameters.
    type Parameters: OfScalars<Scalar = Self::Scalar>;
    /// The given initial data.
    type Initial: OfScalars<Scalar = Self::Scalar>;
    /// The option of the steps: an order for a free body, a solver for a forced one, `()` for most
    /// models.
    type Choice: Copy + Debug + Default + Send + Sync;

    /// Whether an ensemble steps its bodies side by side in lanes: explicit steps and steps with a quartic are faster
    /// in lanes. Iterative steps are not, because each body needs its own number of iterations.
    const SIDE_BY_SIDE: bool;

    /// This model over another scalar.
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

    /// The initial workspace for steps of `h` from `state`. It tries no step: see [`Model::prepare`].
    ///
    /// # Errors
    /// If the model is undefined at the state, or a factor of its equations cannot be computed.
    fn prepared(
        &self,
        state: &Self::State,
        h: Self::Scalar,
        choice: Self::Choice,
    ) -> Result<Self::Workspace, StartError>;

    /// A workspace for steps of `h`, of either sign, from `state`.
    ///
    /// # Errors
    /// When `h` is zero or not finite, or the first step cannot be made: it is tried on a copy.
    fn prepare(
        &self,
        state: &Self::State,
        h: Self::Scalar,
        choice: Self::Choice,
    ) -> Result<Self::Workspace, StartError> {
        validate::directed_step(h)?;
        let work = self.prepared(state, h, choice)?;
        let (mut trial, mut scratch) = (*state, work.clone());
        self.advance(&mut trial, &mut scratch)
            .map_err(|e| StartError::Refused(e.cause))?;
        Ok(work)
    }

    /// Starts a trajectory with step `h` from data at node 0.
    ///
    /// # Errors
    /// Names the value that is not admissible, or says why the first step cannot be solved and which
    /// could.
    fn start_with(
        &self,
        initial: Self::Initial,
        h: Self::Scalar,
        choice: Self::Choice,
    ) -> Result<(Self::State, Self::Workspace), StartError> {
        validate::positive_step(h)?;
        let state = self.begin(initial)?;
        Ok((state, self.prepare(&state, h, choice)?))
    }

    /// The workspace with compensated steps, see [`Settings::COMPENSATED`](crate::card::Settings::COMPENSATED).
    /// Most models return it unchanged.
    #[must_use]
    fn compensated(work: Self::Workspace) -> Self::Workspace {
        work
    }
}
