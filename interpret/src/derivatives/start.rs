//! The start of a trajectory with derivatives: the model, the way of its steps and the initial state.

use super::source::{Begun, Coordinates, Source, Stepping};
use super::values::numbers;
use crate::value::Value;
use clebsch::card::{Card, Settings};
use clebsch::derivatives::{NoDerivative, Point};
use clebsch::integrate::{Offer, Way};
use std::ops::Range;

/// The step size of a substep, with its workspace.
pub type Substep = (f64, Box<dyn Stepping>);

/// A model, its initial state, and how it is stepped.
#[derive(Clone)]
pub struct Started {
    pub source: &'static dyn Source,
    pub begun: Begun,
    /// The parameters, one list for each field of the card.
    pub lists: Vec<Vec<f64>>,
    pub coordinates: Coordinates,
    /// The initial values among the observables, if all of them are.
    pub places: Result<Vec<Range<usize>>, NoDerivative>,
    pub state: Point,
    pub h: f64,
    /// The share of each substep in the step size.
    pub factors: Vec<f64>,
    /// The choice that workspaces are prepared with.
    pub choice: Value<f64>,
}

impl Started {
    /// Starts from the same data as a trajectory.
    pub fn new(
        source: &'static dyn Source,
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
        settings: Settings,
    ) -> Result<Self, NoDerivative> {
        let card = source.card();
        let way = Way::of(Offer::of(card), settings, card.orders)?;
        let begun = source.begin(parameters, initial, settings)?;
        let mut all = Vec::new();
        let counted = numbers(&begun.state, &mut all);
        counted.ok_or(NoDerivative::Unrecorded { what: "the state" })?;
        let factors = match way {
            Way::Composed(order) => order.factors(),
            Way::Plain | Way::Modified(..) => vec![1.0],
        };
        Ok(Started {
            source,
            coordinates: source.coordinates(&begun.initial)?,
            begun,
            lists: parameters.to_vec(),
            places: among_observables(card),
            state: Point {
                numbers: all,
                node: 0,
            },
            h: settings.h,
            factors,
            choice: source.choice(way),
        })
    }

    /// The step sizes of the substeps, with workspaces for a step from this state.
    pub fn parts(&self, state: &Point) -> Result<Vec<Substep>, NoDerivative> {
        let each = self.factors.iter().map(|factor| {
            let h = self.h * factor;
            let part = self.source.stepping(&self.begun, state, h, &self.choice)?;
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
