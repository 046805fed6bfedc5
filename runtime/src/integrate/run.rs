//! The loop itself.
//! Takes a trajectory, a number of steps and an observer; gives a [`Summary`], and the error of the
//! step that failed or of the number that is none.

use super::drift::{Deviation, HeldRate};
use super::{Drift, NotFinite, RunError, Watched};
use crate::card::Trajectory;
use crate::saved::{Saved, Words};

/// What watches a run.
pub trait Observer {
    /// One sample: node, time, all observables, all invariants, in the order of the model's card.
    fn sample(&mut self, node: u64, time: f64, observables: &[f64], invariants: &[f64]);

    /// `done` of `total` steps are made; called now and then, at least 200 times in a long run.
    fn progress(&mut self, done: u64, total: u64) {
        let _ = (done, total);
    }
}

/// At most so many nodes of a run are looked at if none but the last is sampled: looking at one takes as long as twenty
/// explicit steps of a rigid body.
pub const LOOKS: u64 = 10_000;

/// What a run did.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Number of steps made, up to the last node at which what is watched was finite.
    pub steps: u64,
    /// The node reached.
    pub node: u64,
    /// The time there.
    pub time: f64,
    /// Number of samples the observer was given.
    pub samples: u64,
    /// The drift of every component of every invariant, in the order of the model's card.
    pub drifts: Vec<Drift>,
}

/// Makes `steps` steps, sampling the start, every `every`-th step and the end (`every = 0`: start
/// and end only). The invariants are compared with those at the start at every sampled node; with
/// `every = 0` at every node of a run of at most [`LOOKS`] steps, and at that many of a longer one. Allocates before
/// the loop only.
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
/// - the first number that is NaN or infinite: of an invariant or its natural scale at a node that is looked at, of an
///   observable at a node that is sampled. The trajectory stands there; summary and samples are those
///   of the nodes up to the one looked at before.
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

/// A run up to a node: the numbers there, and what was seen before. It is advanced as far as one likes at a
/// time, and can be written down and made again together with its trajectory: how often makes no difference.
#[derive(Clone, Debug)]
pub struct Watch {
    total: u64,
    every: u64,
    /// Whether the start was looked at.
    begun: bool,
    /// The node looked at last, and what was seen up to there.
    looked: Place,
    observables: Vec<f64>,
    invariants: Vec<f64>,
    scales: Vec<f64>,
    /// Where among them the rates of held constraints stand.
    rates: Vec<HeldRate>,
    seen: Vec<Deviation>,
    /// The node sampled last.
    sampled: u64,
    /// The drifts are taken from `seen` at the end.
    summary: Summary,
}

/// How far a run has come.
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

    /// Makes at most `most` of the steps that are left. Before the first of all it looks at the start and
    /// samples it.
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

    /// Looks at the node at hand and adds it to what was seen; goes back to the node before if a number is not finite.
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

    /// Whether all steps are made.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.begun && self.summary.steps >= self.total
    }

    /// Samples the node at which a run ends before its end, unless it was sampled or is none: `error` is
    /// what [`Watch::advance`] gave.
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

    /// Samples the node at hand, unless it was sampled: the last one of a run that is not continued.
    pub fn sample_here(&mut self, trajectory: &dyn Trajectory, observer: &mut dyn Observer) {
        if !self.begun || self.sampled == self.summary.node {
            return;
        }
        if self.look_on(trajectory, true).is_ok() {
            self.sample(observer);
        }
    }

    /// What was done up to here.
    #[must_use]
    pub fn summary(&self) -> Summary {
        Summary {
            drifts: self.seen.iter().map(Deviation::drift).collect(),
            ..self.summary.clone()
        }
    }

    /// The numbers at the node, if all are finite; the observables where it is to be sampled.
    #[inline]
    fn look(&mut self, trajectory: &dyn Trajectory, sampled: bool) -> Result<(), NotFinite> {
        trajectory.invariants(&mut self.invariants);
        if let Err(found) = finite(trajectory, Watched::Invariant, &self.invariants) {
            return Err(self.told_of_overflow(trajectory, found));
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

    /// An invariant that is NaN because its terms are larger than any number: then no function left its domain.
    #[cold]
    fn told_of_overflow(&mut self, trajectory: &dyn Trajectory, found: NotFinite) -> NotFinite {
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

    /// Shows the node to the observer.
    fn sample(&mut self, observer: &mut dyn Observer) {
        let Summary { node, time, .. } = self.summary;
        observer.sample(node, time, &self.observables, &self.invariants);
        self.summary.samples += 1;
        self.sampled = node;
    }
}

/// What was seen, for a run of the same trajectory with the same numbers of steps.
impl Saved for Watch {
    fn words(&mut self, words: &mut Words) {
        let Self {
            total,
            every,
            begun,
            looked,
            // Those of the node at hand, and written before they are read.
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

/// Numbers larger than this have squares that are nearly as large as any number, and a product of two numbers that is kept in two
/// parts is NaN there.
const SQUARED: f64 = 1e150;

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
        since: trajectory.node(),
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
