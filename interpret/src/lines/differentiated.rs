//! Derivatives of models with loops over sites.

use super::card::Carded;
use super::{LineModel, LineTrajectory, Unstarted, columns, numbers};
use crate::code::{Places, Routine};
use crate::derivatives::{
    self, Begun, Coordinates, LocalForm, Source, Stepping, TracedFunctions, dimension, filled,
};
use crate::opened::at;
use crate::recorded::{Traced, value_of};
use crate::running::{put, run, take};
use crate::value::Value;
use clebsch::StepError;
use clebsch::card::{Card, Settings};
use clebsch::derivatives::{NoDerivative, Point};
use clebsch::integrate::{Offer, Way, counted};
use clebsch::line::Stamp;
use clebsch_core::expr::symbol::ascii;
use std::sync::Arc;

type Perhaps = Option<Routine<Traced>>;

/// The functions over the recording scalar. `None` for a function that cannot be recorded.
#[derive(Debug)]
pub struct TracedLine {
    places: usize,
    new: Perhaps,
    start: Perhaps,
    workspace: Perhaps,
    step: Perhaps,
    energies: Perhaps,
    /// By the name of the invariant.
    totals: Vec<(String, Perhaps)>,
    /// In the order of [`LineModel::observers`].
    observers: Vec<Perhaps>,
    /// The index of the observer, the site and the number of components, for each observable of the card.
    order: Vec<(usize, usize, usize)>,
    /// The names of the invariants of the card.
    invariants: Vec<&'static str>,
}

impl TracedLine {
    fn of(carded: &Carded) -> Self {
        let model = &carded.model;
        let over = |routine: &Routine<f64>| routine.map_scalar(Traced::constant);
        let observers = model.observers.iter().chain(&model.functionals);
        let order = carded.order().into_iter().zip(carded.card.observables);
        TracedLine {
            places: model.places,
            new: over(&model.new),
            start: over(&model.start),
            workspace: over(&model.workspace),
            step: over(&model.step),
            energies: model.energies.as_ref().and_then(over),
            totals: model
                .totals
                .iter()
                .map(|(name, routine)| (name.clone(), over(routine)))
                .collect(),
            observers: observers.map(|(_, routine)| over(routine)).collect(),
            order: order
                .map(|((observer, site), field)| (observer, site, field.count()))
                .collect(),
            invariants: carded.card.invariants.iter().map(|i| i.name).collect(),
        }
    }
}

fn valued(routine: &Perhaps, places: &mut Places<Traced>) -> Option<Value<Traced>> {
    value_of(&routine.as_ref()?.body, places)
}

impl TracedFunctions for TracedLine {
    fn places(&self) -> Places<Traced> {
        vec![Value::Unit; self.places]
    }

    fn model(
        &self,
        parameters: Value<Traced>,
        places: &mut Places<Traced>,
    ) -> Option<Value<Traced>> {
        let Value::List(both) = parameters else {
            return None;
        };
        for (value, at) in both.into_iter().zip([at::GIVEN, at::OUT]) {
            *places.get_mut(at)? = value;
        }
        valued(&self.new, places)
    }

    fn begin(&self, given: Value<Traced>, places: &mut Places<Traced>) -> Option<Value<Traced>> {
        *places.get_mut(at::GIVEN)? = given;
        match valued(&self.start, places)? {
            Value::List(both) => both.into_iter().next(),
            _ => None,
        }
    }

    fn prepare(&self, _choice: &Value<f64>, places: &mut Places<Traced>) -> Option<()> {
        let state = places.get(at::STATE)?.clone();
        let work = valued(&self.workspace, places)?;
        *places.get_mut(at::STATE)? = state;
        *places.get_mut(at::WORK)? = work;
        Some(())
    }

    fn step(&self, places: &mut Places<Traced>) -> Option<()> {
        valued(&self.step, places)?;
        Some(())
    }

    fn observe(&self, places: &mut Places<Traced>) -> Option<Vec<Traced>> {
        let mut all = Vec::new();
        for observer in &self.observers {
            let value = valued(observer, places);
            let value = value.and_then(|value| columns(&value).or_else(|| numbers(&value)));
            all.push(value);
        }
        let mut out = Vec::new();
        for (observer, site, size) in &self.order {
            match all.get(*observer)? {
                Some(own) => out.extend_from_slice(own.get(site * size..(site + 1) * size)?),
                // Functionals of all sites are not recorded.
                None => out.extend(vec![Traced::constant(f64::NAN); *size]),
            }
        }
        Some(out)
    }

    fn invariants(&self, places: &mut Places<Traced>) -> Option<Vec<Traced>> {
        let mut out = Vec::new();
        for name in &self.invariants {
            if *name == "energy" {
                let Value::List(both) = valued(&self.energies, places)? else {
                    return None;
                };
                let [Value::Real(kinetic), Value::Real(potential)] = both.as_slice() else {
                    return None;
                };
                out.push(*kinetic + *potential);
                continue;
            }
            let (_, routine) = self.totals.iter().find(|(own, _)| own == name)?;
            out.extend(numbers(&valued(routine, places)?)?);
        }
        Some(out)
    }
}

/// Steps of a chain.
struct LineSteps {
    line: LineTrajectory,
    /// The numbers of the state of the chain.
    now: Vec<f64>,
}

impl LineSteps {
    fn read(&mut self) {
        self.now.clear();
        if let Some(state) = self.line.places.get(at::STATE) {
            // States contain only numbers.
            let _ = derivatives::numbers(state, &mut self.now);
        }
    }
}

impl Stepping for LineSteps {
    fn advance(&mut self, state: &mut Point) -> Result<Option<Vec<f64>>, StepError> {
        let model = self.line.model.clone();
        if state.numbers != self.now || state.node != self.line.node() {
            let own = self.line.places.get(at::STATE);
            if let Some(next) = own.and_then(|own| filled(own, &state.numbers)) {
                let next = model.at_node(next, state.node);
                put(&mut self.line.places, at::STATE, next);
            }
        }
        let made = self.line.step();
        made.map_err(|e| super::running::cause(e).at_node(state.node))?;
        self.read();
        state.numbers.clone_from(&self.now);
        state.node = self.line.node();
        Ok(None)
    }
}

impl LineModel {
    /// A state with the number of its node, which no workspace knows.
    fn at_node(&self, mut state: Value<f64>, node: u64) -> Value<f64> {
        self.set_node(&mut state, node);
        if let Value::Struct(s) = &mut state
            && let Some(stamp) = s.field_mut(self.stamp)
        {
            *stamp = Value::Stamp(Stamp::fresh());
        }
        state
    }

    fn set_node(&self, state: &mut Value<f64>, node: u64) {
        if let Value::Struct(s) = state
            && let Some(Value::Int(own)) = s.field_mut(self.node)
        {
            *own = i64::try_from(node).unwrap_or(i64::MAX);
        }
    }

    /// The model and its state in places, for steps of size `h`.
    fn in_places(&self, model: &Value<f64>, h: f64) -> Places<f64> {
        let mut places = vec![Value::Unit; self.places];
        put(&mut places, at::MODEL, model.clone());
        put(&mut places, at::STEP, Value::Real(h));
        places
    }
}

impl Source for Carded {
    fn card(&'static self) -> &'static Card {
        &self.card
    }

    fn functions(&'static self) -> &'static dyn TracedFunctions {
        self.traced.get_or_init(|| TracedLine::of(self))
    }

    fn begin(
        &'static self,
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
        settings: Settings,
    ) -> Result<Begun, NoDerivative> {
        let card = &self.card;
        counted(card, parameters, initial)?;
        if !self.model.coordinates.is_empty() {
            return Err(NoDerivative::InCoordinates);
        }
        let h = match Way::of(Offer::of(card), settings, card.orders)? {
            Way::Composed(order) => order
                .factors()
                .first()
                .map_or(settings.h, |f| settings.h * f),
            Way::Plain | Way::Modified(..) => settings.h,
        };
        self.read(parameters, initial, |numbers| {
            let started = self.model.start(&self.choice, h, numbers);
            let mut started = started.map_err(|e| self.refused(e))?;
            let model = take(&mut started.places, at::MODEL);
            let state = take(&mut started.places, at::STATE);
            let given = self.model.parameter_values(&self.choice, numbers);
            let initial = self.model.initial.value(numbers, &|_| None);
            Ok(Begun {
                model,
                state,
                parameters: Value::List(given.map_err(|e| self.refused(e))?.into()),
                initial: initial.map_err(|e| self.refused(e))?,
            })
        })
    }

    fn parameter_value(&self, lists: &[Vec<f64>]) -> Option<Value<f64>> {
        self.read(lists, &[], |numbers| {
            let both = self.model.parameter_values(&self.choice, numbers).ok()?;
            Some(Value::List(both.into()))
        })
    }

    fn initial_value(
        &self,
        parameters: &[Vec<f64>],
        lists: &[Vec<f64>],
    ) -> Result<Value<f64>, NoDerivative> {
        // Ends may prescribe quantities by parameters.
        self.read(parameters, lists, |numbers| {
            let given = self.model.initial.value(numbers, &|_| None);
            Ok(given.map_err(|e| self.refused(e))?)
        })
    }

    fn coordinates(&self, initial: &Value<f64>) -> Result<Coordinates, NoDerivative> {
        let Value::Struct(s) = initial else {
            return Err(NoDerivative::InCoordinates);
        };
        let mut fields = Vec::new();
        let mut first = 0;
        for ((name, is_element), value) in self.model.initial.names().zip(&s.values) {
            let form = match is_element {
                true => LocalForm::Element,
                false => LocalForm::Entries,
            };
            let sites = match value {
                Value::Sites(column) => column.len(),
                _ => 1,
            };
            let all = dimension(value, form);
            fields.push((ascii(name), form, first, all / sites.max(1)));
            first += all;
        }
        let (mut dimensions, mut order) = (Vec::new(), Vec::new());
        for place in &self.initial {
            let own = fields.iter().find(|(name, ..)| *name == place.key);
            let (_, _, first, of_site) = own.ok_or(NoDerivative::InCoordinates)?;
            let from = first + place.site.unwrap_or(0) * of_site;
            order.extend(from..from + of_site);
            dimensions.push(*of_site);
        }
        Ok(Coordinates {
            forms: fields.into_iter().map(|(_, form, ..)| form).collect(),
            dimensions,
            order,
        })
    }

    fn state(
        &self,
        model: &Value<f64>,
        given: Value<f64>,
        h: f64,
    ) -> Result<Value<f64>, NoDerivative> {
        let mut places = self.model.in_places(model, h);
        put(&mut places, at::GIVEN, given);
        match run(&self.model.start, &mut places)
            .map_err(|e| self.refused(Unstarted::Line(e.line())))?
        {
            Value::List(both) => Ok(both.into_iter().next().unwrap_or(Value::Unit)),
            _ => Ok(Value::Unit),
        }
    }

    fn set_node(&self, state: &mut Value<f64>, node: u64) {
        self.model.set_node(state, node);
    }

    fn choice(&self, _way: Way) -> Value<f64> {
        Value::Unit
    }

    fn stepping(
        &'static self,
        begun: &Begun,
        state: &Point,
        h: f64,
        _choice: &Value<f64>,
    ) -> Result<Box<dyn Stepping>, NoDerivative> {
        let model: &Arc<LineModel> = &self.model;
        let mut places = model.in_places(&begun.model, h);
        let own = filled(&begun.state, &state.numbers);
        let own = own.ok_or(NoDerivative::Unrecorded { what: "the state" })?;
        let own = model.at_node(own, state.node);
        put(&mut places, at::STATE, own.clone());
        let work = run(&model.workspace, &mut places)
            .map_err(|e| self.refused(Unstarted::Line(e.line())))?;
        put(&mut places, at::STATE, own);
        put(&mut places, at::WORK, work);
        let line = LineTrajectory {
            model: model.clone(),
            places,
            h,
            composed: None,
        };
        let mut steps = LineSteps {
            line,
            now: Vec::new(),
        };
        steps.read();
        Ok(Box::new(steps))
    }
}
