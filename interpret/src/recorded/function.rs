//! A function of numbers, recorded when it is first called. It depends on its arguments alone.

use super::traced::{Traced, record};
use crate::code::{Exit, Routine};
use crate::over::{numbers, over};
use crate::value::Value;
use clebsch::Real;
use clebsch_program::Machine;
use std::sync::{Arc, OnceLock, PoisonError, RwLock};

/// Most tapes of a function: where decisions come out in more ways than these, it is run itself.
pub(super) const MOST: usize = 8;

/// A tape, and the value whose numbers it computes.
#[derive(Debug)]
struct Tape {
    machine: Machine,
    gives: Value<f64>,
}

/// A function and its tapes.
#[derive(Debug)]
pub struct Function {
    plain: Routine<f64>,
    traced: OnceLock<Option<Routine<Traced>>>,
    /// The newest last; as many as were tried.
    tapes: RwLock<Vec<Option<Arc<Tape>>>>,
}

impl Function {
    /// Nothing recorded yet.
    pub fn new(plain: Routine<f64>) -> Self {
        Function {
            plain,
            traced: OnceLock::new(),
            tapes: RwLock::default(),
        }
    }

    /// The value at these arguments; nothing where it has none.
    pub fn at(&self, given: &[&Value<f64>]) -> Option<Value<f64>> {
        let mut all = Vec::new();
        if given
            .iter()
            .try_for_each(|x| numbers(x, &mut all))
            .is_some()
        {
            let tapes = self.tapes.read().unwrap_or_else(PoisonError::into_inner);
            let known = tapes.iter().rev().flatten();
            if let Some(found) = known.into_iter().find_map(|tape| tape.at(&all)) {
                return Some(found);
            }
            let tried = tapes.len();
            drop(tapes);
            if tried < MOST
                && let Some(found) = self.recorded(given, &all)
            {
                return Some(found);
            }
        }
        run(&self.plain, given.iter().map(|x| (*x).clone()).collect())
    }

    /// The same by a tape that is made.
    fn recorded(&self, given: &[&Value<f64>], all: &[f64]) -> Option<Value<f64>> {
        let traced = self
            .traced
            .get_or_init(|| self.plain.over(Traced::constant));
        let made = traced.as_ref().and_then(|traced| tape_of(traced, given));
        let made = made.map(Arc::new);
        let mut tapes = self.tapes.write().unwrap_or_else(PoisonError::into_inner);
        tapes.push(made.clone());
        drop(tapes);
        made?.at(all)
    }
}

fn tape_of(traced: &Routine<Traced>, given: &[&Value<f64>]) -> Option<Tape> {
    let mut gives = None;
    let (tape, inputs) = record(|| {
        let mut places = Vec::with_capacity(traced.places);
        for value in given {
            places.push(over(value, &mut Traced::input)?);
        }
        let found = run(traced, places)?;
        gives = over(&found, &mut |_| 0.0);
        let mut out = Vec::new();
        numbers(&found, &mut out)?;
        Some(out)
    })?;
    Some(Tape {
        machine: Machine::new(&tape, inputs),
        gives: gives?,
    })
}

impl Tape {
    fn at(&self, all: &[f64]) -> Option<Value<f64>> {
        let mut frame = self.machine.frame::<1>();
        let fits = self.machine.inputs() == all.len();
        let loaded = super::load(frame.inputs().get_mut(..all.len())?, all);
        if !fits || loaded.is_none() || !self.machine.run(&mut frame) {
            return None;
        }
        let mut made = self.machine.gives(&frame, 0);
        over(&self.gives, &mut |x| made.next().unwrap_or(x))
    }
}

/// Runs a function with places of its own.
pub fn run<T: Real>(routine: &Routine<T>, given: Vec<Value<T>>) -> Option<Value<T>> {
    let mut places = given;
    places.resize(routine.places.max(places.len()), Value::Unit);
    match routine.body.run(&mut places) {
        Ok(value) => Some(value),
        Err(Exit::Return(value)) => Some(*value),
        Err(Exit::Unfit(_)) => None,
    }
}
