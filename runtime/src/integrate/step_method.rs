//! Selects how a trajectory takes its steps, from the settings and the orders that a model offers. Compiled models
//! and models read from their text use the same selection. Takes the settings; gives the method, or an error that
//! lists the available orders.

use super::CompositionOrder;
use crate::card::{Card, OpenError, Settings};
use crate::solvers::moser_veselov::Order;
use crate::validate;

/// The steps that a model offers besides its plain steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Offer {
    /// None.
    Plain,
    /// Its plain steps with modified moments.
    Modified,
    /// Compositions of its plain steps.
    Composed,
}

impl Offer {
    /// The offer of a model with this card.
    #[must_use]
    pub fn of(card: &Card) -> Self {
        match (card.preprocessed, card.orders.len() > 1) {
            (true, _) => Self::Modified,
            (false, true) => Self::Composed,
            (false, false) => Self::Plain,
        }
    }
}

/// How steps are taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// Each step is one step of the model.
    Plain,
    /// Each step is one step of the model with moments modified for this order, with or without compensation.
    Modified(Order, bool),
    /// Several of the model, to this order.
    Composed(CompositionOrder),
}

impl Way {
    /// The kind of steps that the settings request, for a model with these orders.
    ///
    /// # Errors
    /// [`OpenError`] for an order that is not offered, a compensation where there is none, or a step that is
    /// not positive.
    pub fn of(offer: Offer, settings: Settings, orders: &'static [u32]) -> Result<Self, OpenError> {
        let composed = settings.order.and_then(CompositionOrder::of_number);
        let way = match (offer, composed) {
            (Offer::Modified, _) => {
                let order = modified(settings, orders)?;
                match order {
                    Order::Two => Self::Plain,
                    _ => Self::Modified(order, settings.compensated),
                }
            }
            (Offer::Composed, Some(order)) => {
                uncompensated(settings, orders)?;
                Self::Composed(order)
            }
            _ => {
                if let Some(asked) = settings.order.filter(|o| orders.first() != Some(o)) {
                    return Err(OpenError::Order {
                        asked,
                        offered: orders,
                    });
                }
                uncompensated(settings, orders)?;
                Self::Plain
            }
        };
        validate::positive_step(settings.h)?;
        Ok(way)
    }

    /// The order of the moments.
    #[must_use]
    pub fn moments(self) -> Order {
        match self {
            Self::Modified(order, _) => order,
            Self::Plain | Self::Composed(_) => Order::Two,
        }
    }
}

/// The requested order of modified moments.
fn modified(settings: Settings, orders: &'static [u32]) -> Result<Order, OpenError> {
    let asked = settings.order.unwrap_or(2);
    let order = Order::of_number(asked).ok_or(OpenError::Order {
        asked,
        offered: orders,
    })?;
    match settings.compensated && !Settings::COMPENSATED.contains(&asked) {
        true => Err(OpenError::Compensation {
            order: asked,
            preprocessed: true,
        }),
        false => Ok(order),
    }
}

/// Plain and composed steps are not compensated.
fn uncompensated(settings: Settings, orders: &'static [u32]) -> Result<(), OpenError> {
    match settings.compensated {
        false => Ok(()),
        true => Err(OpenError::Compensation {
            order: settings.order.or(orders.first().copied()).unwrap_or(2),
            preprocessed: false,
        }),
    }
}

/// Whether there are as many values as a card has fields.
///
/// # Errors
/// [`OpenError::Count`] where there are not.
pub fn counted(
    card: &Card,
    parameters: &[Vec<f64>],
    initial: &[Vec<f64>],
) -> Result<(), OpenError> {
    for (field, expected, found) in [
        ("parameters", card.parameters.len(), parameters.len()),
        ("initial values", card.initial.len(), initial.len()),
    ] {
        if expected != found {
            return Err(OpenError::Count {
                field,
                expected,
                found,
            });
        }
    }
    Ok(())
}
