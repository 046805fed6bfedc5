//! Recordings of the functions of a model with their derivatives.

use super::coordinates::moved_all;
use super::linear::Linear;
use super::source::{Source, TracedFunctions};
use super::start::Started;
use super::values::{count, map, numbers};
use crate::code::Places;
use crate::opened::at;
use crate::recorded::{Traced, record_with_derivatives};
use crate::value::Value;

type Recorded = Option<Vec<Traced>>;

impl Started {
    fn functions(&self) -> &'static dyn TracedFunctions {
        self.source.functions()
    }

    /// Places with the model and the step size as inputs, which come first.
    fn places(&self, h: f64) -> Option<Places<Traced>> {
        let mut places = self.functions().places();
        *places.get_mut(at::MODEL)? = map(&self.begun.model, &mut Traced::input)?;
        *places.get_mut(at::STEP)? = Value::Real(Traced::input(h));
        Some(places)
    }

    /// The number of inputs that are the same in all steps.
    fn steady(&self) -> usize {
        count(&self.begun.model) + 1
    }

    /// Records a function of a state, for steps of size `h`.
    fn of_state(
        &self,
        h: f64,
        state: &Value<f64>,
        then: impl FnOnce(&mut Places<Traced>) -> Recorded,
    ) -> Option<Linear> {
        let made = record_with_derivatives(self.steady(), || {
            let mut places = self.places(h)?;
            *places.get_mut(at::STATE)? = map(state, &mut Traced::input)?;
            then(&mut places)
        })?;
        Some(Linear::new(made, self.steady()))
    }

    /// The state after a step, as a function of the state before it. The solver starts without memory of other steps.
    pub fn record_step(&self, h: f64, state: &Value<f64>) -> Option<Linear> {
        self.of_state(h, state, |places| {
            self.functions().prepare(&self.choice, places)?;
            self.functions().step(places)?;
            let mut out = Vec::new();
            numbers(places.get(at::STATE)?, &mut out)?;
            Some(out)
        })
    }

    /// The observables of a state.
    pub fn record_observables(&self, state: &Value<f64>) -> Option<Linear> {
        self.of_state(self.h, state, |places| self.functions().observe(places))
    }

    /// The invariants of a state.
    pub fn record_invariants(&self, state: &Value<f64>) -> Option<Linear> {
        self.of_state(self.h, state, |places| {
            self.functions().prepare(&self.choice, places)?;
            self.functions().invariants(places)
        })
    }

    /// The state at local coordinates of initial values, as a function of the initial values and the coordinates.
    pub fn record_chart(&self, given: &Value<f64>, xi: &[f64]) -> Option<Linear> {
        self.in_chart(given, xi, |places| {
            let mut out = Vec::new();
            numbers(places.get(at::STATE)?, &mut out)?;
            Some(out)
        })
    }

    /// The invariants at local coordinates of initial values.
    pub fn record_invariants_in_chart(&self, given: &Value<f64>, xi: &[f64]) -> Option<Linear> {
        self.in_chart(given, xi, |places| {
            self.functions().prepare(&self.choice, places)?;
            self.functions().invariants(places)
        })
    }

    fn in_chart(
        &self,
        given: &Value<f64>,
        xi: &[f64],
        then: impl FnOnce(&mut Places<Traced>) -> Recorded,
    ) -> Option<Linear> {
        let made = record_with_derivatives(self.steady(), || {
            let mut places = self.places(self.h)?;
            let own = map(given, &mut Traced::input)?;
            let xi: Vec<Traced> = xi.iter().map(|x| Traced::input(*x)).collect();
            let moved = moved_all(&own, &self.coordinates, &xi)?;
            let state = self.functions().begin(moved, &mut places)?;
            *places.get_mut(at::STATE)? = state;
            then(&mut places)
        })?;
        Some(Linear::new(made, self.steady()))
    }

    /// The numbers of the model and then of the initial state, as functions of parameters and initial values.
    pub fn record_start(&self) -> Option<Linear> {
        let made = record_with_derivatives(0, || {
            let mut places = self.functions().places();
            let parameters = map(&self.begun.parameters, &mut Traced::input)?;
            let model = self.functions().model(parameters, &mut places)?;
            let mut out = Vec::new();
            numbers(&model, &mut out)?;
            *places.get_mut(at::MODEL)? = model;
            *places.get_mut(at::STEP)? = Value::Real(Traced::constant(self.h));
            let initial = map(&self.begun.initial, &mut Traced::input)?;
            let state = self.functions().begin(initial, &mut places)?;
            numbers(&state, &mut out)?;
            Some(out)
        })?;
        Some(Linear::new(made, 0))
    }
}

/// The list of each parameter of the card, from derivatives with respect to the numbers of the parameters. Returns nothing if the
/// numbers of the card cannot be followed to the model.
pub fn by_parameter(source: &'static dyn Source, pulled: &[f64]) -> Option<Vec<Vec<f64>>> {
    // Each number of the card is replaced by its index, which shows where the model reads it.
    let (mut next, mut lists) = (0.0, Vec::new());
    for field in source.card().parameters {
        let list: Vec<f64> = (0..field.count())
            .map(|_| {
                next += 1.0;
                next
            })
            .collect();
        lists.push(list);
    }
    let mut read = Vec::new();
    numbers(&source.parameter_value(&lists)?, &mut read)?;
    let mut all = vec![0.0; next as usize];
    for (index, derivative) in read.iter().zip(pulled) {
        if *index >= 1.0
            && let Some(sum) = all.get_mut(*index as usize - 1)
        {
            *sum += derivative;
        }
    }
    let mut rest = all.as_slice();
    let each = source.card().parameters.iter().map(|field| {
        let (own, others) = rest.split_at(field.count().min(rest.len()));
        rest = others;
        own.to_vec()
    });
    Some(each.collect())
}
