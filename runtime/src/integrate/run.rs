//! The loop itself.
//! Takes a trajectory, a number of steps and an observer; gives a [`Summary`], or the error of the
//! step that failed or of the number that is none.

use super::Drift;
use super::drift::Deviation;
use crate::StepError;
use crate::card::Trajectory;
use core::fmt;

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
    /// Number of steps made.
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

/// What of a trajectory is watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Watched {
    /// A component of an invariant, looked at on every node.
    Invariant,
    /// The natural scale of a component of an invariant, looked at on every node.
    Scale,
    /// A number of an observable, looked at on every node that is sampled.
    Observable,
}

/// A number of a trajectory that is NaN or infinite, though every step was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotFinite {
    /// The node.
    pub node: u64,
    /// The time there.
    pub time: f64,
    /// What it is a number of.
    pub watched: Watched,
    /// The name of the invariant or observable, as the card has it.
    pub name: &'static str,
    /// Which of its numbers, row-major from 0; `None` where there is one only.
    pub index: Option<usize>,
    /// How many numbers a row of it has.
    pub columns: usize,
    /// The number.
    pub value: f64,
}

impl fmt::Display for NotFinite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            node,
            time,
            name,
            value,
            ..
        } = self;
        write!(f, "at node {node} (time {time}) ")?;
        // Counted from 1, as in files and plots.
        match (self.index, self.columns) {
            (None, _) => {}
            (Some(index), ..=1) => write!(f, "component {} of ", index + 1)?,
            (Some(index), n) => write!(f, "entry ({}, {}) of ", index / n + 1, index % n + 1)?,
        }
        match self.watched {
            Watched::Invariant => write!(f, "the invariant `{name}` is {value}"),
            Watched::Scale => write!(f, "the natural scale of the invariant `{name}` is {value}"),
            Watched::Observable => write!(f, "`{name}` is {value}"),
        }?;
        f.write_str(
            ": a function was left by its domain, or a number is too large for f64; reduce the \
             step size, or check the parameters and initial values",
        )
    }
}

impl std::error::Error for NotFinite {}

/// Why a run stopped before its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RunError {
    /// A step was not made.
    Step(StepError),
    /// A step was made, and what is watched is no number after it.
    NotFinite(NotFinite),
}

impl RunError {
    /// The node at which the trajectory stands.
    #[must_use]
    pub fn node(&self) -> u64 {
        match self {
            Self::Step(error) => error.node,
            Self::NotFinite(found) => found.node,
        }
    }
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step(error) => error.fmt(f),
            Self::NotFinite(found) => found.fmt(f),
        }
    }
}

impl std::error::Error for RunError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Step(error) => Some(error),
            Self::NotFinite(found) => Some(found),
        }
    }
}

impl From<StepError> for RunError {
    #[cold]
    fn from(error: StepError) -> Self {
        Self::Step(error)
    }
}

impl From<NotFinite> for RunError {
    #[cold]
    fn from(found: NotFinite) -> Self {
        Self::NotFinite(found)
    }
}

/// Makes `steps` steps, sampling the start, every `every`-th step and the end (`every = 0`: start
/// and end only). The invariants are compared with those at the start after every step, sampled
/// or not. Allocates before the loop only.
///
/// # Errors
/// The first [`StepError`]; the trajectory then stands at the node before it, and the observer has
/// all samples up to there. The first number that is NaN or infinite: of an invariant or its natural
/// scale at any node, of an observable at a node that is sampled; the trajectory stands there, and the observer has all
/// samples before it.
pub fn run(
    trajectory: &mut dyn Trajectory,
    steps: u64,
    every: u64,
    observer: &mut dyn Observer,
) -> Result<Summary, RunError> {
    let card = trajectory.card();
    let mut observables = vec![0.0; card.observable_count()];
    let mut invariants = vec![0.0; card.invariant_count()];
    let mut scales = vec![0.0; card.invariant_count()];
    trajectory.scales(&mut scales);
    trajectory.invariants(&mut invariants);
    finite(trajectory, Watched::Invariant, &invariants)?;
    finite(trajectory, Watched::Scale, &scales)?;
    let seen = invariants.iter().zip(&scales);
    let mut seen: Vec<Deviation> = seen.map(|(start, s)| Deviation::none(*start, *s)).collect();

    let stride = (steps / 200).clamp(1, 1024);
    let mut samples = 1;
    trajectory.observe(&mut observables);
    finite(trajectory, Watched::Observable, &observables)?;
    observer.sample(
        trajectory.node(),
        trajectory.time(),
        &observables,
        &invariants,
    );
    for done in 1..=steps {
        trajectory.step()?;
        trajectory.invariants(&mut invariants);
        finite(trajectory, Watched::Invariant, &invariants)?;
        trajectory.scales(&mut scales);
        finite(trajectory, Watched::Scale, &scales)?;
        for ((seen, now), scale) in seen.iter_mut().zip(&invariants).zip(&scales) {
            seen.record(*now, *scale);
        }
        if done == steps || (every != 0 && done % every == 0) {
            trajectory.observe(&mut observables);
            finite(trajectory, Watched::Observable, &observables)?;
            observer.sample(
                trajectory.node(),
                trajectory.time(),
                &observables,
                &invariants,
            );
            samples += 1;
        }
        if done == steps || done % stride == 0 {
            observer.progress(done, steps);
        }
    }
    Ok(Summary {
        steps,
        node: trajectory.node(),
        time: trajectory.time(),
        samples,
        drifts: seen.iter().map(Deviation::drift).collect(),
    })
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
