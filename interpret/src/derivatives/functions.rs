//! The functions of a model that are differentiated, over the recording scalar.

use super::coordinates::{LocalForm, moved_all};
use super::linear::Linear;
use crate::code::{Places, Routine};
use crate::map_scalar::{map_scalar, numbers};
use crate::opened::{Functions, at};
use crate::recorded::{Traced, record_with_derivatives, value_of};
use crate::value::Value;

/// The functions over the recording scalar. `None` for a function that cannot be recorded.
#[derive(Debug)]
pub struct Traceable {
    new: Option<Routine<Traced>>,
    begin: Option<Routine<Traced>>,
    prepared: Option<Routine<Traced>>,
    step: Option<Routine<Traced>>,
    observe: Option<Routine<Traced>>,
    invariants: Option<Routine<Traced>>,
    places: usize,
}

/// Where a function is recorded.
pub struct Around<'a> {
    pub model: &'a Value<f64>,
    pub h: f64,
    /// The choice that a workspace is prepared with.
    pub choice: &'a Value<f64>,
}

type Recorded = Option<Vec<Traced>>;

impl Traceable {
    /// The functions of a model, which need this number of places.
    pub fn of(functions: &Functions, places: usize) -> Self {
        let over = |routine: &Routine<f64>| routine.map_scalar(Traced::constant);
        Traceable {
            new: over(&functions.new),
            begin: over(&functions.begin),
            prepared: over(&functions.prepared),
            step: over(&functions.step),
            observe: over(&functions.observe),
            invariants: over(&functions.invariants),
            places,
        }
    }

    /// Places with the model and the step size as inputs, which come first.
    fn places(&self, around: &Around<'_>) -> Option<Places<Traced>> {
        let mut places = vec![Value::Unit; self.places];
        *places.get_mut(at::MODEL)? = map_scalar(around.model, &mut Traced::input)?;
        *places.get_mut(at::STEP)? = Value::Real(Traced::input(around.h));
        Some(places)
    }

    /// Records a function of a state.
    fn of_state(
        &self,
        around: &Around<'_>,
        state: &Value<f64>,
        then: impl FnOnce(&mut Places<Traced>) -> Recorded,
    ) -> Option<Linear> {
        let made = record_with_derivatives(|| {
            let mut places = self.places(around)?;
            *places.get_mut(at::STATE)? = map_scalar(state, &mut Traced::input)?;
            then(&mut places)
        })?;
        Some(Linear::new(made, steady(around)?))
    }

    /// The state after a step, as a function of the state before it. The solver starts without memory of other steps.
    pub fn step(&self, around: &Around<'_>, state: &Value<f64>) -> Option<Linear> {
        self.of_state(around, state, |places| {
            self.prepare(places, around)?;
            value_of(&self.step.as_ref()?.body, places)?;
            let mut out = Vec::new();
            numbers(places.get(at::STATE)?, &mut out)?;
            Some(out)
        })
    }

    /// The observables of a state.
    pub fn observed(&self, around: &Around<'_>, state: &Value<f64>) -> Option<Linear> {
        self.of_state(around, state, |places| {
            listed(self.observe.as_ref()?, places)
        })
    }

    /// The invariants of a state.
    pub fn invariants(&self, around: &Around<'_>, state: &Value<f64>) -> Option<Linear> {
        self.of_state(around, state, |places| {
            self.prepare(places, around)?;
            listed(self.invariants.as_ref()?, places)
        })
    }

    /// The state at local coordinates of initial values, as a function of the initial values and the coordinates.
    pub fn chart(
        &self,
        around: &Around<'_>,
        given: &Value<f64>,
        (forms, xi): (&[LocalForm], &[f64]),
    ) -> Option<Linear> {
        self.in_chart(around, (given, forms, xi), |places| {
            let mut out = Vec::new();
            numbers(places.get(at::STATE)?, &mut out)?;
            Some(out)
        })
    }

    /// The invariants at local coordinates of initial values.
    pub fn invariants_in_chart(
        &self,
        around: &Around<'_>,
        given: (&Value<f64>, &[LocalForm], &[f64]),
    ) -> Option<Linear> {
        self.in_chart(around, given, |places| {
            self.prepare(places, around)?;
            listed(self.invariants.as_ref()?, places)
        })
    }

    fn in_chart(
        &self,
        around: &Around<'_>,
        (given, forms, xi): (&Value<f64>, &[LocalForm], &[f64]),
        then: impl FnOnce(&mut Places<Traced>) -> Recorded,
    ) -> Option<Linear> {
        let made = record_with_derivatives(|| {
            let mut places = self.places(around)?;
            let own = map_scalar(given, &mut Traced::input)?;
            let xi: Vec<Traced> = xi.iter().map(|x| Traced::input(*x)).collect();
            *places.get_mut(at::GIVEN)? = moved_all(&own, forms, &xi)?;
            let state = value_of(&self.begin.as_ref()?.body, &mut places)?;
            *places.get_mut(at::STATE)? = state;
            then(&mut places)
        })?;
        Some(Linear::new(made, steady(around)?))
    }

    /// The numbers of the model and then of the initial state, as functions of parameters and initial values.
    pub fn start(&self, parameters: &Value<f64>, initial: &Value<f64>) -> Option<Linear> {
        let made = record_with_derivatives(|| {
            let mut places = vec![Value::Unit; self.places];
            *places.get_mut(at::GIVEN)? = map_scalar(parameters, &mut Traced::input)?;
            let model = value_of(&self.new.as_ref()?.body, &mut places)?;
            let mut out = Vec::new();
            numbers(&model, &mut out)?;
            *places.get_mut(at::MODEL)? = model;
            *places.get_mut(at::GIVEN)? = map_scalar(initial, &mut Traced::input)?;
            let state = value_of(&self.begin.as_ref()?.body, &mut places)?;
            numbers(&state, &mut out)?;
            Some(out)
        })?;
        Some(Linear::new(made, 0))
    }

    /// Prepares the workspace of the state in the places.
    fn prepare(&self, places: &mut Places<Traced>, around: &Around<'_>) -> Option<()> {
        let state = places.get(at::STATE)?.clone();
        *places.get_mut(at::GIVEN)? = map_scalar(around.choice, &mut Traced::constant)?;
        let work = value_of(&self.prepared.as_ref()?.body, places)?;
        *places.get_mut(at::STATE)? = state;
        *places.get_mut(at::WORK)? = work;
        Some(())
    }
}

/// The number of inputs that are the same in all steps.
fn steady(around: &Around<'_>) -> Option<usize> {
    let mut all = Vec::new();
    numbers(around.model, &mut all)?;
    Some(all.len() + 1)
}

/// The numbers that an observer of the state appends to a list.
fn listed(routine: &Routine<Traced>, places: &mut Places<Traced>) -> Recorded {
    *places.get_mut(at::OUT)? = Value::List(Vec::new());
    value_of(&routine.body, places)?;
    let Value::List(list) = places.get(at::OUT)? else {
        return None;
    };
    let each = list.iter().map(|x| match x {
        Value::Real(x) => Some(*x),
        _ => None,
    });
    each.collect()
}
