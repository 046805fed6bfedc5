//! Bodies side by side: one trajectory of the model over lanes.
//! Takes as many bodies as there are lanes; advances them, and finds the one that cannot go on.

use super::EnsembleError;
use crate::integrate::{Model, Stepper};
use crate::scalar::{gather, lane};
use crate::{Lanes, StartError, StepError};
use core::array::from_fn;

/// The model over lanes.
pub(super) type Wide<M, const N: usize> = <M as Model>::Over<Lanes<N>>;

/// Parameters and state of one body.
pub(super) type Body<M> = (<M as Model>::Parameters, <M as Stepper>::State);

/// What makes the steps of every body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps<C> {
    /// The step size.
    pub(super) h: f64,
    /// What was chosen about them.
    pub(super) choice: C,
}

/// `N` bodies.
#[derive(Clone, Debug)]
pub(super) struct Group<M: Model<Scalar = f64>, const N: usize> {
    pub(super) model: Wide<M, N>,
    pub(super) state: <Wide<M, N> as Stepper>::State,
    workspace: <Wide<M, N> as Stepper>::Workspace,
    /// Where each body was when the group was at its node 0.
    begun: [u64; N],
}

impl<M: Model<Scalar = f64>, const N: usize> Group<M, N> {
    /// The group of these bodies, the first of which has the index `first`; empty lanes repeat the
    /// last body. Nothing if there are none.
    pub(super) fn start(
        bodies: &[Body<M>],
        first: usize,
        steps: Steps<M::Choice>,
    ) -> Option<Result<Self, EnsembleError<StartError>>> {
        let last = bodies.last()?;
        let body = |i: usize| bodies.get(i).unwrap_or(last);
        let begun = || {
            let model = Wide::<M, N>::of(gather(|i| body(i).0))?;
            let state = gather::<M::State, N>(|i| M::at_node(body(i).1, 0));
            let workspace = model.prepare(&state, Lanes([steps.h; N]), steps.choice)?;
            Ok(Self {
                model,
                state,
                workspace,
                begun: from_fn(|i| M::node(&body(i).1)),
            })
        };
        Some(begun().map_err(|cause| {
            let alone = |(parameters, state): &Body<M>| {
                let model = M::of(*parameters)?;
                model.prepare(state, steps.h, steps.choice).map(|_| ())
            };
            told(bodies.iter().map(alone), first, cause)
        }))
    }

    /// Steps of all bodies; those of the first `bodies` lanes count. After an error the state is
    /// what it was.
    #[inline(always)]
    pub(super) fn advance(&mut self, count: u64) -> Result<(), StepError> {
        let mut moving = self.state;
        self.model
            .advance_many(&mut moving, &mut self.workspace, count)?;
        self.state = moving;
        Ok(())
    }

    /// Which of the `bodies` bodies is to blame for `cause`: each is run alone.
    #[cold]
    #[inline(never)]
    pub(super) fn blame(
        &self,
        count: u64,
        [first, bodies]: [usize; 2],
        steps: Steps<M::Choice>,
        cause: StepError,
    ) -> EnsembleError<StepError> {
        let alone = |at: usize| {
            let (parameters, mut state) = self.body(at);
            let node = M::node(&state);
            let refused = |e: StartError| match e {
                StartError::Refused(cause) => cause.at_node(node),
                StartError::Initial(_) => cause,
            };
            let model = M::of(parameters).map_err(|_| cause)?;
            let mut workspace = model
                .prepare(&state, steps.h, steps.choice)
                .map_err(refused)?;
            model.advance_many(&mut state, &mut workspace, count)
        };
        told((0..bodies).map(alone), first, cause)
    }

    /// The body in a lane.
    pub(super) fn body(&self, at: usize) -> Body<M> {
        let begun = self.begun.get(at).copied().unwrap_or(0);
        let node = begun.saturating_add(Wide::<M, N>::node(&self.state));
        let state = lane::<M::State, N>(&self.state, at);
        (
            lane::<M::Parameters, N>(self.model.given(), at),
            M::at_node(state, node),
        )
    }
}

/// The first body that fails alone, how many do, or all of them when none does.
fn told<E>(
    alone: impl ExactSizeIterator<Item = Result<(), E>>,
    first: usize,
    cause: E,
) -> EnsembleError<E> {
    let bodies = alone.len();
    let mut failures = alone
        .enumerate()
        .filter_map(|(at, done)| done.err().map(|e| (at, e)));
    match failures.next() {
        Some((at, cause)) => EnsembleError {
            body: first + at,
            among: 1,
            failed: 1 + failures.count(),
            cause,
        },
        None => EnsembleError {
            body: first,
            among: bodies,
            failed: bodies,
            cause,
        },
    }
}
