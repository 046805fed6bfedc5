//! Many independent trajectories of one model, with different parameters and states.
//! Takes a model and a state for each block; advances all of them, in cache and on all cores.
//!
//! A block is one trajectory of a model over [`Lanes`](crate::Lanes): its lanes are the members,
//! side by side in the vector registers. A block makes all its steps before the next one is
//! touched, so that a large ensemble costs per step what a small one does. Blocks do not speak to
//! each other: the result is the same bits whatever the number of threads.

use super::Stepper;
use crate::{StartError, StepError};
use core::fmt;

/// One block: a model, where it is, and what it keeps.
#[derive(Clone, Debug)]
pub struct Member<S: Stepper> {
    model: S,
    state: S::State,
    workspace: S::Workspace,
}

impl<S: Stepper> Member<S> {
    /// The model with its parameters.
    pub fn model(&self) -> &S {
        &self.model
    }

    /// Where it is.
    pub fn state(&self) -> &S::State {
        &self.state
    }

    #[inline(always)]
    fn advance(&mut self, steps: u64) -> Result<(), StepError> {
        let mut moving = self.state;
        self.model
            .advance_many(&mut moving, &mut self.workspace, steps)?;
        self.state = moving;
        Ok(())
    }
}

/// An ensemble.
#[derive(Clone, Debug)]
pub struct Ensemble<S: Stepper> {
    members: Vec<Member<S>>,
}

/// One block could not go on. All others are where they should be; this one is where it was.
#[derive(Clone, Debug, PartialEq)]
pub struct EnsembleError<E> {
    /// Its place in the ensemble; the first, if there are several.
    pub block: usize,
    /// How many blocks failed.
    pub failed: usize,
    /// Why the first did.
    pub cause: E,
}

impl<E: fmt::Display> fmt::Display for EnsembleError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "block {}: {}", self.block, self.cause)?;
        if self.failed > 1 {
            write!(f, " ({} blocks failed)", self.failed)?;
        }
        Ok(())
    }
}

impl<E: std::error::Error + 'static> std::error::Error for EnsembleError<E> {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.cause)
    }
}

impl<S: Stepper> Ensemble<S> {
    /// An ensemble of steps of `h`.
    ///
    /// # Errors
    /// Names the first block whose first step could not be made.
    pub fn start(
        blocks: impl IntoIterator<Item = (S, S::State)>,
        h: S::Scalar,
    ) -> Result<Self, EnsembleError<StartError>> {
        let members = blocks
            .into_iter()
            .enumerate()
            .map(|(block, (model, state))| match model.workspace(&state, h) {
                Ok(workspace) => Ok(Member {
                    model,
                    state,
                    workspace,
                }),
                Err(cause) => Err(EnsembleError {
                    block,
                    failed: 1,
                    cause,
                }),
            });
        Ok(Self {
            members: members.collect::<Result<_, _>>()?,
        })
    }

    /// The blocks, in the order they were given.
    pub fn members(&self) -> &[Member<S>] {
        &self.members
    }

    /// `steps` steps of every block, on this thread.
    ///
    /// # Errors
    /// Names the first block that could not go on.
    pub fn run(&mut self, steps: u64) -> Result<(), EnsembleError<StepError>> {
        first(self.members.iter_mut().map(|m| m.advance(steps).err()))
    }

    /// As [`Ensemble::run`], on all threads of the pool in use; the same bits.
    ///
    /// # Errors
    /// As [`Ensemble::run`].
    #[cfg(feature = "rayon")]
    pub fn run_parallel(&mut self, steps: u64) -> Result<(), EnsembleError<StepError>>
    where
        S: Send,
        S::State: Send,
        S::Workspace: Send,
    {
        use rayon::prelude::*;
        let failures: Vec<Option<StepError>> = self
            .members
            .par_iter_mut()
            .map(|m| m.advance(steps).err())
            .collect();
        first(failures.into_iter())
    }
}

/// The first failure, and how many there are.
fn first(
    failures: impl Iterator<Item = Option<StepError>>,
) -> Result<(), EnsembleError<StepError>> {
    let mut told: Option<EnsembleError<StepError>> = None;
    for (block, failure) in failures.enumerate() {
        match (&mut told, failure) {
            (Some(told), Some(_)) => told.failed += 1,
            (None, Some(cause)) => {
                told = Some(EnsembleError {
                    block,
                    failed: 1,
                    cause,
                });
            }
            (_, None) => {}
        }
    }
    told.map_or(Ok(()), Err)
}
