//! The functions of a trajectory as tapes: its step, and what a run evaluates at nodes.

use super::counts::{Choice, Chosen, counts, each_count, grow, growth, uncounted};
use super::decision_tree::{Node, OutcomeTape, TapesByOutcome};
use super::form::value_of;
use super::shared::{Kinds, SharedTapes};
use super::solves::{RecordingPause, in_parts};
use super::traced::{Traced, record_with_solves};
use crate::code::{Places, Routine};
use crate::listing::{FieldNames, Section};
use crate::map_scalar::{alike, fill, map_scalar, numbers};
use crate::opened::{Functions, at};
use crate::packed::Packed;
use crate::value::Value;
use clebsch_program::Tape;
use std::sync::Arc;

/// The functions that are recorded, with their tapes for all trajectories.
#[derive(Debug)]
pub struct Recordable {
    step: Option<SharedTapes>,
    watched: [Option<SharedTapes>; 3],
    places: usize,
}

/// The functions that a run evaluates at a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Watched {
    /// The observables.
    Observables,
    /// The invariants.
    Invariants,
    /// Their scales.
    Scales,
}

impl Recordable {
    /// The functions of a model over the scalar that records.
    pub fn of(functions: &Functions, places: usize) -> Self {
        let over = |routine: &Routine<f64>| {
            let traced = routine.map_scalar(Traced::constant);
            traced.map(SharedTapes::new)
        };
        Recordable {
            step: over(&functions.step),
            watched: [
                over(&functions.observe),
                over(&functions.invariants),
                over(&functions.scales),
            ],
            places,
        }
    }

    /// Takes a step within a recording, from the state and the workspace in the places.
    pub fn traced_step(&self, places: &mut Places<Traced>) -> Option<()> {
        value_of(&self.step.as_ref()?.routine.body, places)?;
        Some(())
    }

    /// The numbers of an observer of the state, within a recording.
    pub fn traced_watch(&self, which: Watched, places: &mut Places<Traced>) -> Option<Vec<Traced>> {
        listed(&self.watched.get(which as usize)?.as_ref()?.routine, places)
    }

    /// Places with the model and the step size of a trajectory: as inputs, or as constants if the tapes serve one model
    /// only. Also gives the number of inputs.
    fn places(&self, from: &Places<f64>, is_bound: bool) -> Option<(Places<Traced>, usize)> {
        let mut places = vec![Value::Unit; self.places];
        let mut steady = 0;
        for at in [at::MODEL, at::STEP] {
            let mut change = |x: f64| match is_bound {
                true => Traced::constant(x),
                false => {
                    steady += 1;
                    Traced::input(x)
                }
            };
            *places.get_mut(at)? = map_scalar(from.get(at)?, &mut change)?;
        }
        Some((places, steady))
    }
}

/// The tapes of a trajectory, and the numbers of its state and workspace.
#[derive(Debug)]
pub struct Recorded {
    functions: &'static Recordable,
    step: TapesByOutcome,
    watched: [TapesByOutcome; 3],
    /// The numbers of the state, followed by the numbers of the workspace.
    numbers: Vec<f64>,
    /// The number of numbers that belong to the state.
    of_state: usize,
    counts: Vec<i64>,
    newest: Newest,
}

/// A copy starts without tapes.
impl Clone for Recorded {
    fn clone(&self) -> Self {
        Recorded::new(self.functions, !self.step.are_none())
    }
}

/// Where the newest state and workspace are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Newest {
    /// In the numbers of the tapes.
    Numbers,
    /// In the places.
    Places,
    /// In both.
    Both,
}

impl Recorded {
    /// An empty record. Only steps of the model itself are recorded.
    pub fn new(functions: &'static Recordable, own_step: bool) -> Self {
        let watched = functions.watched.each_ref();
        Recorded {
            functions,
            step: TapesByOutcome::new(functions.step.as_ref().filter(|_| own_step)),
            watched: watched.map(|f| TapesByOutcome::new(f.as_ref())),
            numbers: Vec::new(),
            of_state: 0,
            counts: Vec::new(),
            newest: Newest::Places,
        }
    }

    /// The recorded functions as text.
    pub fn sections(&self, places: &Places<f64>, names: &FieldNames) -> Vec<Section> {
        let (mut steady, mut before, mut after) = (Vec::new(), Vec::new(), Vec::new());
        for (at, name) in [(at::MODEL, ""), (at::STEP, "h")] {
            if let Some(value) = places.get(at) {
                names.numbers(name, value, &mut steady);
            }
        }
        for (at, name) in [(at::STATE, ""), (at::WORK, "workspace")] {
            let Some(value) = places.get(at).filter(|value| recordable(value)) else {
                continue;
            };
            names.numbers(name, value, &mut before);
            after.extend(before.iter().skip(after.len()).map(|x| format!("next {x}")));
        }
        let mut all = self.step.sections("step", [&steady, &before, &after]);
        for (tapes, title) in self
            .watched
            .iter()
            .zip(["observables", "invariants", "scales"])
        {
            all.extend(tapes.sections(title, [&steady, &before, &[]]));
        }
        all
    }

    /// Marks the values in the places as newest.
    pub fn follow(&mut self) {
        self.newest = Newest::Places;
    }

    /// Reads the numbers from the places, if these are newer.
    fn read(&mut self, places: &Places<f64>) {
        if self.newest != Newest::Places {
            return;
        }
        self.newest = Newest::Both;
        self.numbers.clear();
        self.counts.clear();
        for at in [at::STATE, at::WORK] {
            let Some(value) = places.get(at) else {
                continue;
            };
            let before = self.numbers.len();
            if numbers(value, &mut self.numbers).is_none() {
                self.numbers.truncate(before);
            }
            counts(value, &mut self.counts);
            if at == at::STATE {
                self.of_state = self.numbers.len();
            }
        }
    }

    /// Writes the numbers to the places, if the numbers are newer.
    pub fn write(&mut self, places: &mut Places<f64>) {
        put(&self.numbers, &self.counts, &mut self.newest, places);
    }

    /// Takes a step; returns false if the function itself must run.
    pub fn step(&mut self, places: &mut Places<f64>) -> bool {
        if self.step.are_none() {
            return false;
        }
        self.read(places);
        let functions = self.functions;
        let node = Node {
            numbers: &self.numbers,
            first: self.counts.first().copied().unwrap_or(0),
            places,
        };
        let way = self.step.found(node, |places| {
            put(&self.numbers, &self.counts, &mut self.newest, places);
            functions.recorded_step(places)
        });
        let Some(way) = way else {
            return false;
        };
        for (slot, x) in self.numbers.iter_mut().zip(way.last.gives()) {
            *slot = x;
        }
        grow(&mut self.counts, &way.growth);
        self.newest = Newest::Numbers;
        true
    }

    /// The solutions of the equations of the last step. Returns nothing if no tape has taken a step.
    pub fn solutions(&self) -> Option<&[f64]> {
        self.step.newest()?.solutions()
    }

    /// Takes a step from this state; returns false if the function itself must run, from the places.
    pub fn step_from(&mut self, state: &mut Packed, places: &mut Places<f64>) -> bool {
        if self.step.are_none() || !self.put(state, places) || !self.step(places) {
            return false;
        }
        self.newest()
            .is_some_and(|(all, node)| state.set(all, node))
    }

    /// Sets the state in the numbers; returns false if the count of numbers differs.
    pub fn put(&mut self, state: &Packed, places: &Places<f64>) -> bool {
        self.read(places);
        let given = state.numbers();
        let own = self.numbers.get_mut(..self.of_state);
        let own = own.filter(|own| own.len() == given.len());
        let (Some(own), Some(node)) = (own, self.counts.first_mut()) else {
            return false;
        };
        own.copy_from_slice(given);
        *node = state.node.cast_signed();
        self.newest = Newest::Numbers;
        true
    }

    /// The numbers of the state and its node, if they are stored here.
    fn newest(&self) -> Option<(&[f64], u64)> {
        if self.newest == Newest::Places {
            return None;
        }
        let node = u64::try_from(*self.counts.first()?).ok()?;
        Some((self.numbers.get(..self.of_state)?, node))
    }

    /// The state, if it is stored in the numbers.
    pub fn packed(&self) -> Option<Packed> {
        let (all, node) = self.newest()?;
        Packed::of_numbers(all, node)
    }

    /// The node, if the numbers are newer than the places: the only count of a state.
    pub fn node(&self) -> Option<u64> {
        let newer = self.newest == Newest::Numbers;
        let node = self.counts.first().filter(|_| newer);
        node.and_then(|n| u64::try_from(*n).ok())
    }

    /// Writes observed numbers. Returns false if the function itself must run.
    pub fn watch(&mut self, which: Watched, places: &mut Places<f64>, out: &mut [f64]) -> bool {
        self.read(places);
        let Self {
            functions,
            watched: [observables, invariants, scales],
            ..
        } = self;
        let ways = match which {
            Watched::Observables => observables,
            Watched::Invariants => invariants,
            Watched::Scales => scales,
        };
        let node = Node {
            numbers: &self.numbers,
            first: self.counts.first().copied().unwrap_or(0),
            places,
        };
        let way = ways.found(node, |places| {
            put(&self.numbers, &self.counts, &mut self.newest, places);
            functions.recorded_watch(which, places)
        });
        let Some(way) = way.filter(|way| way.last.outputs() == out.len()) else {
            return false;
        };
        for (slot, x) in out.iter_mut().zip(way.last.gives()) {
            *slot = x;
        }
        true
    }
}

fn put(numbers: &[f64], counts: &[i64], newest: &mut Newest, places: &mut Places<f64>) {
    if *newest != Newest::Numbers {
        return;
    }
    *newest = Newest::Both;
    let mut numbers = numbers.iter().copied();
    let mut counts = counts.iter().copied();
    for place in [at::STATE, at::WORK] {
        let Some(value) = places.get_mut(place) else {
            continue;
        };
        if recordable(value) {
            fill(value, &mut numbers);
            each_count(value, &mut |n| *n = counts.next().unwrap_or(*n));
        }
    }
}

/// Whether a tape can contain a value. It cannot contain the memory of a solver.
fn recordable(value: &Value<f64>) -> bool {
    numbers(value, &mut Vec::new()).is_some()
}

/// A recording: a tape, its number of inputs and its pauses; the number of inputs that are the same in all steps; the
/// counts before and after.
struct StepRecording {
    recorded: (Tape, usize, Vec<RecordingPause>),
    steady: usize,
    counts: [Vec<i64>; 2],
}

/// Records twice, with different counts: if a number or a decision depends on them, the recording is discarded.
fn twice(once: impl Fn(Choice) -> Option<StepRecording>) -> Option<OutcomeTape> {
    let first = once(Choice::Equal)?;
    let second = once(Choice::Apart)?;
    let (tape, inputs, cuts) = first.recorded;
    let (other, _, others) = second.recorded;
    let agree = cuts.len() == others.len() && cuts.iter().zip(&others).all(|(a, b)| a.agrees(b));
    if !agree || tape != other {
        return None;
    }
    let ([before, after], [earlier, later]) = (first.counts, second.counts);
    let growth = growth([&before, &after], [&earlier, &later])?;
    let (between, last) = in_parts(tape, inputs, cuts, first.steady)?;
    Some(OutcomeTape {
        between,
        last,
        growth,
        numbers: Vec::new(),
    })
}

/// The value with its numbers as inputs and with the chosen counts.
fn input(value: &Value<f64>, counts: &mut Chosen) -> Option<Value<Traced>> {
    numbers(value, &mut Vec::new())?;
    let mut value = map_scalar(value, &mut Traced::input)?;
    counts.choose(&mut value);
    Some(value)
}

/// The numbers that an observer of the state appends to a list.
fn listed(routine: &Routine<Traced>, places: &mut Places<Traced>) -> Option<Vec<Traced>> {
    *places.get_mut(at::OUT)? = Value::List(Vec::new());
    value_of(&routine.body, places)?;
    let Value::List(list) = places.get(at::OUT)? else {
        return None;
    };
    let numbers = list.iter().map(|x| match x {
        Value::Real(x) => Some(*x),
        _ => None,
    });
    numbers.collect()
}

/// Records for all models; if the recording would depend on numbers of the model, records for one model.
fn stored(
    tapes: &SharedTapes,
    from: &Places<f64>,
    record: impl Fn(bool) -> Option<OutcomeTape>,
) -> Option<Arc<OutcomeTape>> {
    let (is_bound, tape) = match record(false) {
        Some(tape) => (false, tape),
        None => (true, record(true)?),
    };
    Some(tapes.store(Kinds::of(from)?, is_bound, tape))
}

impl Recordable {
    fn recorded_step(&self, from: &Places<f64>) -> Option<Arc<OutcomeTape>> {
        let tapes = self.step.as_ref()?;
        let once = |choice, is_bound| {
            let (mut before, mut after) = (Chosen::by(choice), Vec::new());
            let mut steady = 0;
            let recorded = record_with_solves(|| {
                let (mut places, count) = self.places(from, is_bound)?;
                steady = count;
                let mut whole = Vec::new();
                for at in [at::STATE, at::WORK] {
                    let value = input(from.get(at)?, &mut before)?;
                    whole.push(value.clone());
                    *places.get_mut(at)? = value;
                }
                value_of(&tapes.routine.body, &mut places)?;
                let mut outputs = Vec::new();
                for (at, before) in [at::STATE, at::WORK].into_iter().zip(&whole) {
                    let value = places
                        .get(at)
                        .filter(|value| alike(&uncounted(before), &uncounted(value)))?;
                    numbers(value, &mut outputs)?;
                    counts(value, &mut after);
                }
                Some(outputs)
            })?;
            Some(StepRecording {
                recorded,
                steady,
                counts: [before.all, after],
            })
        };
        stored(tapes, from, |is_bound| {
            twice(|choice| once(choice, is_bound))
        })
    }

    fn recorded_watch(&self, which: Watched, from: &Places<f64>) -> Option<Arc<OutcomeTape>> {
        let tapes = self.watched.get(which as usize)?.as_ref()?;
        let once = |choice, is_bound| {
            let mut steady = 0;
            let recorded = record_with_solves(|| {
                let (mut places, count) = self.places(from, is_bound)?;
                steady = count;
                let mut chosen = Chosen::by(choice);
                let state = input(from.get(at::STATE)?, &mut chosen)?;
                *places.get_mut(at::STATE)? = state;
                // A function that reads the memory of a solver is not recorded.
                if let Some(work) = input(from.get(at::WORK)?, &mut chosen) {
                    *places.get_mut(at::WORK)? = work;
                }
                listed(&tapes.routine, &mut places)
            })?;
            // An evaluation at a node solves no equations.
            recorded.2.is_empty().then_some(StepRecording {
                recorded,
                steady,
                counts: [Vec::new(), Vec::new()],
            })
        };
        stored(tapes, from, |is_bound| {
            twice(|choice| once(choice, is_bound))
        })
    }
}
