//! Derivatives of models without loops over sites.

use super::coordinates::{LocalForm, dimensions};
use super::source::{Begun, Coordinates, Source, Stepping, TracedFunctions};
use super::values::{map, set_node};
use crate::code::{Places, Routine};
use crate::composed::{Model, Part};
use crate::failure::Failure;
use crate::opened::{Opened, at};
use crate::packed::{self, Packed};
use crate::recorded::{Recordable, Traced, Watched, value_of};
use crate::running::{self, put, run, take};
use crate::value::Value;
use clebsch::StepError;
use clebsch::card::{Card, Settings};
use clebsch::derivatives::{NoDerivative, Point};
use clebsch::integrate::Way;

/// The functions over the recording scalar. `None` for a function that cannot be recorded.
#[derive(Debug)]
pub struct TracedBody {
    new: Option<Routine<Traced>>,
    begin: Option<Routine<Traced>>,
    prepared: Option<Routine<Traced>>,
    /// The step and the observers.
    recordable: &'static Recordable,
    places: usize,
}

impl TracedBody {
    /// The functions of a model.
    pub fn of(opened: &'static Opened) -> Self {
        let over = |routine: &Routine<f64>| routine.map_scalar(Traced::constant);
        TracedBody {
            new: over(&opened.functions.new),
            begin: over(&opened.functions.begin),
            prepared: over(&opened.functions.prepared),
            recordable: opened.recordable(),
            places: opened.places,
        }
    }
}

/// Runs a function with a value in a place.
fn with(
    routine: Option<&Routine<Traced>>,
    (at, value): (usize, Value<Traced>),
    places: &mut Places<Traced>,
) -> Option<Value<Traced>> {
    *places.get_mut(at)? = value;
    value_of(&routine?.body, places)
}

impl TracedFunctions for TracedBody {
    fn places(&self) -> Places<Traced> {
        vec![Value::Unit; self.places]
    }

    fn model(
        &self,
        parameters: Value<Traced>,
        places: &mut Places<Traced>,
    ) -> Option<Value<Traced>> {
        with(self.new.as_ref(), (at::GIVEN, parameters), places)
    }

    fn begin(&self, given: Value<Traced>, places: &mut Places<Traced>) -> Option<Value<Traced>> {
        with(self.begin.as_ref(), (at::GIVEN, given), places)
    }

    fn prepare(&self, choice: &Value<f64>, places: &mut Places<Traced>) -> Option<()> {
        let state = places.get(at::STATE)?.clone();
        let choice = map(choice, &mut Traced::constant)?;
        let work = with(self.prepared.as_ref(), (at::GIVEN, choice), places)?;
        *places.get_mut(at::STATE)? = state;
        *places.get_mut(at::WORK)? = work;
        Some(())
    }

    fn step(&self, places: &mut Places<Traced>) -> Option<()> {
        self.recordable.traced_step(places)
    }

    fn observe(&self, places: &mut Places<Traced>) -> Option<Vec<Traced>> {
        self.recordable.traced_watch(Watched::Observables, places)
    }

    fn invariants(&self, places: &mut Places<Traced>) -> Option<Vec<Traced>> {
        self.recordable.traced_watch(Watched::Invariants, places)
    }
}

/// A step of a body.
struct BodySteps {
    model: Model,
    part: Part,
}

impl Stepping for BodySteps {
    fn advance(&mut self, state: &mut Point) -> Result<Option<Vec<f64>>, StepError> {
        // The workspace exists only for states that fit.
        let Some(mut packed) = Packed::of_numbers(&state.numbers, state.node) else {
            return Ok(None);
        };
        let solutions = self.part.advance(&self.model, &mut packed)?;
        state.numbers.clear();
        state.numbers.extend_from_slice(packed.numbers());
        state.node = packed.node;
        Ok(solutions.map(<[f64]>::to_vec))
    }
}

impl Source for Opened {
    fn card(&'static self) -> &'static Card {
        &self.card
    }

    fn functions(&'static self) -> &'static dyn TracedFunctions {
        self.traced()
    }

    fn begin(
        &'static self,
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
        settings: Settings,
    ) -> Result<Begun, NoDerivative> {
        let running::Begun {
            mut places,
            parameters,
            initial,
            ..
        } = Opened::begin(self, parameters, initial, settings)?;
        let model = take(&mut places, at::MODEL);
        let state = take(&mut places, at::STATE);
        if Packed::of(&state).is_none() {
            return Err(NoDerivative::TooLarge {
                numbers: super::values::count(&state),
                most: packed::MOST,
            });
        }
        Ok(Begun {
            model,
            state,
            parameters,
            initial,
        })
    }

    fn parameter_value(&self, lists: &[Vec<f64>]) -> Option<Value<f64>> {
        running::collected(&self.parameters, self.card.parameters, lists).ok()
    }

    fn initial_value(
        &self,
        _parameters: &[Vec<f64>],
        lists: &[Vec<f64>],
    ) -> Result<Value<f64>, NoDerivative> {
        Ok(self.initial_values(lists)?)
    }

    fn coordinates(&self, initial: &Value<f64>) -> Result<Coordinates, NoDerivative> {
        let forms = LocalForm::of_fields(&self.initial.1, self.card.initial);
        let dimensions = dimensions(initial, &forms);
        Ok(Coordinates {
            order: (0..dimensions.iter().sum()).collect(),
            forms,
            dimensions,
        })
    }

    fn state(
        &self,
        model: &Value<f64>,
        given: Value<f64>,
        _h: f64,
    ) -> Result<Value<f64>, NoDerivative> {
        let mut places = self.places(model.clone());
        put(&mut places, at::GIVEN, given);
        Ok(run(&self.functions.begin, &mut places).map_err(Failure::start)?)
    }

    fn set_node(&self, state: &mut Value<f64>, node: u64) {
        set_node(state, node);
    }

    fn choice(&self, way: Way) -> Value<f64> {
        match self.card.preprocessed {
            true => Value::Order(way.moments()),
            false => self.usual(),
        }
    }

    fn stepping(
        &'static self,
        begun: &Begun,
        state: &Point,
        h: f64,
        choice: &Value<f64>,
    ) -> Result<Box<dyn Stepping>, NoDerivative> {
        let model = Model {
            opened: self,
            model: begun.model.clone(),
            state: begun.state.clone(),
        };
        let too_large = NoDerivative::TooLarge {
            numbers: state.numbers.len(),
            most: packed::MOST,
        };
        let packed = Packed::of_numbers(&state.numbers, state.node).ok_or(too_large)?;
        let part = model.workspace_by(&packed, h, choice.clone())?;
        Ok(Box::new(BodySteps { model, part }))
    }
}
