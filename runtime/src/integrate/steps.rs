//! The steps of one trajectory, plain or composed, chosen when it is started.
//! Takes a model, a state and the settings; advances the state.

use super::{Composition, CompositionOrder, Model, Reversible, Stepper};
use crate::card::{OpenError, Settings};
use crate::solvers::moser_veselov::Order;
use crate::{StepError, validate};

/// The order of modified moments that the settings ask for; an error where there is none, or it is to be
/// compensated and cannot be.
///
/// # Errors
/// [`OpenError::Order`] and [`OpenError::Compensation`].
pub fn preprocessing_order(settings: Settings, orders: &'static [u32]) -> Result<Order, OpenError> {
    let asked = settings.order.unwrap_or(2);
    let order = Order::of_number(asked).ok_or(OpenError::Order {
        asked,
        offered: orders,
    })?;
    if settings.compensated && !Settings::COMPENSATED.contains(&asked) {
        return Err(OpenError::Compensation {
            order: asked,
            preprocessed: true,
        });
    }
    Ok(order)
}

/// Plain and composed steps are not compensated.
///
/// # Errors
/// [`OpenError::Compensation`] where that is asked for.
pub fn uncompensated(settings: Settings, orders: &'static [u32]) -> Result<(), OpenError> {
    match settings.compensated {
        false => Ok(()),
        true => Err(OpenError::Compensation {
            order: settings.order.or(orders.first().copied()).unwrap_or(2),
            preprocessed: false,
        }),
    }
}

/// What makes the steps of one trajectory.
#[derive(Clone, Debug)]
pub enum Steps<S: Stepper> {
    /// One step of the model each.
    Plain(S::Workspace),
    /// One step of the model each, with modified moments.
    Modified(S::Workspace),
    /// Several.
    Composed(Composition<S>),
}

impl<S: Stepper<Scalar = f64>> Steps<S> {
    /// Plain steps, whatever the model; no other order is offered.
    ///
    /// # Errors
    /// For another order, a compensation, a step that is not positive, or a first step that cannot be made.
    pub fn plain(
        model: &S,
        state: &S::State,
        settings: Settings,
        orders: &'static [u32],
    ) -> Result<Self, OpenError> {
        if let Some(asked) = settings.order.filter(|o| orders.first() != Some(o)) {
            return Err(OpenError::Order {
                asked,
                offered: orders,
            });
        }
        uncompensated(settings, orders)?;
        validate::positive_step(settings.h)?;
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
}

impl<S: Stepper> Steps<S> {
    /// Whether each is a step of the derivation as it stands.
    #[must_use]
    pub fn are_plain(&self) -> bool {
        matches!(self, Self::Plain(_))
    }

    /// The workspace of steps that are not composed.
    #[must_use]
    pub fn workspace(&self) -> Option<&S::Workspace> {
        match self {
            Self::Plain(workspace) | Self::Modified(workspace) => Some(workspace),
            Self::Composed(_) => None,
        }
    }
}

impl<S: Model<Scalar = f64, Choice = Order>> Steps<S> {
    /// Steps of the order asked for, above two with modified moments.
    ///
    /// # Errors
    /// As [`Steps::plain`].
    pub fn modified(
        model: &S,
        state: &S::State,
        settings: Settings,
        orders: &'static [u32],
    ) -> Result<Self, OpenError> {
        let order = preprocessing_order(settings, orders)?;
        validate::positive_step(settings.h)?;
        let work = model.prepare(state, settings.h, order)?;
        Ok(match (order, settings.compensated) {
            (Order::Two, _) => Self::Plain(work),
            (_, true) => Self::Modified(S::compensated(work)),
            (_, false) => Self::Modified(work),
        })
    }
}

impl<S: Reversible<Scalar = f64>> Steps<S> {
    /// Steps of the order asked for.
    ///
    /// # Errors
    /// As [`Steps::plain`].
    pub fn of_order(
        model: &S,
        state: &S::State,
        settings: Settings,
        orders: &'static [u32],
    ) -> Result<Self, OpenError> {
        let composed = settings.order.and_then(CompositionOrder::of_number);
        let Some(order) = composed else {
            return Self::plain(model, state, settings, orders);
        };
        uncompensated(settings, orders)?;
        validate::positive_step(settings.h)?;
        let composition = Composition::start(model, state, settings.h, order)?;
        Ok(Self::Composed(composition))
    }
}
