//! What every emitted model is, seen from the outside: something that steps.
//! Takes a state and a workspace made for it; compositions and ensembles are written on this.

use crate::{Real, StartError, StepError};

/// A model with its parameters.
pub trait Stepper {
    /// The numbers it computes with.
    type Scalar: Real;
    /// What moves, at one node. Saved and compared by the user.
    type State: Copy + core::fmt::Debug;
    /// The step size, what is kept between steps, and what the first guess needs.
    type Workspace: Clone + core::fmt::Debug + Send;

    /// A workspace for steps of `h`, of either sign, from `state`.
    ///
    /// # Errors
    /// When the first step could not be made.
    fn workspace(
        &self,
        state: &Self::State,
        h: Self::Scalar,
    ) -> Result<Self::Workspace, StartError>;

    /// One step, in place.
    ///
    /// # Errors
    /// When it cannot be solved; the state is then unchanged.
    fn advance(
        &self,
        state: &mut Self::State,
        workspace: &mut Self::Workspace,
    ) -> Result<(), StepError>;

    /// The state after one step of `h` in a workspace of its own, or none: for searches that try
    /// many steps, to which the reason of a refusal is nothing. That the step can be made is not
    /// proved: what is offered in the end is made once more as any other.
    #[must_use]
    fn attempt(&self, state: &Self::State, h: Self::Scalar) -> Option<Self::State> {
        let mut moving = *state;
        let mut workspace = self.workspace(state, h).ok()?;
        self.advance(&mut moving, &mut workspace).ok()?;
        Some(moving)
    }

    /// `count` steps, in place, with the same result as one by one, but for rounding where the
    /// model has a shorter way. How many are asked for at once makes no difference at all.
    ///
    /// # Errors
    /// When one of them cannot be solved; the state is then somewhere between.
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

    /// The same state, counted as another node.
    #[must_use]
    fn at_node(state: Self::State, node: u64) -> Self::State;
}

/// A model whose step is its own inverse under `h -> -h`, which the derivation has shown for the
/// discrete Lagrangian. Only such steps gain order by [`Composition`](super::Composition).
pub trait Reversible: Stepper {}
