//! Bodies side by side: one trajectory of the model over lanes. Takes as many bodies as there are
//! lanes; advances them, and finds the body that fails.

use super::EnsembleError;
use crate::integrate::{Model, Stepper};
use crate::scalar::{gather, lane};
use crate::{Lanes, StartError, StepError};
use core::array::from_fn;

/// The model over lanes.
pub(super) type Wide<M, const N: usize> = <M as Model>::Over<Lanes<N>>;

/// Parameters and state of one body.
pub(super) type Body<M> = (<M as Model>::Parameters, <M as Stepper>::State);

/// The settings of the steps, the same for every body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps<C> {
    /// The step size.
    pub(super) h: f64,
    /// The option of the steps.
    pub(super) choice: C,
}

/// `N` bodies.
#[derive(Clone, Debug)]
pub(super) struct Group<M: Model<Scalar = f64>, const N: usize> {
    model: Wide<M, N>,
    moving: BodyStates<M, N>,
}

/// The states of the bodies, with their workspaces.
#[derive(Clone, Debug)]
enum BodyStates<M: Model<Scalar = f64>, const N: usize> {
    /// In the lanes.
    Lanes {
        state: <Wide<M, N> as Stepper>::State,
        workspace: <Wide<M, N> as Stepper>::Workspace,
        /// The node of each body when the group was at its node 0.
        begun: [u64; N],
    },
    /// One by one.
    Alone(Vec<Single<M>>),
}

/// A body that steps alone.
#[derive(Clone, Debug)]
struct Single<M: Model<Scalar = f64>> {
    model: M,
    state: M::State,
    workspace: M::Workspace,
    /// Its state before the current steps.
    before: M::State,
}

impl<M: Model<Scalar = f64>, const N: usize> Group<M, N> {
    /// The group of these bodies, the first of which has the index `first`; empty lanes repeat the
    /// last body. `None` if the list is empty.
    pub(super) fn start(
        bodies: &[Body<M>],
        first: usize,
        steps: Steps<M::Choice>,
    ) -> Option<Result<Self, EnsembleError<StartError>>> {
        let last = bodies.last()?;
        let body = |i: usize| bodies.get(i).unwrap_or(last);
        let alone = |(parameters, state): &Body<M>| {
            let model = M::of(*parameters)?;
            let workspace = model.prepare(state, steps.h, steps.choice)?;
            Ok(Single {
                model,
                state: *state,
                workspace,
                before: *state,
            })
        };
        let begun = || {
            let model = Wide::<M, N>::of(gather(|i| body(i).0))?;
            // The condition is constant, so only one branch is compiled.
            let moving = if M::SIDE_BY_SIDE {
                let state = gather(|i| M::at_node(body(i).1, 0));
                let workspace = model.prepare(&state, Lanes([steps.h; N]), steps.choice)?;
                BodyStates::Lanes {
                    state,
                    workspace,
                    begun: from_fn(|i| M::node(&body(i).1)),
                }
            } else {
                BodyStates::Alone(
                    bodies
                        .iter()
                        .map(alone)
                        .collect::<Result<_, StartError>>()?,
                )
            };
            Ok(Self { model, moving })
        };
        Some(begun().map_err(|cause| {
            ensemble_error(bodies.iter().map(|b| alone(b).map(|_| ())), first, cause)
        }))
    }

    /// Steps of all bodies. After an error the states are unchanged.
    #[inline(always)]
    pub(super) fn advance(&mut self, count: u64) -> Result<(), StepError> {
        match &mut self.moving {
            BodyStates::Lanes {
                state, workspace, ..
            } if M::SIDE_BY_SIDE => {
                let mut moving = *state;
                self.model.advance_many(&mut moving, workspace, count)?;
                *state = moving;
                Ok(())
            }
            BodyStates::Lanes { .. } => Ok(()),
            BodyStates::Alone(bodies) => one_by_one(bodies, count),
        }
    }

    /// Finds the body among `bodies` bodies that causes `cause`, by stepping each body alone.
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
            let (parameters, mut state) = self.body(at).ok_or(cause)?;
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
        ensemble_error((0..bodies).map(alone), first, cause)
    }

    /// The model and the state in the lanes, for reading.
    pub(super) fn shown(&self) -> (&Wide<M, N>, <Wide<M, N> as Stepper>::State) {
        let state = match &self.moving {
            BodyStates::Lanes { state, .. } => *state,
            BodyStates::Alone(bodies) => gather(|i| {
                let last = bodies.len().saturating_sub(1);
                M::at_node(bodies[i.min(last)].state, 0)
            }),
        };
        (&self.model, state)
    }

    /// The body in a lane.
    pub(super) fn body(&self, at: usize) -> Option<Body<M>> {
        let state = match &self.moving {
            BodyStates::Lanes { state, begun, .. } => {
                let begun = begun.get(at).copied()?;
                let node = begun.saturating_add(Wide::<M, N>::node(state));
                M::at_node(lane::<M::State, N>(state, at), node)
            }
            BodyStates::Alone(bodies) => bodies.get(at)?.state,
        };
        Some((lane::<M::Parameters, N>(self.model.given(), at), state))
    }
}

/// Steps of each body. Not inlined, so that they are compiled once and not for each instruction set.
#[inline(never)]
fn one_by_one<M: Model<Scalar = f64>>(
    bodies: &mut [Single<M>],
    count: u64,
) -> Result<(), StepError> {
    for body in bodies.iter_mut() {
        body.before = body.state;
    }
    let made = bodies.iter_mut().try_for_each(|body| {
        let (model, state, workspace) = (&body.model, &mut body.state, &mut body.workspace);
        model.advance_many(state, workspace, count)
    });
    if made.is_err() {
        for body in bodies {
            body.state = body.before;
        }
    }
    made
}

/// The first body that fails alone and the number of such bodies; if none fails alone, the first body and the number
/// of all bodies.
fn ensemble_error<E>(
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
