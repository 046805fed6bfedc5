//! A part of a function, such as the residual at a trial, as tapes. Values around it enter as numbers.

use super::ask::{Asker, Fixed, From};
use super::form::{Form, stands};
use super::kept::{Pool, Tapes};
use super::traced::record;
use crate::code::{Code, Evaluated, Places, unfit};
use crate::over::{alike, numbers, over};
use crate::value::Value;
use clebsch_program::{Frame, Machine};
use std::sync::OnceLock;

/// A tape with the places of its inputs.
#[derive(Debug)]
struct Tape {
    machine: Machine,
    /// Paths around, each with its first input and how many it has.
    around: Vec<(Code<f64>, usize, usize)>,
    /// The argument, for its kind, and its first input.
    takes: Value<f64>,
    argument: usize,
    fixed: Fixed,
    gives: Value<f64>,
    frames: Pool<Frame<1>>,
}

/// Operations on one argument, given its place, and on other places.
#[derive(Debug)]
pub struct PlaceFunction {
    argument: usize,
    body: Code<f64>,
    form: OnceLock<Option<Form>>,
    tapes: Tapes<Tape>,
}

impl PlaceFunction {
    /// Nothing recorded yet.
    pub fn new(argument: usize, body: Code<f64>) -> Self {
        PlaceFunction {
            argument,
            body,
            form: OnceLock::new(),
            tapes: Tapes::new(),
        }
    }

    /// The value at an argument.
    ///
    /// # Errors
    /// As the operations have.
    pub fn at(&self, argument: &Value<f64>, places: &mut Places<f64>) -> Evaluated<f64> {
        if let Some(value) = self.by_tape(argument, places) {
            return Ok(value);
        }
        *unfit(places.get_mut(self.argument))? = argument.clone();
        self.body.returned(places)
    }

    fn by_tape(&self, argument: &Value<f64>, places: &Places<f64>) -> Option<Value<f64>> {
        let mut own = Vec::new();
        numbers(argument, &mut own)?;
        self.tapes.compute(
            |tape| tape.at(argument, &own, places),
            || self.recorded(argument, places),
        )
    }

    fn recorded(&self, argument: &Value<f64>, places: &Places<f64>) -> Option<Tape> {
        let form = self
            .form
            .get_or_init(|| Form::of(&[self.argument], &self.body))
            .as_ref()?;
        let mut asker = Asker::new(0);
        let mut gives = None;
        let (tape, inputs) = record(|| {
            let mut own = form.places(&mut asker, places)?;
            *own.get_mut(self.argument)? = asker.read(From::Argument, argument)?;
            let value = form.run(&mut own)?;
            gives = over(&value, &mut |_| 0.0);
            let mut outputs = Vec::new();
            numbers(&value, &mut outputs)?;
            Some(outputs)
        })?;
        let machine = Machine::new(&tape, inputs);
        let (reads, fixed) = asker.told();
        let mut made = Tape {
            machine,
            around: Vec::new(),
            takes: argument.clone(),
            argument: 0,
            fixed,
            gives: gives?,
            frames: Pool::new(),
        };
        for read in reads {
            match read.from {
                From::Argument => made.argument = read.first,
                From::Around(path) => {
                    let mut inputs = read.first..read.first + read.count;
                    if inputs.any(|input| made.machine.reads(input)) {
                        made.around.push((path, read.first, read.count));
                    }
                }
                From::Of(..) => return None,
            }
        }
        Some(made)
    }
}

impl Tape {
    /// The value at an argument of these numbers; nothing for another kind of argument, or other values around.
    fn at(&self, argument: &Value<f64>, own: &[f64], places: &Places<f64>) -> Option<Value<f64>> {
        if !alike(argument, &self.takes) || !stands(&self.fixed, places) {
            return None;
        }
        self.frames.with(
            || self.machine.frame(),
            |frame| self.in_frame(own, places, frame),
        )
    }

    fn in_frame(
        &self,
        argument: &[f64],
        places: &Places<f64>,
        frame: &mut Frame<1>,
    ) -> Option<Value<f64>> {
        let mut own = Vec::new();
        for (path, first, count) in &self.around {
            own.clear();
            numbers(path.place(places)?, &mut own)?;
            super::load(frame.inputs().get_mut(*first..*first + *count)?, &own)?;
        }
        let inputs = frame.inputs();
        let to = self.argument..self.argument + argument.len();
        super::load(inputs.get_mut(to)?, argument)?;
        if !self.machine.run(frame) {
            return None;
        }
        let mut made = self.machine.gives(frame, 0);
        over(&self.gives, &mut |x| made.next().unwrap_or(x))
    }
}
