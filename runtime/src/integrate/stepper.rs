//! The trait of every emitted model: it advances a state by one step.
//! Takes a state and a workspace made for it; compositions and ensembles use only this trait.

use crate::{Real, StartError, StepError};

/// A model with its parameters.
pub trait Stepper {
    /// The numbers it computes with.
    type Scalar: Real;
    /// The configurations and momenta at one node. You can save and compare states.
    type State: Copy + core::fmt::Debug;
    /// The step size, the data kept between steps, and the data of the first guess.
    type Workspace: Clone + core::fmt::Debug + Send;

    /// A workspace for steps of `h`, of either sign, from `state`.
    ///
    /// # Errors
    /// If the first step fails.
    fn workspace(
        &self,
        state: &Self::State,
        h: Self::Scalar,
    ) -> Result<Self::Workspace, StartError>;

    /// One step, in place.
    ///
    /// # Errors
    /// If the step cannot be solved; the state is then unchanged.
    fn advance(
        &self,
        state: &mut Self::State,
        workspace: &mut Self::Workspace,
    ) -> Result<(), StepError>;

    /// The state after one step of `h` in a new workspace, or `None` if the step fails. Searches that try many steps
    /// use it, since they do not need the cause of a failure. The model may skip the proof of the step here, so a
    /// search confirms its result by an ordinary step.
    #[must_use]
    fn attempt(&self, state: &Self::State, h: Self::Scalar) -> Option<Self::State> {
        let mut moving = *state;
        let mut workspace = self.workspace(state, h).ok()?;
        self.advance(&mut moving, &mut workspace).ok()?;
        Some(moving)
    }

    /// `count` steps, in place. The result equals the result of `count` single steps, up to rounding if the model has
    /// a faster loop. It does not depend on how you split `count` into calls.
    ///
    /// # Errors
    /// If one of them fails. The state is then at one of the nodes of the loop.
    #[inline(always)]
    fn advance_many(
        &self,
        state: &mut Self::State,
        workspace: &mut Self::Workspace,
        count: u64,
    ) -> Result<(), StepError> {
        for _ in 0..count {
            self.advance(state, workspace)?;
        }
        Ok(())
    }

    /// The number of the node.
    fn node(state: &Self::State) -> u64;

    /// The state, with its node number set to `node`.
    #[must_use]
    fn at_node(state: Self::State, node: u64) -> Self::State;
}

/// A model whose step is its own inverse under `h -> -h`; the derivation has proved this for the discrete Lagrangian.
/// Only such steps gain order by [`Composition`](super::Composition).
pub trait Reversible: Stepper {}
