//! The steps of one trajectory, plain or composed, selected at its start. Takes a model, a state and the settings;
//! advances the state.

use super::{Composition, Model, Offer, Reversible, Stepper, Way};
use crate::StepError;
use crate::card::{OpenError, Settings};
use crate::saved::{Saved, Words};
use crate::solvers::moser_veselov::Order;

/// The steps of one trajectory, with their workspaces.
#[derive(Clone, Debug)]
pub enum Steps<S: Stepper> {
    /// Each step is one step of the model.
    Plain(S::Workspace),
    /// Each step is one step of the model, with modified moments.
    Modified(S::Workspace),
    /// Several.
    Composed(Composition<S>),
}

impl<S: Stepper<Scalar = f64>> Steps<S> {
    /// Plain steps for any model; no other order is offered.
    ///
    /// # Errors
    /// For another order, a compensation, a step that is not positive, or a first step that cannot be made.
    pub fn plain(
        model: &S,
        state: &S::State,
        settings: Settings,
        orders: &'static [u32],
    ) -> Result<Self, OpenError> {
        Way::of(Offer::Plain, settings, orders)?;
        Ok(Self::Plain(model.workspace(state, settings.h)?))
    }

    /// One step, in place.
    ///
    /// # Errors
    /// When it cannot be solved; the state is then unchanged.
    pub fn step(&mut self, model: &S, state: &mut S::State) -> Result<(), StepError> {
        match self {
            Self::Plain(workspace) | Self::Modified(workspace) => model.advance(state, workspace),
            Self::Composed(composition) => composition.step(model, state),
        }
    }

    /// One step, in place, that calls `seen` after each of the model's own steps within it. `seen` receives the
    /// fraction of the whole step, and the state. Steps with modified moments do not call `seen`.
    ///
    /// # Errors
    /// As [`Steps::step`].
    pub fn step_in_parts(
        &mut self,
        model: &S,
        state: &mut S::State,
        mut seen: impl FnMut(f64, &S::State),
    ) -> Result<(), StepError> {
        match self {
            Self::Plain(workspace) => {
                model.advance(state, workspace)?;
                seen(1.0, state);
                Ok(())
            }
            Self::Modified(workspace) => model.advance(state, workspace),
            Self::Composed(composition) => composition.step_in_parts(model, state, seen),
        }
    }
}

impl<S: Stepper> Steps<S> {
    /// The workspace of steps that are not composed.
    #[must_use]
    pub fn workspace(&self) -> Option<&S::Workspace> {
        match self {
            Self::Plain(workspace) | Self::Modified(workspace) => Some(workspace),
            Self::Composed(_) => None,
        }
    }
}

impl<S: Stepper<Workspace: Saved>> Saved for Steps<S> {
    fn words(&mut self, words: &mut Words) {
        match self {
            Self::Plain(workspace) | Self::Modified(workspace) => workspace.words(words),
            Self::Composed(composition) => {
                composition
                    .workspaces_mut()
                    .for_each(|workspace| workspace.words(words));
            }
        }
    }
}

impl<S: Model<Scalar = f64, Choice = Order>> Steps<S> {
    /// Steps of the requested order; orders above two use modified moments.
    ///
    /// # Errors
    /// As [`Steps::plain`].
    pub fn modified(
        model: &S,
        state: &S::State,
        settings: Settings,
        orders: &'static [u32],
    ) -> Result<Self, OpenError> {
        let way = Way::of(Offer::Modified, settings, orders)?;
        let work = model.prepare(state, settings.h, way.moments())?;
        Ok(match way {
            Way::Modified(_, true) => Self::Modified(S::compensated(work)),
            Way::Modified(_, false) => Self::Modified(work),
            Way::Plain | Way::Composed(_) => Self::Plain(work),
        })
    }
}

impl<S: Reversible<Scalar = f64>> Steps<S> {
    /// Steps of the requested order.
    ///
    /// # Errors
    /// As [`Steps::plain`].
    pub fn of_order(
        model: &S,
        state: &S::State,
        settings: Settings,
        orders: &'static [u32],
    ) -> Result<Self, OpenError> {
        Ok(match Way::of(Offer::Composed, settings, orders)? {
            Way::Composed(order) => {
                Self::Composed(Composition::start(model, state, settings.h, order)?)
            }
            Way::Plain | Way::Modified(..) => Self::Plain(model.workspace(state, settings.h)?),
        })
    }
}
