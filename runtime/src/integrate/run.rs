//! The integration loop.
//! Takes a trajectory, a number of steps and an observer; gives a [`Summary`], and the error of the
//! step that failed or of the number that is not finite.

use super::drift::{Deviation, HeldRate};
use super::{Drift, NotFinite, RunError, Watched};
use crate::card::Trajectory;
use crate::saved::{Saved, Words};

/// Receives the samples and the progress of a run.
pub trait Observer {
    /// One sample: node, time, all observables, all invariants, in the order of the model's card.
    fn sample(&mut self, node: u64, time: f64, observables: &[f64], invariants: &[f64]);

    /// Reports that `done` of `total` steps are complete. A long run calls it at least 200 times.
    fn progress(&mut self, done: u64, total: u64) {
        let _ = (done, total);
    }
}

/// If a run samples only its start and end, it checks at most this many nodes: a check takes as long as twenty explicit
/// steps of a rigid body.
pub const LOOKS: u64 = 10_000;

/// The result of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Number of steps taken, up to the last node at which all checked numbers were finite.
    pub steps: u64,
    /// The node reached.
    pub node: u64,
    /// The time there.
    pub time: f64,
    /// Number of samples that the observer received.
    pub samples: u64,
    /// The drift of every component of every invariant, in the order of the model's card.
    pub drifts: Vec<Drift>,
}

/// Takes `steps` steps and samples the start, every `every`-th step and the end (`every = 0`: start and end only).
/// The invariants are compared with their initial values at every sampled node. If `every = 0`, they are compared at
/// every node of a run of at most [`LOOKS`] steps, and at [`LOOKS`] nodes of a longer run. Allocates before the loop
/// only.
///
/// # Errors
/// As [`run_until_stopped`]; use that function if you need the results of an incomplete run.
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

/// As [`run`], but returns the summary also if the run stops early, together with the error:
///
/// - the first [`StepError`](crate::StepError). The trajectory is then at the node before the failed
///   step, which is the last sample;
/// - the first number that is NaN or infinite: of an invariant or its natural scale at a checked node, or of an
///   observable at a sampled node. The trajectory remains at that node. The summary and the samples end at the
///   node checked before it.
pub fn run_until_stopped(
    trajectory: &mut dyn Trajectory,
    steps: u64,
    every: u64,
    observer: &mut dyn Observer,
) -> (Summary, Option<RunError>) {
    let mut watch = Watch::new(trajectory, steps, every);
    let stride = (steps / 200).clamp(1, 1024);
    let stopped = loop {
        let done = watch.summary.steps;
        if let Err(error) = watch.advance(trajectory, observer, stride - done % stride) {
            break Some(error);
        }
        if watch.summary.steps > done {
            observer.progress(watch.summary.steps, steps);
        }
        if watch.is_over() {
            break None;
        }
    };
    if let Some(error) = &stopped {
        watch.stop(trajectory, observer, error);
    }
    (watch.summary(), stopped)
}

/// The state of a run at a node: the numbers there, and the drifts so far. You can advance it by any number of steps
/// at a time, and save and restore it together with its trajectory, without a change of the results.
#[derive(Clone, Debug)]
pub struct Watch {
    total: u64,
    every: u64,
    /// Whether the start was checked.
    begun: bool,
    /// The node checked last.
    looked: Place,
    observables: Vec<f64>,
    invariants: Vec<f64>,
    scales: Vec<f64>,
    /// The positions of the constraint rates among the invariants.
    rates: Vec<HeldRate>,
    seen: Vec<Deviation>,
    /// The node sampled last.
    sampled: u64,
    /// Without drifts, which come from `seen` at the end.
    summary: Summary,
}

/// The progress of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    steps: u64,
    node: u64,
    time: f64,
}

impl Watch {
    /// A run of `total` steps, of which every `every`-th is sampled, as by [`run`].
    #[must_use]
    pub fn new(trajectory: &dyn Trajectory, total: u64, every: u64) -> Self {
        let card = trajectory.card();
        Self {
            total,
            every,
            begun: false,
            looked: Place {
                steps: 0,
                node: trajectory.node(),
                time: trajectory.time(),
            },
            observables: vec![0.0; card.observable_count()],
            invariants: vec![0.0; card.invariant_count()],
            scales: vec![0.0; card.invariant_count()],
            rates: HeldRate::all(card),
            seen: Vec::with_capacity(card.invariant_count()),
            sampled: trajectory.node(),
            summary: Summary {
                steps: 0,
                node: trajectory.node(),
                time: trajectory.time(),
                samples: 0,
                drifts: Vec::new(),
            },
        }
    }

    /// Takes at most `most` of the remaining steps. The first call also checks and samples the start.
    ///
    /// # Errors
    /// As [`run_until_stopped`] says; [`Watch::stop`] then takes the last sample.
    pub fn advance(
        &mut self,
        trajectory: &mut dyn Trajectory,
        observer: &mut dyn Observer,
        most: u64,
    ) -> Result<(), RunError> {
        if !self.begun {
            self.look(trajectory, true)?;
            let start = self.invariants.iter().zip(&self.scales);
            let start = start.map(|(value, terms)| Deviation::none(*value, *terms));
            self.seen.extend(start);
            self.sample(observer);
            self.begun = true;
        }
        let made = self.summary.steps;
        let last = self.total.min(made.saturating_add(most));
        let stride = match self.every {
            0 => self.total.div_ceil(LOOKS).max(1),
            every => every,
        };
        for done in made.saturating_add(1)..=last {
            trajectory.step()?;
            let summary = &mut self.summary;
            summary.steps = done;
            summary.node = trajectory.node();
            summary.time = trajectory.time();
            if done == self.total || done % stride == 0 {
                let sampled = done == self.total || self.every != 0;
                self.look_on(trajectory, sampled)?;
                if sampled {
                    self.sample(observer);
                }
            }
        }
        Ok(())
    }

    /// Checks the current node and records its deviations. If a number is not finite, the summary returns to the node
    /// checked before.
    fn look_on(&mut self, trajectory: &dyn Trajectory, sampled: bool) -> Result<(), NotFinite> {
        if let Err(found) = self.look(trajectory, sampled) {
            let Place { steps, node, time } = self.looked;
            self.summary.steps = steps;
            self.summary.node = node;
            self.summary.time = time;
            return Err(NotFinite {
                since: node,
                ..found
            });
        }
        let values = self.invariants.iter().zip(&self.scales);
        for (seen, (value, terms)) in self.seen.iter_mut().zip(values) {
            seen.record(self.summary.node, *value, *terms);
        }
        let Summary {
            steps, node, time, ..
        } = self.summary;
        self.looked = Place { steps, node, time };
        Ok(())
    }

    /// Whether all steps are complete.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.begun && self.summary.steps >= self.total
    }

    /// Samples the node at which a run stops early, unless it was sampled or its numbers are not finite. `error` is
    /// the error of [`Watch::advance`].
    pub fn stop(
        &mut self,
        trajectory: &dyn Trajectory,
        observer: &mut dyn Observer,
        error: &RunError,
    ) {
        if matches!(error, RunError::Step(_)) {
            self.sample_here(trajectory, observer);
        }
    }

    /// Samples the current node, unless it was sampled. Call it if you end a run early.
    pub fn sample_here(&mut self, trajectory: &dyn Trajectory, observer: &mut dyn Observer) {
        if !self.begun || self.sampled == self.summary.node {
            return;
        }
        if self.look_on(trajectory, true).is_ok() {
            self.sample(observer);
        }
    }

    /// The summary of the steps so far.
    #[must_use]
    pub fn summary(&self) -> Summary {
        Summary {
            drifts: self.seen.iter().map(Deviation::drift).collect(),
            ..self.summary.clone()
        }
    }

    /// Reads the numbers at the node and checks that all are finite; reads the observables only if the node is
    /// sampled.
    #[inline]
    fn look(&mut self, trajectory: &dyn Trajectory, sampled: bool) -> Result<(), NotFinite> {
        trajectory.invariants(&mut self.invariants);
        if let Err(found) = finite(trajectory, Watched::Invariant, &self.invariants) {
            return Err(self.overflow_as_infinite(trajectory, found));
        }
        trajectory.scales(&mut self.scales);
        if trajectory.node() > 0 {
            let h = trajectory.time() / trajectory.node() as f64;
            self.rates
                .iter()
                .for_each(|rate| rate.not_less(&mut self.scales, h));
        }
        finite(trajectory, Watched::Scale, &self.scales)?;
        if sampled {
            trajectory.observe(&mut self.observables);
            finite(trajectory, Watched::Observable, &self.observables)?;
        }
        Ok(())
    }

    /// Reports an invariant that is NaN as infinite if its terms overflow: in this case no function left its domain.
    #[cold]
    fn overflow_as_infinite(&mut self, trajectory: &dyn Trajectory, found: NotFinite) -> NotFinite {
        trajectory.scales(&mut self.scales);
        trajectory.observe(&mut self.observables);
        let is_large = |x: &f64| x.abs() > SQUARED;
        let of_state = self.observables.iter().any(is_large);
        let of_terms = self
            .scales
            .iter()
            .any(|x| x.is_infinite() || is_large(&x.abs().sqrt()));
        match found.value.is_nan() && (of_state || of_terms) {
            true => NotFinite {
                value: f64::INFINITY,
                ..found
            },
            false => found,
        }
    }

    /// Passes the node to the observer.
    fn sample(&mut self, observer: &mut dyn Observer) {
        let Summary { node, time, .. } = self.summary;
        observer.sample(node, time, &self.observables, &self.invariants);
        self.summary.samples += 1;
        self.sampled = node;
    }
}

/// Restores into a run of the same trajectory with the same numbers of steps.
impl Saved for Watch {
    fn words(&mut self, words: &mut Words) {
        let Self {
            total,
            every,
            begun,
            looked,
            // The numbers at the current node: always written before they are read.
            observables: _,
            invariants: _,
            scales: _,
            rates: _,
            seen,
            sampled,
            summary,
        } = self;
        words.same(*total);
        words.same(*every);
        begun.words(words);
        looked.steps.words(words);
        looked.node.words(words);
        looked.time.words(words);
        let count = words.count(seen.len(), seen.capacity());
        seen.resize(count, Deviation::none(0.0, 0.0));
        seen.iter_mut().for_each(|seen| seen.words(words));
        sampled.words(words);
        let Summary {
            steps,
            node,
            time,
            samples,
            drifts: _,
        } = summary;
        steps.words(words);
        node.words(words);
        time.words(words);
        samples.words(words);
    }
}

/// Squares of larger numbers are near overflow, and a product that is stored in two numbers is NaN there.
const SQUARED: f64 = 1e150;

/// Refuses numbers that are NaN or infinite.
#[inline]
fn finite(trajectory: &dyn Trajectory, watched: Watched, values: &[f64]) -> Result<(), NotFinite> {
    // Zero times a finite number is zero, and zero times any other number is NaN: one sum tests all of them.
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
        since: trajectory.node(),
        watched,
        // The name if the card lists fewer numbers than this.
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
