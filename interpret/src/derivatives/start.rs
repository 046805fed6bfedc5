//! The start of a trajectory with derivatives: the model, the way of its steps and the initial state.

use super::coordinates::LocalForm;
use super::functions::Traceable;
use crate::composed::{Model, Part};
use crate::opened::{Opened, at};
use crate::packed::{self, Packed};
use crate::running::Begun;
use crate::value::Value;
use clebsch::card::{Card, Settings};
use clebsch::derivatives::NoDerivative;
use clebsch::integrate::{Offer, Way};
use std::ops::Range;

/// A model, its initial state, and how it is stepped.
#[derive(Clone)]
pub struct Started {
    pub opened: &'static Opened,
    pub traceable: &'static Traceable,
    pub model: Model,
    pub parameters: Value<f64>,
    /// The initial values, and how they are moved.
    pub initial: Value<f64>,
    pub forms: Vec<LocalForm>,
    /// The initial values among the observables, if all of them are.
    pub places: Result<Vec<Range<usize>>, NoDerivative>,
    pub state: Packed,
    pub h: f64,
    /// The share of each substep in the step size.
    pub factors: Vec<f64>,
    /// The choice that workspaces are prepared with.
    pub choice: Value<f64>,
}

impl Started {
    /// Starts from the same data as a trajectory.
    pub fn new(
        opened: &'static Opened,
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
        settings: Settings,
    ) -> Result<Self, NoDerivative> {
        let card = &opened.card;
        let way = Way::of(Offer::of(card), settings, card.orders)?;
        let Begun {
            mut places,
            parameters,
            initial,
            ..
        } = opened.begin(parameters, initial, settings)?;
        let mut taken = |at: usize| {
            places
                .get_mut(at)
                .map_or(Value::Unit, |value| std::mem::replace(value, Value::Unit))
        };
        let (model, state) = (taken(at::MODEL), taken(at::STATE));
        let packed = Packed::of(&state).ok_or_else(|| NoDerivative::TooLarge {
            numbers: packed::count(&state),
            most: packed::MOST,
        })?;
        let factors = match way {
            Way::Composed(order) => order.factors(),
            Way::Plain | Way::Modified(..) => vec![1.0],
        };
        let choice = match card.preprocessed {
            true => Value::Order(way.moments()),
            false => opened.usual(),
        };
        Ok(Started {
            opened,
            traceable: opened.traceable(),
            model: Model {
                opened,
                model,
                state,
            },
            parameters,
            initial,
            forms: LocalForm::of_fields(&opened.initial.1, card.initial),
            places: among_observables(card),
            state: packed,
            h: settings.h,
            factors,
            choice,
        })
    }

    /// The step sizes of the substeps, with workspaces for a step from this state.
    pub fn parts(&self, state: &Packed) -> Result<Vec<(f64, Part)>, NoDerivative> {
        let each = self.factors.iter().map(|factor| {
            let h = self.h * factor;
            let choice = self.choice.clone();
            let part = self.model.workspace_by(state, h, choice)?;
            Ok((h, part))
        });
        each.collect()
    }
}

/// Where the observables give the initial values.
fn among_observables(card: &'static Card) -> Result<Vec<Range<usize>>, NoDerivative> {
    let each = card.initial.iter().map(|field| {
        let mut first = 0;
        for seen in card.observables {
            if seen.name == field.name && seen.count() == field.count() {
                return Ok(first..first + seen.count());
            }
            first += seen.count();
        }
        Err(NoDerivative::Unseen { field: field.name })
    });
    each.collect()
}
