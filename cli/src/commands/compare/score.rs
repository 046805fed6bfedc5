//! How a course compares with the reference: errors of the state and drifts of the invariants at every
//! sample. Takes two records; gives curves against time, and their largest and last values.

use crate::case_file::quantity_of;
use clebsch::card::{Card, Field};
use clebsch::integrate::Drift;
use clebsch::record::Record;
use clebsch::scalar::larger;
use clebsch_comparisons::gallery::Role;
use serde_json::{Map, Value, json};
use std::ops::Range;

/// A quantity at every sample after the first.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    /// Name of the field or invariant, ASCII.
    pub name: &'static str,
    /// Time and value.
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    /// The largest value; NaN if there is one.
    pub fn worst(&self) -> f64 {
        let values = self.points.iter().map(|point| point.1);
        values.fold(0.0, larger)
    }

    /// The last value.
    pub fn last(&self) -> f64 {
        self.points.last().map_or(0.0, |point| point.1)
    }
}

/// The result of a method.
#[derive(Clone, Debug)]
pub(crate) struct Score {
    /// Name for tables and files.
    pub name: String,
    /// A description.
    pub doc: String,
    /// The role of the method; `None` for the generated stepper.
    pub role: Option<Role>,
    /// Error of each state field: distance to the reference, relative to the reference's largest norm. The
    /// error is absolute if that norm is zero.
    pub errors: Vec<Curve>,
    /// Drift of each invariant over its natural scale.
    pub drifts: Vec<Curve>,
    /// Time per step.
    pub nanoseconds: Option<f64>,
    /// The node that was not reached, and the reason.
    pub stopped: Option<(u64, String)>,
}

/// More quantities than this are compared by their norms over all sites or copies.
const MOST_FIELDS: usize = 8;

/// A quantity of the state: its name, and its columns among the observables.
type Quantity = (&'static str, Vec<Range<usize>>);

/// The fields that form the state. If no observable is an initial value, all observables form the state. Many
/// copies of a quantity, `q_0`, `q_1`, ..., are combined to one quantity `q`.
fn state(card: &Card) -> Vec<Quantity> {
    let mut from = 0;
    let placed: Vec<(&'static Field, Range<usize>)> = card
        .observables
        .iter()
        .map(|field| {
            let columns = from..from + field.count();
            from = columns.end;
            (field, columns)
        })
        .collect();
    let of_state = |field: &Field| card.initial.iter().any(|start| start.ascii == field.ascii);
    let chosen: Vec<_> = placed
        .iter()
        .filter(|(field, _)| of_state(field))
        .cloned()
        .collect();
    let all = if chosen.is_empty() { placed } else { chosen };
    let many = all.len() > MOST_FIELDS;
    let mut quantities: Vec<Quantity> = Vec::new();
    for (field, columns) in all {
        let stem = quantity_of(field.ascii).filter(|_| many);
        let name = stem.unwrap_or(field.ascii);
        match quantities
            .iter_mut()
            .rev()
            .find(|(known, _)| *known == name)
        {
            Some((_, own)) if stem.is_some() => own.push(columns),
            _ => quantities.push((name, vec![columns])),
        }
    }
    quantities
}

fn norm(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|value| value * value).sum::<f64>().sqrt()
}

/// Errors of `record` against `truth`, one curve per field. The error is absolute if the reference is zero.
pub(crate) fn errors(card: &Card, record: &Record, truth: &Record) -> Vec<Curve> {
    let part = |row: &[f64], columns: &[Range<usize>]| -> Vec<f64> {
        let each = columns.iter().filter_map(|own| row.get(own.clone()));
        each.flatten().copied().collect()
    };
    let curve = |(name, columns): Quantity| {
        let truths = || truth.observables.rows().map(|row| part(row, &columns));
        let scale = truths().map(|row| norm(row.into_iter())).fold(0.0, larger);
        let rows = record.observables.rows().map(|row| part(row, &columns));
        let distances = rows
            .zip(truths())
            .map(|(here, there)| norm(here.into_iter().zip(there).map(|(a, b)| a - b)))
            .map(|distance| Drift::of(distance, scale));
        let points = record.times.iter().copied().zip(distances);
        Curve {
            name,
            points: points.skip(1).collect(),
        }
    };
    state(card).into_iter().map(curve).collect()
}

/// Drifts of the invariants of `record`, the largest component of each, relative to the natural scales. A drift
/// is absolute if its scale is zero.
pub(crate) fn drifts(card: &Card, record: &Record, scales: &[f64]) -> Vec<Curve> {
    let mut from = 0;
    let curve = |invariant: &'static clebsch::card::Invariant| {
        let columns = from..from + invariant.rows;
        from = columns.end;
        let rows = || {
            record
                .invariants
                .rows()
                .map(|row| row.get(columns.clone()).unwrap_or_default())
        };
        let start = rows().next().unwrap_or_default();
        let scales = scales.get(columns.clone()).unwrap_or_default();
        let largest = rows().map(|row| {
            let each = row.iter().zip(start).zip(scales);
            each.fold(0.0_f64, |most, ((now, then), scale)| {
                larger(most, Drift::of(now - then, *scale).abs())
            })
        });
        let points = record.times.iter().copied().zip(largest);
        Curve {
            name: invariant.name,
            points: points.skip(1).collect(),
        }
    };
    card.invariants.iter().map(curve).collect()
}

impl Score {
    /// The score for files and `--json`.
    pub fn json(&self, made: super::StepperOrigin) -> Value {
        let curves = |curves: &[Curve]| -> Value {
            let pairs = curves.iter().map(|curve| {
                let value = json!({"worst": curve.worst(), "last": curve.last()});
                (curve.name.to_owned(), value)
            });
            pairs.collect::<Map<_, _>>().into()
        };
        json!({
            "name": self.name,
            "doc": self.doc,
            "role": match self.role {
                None => made.name(),
                Some(Role::Reference) => "reference",
                Some(Role::ByHand) => "by hand",
                Some(Role::Published) => "published",
            },
            "error": curves(&self.errors),
            "drift": curves(&self.drifts),
            "nanoseconds_per_step": self.nanoseconds,
            "stopped": self.stopped.as_ref().map(|(node, why)| json!({"node": node, "why": why})),
        })
    }
}

/// The table: one line a method.
pub(crate) fn table(scores: &[Score], width: Option<usize>) -> String {
    let number = |x: f64| {
        if x == 0.0 {
            "0".to_owned()
        } else {
            format!("{x:.1e}")
        }
    };
    let mut head = vec!["method".to_owned(), "ns/step".to_owned()];
    if let Some(first) = scores.first() {
        head.extend(first.errors.iter().map(|c| format!("error {}", c.name)));
        head.extend(first.drifts.iter().map(|c| format!("drift {}", c.name)));
    }
    let right: Vec<usize> = (1..head.len()).collect();
    let mut rows = vec![head];
    for score in scores {
        let time = score
            .nanoseconds
            .map_or_else(|| "-".to_owned(), |t| format!("{t:.0}"));
        let mut row = vec![score.name.clone(), time];
        let curves = score.errors.iter().chain(&score.drifts);
        row.extend(curves.map(|curve| match (score.role, &score.stopped) {
            // The generated stepper up to the node where it stopped.
            (None, Some(_)) if !curve.points.is_empty() => number(curve.worst()),
            (_, Some(_)) => "-".to_owned(),
            _ => number(curve.worst()),
        }));
        rows.push(row);
    }
    crate::words::columns::aligned(&rows, &right, width)
}
