//! The loop itself.
//! Takes a trajectory, a number of steps and an observer; gives a [`Summary`], and the error of the
//! step that failed or of the number that is none.

use super::drift::Deviation;
use super::{Drift, NotFinite, RunError, Watched};
use crate::card::Trajectory;

/// What watches a run.
pub trait Observer {
    /// One sample: node, time, all observables, all invariants, in the order of the model's card.
    fn sample(&mut self, node: u64, time: f64, observables: &[f64], invariants: &[f64]);

    /// `done` of `total` steps are made; called now and then, at least 200 times in a long run.
    fn progress(&mut self, done: u64, total: u64) {
        let _ = (done, total);
    }
}

/// What a run did.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Number of steps made, after each of which what is watched was finite.
    pub steps: u64,
    /// The node reached.
    pub node: u64,
    /// The time there.
    pub time: f64,
    /// Number of samples the observer was given.
    pub samples: u64,
    /// The drift of every component of every invariant, in the order of the model's card.
    pub drifts: Vec<Drift>,
    /// The largest residual of a step; none where the trajectory has none.
    pub residual: Option<LargestResidual>,
}

/// The step of a run that solves its equations worst.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargestResidual {
    /// The residual relative to the terms of its equation, see
    /// [`Trajectory::residual`]; NaN where one was.
    pub relative: f64,
    /// The node at the end of the step.
    pub node: u64,
}

impl LargestResidual {
    /// The worse of the two; the first where they are equal, and any that is NaN.
    fn worse(one: Option<Self>, other: Option<Self>) -> Option<Self> {
        match (one, other) {
            (Some(a), Some(b)) if b.relative <= a.relative || a.relative.is_nan() => Some(a),
            (a, b) => b.or(a),
        }
    }
}

/// Makes `steps` steps, sampling the start, every `every`-th step and the end (`every = 0`: start
/// and end only). The invariants are compared with those at the start after every step, sampled
/// or not. Allocates before the loop only.
///
/// # Errors
/// As [`run_until_stopped`], of which this is the form for runs that are worth nothing unless whole.
pub fn run(
    trajectory: &mut dyn Trajectory,
    steps: u64,
    every: u64,
    observer: &mut dyn Observer,
) -> Result<Summary, RunError> {
    match run_until_stopped(trajectory, steps, every, observer) {
        (summary, None) => Ok(summary),
        (_, Some(error)) => Err(error),
    }
}

/// As [`run`], with what was done up to where the run stopped, and why it did, if it did:
///
/// - the first [`StepError`](crate::StepError). The trajectory then stands at the node before it,
///   which is the last sample;
/// - the first number that is NaN or infinite: of an invariant or its natural scale at any node, of an
///   observable at a node that is sampled. The trajectory stands there; summary and samples are those
///   of the nodes before.
pub fn run_until_stopped(
    trajectory: &mut dyn Trajectory,
    steps: u64,
    every: u64,
    observer: &mut dyn Observer,
) -> (Summary, Option<RunError>) {
    let mut watch = Watch::new(trajectory, steps, every);
    let stopped = watch.follow(trajectory, observer).err();
    // Seen already, but for the observables of a node that was not to be sampled.
    if matches!(stopped, Some(RunError::Step(_))) && watch.sampled != watch.summary.node {
        trajectory.observe(&mut watch.observables);
        if finite(trajectory, Watched::Observable, &watch.observables).is_ok() {
            watch.sample(observer);
        }
    }
    let drifts = watch.seen.iter().map(Deviation::drift).collect();
    let summary = Summary {
        drifts,
        ..watch.summary
    };
    (summary, stopped)
}

/// A run up to a node: the numbers there, and what was seen before.
struct Watch {
    total: u64,
    every: u64,
    observables: Vec<f64>,
    invariants: Vec<f64>,
    scales: Vec<f64>,
    seen: Vec<Deviation>,
    /// The node sampled last.
    sampled: u64,
    /// The drifts are taken from `seen` at the end.
    summary: Summary,
}

impl Watch {
    fn new(trajectory: &dyn Trajectory, total: u64, every: u64) -> Self {
        let card = trajectory.card();
        Self {
            total,
            every,
            observables: vec![0.0; card.observable_count()],
            invariants: vec![0.0; card.invariant_count()],
            scales: vec![0.0; card.invariant_count()],
            seen: Vec::with_capacity(card.invariant_count()),
            sampled: trajectory.node(),
            summary: Summary {
                steps: 0,
                node: trajectory.node(),
                time: trajectory.time(),
                samples: 0,
                drifts: Vec::new(),
                residual: None,
            },
        }
    }

    fn follow(
        &mut self,
        trajectory: &mut dyn Trajectory,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        self.look(trajectory, true)?;
        let start = self.invariants.iter().zip(&self.scales);
        let start = start.map(|(value, terms)| Deviation::none(*value, *terms));
        self.seen.extend(start);
        self.sample(observer);
        let stride = (self.total / 200).clamp(1, 1024);
        for done in 1..=self.total {
            trajectory.step()?;
            let sampled = done == self.total || (self.every != 0 && done % self.every == 0);
            self.look(trajectory, sampled)?;
            let values = self.invariants.iter().zip(&self.scales);
            for (seen, (value, terms)) in self.seen.iter_mut().zip(values) {
                seen.record(*value, *terms);
            }
            let summary = &mut self.summary;
            summary.steps = done;
            summary.node = trajectory.node();
            summary.time = trajectory.time();
            let residual = trajectory.residual().map(|relative| LargestResidual {
                relative,
                node: summary.node,
            });
            summary.residual = LargestResidual::worse(summary.residual, residual);
            if sampled {
                self.sample(observer);
            }
            if done == self.total || done % stride == 0 {
                observer.progress(done, self.total);
            }
        }
        Ok(())
    }

    /// The numbers at the node, if all are finite; the observables where it is to be sampled.
    #[inline]
    fn look(&mut self, trajectory: &dyn Trajectory, sampled: bool) -> Result<(), NotFinite> {
        trajectory.invariants(&mut self.invariants);
        finite(trajectory, Watched::Invariant, &self.invariants)?;
        trajectory.scales(&mut self.scales);
        finite(trajectory, Watched::Scale, &self.scales)?;
        if sampled {
            trajectory.observe(&mut self.observables);
            finite(trajectory, Watched::Observable, &self.observables)?;
        }
        Ok(())
    }

    /// Shows the node to the observer.
    fn sample(&mut self, observer: &mut dyn Observer) {
        let Summary { node, time, .. } = self.summary;
        observer.sample(node, time, &self.observables, &self.invariants);
        self.summary.samples += 1;
        self.sampled = node;
    }
}

/// Refuses numbers that are NaN or infinite.
#[inline]
fn finite(trajectory: &dyn Trajectory, watched: Watched, values: &[f64]) -> Result<(), NotFinite> {
    // Zero times a finite number is zero, times any other NaN: one sum looks at all of them.
    if values.iter().map(|x| 0.0 * x).sum::<f64>() == 0.0 {
        return Ok(());
    }
    Err(the_one(trajectory, watched, values))
}

/// The first number that is not finite, by its name on the card.
#[cold]
fn the_one(trajectory: &dyn Trajectory, watched: Watched, values: &[f64]) -> NotFinite {
    let card = trajectory.card();
    let place = values.iter().position(|x| !x.is_finite()).unwrap_or(0);
    let shapes: Vec<(&'static str, usize, usize)> = match watched {
        Watched::Observable => {
            let fields = card.observables.iter();
            fields.map(|f| (f.name, f.rows, f.cols)).collect()
        }
        Watched::Invariant | Watched::Scale => {
            let invariants = card.invariants.iter();
            invariants.map(|i| (i.name, i.rows, 1)).collect()
        }
    };
    let mut found = NotFinite {
        node: trajectory.node(),
        time: trajectory.time(),
        watched,
        // More numbers than the card names have no name.
        name: "?",
        index: Some(place),
        columns: 1,
        value: values.get(place).copied().unwrap_or(f64::NAN),
    };
    let mut before = 0;
    for (name, rows, columns) in shapes {
        let count = rows * columns;
        if (before..before + count).contains(&place) {
            found.name = name;
            found.index = (count > 1).then_some(place - before);
            found.columns = columns;
            break;
        }
        before += count;
    }
    found
}
