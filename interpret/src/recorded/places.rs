//! A part of a function, such as the residual at a trial, as tapes. Values around it enter as numbers.

use super::ask::{Asker, Fixed, From};
use super::form::{Form, stands};
use super::function::MOST;
use super::traced::record;
use crate::code::{Code, Evaluated, Exit, Places, unfit};
use crate::over::{numbers, over};
use crate::value::Value;
use clebsch_program::{Frame, Machine};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, RwLock};

/// A tape with the places of its inputs.
#[derive(Debug)]
struct Tape {
    machine: Machine,
    /// Paths around, each with its first input and how many it has.
    around: Vec<(Code<f64>, usize, usize)>,
    /// The first input of the argument.
    argument: usize,
    fixed: Fixed,
    gives: Value<f64>,
    frames: Mutex<Vec<Frame<1>>>,
}

/// Operations on one argument, given its place, and on other places.
#[derive(Debug)]
pub struct PlaceFunction {
    argument: usize,
    body: Code<f64>,
    form: OnceLock<Option<Form>>,
    /// The newest last; as many as were tried.
    tapes: RwLock<Vec<Option<Arc<Tape>>>>,
}

impl PlaceFunction {
    /// Nothing recorded yet.
    pub fn new(argument: usize, body: Code<f64>) -> Self {
        PlaceFunction {
            argument,
            body,
            form: OnceLock::new(),
            tapes: RwLock::default(),
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
        match self.body.run(places) {
            Err(Exit::Return(value)) => Ok(*value),
            other => other,
        }
    }

    fn by_tape(&self, argument: &Value<f64>, places: &Places<f64>) -> Option<Value<f64>> {
        let mut own = Vec::new();
        numbers(argument, &mut own)?;
        let tapes = self.tapes.read().unwrap_or_else(PoisonError::into_inner);
        let mut known = tapes.iter().rev().flatten();
        if let Some(value) = known.find_map(|tape| tape.at(&own, places)) {
            return Some(value);
        }
        let tried = tapes.len();
        drop(tapes);
        if tried == MOST {
            return None;
        }
        let made = self.recorded(argument, places).map(Arc::new);
        let mut tapes = self.tapes.write().unwrap_or_else(PoisonError::into_inner);
        tapes.push(made.clone());
        drop(tapes);
        made?.at(&own, places)
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
            argument: 0,
            fixed,
            gives: gives?,
            frames: Mutex::default(),
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
    fn at(&self, argument: &[f64], places: &Places<f64>) -> Option<Value<f64>> {
        if !stands(&self.fixed, places) {
            return None;
        }
        let mut pool = self.frames.lock().unwrap_or_else(PoisonError::into_inner);
        let frame = pool.pop();
        drop(pool);
        let mut frame = frame.unwrap_or_else(|| self.machine.frame());
        let value = self.in_frame(argument, places, &mut frame);
        self.frames
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(frame);
        value
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
