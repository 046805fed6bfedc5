//! Equations that a step solves on its way, as parts of a recording. A tape ends where Newton's method begins; the next one
//! takes the solution as inputs.

use super::traced::{Traced, cut, model, with_newest_cut};
use crate::code::{Code, Exit, Iterate, Places, unfit};
use crate::newton::{Held, Solve, remember as remembered};
use crate::opened::at;
use crate::over::{fill, numbers, over};
use crate::value::Value;
use clebsch_program::{Frame, Guard, Machine, Scalar, Tape};
use std::sync::Arc;

/// Where a recording ends for a while.
#[derive(Clone, Debug)]
pub struct Cut {
    /// What the part before computes for the equations.
    pub outputs: Vec<Scalar>,
    /// How many decisions were noted before.
    pub guards: usize,
    /// How many inputs there were before.
    pub inputs: usize,
    /// What is solved.
    pub solved: SolvedHere,
}

impl Cut {
    /// Whether two recordings have the same cut. Counts enter neither.
    pub fn agrees(&self, other: &Cut) -> bool {
        self.outputs == other.outputs
            && self.guards == other.guards
            && self.inputs == other.inputs
            && self.solved.node == other.solved.node
            && self.solved.remembers == other.solved.remembers
    }
}

/// Equations among the places of a step.
#[derive(Clone, Debug)]
pub struct SolvedHere {
    with: Arc<Solve>,
    /// The places as they were, for all that is not computed.
    places: Places<f64>,
    /// The places whose numbers are computed.
    computed: Vec<usize>,
    /// How far the node is from the first count of the state.
    node: i64,
    /// The numbers of the solution.
    solution: Vec<Scalar>,
    /// Whether the search remembers the solution once the step is made.
    remembers: bool,
}

/// Newton's method over the scalar that records.
#[derive(Debug)]
pub struct RecordedSolve {
    with: Arc<Solve>,
    search: Code<Traced>,
    node: Code<Traced>,
}

impl RecordedSolve {
    /// The same equations; nothing if the search or the node is not found by places alone.
    pub fn of(with: Arc<Solve>) -> Option<Self> {
        Some(RecordedSolve {
            search: with.search.over(Traced::constant)?,
            node: with.node.over(Traced::constant)?,
            with,
        })
    }
}

fn count(value: &Value<Traced>) -> Option<i64> {
    match value {
        Value::Int(n) => Some(*n),
        _ => None,
    }
}

/// The first count of the state: its node.
fn first_count(places: &Places<Traced>) -> Option<i64> {
    let mut all = Vec::new();
    super::counts::counts(places.get(at::STATE)?, &mut all);
    all.first().copied()
}

impl Iterate<Traced> for RecordedSolve {
    fn run(&self, places: &mut Places<Traced>) -> Result<Value<Traced>, Exit<Traced>> {
        let node = unfit(count(&self.node.run(places)?))?;
        let first = unfit(first_count(places))?;
        let Some(Value::Search(held)) = self.search.place(places) else {
            return unfit(None);
        };
        let mut held = held.clone();
        let (mut own, mut outputs, mut computed) = (Vec::new(), Vec::new(), Vec::new());
        for (at, value) in places.iter().enumerate() {
            // What the equations could not use is not among the places.
            let seen = over(value, &mut Traced::seen).unwrap_or(Value::Unit);
            let mut all = Vec::new();
            if !matches!(seen, Value::Unit)
                && numbers(value, &mut all).is_some()
                && all.iter().any(|x| x.at().is_some())
            {
                computed.push(at);
                outputs.append(&mut all);
            }
            own.push(seen);
        }
        *unfit(own.get_mut(at::MODEL))? = unfit(model())?;
        let solved = held.solve(&self.with, node.unsigned_abs(), &mut own.clone());
        let Ok(Value::Struct(mut solved)) = solved else {
            return unfit(None);
        };
        let element = unfit(solved.values.first().cloned())?;
        // Nothing is computed from how the solution was found.
        solved
            .values
            .iter_mut()
            .skip(1)
            .for_each(|x| *x = Value::Unit);
        cut(
            &outputs,
            SolvedHere {
                with: self.with.clone(),
                places: own,
                computed,
                node: node - first,
                solution: Vec::new(),
                remembers: false,
            },
        );
        let element = unfit(over(&element, &mut Traced::input))?;
        let mut all = Vec::new();
        unfit(numbers(&element, &mut all))?;
        let steps: Option<Vec<Scalar>> = all.iter().map(|x| x.at()).collect();
        let steps = unfit(steps)?;
        unfit(with_newest_cut(|cut| cut.solved.solution = steps))?;
        let mut solved = unfit(over(&Value::Struct(solved), &mut Traced::constant))?;
        if let Value::Struct(s) = &mut solved {
            *unfit(s.values.first_mut())? = element;
        }
        Ok(solved)
    }
}

/// `search.remember(node, &found)`: noted, and done when the whole step is made.
pub fn remember(
    places: &mut Places<Traced>,
    a: &[Code<Traced>],
) -> Result<Value<Traced>, Exit<Traced>> {
    let [_, node, found] = a else {
        return unfit(None);
    };
    let (node, found) = (node.run(places)?, found.run(places)?);
    let Value::Struct(found) = &found else {
        return unfit(None);
    };
    let mut all = Vec::new();
    unfit(numbers(unfit(found.values.first())?, &mut all))?;
    let (node, first) = (unfit(count(&node))?, unfit(first_count(places))?);
    // The state has gone on by one node.
    let node = node - (first - 1);
    let is_noted = with_newest_cut(|cut| {
        let solved = &mut cut.solved;
        let is_solution = all
            .iter()
            .map(|x| x.at())
            .eq(solved.solution.iter().map(|x| Some(*x)));
        solved.remembers |= is_solution;
        is_solution && node == solved.node
    });
    unfit(is_noted.filter(|noted| *noted))?;
    Ok(Value::Unit)
}

/// Equations that are solved between two tapes.
#[derive(Debug)]
pub struct Between {
    machine: Machine,
    frame: Frame<1>,
    solved: SolvedHere,
    /// What the search had measured before the step.
    before: Option<Held>,
    /// Whether this step has come to the equations.
    begun: bool,
    /// The newest solution.
    found: Value<f64>,
}

/// The part of a tape that computes other outputs, by the decisions of `guards`.
fn part(tape: &Tape, outputs: &[Scalar], guards: &[Guard]) -> Tape {
    Tape {
        guards: guards.to_vec(),
        outputs: outputs.to_vec(),
        ..tape.clone()
    }
}

/// The tapes before each cut, and the tape of the last part.
pub fn in_parts(tape: Tape, cuts: Vec<Cut>) -> (Vec<Between>, Tape) {
    let mut decided = 0;
    let mut all = Vec::new();
    for cut in cuts {
        let guards = tape.guards.get(decided..cut.guards).unwrap_or_default();
        let machine = Machine::new(&part(&tape, &cut.outputs, guards), cut.inputs);
        decided = cut.guards;
        all.push(Between {
            frame: machine.frame(),
            machine,
            solved: cut.solved,
            before: None,
            begun: false,
            found: Value::Unit,
        });
    }
    let guards = tape.guards.get(decided..).unwrap_or_default();
    let last = part(&tape, &tape.outputs, guards);
    (all, last)
}

/// How a step by tapes went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Went {
    /// As recorded.
    On,
    /// A decision came out otherwise.
    Elsewhere,
    /// The equations were not solved.
    Unsolved,
}

impl Between {
    /// Computes what the equations need from `numbers`, solves them and appends their solution. `first` is the first count
    /// of the state; the search is among the `places`.
    pub fn solve(&mut self, own: &mut Vec<f64>, first: i64, places: &mut Places<f64>) -> Went {
        self.begun = false;
        let loaded = own.get(..self.machine.inputs());
        let loaded = loaded.and_then(|own| super::load(self.frame.inputs(), own));
        if loaded.is_none() || !self.machine.run(&mut self.frame) {
            return Went::Elsewhere;
        }
        let solved = &mut self.solved;
        let mut given = self.machine.gives(&self.frame, 0);
        for at in &solved.computed {
            if let Some(value) = solved.places.get_mut(*at) {
                fill(value, &mut given);
            }
        }
        let Some(Value::Search(held)) = solved.with.search.place_mut(places) else {
            return Went::Unsolved;
        };
        match &mut self.before {
            Some(before) => before.measure_as(held),
            None => self.before = Some(held.clone()),
        }
        self.begun = true;
        let node = (first + solved.node).unsigned_abs();
        let Ok(found) = held.solve(&solved.with, node, &mut solved.places) else {
            return Went::Unsolved;
        };
        let element = match &found {
            Value::Struct(found) => found.values.first(),
            _ => None,
        };
        let noted = element.and_then(|x| numbers(x, own));
        self.found = found;
        match noted {
            Some(()) => Went::On,
            None => Went::Unsolved,
        }
    }

    /// Gives the search back what it had measured before the step, if the step has come to the equations.
    pub fn undo(&self, places: &mut Places<f64>) {
        if let (true, Some(before), Some(Value::Search(held))) = (
            self.begun,
            &self.before,
            self.solved.with.search.place_mut(places),
        ) {
            held.measure_as(before);
        }
    }

    /// The step from the node `first` is made: the search remembers its solution.
    pub fn remember(&self, first: i64, places: &mut Places<f64>) {
        let node = Value::Int(first + self.solved.node);
        if self.solved.remembers
            && let Some(search) = self.solved.with.search.place_mut(places)
        {
            let _ = remembered(search, &node, &self.found);
        }
    }
}
