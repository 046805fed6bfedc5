//! The runs that are compared: the results of each method at the same nodes. Takes a plan; gives records of
//! observables and invariants. For other methods, the model computes them from the state of the method.

use crate::plan::Plan;
use crate::terminal::failure::Failure;
use crate::trajectory::record::Recorder;
use clebsch::card::{Card, Settings, Trajectory};
use clebsch::integrate::{self, Drift};
use clebsch::record::{Record, Table};
use clebsch::scalar::largest;
use clebsch_comparisons::gallery::{Offer, Problem};

/// The step sizes of the extrapolated reference are h divided by each of these.
const PARTS: [u32; 6] = [1, 2, 3, 4, 6, 8];

/// The samples of a method, up to the node where it stopped.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    /// The samples. There are fewer than requested if the method stopped.
    pub record: Record,
    /// The node that was not reached, and the reason.
    pub stopped: Option<(u64, String)>,
}

/// The run of the generated stepper, and the natural scale of each component of the invariants along it.
///
/// # Errors
/// Usage or failed, as for a run; failed if it is not completed.
pub(crate) fn generated(
    card: &Card,
    plan: &Plan,
    progress: bool,
) -> Result<(Course, Vec<f64>), Failure> {
    let (course, scales) = up_to_stop(card, plan, progress)?;
    match course.stopped {
        Some((_, why)) => Err(Failure::Failed(why)),
        None => Ok((course, scales)),
    }
}

/// The run of the generated stepper up to the node where it stops.
///
/// # Errors
/// Usage or failed, as for a run that makes no step.
pub(crate) fn up_to_stop(
    card: &Card,
    plan: &Plan,
    progress: bool,
) -> Result<(Course, Vec<f64>), Failure> {
    let mut trajectory = plan.open(card)?;
    let steps = plan.case.steps;
    let mut recorder = Recorder::new(card, steps, true, progress);
    let (summary, stopped) =
        integrate::run_until_stopped(trajectory.as_mut(), steps, plan.every, &mut recorder);
    let mut record = recorder.finish().unwrap_or_default();
    if let Some(error) = &stopped {
        if summary.steps == 0 {
            return Err(Failure::Failed(error.to_string()));
        }
        // The last node that was reached is sampled as well. Other runs have no sample there.
        record.keep(|node| node.is_multiple_of(plan.every.max(1)));
    }
    let course = Course {
        record,
        stopped: stopped.map(|error| (summary.node + 1, error.to_string())),
    };
    Ok((course, summary.drifts.iter().map(|d| d.scale).collect()))
}

/// The course of another method.
pub(crate) fn other(card: &Card, plan: &Plan, offer: &Offer) -> Course {
    let mut course = Course {
        record: empty(card),
        stopped: None,
    };
    let stopped = follow(card, plan, offer, &mut course.record);
    course.stopped = stopped.err();
    course
}

fn follow(
    card: &Card,
    plan: &Plan,
    offer: &Offer,
    record: &mut Record,
) -> Result<(), (u64, String)> {
    let case = &plan.case;
    let problem = Problem {
        parameters: &case.parameters,
        initial: &case.initial,
        h: case.h,
    };
    let mut method = (offer.start)(&problem).map_err(|_| (0, "does not start".to_owned()))?;
    for node in 0..=case.steps {
        if node > 0 {
            method
                .step()
                .map_err(|_| (node, "finds no solution".to_owned()))?;
        }
        if node.is_multiple_of(plan.every.max(1)) || node == case.steps {
            // The model computes its observables from the state of the method.
            let here = (card.open)(&case.parameters, &method.shown(), Settings::step(case.h))
                .map_err(|error| (node, format!("not a state of the model: {error}")))?;
            push(record, node, case.h, here.as_ref()).map_err(|what| (node, what))?;
        }
    }
    Ok(())
}

/// A reference for any model: the generated stepper with smaller and smaller step sizes, extrapolated to step size
/// zero (Richardson; Neville's scheme). It measures the error of the step, not of the equations. Returns the run and
/// the change due to the smallest step size, relative to the largest component of each observable.
///
/// # Errors
/// Failed: a run with a smaller step size is not completed.
pub(crate) fn extrapolated(card: &Card, plan: &Plan) -> Result<(Course, f64), Failure> {
    let mut records = Vec::new();
    for part in PARTS {
        let mut finer = plan.clone();
        finer.case.h = plan.case.h / f64::from(part);
        finer.case.steps = plan.case.steps * u64::from(part);
        finer.every = plan.every * u64::from(part);
        records.push(generated(card, &finer, false)?.0.record);
    }
    // The error of a reversible scheme has even powers of the step only.
    let power = if card.reversible { 2 } else { 1 };
    let places: Vec<f64> = PARTS.map(|part| f64::from(part).powi(-power)).to_vec();
    let records: Vec<&Record> = records.iter().collect();
    let (_, last) = neville(&records, &places, |record| &record.observables);
    let record = extrapolation(&records, &places)?;
    let size = |table: &Table| largest(table.numbers.iter().copied());
    let accuracy = Drift::of(size(&last), size(&record.observables));
    let course = Course {
        record,
        stopped: None,
    };
    Ok((course, accuracy))
}

/// The values of runs with several step sizes, extrapolated to step size zero. `places` are the powers of the
/// step size in the error.
///
/// # Errors
/// Failed: there is no run.
pub(crate) fn extrapolation(records: &[&Record], places: &[f64]) -> Result<Record, Failure> {
    let (observables, _) = neville(records, places, |record| &record.observables);
    let (invariants, _) = neville(records, places, |record| &record.invariants);
    let Some(first) = records.first() else {
        return Err(Failure::Failed(
            "there are no steps to extrapolate from".to_owned(),
        ));
    };
    Ok(Record {
        observables,
        invariants,
        nodes: first.nodes.clone(),
        times: first.times.clone(),
    })
}

/// Values at step size zero of the polynomial through all records, and the change due to the last record.
fn neville(
    records: &[&Record],
    places: &[f64],
    table: impl Fn(&Record) -> &Table,
) -> (Table, Table) {
    let tables: Vec<&Table> = records.iter().map(|record| table(record)).collect();
    let width = tables.first().map_or(0, |table| table.width);
    let count = tables
        .iter()
        .map(|table| table.numbers.len())
        .min()
        .unwrap_or(0);
    let (mut values, mut changes) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for index in 0..count {
        let mut column: Vec<f64> = tables
            .iter()
            .filter_map(|table| table.numbers.get(index).copied())
            .collect();
        // Works in place, from the end: after pass `order` an entry is extrapolated from order + 1 records.
        for order in 1..column.len() {
            for row in (order..column.len()).rev() {
                let pairs = (places.get(row), places.get(row - order));
                let (Some(near), Some(far)) = pairs else {
                    continue;
                };
                let [before, value] = [row - 1, row].map(|at| column.get(at).copied());
                let (Some(before), Some(value)) = (before, value) else {
                    continue;
                };
                if let Some(place) = column.get_mut(row) {
                    *place = value + (value - before) * near / (far - near);
                }
            }
        }
        let last = column.pop().unwrap_or(f64::NAN);
        // The extrapolation without the record of the smallest step size.
        let without = column.pop().unwrap_or(f64::NAN);
        values.push(last);
        changes.push(last - without);
    }
    let of = |numbers| Table { width, numbers };
    (of(values), of(changes))
}

fn empty(card: &Card) -> Record {
    let table = |width| Table {
        width,
        numbers: Vec::new(),
    };
    Record {
        observables: table(card.observable_count()),
        invariants: table(card.invariant_count()),
        ..Record::default()
    }
}

/// Adds a sample. Fails if a number in it is not finite.
#[allow(clippy::cast_precision_loss)]
fn push(record: &mut Record, node: u64, h: f64, here: &dyn Trajectory) -> Result<(), String> {
    let mut observables = vec![0.0; record.observables.width];
    here.observe(&mut observables);
    let mut invariants = vec![0.0; record.invariants.width];
    here.invariants(&mut invariants);
    if let Some(wrong) = observables
        .iter()
        .chain(&invariants)
        .find(|x| !x.is_finite())
    {
        return Err(format!("an observable or invariant is {wrong}"));
    }
    record.nodes.push(node);
    record.times.push(node as f64 * h);
    record.observables.numbers.extend(observables);
    record.invariants.numbers.extend(invariants);
    Ok(())
}
