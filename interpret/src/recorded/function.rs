//! A function of numbers, recorded when it is first called. It depends only on its arguments.

use super::form::value_of;
use super::tape_storage::{Pool, Tapes};
use super::traced::{Traced, record};
use crate::code::Routine;
use crate::map_scalar::{alike, map_scalar, numbers};
use crate::value::Value;
use clebsch::Real;
use clebsch_program::{Frame, Machine};
use std::sync::OnceLock;

/// A tape, the kinds of its arguments, and the value whose numbers it computes.
#[derive(Debug)]
struct Tape {
    machine: Machine,
    takes: Vec<Value<f64>>,
    gives: Value<f64>,
    frames: Pool<Frame<1>>,
}

/// A function and its tapes.
#[derive(Debug)]
pub struct Function {
    plain: Routine<f64>,
    traced: OnceLock<Option<Routine<Traced>>>,
    tapes: Tapes<Tape>,
}

impl Function {
    /// An empty record.
    pub fn new(plain: Routine<f64>) -> Self {
        Function {
            plain,
            traced: OnceLock::new(),
            tapes: Tapes::new(),
        }
    }

    /// The value at these arguments, if it exists.
    pub fn at(&self, given: &[&Value<f64>]) -> Option<Value<f64>> {
        let by_tape = self.by_tape(given);
        by_tape.or_else(|| run(&self.plain, given.iter().map(|x| (*x).clone()).collect()))
    }

    fn by_tape(&self, given: &[&Value<f64>]) -> Option<Value<f64>> {
        let mut all = Vec::new();
        given.iter().try_for_each(|x| numbers(x, &mut all))?;
        let computes = |tape: &Tape| tape.at(given, &all);
        self.tapes.compute(computes, || self.recorded(given))
    }

    /// The function over the recording scalar, if it can be recorded.
    pub fn traced(&self) -> Option<&Routine<Traced>> {
        let traced = || self.plain.map_scalar(Traced::constant);
        self.traced.get_or_init(traced).as_ref()
    }

    fn recorded(&self, given: &[&Value<f64>]) -> Option<Tape> {
        let traced = self.traced()?;
        let mut gives = None;
        let (tape, inputs) = record(|| {
            let inputs = given
                .iter()
                .map(|value| map_scalar(value, &mut Traced::input));
            let mut places: Vec<Value<Traced>> = inputs.collect::<Option<_>>()?;
            places.resize(traced.places.max(places.len()), Value::Unit);
            let found = value_of(&traced.body, &mut places)?;
            gives = map_scalar(&found, &mut |_| 0.0);
            let mut out = Vec::new();
            numbers(&found, &mut out)?;
            Some(out)
        })?;
        Some(Tape {
            machine: Machine::new(&tape, inputs),
            takes: given.iter().map(|x| (*x).clone()).collect(),
            gives: gives?,
            frames: Pool::new(),
        })
    }
}

impl Tape {
    /// The value at arguments of these numbers. Returns nothing for arguments of other kinds.
    fn at(&self, given: &[&Value<f64>], all: &[f64]) -> Option<Value<f64>> {
        let same = given.len() == self.takes.len()
            && given.iter().zip(&self.takes).all(|(a, b)| alike(a, b));
        if !same {
            return None;
        }
        self.frames.with(
            || self.machine.frame(),
            |frame| {
                super::load(frame.inputs(), all)?;
                if !self.machine.run(frame) {
                    return None;
                }
                let mut made = self.machine.gives(frame, 0);
                map_scalar(&self.gives, &mut |x| made.next().unwrap_or(x))
            },
        )
    }
}

/// Runs a function with places of its own.
pub fn run<T: Real>(routine: &Routine<T>, given: Vec<Value<T>>) -> Option<Value<T>> {
    let mut places = given;
    places.resize(routine.places.max(places.len()), Value::Unit);
    routine.body.returned(&mut places).ok()
}
