//! The loop itself.
//! Takes a trajectory, a number of steps and an observer; gives a [`Summary`] or the step's error.

use super::Drift;
use crate::StepError;
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

/// Makes `steps` steps, sampling the start, every `every`-th step and the end (`every = 0`: start
/// and end only). The invariants are compared with those at the start after every step, sampled
/// or not. Allocates before the loop only.
///
/// # Errors
/// The first [`StepError`]; the trajectory then stands at the node before it, and the observer has
/// all samples up to there.
pub fn run(
    trajectory: &mut dyn Trajectory,
    steps: u64,
    every: u64,
    observer: &mut dyn Observer,
) -> Result<Summary, StepError> {
    let card = trajectory.card();
    let mut observables = vec![0.0; card.observable_count()];
    let mut invariants = vec![0.0; card.invariant_count()];
    let mut scales = vec![0.0; card.invariant_count()];
    trajectory.scales(&mut scales);
    trajectory.invariants(&mut invariants);
    let initial = invariants.clone();
    let mut drifts: Vec<Drift> = scales.iter().map(|scale| Drift::at_rest(*scale)).collect();

    let stride = (steps / 200).clamp(1, 1024);
    let mut samples = 1;
    trajectory.observe(&mut observables);
    observer.sample(
        trajectory.node(),
        trajectory.time(),
        &observables,
        &invariants,
    );
    for done in 1..=steps {
        trajectory.step()?;
        trajectory.invariants(&mut invariants);
        for ((drift, now), then) in drifts.iter_mut().zip(&invariants).zip(&initial) {
            drift.record(now - then);
        }
        if done == steps || (every != 0 && done % every == 0) {
            trajectory.observe(&mut observables);
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
        drifts,
    })
}
