//! Equations that a step solves, as parts of a recording. A tape ends where Newton's method starts; the next tape
//! takes the solution as inputs.

use super::equations::{EquationValues, Equations, NewtonFunction, Recorded};
use super::form::value_of;
use super::function::run as run_alone;
use super::ready::Ready;
use super::traced::{Traced, aside, cut, has_derivatives, steps, with_newest_cut, with_some_cut};
use crate::code::{Code, Exit, Iterate, Places, unfit};
use crate::listing::{Section, numbered};
use crate::map_scalar::{map_scalar, numbers};
use crate::newton::{AtTrial, SearchValue, Solve, Sought, matrix, solution_value, vector};
use crate::opened::at;
use crate::value::{Struct, Value};
use clebsch::linalg::{Dense, Reals};
use clebsch::solvers::newton::{Chart, Solved};
use clebsch_program::{Guard, Part, Scalar, Tape};
use std::sync::Arc;

/// The end of a part of a recording.
#[derive(Clone, Debug)]
pub struct RecordingPause {
    /// The number of decisions recorded before it.
    pub guards: usize,
    /// The number of inputs before it.
    pub inputs: usize,
    /// The equations that Newton's method solves there.
    pub solved: SolvedHere,
}

impl RecordingPause {
    /// Whether two recordings have the same pause. Counts are not compared.
    pub fn agrees(&self, other: &RecordingPause) -> bool {
        let (own, others) = (&self.solved, &other.solved);
        let same = match (&own.equations, &others.equations) {
            (Some(a), Some(b)) => a.agrees(b),
            _ => false,
        };
        same && self.guards == other.guards
            && self.inputs == other.inputs
            && own.node == others.node
            && own.remembers == others.remembers
    }
}

/// Equations that a step solves.
#[derive(Clone, Debug)]
pub struct SolvedHere {
    with: Arc<Solve>,
    /// The functions that evaluate them.
    equations: Option<Recorded>,
    /// The node minus the first count of the state.
    node: i64,
    /// The numbers of the solution.
    solution: Vec<Scalar>,
    /// Whether the search stores the solution after the step.
    remembers: bool,
}

/// Newton's method over the recording scalar.
#[derive(Debug)]
pub struct RecordedSolve {
    with: Arc<Solve>,
    search: Code<Traced>,
    node: Code<Traced>,
    /// The functions of a trial, if they can be recorded.
    residual: Option<Code<Traced>>,
    tangent: Option<Code<Traced>>,
    at_rest: Option<Code<Traced>>,
    convex: Option<Code<Traced>>,
    /// The arguments of the separate residual, before the trial.
    known: Option<Vec<Code<Traced>>>,
}

impl RecordedSolve {
    /// Records these equations. Returns `None` if the search or the node is not at a place.
    pub fn of(with: Arc<Solve>) -> Option<Self> {
        let at_trial = |what: &AtTrial| what.body.map_scalar(Traced::constant);
        Some(RecordedSolve {
            residual: at_trial(&with.residual),
            tangent: at_trial(&with.tangent),
            at_rest: with.at_rest.map_scalar(Traced::constant),
            convex: with.convex.as_ref().and_then(at_trial),
            known: with
                .known
                .iter()
                .map(|code| code.map_scalar(Traced::constant))
                .collect(),
            search: with.search.map_scalar(Traced::constant)?,
            node: with.node.map_scalar(Traced::constant)?,
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
        let (mut own, mut around, mut computed) = (Vec::new(), Vec::new(), Vec::new());
        for (at, value) in places.iter().enumerate() {
            // A value that the equations cannot use is replaced by `Unit`.
            let seen = map_scalar(value, &mut Traced::seen).unwrap_or(Value::Unit);
            let mut all = Vec::new();
            if !matches!(seen, Value::Unit)
                && numbers(value, &mut all).is_some()
                && all.iter().any(|x| x.at().is_some())
            {
                computed.push(at);
                around.append(&mut all);
            }
            own.push(seen);
        }
        let mut seen = own.clone();
        let solved = held.solve(
            &self.with,
            node.unsigned_abs(),
            &mut EquationValues::Places(&mut seen),
        );
        let solved = unfit(solved.ok())?;
        let sought = held.sought();
        if has_derivatives() {
            return self.corrected(sought, &solved, places);
        }
        cut(SolvedHere {
            with: self.with.clone(),
            equations: None,
            node: node - first,
            solution: Vec::new(),
            remembers: false,
        });
        let values = sought.all().value(&solved.element);
        let element = unfit(map_scalar(&values, &mut Traced::input))?;
        let mut inputs = Vec::new();
        unfit(numbers(&element, &mut inputs))?;
        let (parts, of_trial) = unfit(self.parts(&element, &inputs, sought, places))?;
        let around = steps(&around);
        let solution = steps(&inputs);
        let noted = with_newest_cut(|cut| {
            cut.solved.solution = solution;
            cut.solved.equations = Some(Recorded {
                parts,
                inputs: cut.inputs,
                of_trial,
                places: own,
                computed,
                around,
            });
        });
        unfit(noted)?;
        // The tapes do not depend on how the solution was found.
        let told = solution_value(sought.all(), &solved);
        let Value::Struct(Struct { layout, .. }) = told else {
            return unfit(None);
        };
        Ok(Value::Struct(Struct {
            layout,
            values: vec![element, Value::Unit, Value::Unit],
        }))
    }
}

fn part(numbers: &[Traced], guards: Vec<Guard>) -> Part {
    let outputs = steps(numbers);
    Part { outputs, guards }
}

impl RecordedSolve {
    /// The solution after one more correction of Newton's method. The solution itself is an input; the correction is zero
    /// up to rounding, and its derivative is the derivative of the solution by the implicit function theorem.
    fn corrected(
        &self,
        sought: &Sought,
        solved: &Solved<Reals>,
        places: &Places<Traced>,
    ) -> Result<Value<Traced>, Exit<Traced>> {
        let found = sought.all().value(&solved.element);
        let Some(Value::List(found)) = map_scalar(&found, &mut Traced::input) else {
            return unfit(None);
        };
        let trial = sought.shape.part_of(&found);
        let size = sought.shape.parts().dimension();
        let wanted = |wanted| {
            let value = self.at_trial(wanted, Value::List(trial.clone()), places)?;
            wanted_numbers(wanted, value, [size; 2], false)
        };
        let residual = unfit(wanted(NewtonFunction::Residual))?;
        let mut tangent = unfit(wanted(NewtonFunction::Tangent))?;
        let unit = unfit(tangent.pop())?;
        let tangent = Dense {
            rows: size,
            cols: size,
            data: tangent,
        };
        let right = residual.iter().map(|x| -*x * unit).collect();
        let correction = unfit(tangent.solved(&Dense::column_of(right)))?.data;
        let from_left = self.with.from_left;
        let mut moved = unfit(sought.shape.moved(&trial, &correction, from_left))?;
        if self.with.completed_at.is_some() {
            // The residual also gives the whole trial.
            let both = self.at_trial(NewtonFunction::Residual, Value::List(moved), places);
            moved = match unfit(both)? {
                Value::List(both) => match both.into_iter().next() {
                    Some(Value::List(whole)) => whole,
                    _ => return unfit(None),
                },
                _ => return unfit(None),
            };
        }
        let told = solution_value(sought.all(), solved);
        let Value::Struct(Struct { layout, .. }) = told else {
            return unfit(None);
        };
        Ok(Value::Struct(Struct {
            layout,
            values: vec![Value::List(moved), Value::Unit, Value::Unit],
        }))
    }
}

/// The parts of a recording that evaluate equations, and which numbers of a solution a trial has.
type Parts = ([Option<Part>; 5], Vec<usize>);

impl RecordedSolve {
    /// The value of a function of Newton's method at a trial. Returns nothing for the residual alone.
    fn at_trial(
        &self,
        wanted: NewtonFunction,
        trial: Value<Traced>,
        places: &Places<Traced>,
    ) -> Option<Value<Traced>> {
        let (body, trial_at) = match wanted {
            NewtonFunction::Residual => (&self.residual, Some(self.with.residual.place)),
            NewtonFunction::Tangent => (&self.tangent, Some(self.with.tangent.place)),
            NewtonFunction::AtRest => (&self.at_rest, None),
            NewtonFunction::Convex => (&self.convex, Some(self.with.convex.as_ref()?.place)),
            NewtonFunction::Alone => return None,
        };
        let mut places = places.clone();
        if let Some(at) = trial_at {
            *places.get_mut(at)? = trial;
        }
        value_of(body.as_ref()?, &mut places)
    }

    /// Records what Newton's method evaluates at a trial, with the inputs of the solution as the trial.
    fn parts(
        &self,
        element: &Value<Traced>,
        inputs: &[Traced],
        sought: &Sought,
        places: &Places<Traced>,
    ) -> Option<Parts> {
        let Value::List(all) = element else {
            return None;
        };
        let trial = Value::List(sought.shape.part_of(all));
        let mut own = Vec::new();
        numbers(&trial, &mut own)?;
        let place = |x: &Traced| inputs.iter().position(|input| input.at() == x.at());
        let of_trial: Option<Vec<usize>> = own.iter().map(place).collect();
        let sizes = [&sought.shape, sought.all()].map(|shape| shape.parts().dimension());
        let in_part = self.with.completed_at.is_some();
        // Tests of a solution evaluate the residual alone only if a part of the unknowns lacks a scale.
        let is_asked_alone = !in_part && sought.shape.parts().open.contains(&true);
        let wanted = |wanted: NewtonFunction| {
            if wanted == NewtonFunction::Alone {
                return is_asked_alone
                    .then(|| self.alone(&trial, sizes, places))
                    .flatten();
            }
            let (numbers, guards) = aside(|| {
                let value = self.at_trial(wanted, trial.clone(), places)?;
                wanted_numbers(wanted, value, sizes, in_part)
            })?;
            Some(part(&numbers, guards))
        };
        Some((NewtonFunction::ALL.map(wanted), of_trial?))
    }

    /// The residual alone.
    fn alone(
        &self,
        trial: &Value<Traced>,
        [_, all]: [usize; 2],
        places: &Places<Traced>,
    ) -> Option<Part> {
        let residual = self.with.residual_at.traced()?;
        let (numbers, guards) = aside(|| {
            let mut places = places.clone();
            let known = self.known.as_ref()?.iter();
            let known = known.map(|code| code.run(&mut places).ok());
            let mut given: Vec<Value<Traced>> = known.collect::<Option<_>>()?;
            given.push(trial.clone());
            vector(&run_alone(residual, given)?, all)
        })?;
        Some(part(&numbers, guards))
    }
}

/// The numbers of a function of Newton's method, for `size` unknowns of `all` equations.
fn wanted_numbers(
    wanted: NewtonFunction,
    value: Value<Traced>,
    [size, all]: [usize; 2],
    in_part: bool,
) -> Option<Vec<Traced>> {
    match (wanted, value) {
        (NewtonFunction::Residual, Value::List(mut both)) => {
            let mut residual = vector(&both.pop()?, size)?;
            if in_part {
                numbers(&both.pop()?, &mut residual)?;
            }
            Some(residual)
        }
        (NewtonFunction::Tangent, Value::List(both)) => match both.as_slice() {
            [tangent, Value::Real(unit)] => {
                let mut data = matrix(tangent, size)?.data;
                data.push(*unit);
                Some(data)
            }
            _ => None,
        },
        (NewtonFunction::AtRest, value) => vector(&value, all),
        (NewtonFunction::Convex, Value::Bool(true)) => Some(Vec::new()),
        _ => None,
    }
}

/// `search.remember(node, &found)`: recorded, and executed after the whole step.
pub fn remember(
    places: &mut Places<Traced>,
    a: &[Code<Traced>],
) -> Result<Value<Traced>, Exit<Traced>> {
    if has_derivatives() {
        return Ok(Value::Unit);
    }
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
    // The state has advanced by one node.
    let node = node - (first - 1);
    let noted = with_some_cut(|cut| {
        let solved = &mut cut.solved;
        let solution = solved.solution.iter().map(|x| Some(*x));
        let is_own = node == solved.node && all.iter().map(|x| x.at()).eq(solution);
        is_own.then(|| solved.remembers = true)
    });
    unfit(noted)?;
    Ok(Value::Unit)
}

/// Equations that are solved between two tapes.
#[derive(Clone, Debug)]
pub struct SolveBetweenTapes {
    /// The tape before the equations.
    ready: Ready,
    equations: Equations,
    with: Arc<Solve>,
    node: i64,
    remembers: bool,
    /// The search before the step, with its measured scales.
    before: Option<SearchValue>,
    /// Whether this step has reached the equations.
    begun: bool,
    /// The newest solution.
    found: Reals,
}

/// The tapes before each pause, and the tape of the last part with this number of inputs. The first `steady` inputs are the
/// same in all steps.
pub fn in_parts(
    tape: Tape,
    inputs: usize,
    cuts: Vec<RecordingPause>,
    steady: usize,
) -> Option<(Vec<SolveBetweenTapes>, Ready)> {
    let mut decided = 0;
    let mut all = Vec::new();
    for cut in cuts {
        let SolvedHere {
            with,
            equations,
            node,
            solution,
            remembers,
        } = cut.solved;
        let guards = tape.guards.get(decided..cut.guards).unwrap_or_default();
        let (equations, given) = equations?.equations(&tape, solution.len(), steady);
        let before = Part {
            outputs: given,
            guards: guards.to_vec(),
        };
        decided = cut.guards;
        all.push(SolveBetweenTapes {
            ready: Ready::new(&tape.part(before), cut.inputs, steady),
            equations,
            with,
            node,
            remembers,
            before: None,
            begun: false,
            found: Reals::new(),
        });
    }
    let guards = tape.guards.get(decided..).unwrap_or_default().to_vec();
    let last = Ready::new(&Tape { guards, ..tape }, inputs, steady);
    Some((all, last))
}

/// The outcome of a step by tapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TapeOutcome {
    /// As recorded.
    On,
    /// A decision differs from the recorded one.
    Elsewhere,
    /// The equations were not solved.
    Unsolved,
}

impl SolveBetweenTapes {
    /// The tape before the equations and the functions of the equations as text, given the names of the steady numbers and
    /// of the inputs.
    pub fn sections(&self, names: &[String], inputs: &[String]) -> Vec<Section> {
        let outputs = numbered("given", self.ready.outputs());
        let title = "step, before its equations are solved";
        let mut all = self.ready.sections(title, names, inputs, &outputs);
        all.extend(self.equations.sections());
        all
    }

    /// Sets the numbers of the model and of the step size. Returns nothing if there are too few.
    pub fn begin(&mut self, steady: &[f64]) -> Option<()> {
        self.ready.begin(steady)?;
        self.equations.begin(steady)
    }

    /// The number of numbers of a solution.
    pub fn solution(&self) -> usize {
        self.found.len()
    }

    /// Computes what the equations need from `numbers`, solves them and appends their solution. `first` is the first count
    /// of the state; the search is among the `places`.
    pub fn solve(
        &mut self,
        own: &mut Vec<f64>,
        first: i64,
        places: &mut Places<f64>,
    ) -> TapeOutcome {
        self.begun = false;
        if !self.ready.computes(own) {
            return TapeOutcome::Elsewhere;
        }
        let given = own.get(..self.ready.inputs()).unwrap_or_default();
        self.equations.begin_step(given, self.ready.gives());
        let Some(Value::Search(held)) = self.with.search.place_mut(places) else {
            return TapeOutcome::Unsolved;
        };
        match &mut self.before {
            Some(before) => before.measure_as(held),
            None => self.before = Some(held.clone()),
        }
        self.begun = true;
        let node = (first + self.node).unsigned_abs();
        let around = &mut EquationValues::Tapes(&mut self.equations);
        let Ok(Solved { element, .. }) = held.solve(&self.with, node, around) else {
            return TapeOutcome::Unsolved;
        };
        own.extend_from_slice(&element);
        self.found = element;
        TapeOutcome::On
    }

    /// Restores the scales that the search had before the step, if the step has reached the equations.
    pub fn undo(&self, places: &mut Places<f64>) {
        if let (true, Some(before), Some(Value::Search(held))) =
            (self.begun, &self.before, self.with.search.place_mut(places))
        {
            held.measure_as(before);
        }
    }

    /// The step from the node `first` is complete: the search stores its solution.
    pub fn remember(&self, first: i64, places: &mut Places<f64>) {
        if self.remembers
            && let Some(Value::Search(held)) = self.with.search.place_mut(places)
        {
            held.remember((first + self.node).unsigned_abs(), &self.found);
        }
    }
}
