//! A running case, with its samples in memory. Takes a plan; takes steps for a given time, and gives rows and drifts
//! at any node. How the steps are divided changes no result.

use super::model::Planned;
use crate::plan::Plan;
use crate::terminal::failure::Failure;
use crate::trajectory::checkpoint::{Checkpoint, Identity};
use crate::trajectory::stated::JudgedTrajectory;
use crate::trajectory::step_limit::StepLimit;
use crate::trajectory::verdict::{Outcome, judge, lost};
use clebsch::StepError;
use clebsch::card::{Card, Trajectory};
use clebsch::integrate::{Halvings, Observer, RunError, Summary, Watch};
use clebsch::saved::Words;
use clebsch_check::{StepSelection, Verdict};
use std::collections::TryReserveError;
use std::time::{Duration, Instant};

/// The duration of a batch of steps.
const AT_A_TIME: Duration = Duration::from_millis(20);

/// Samples of a run, each as one row of observables and invariants.
#[derive(Debug, Default)]
pub struct Rows {
    /// The node of each sample.
    pub nodes: Vec<u64>,
    /// The time of each sample.
    pub times: Vec<f64>,
    /// The rows, one after another.
    pub numbers: Vec<f64>,
    /// The first time at which memory did not suffice: later samples are dropped.
    full: Option<TryReserveError>,
}

impl Rows {
    /// Allocates memory for `samples` samples, so that rows are never moved.
    fn with_room(samples: usize, width: usize) -> Result<Self, TryReserveError> {
        let mut rows = Self::default();
        rows.nodes.try_reserve_exact(samples)?;
        rows.times.try_reserve_exact(samples)?;
        rows.numbers
            .try_reserve_exact(samples.saturating_mul(width))?;
        Ok(rows)
    }
}

impl Observer for Rows {
    fn sample(&mut self, node: u64, time: f64, observables: &[f64], invariants: &[f64]) {
        if self.full.is_some() {
            return;
        }
        let more = observables.len() + invariants.len();
        let room = self
            .numbers
            .try_reserve(more)
            .and_then(|()| self.nodes.try_reserve(1))
            .and_then(|()| self.times.try_reserve(1));
        if let Err(error) = room {
            self.full = Some(error);
            return;
        }
        self.nodes.push(node);
        self.times.push(time);
        self.numbers.extend_from_slice(observables);
        self.numbers.extend_from_slice(invariants);
    }
}

/// The stability limit of the step size.
#[derive(Clone, Debug, Default)]
pub struct StepLimits {
    /// The largest stable step size.
    pub step: Option<f64>,
    /// The frequency of the fastest small motion about the start.
    pub frequency: Option<f64>,
    /// The limit as a sentence, if it is reported.
    pub told: Option<String>,
    /// A warning on the step size of the case.
    pub warning: Option<String>,
}

/// A running case.
pub struct Running {
    card: Card,
    plan: Plan,
    judged: bool,
    trajectory: JudgedTrajectory,
    watch: Watch,
    rows: Rows,
}

impl Running {
    /// Starts a plan; its samples are stored if `sampled` is true.
    ///
    /// # Errors
    /// Usage: the model rejects the data. Failed: the first step fails, or memory does not suffice.
    pub fn start(planned: Planned, which: StepSelection, sampled: bool) -> Result<Self, Failure> {
        let Planned { card, plan, .. } = planned;
        let opened = plan.open(&card)?;
        let trajectory = JudgedTrajectory::new(&card, &plan, which, opened);
        let steps = plan.case.steps;
        let watch = Watch::new(&trajectory, steps, plan.every);
        let rows = match sampled {
            false => Rows::default(),
            true => {
                let samples = match plan.every {
                    0 => 2,
                    every => (steps / every).saturating_add(2),
                };
                let samples = usize::try_from(samples).unwrap_or(usize::MAX);
                let width = card.observable_count() + card.invariant_count();
                Rows::with_room(samples, width).map_err(|error| {
                    Failure::Failed(format!(
                        "{samples} samples of {width} numbers do not fit into memory ({error}); record fewer nodes with a \
                         larger `every`"
                    ))
                })?
            }
        };
        Ok(Self {
            card,
            plan,
            judged: which != StepSelection::None,
            trajectory,
            watch,
            rows,
        })
    }

    /// The model.
    #[must_use]
    pub fn card(&self) -> &Card {
        &self.card
    }

    /// The plan of the run.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Takes steps for about this time; returns whether the run has ended.
    ///
    /// # Errors
    /// The step that failed, or the number that is not finite after it. The run ends at the previous node.
    pub fn advance(&mut self, time: Duration) -> Result<bool, RunError> {
        let begun = Instant::now();
        let mut most: u64 = 1;
        loop {
            let from = Instant::now();
            if let Err(error) = self
                .watch
                .advance(&mut self.trajectory, &mut self.rows, most)
            {
                self.watch.stop(&self.trajectory, &mut self.rows, &error);
                return Err(error);
            }
            if self.watch.is_over() || self.rows.full.is_some() {
                return Ok(true);
            }
            if begun.elapsed() >= time {
                return Ok(false);
            }
            most = match from.elapsed() {
                short if short < AT_A_TIME / 2 => most.saturating_mul(4),
                long if long > AT_A_TIME => (most / 2).max(1),
                _ => most,
            };
        }
    }

    /// Ends the run at the current node, which becomes the last sample.
    pub fn end_here(&mut self) {
        self.watch.sample_here(&self.trajectory, &mut self.rows);
    }

    /// Why samples are missing, if memory did not suffice.
    #[must_use]
    pub fn full(&self) -> Option<String> {
        self.rows.full.as_ref().map(ToString::to_string)
    }

    /// Steps, node, time and drifts so far.
    #[must_use]
    pub fn summary(&self) -> Summary {
        self.watch.summary()
    }

    /// The outcome of every invariant so far.
    #[must_use]
    pub fn outcomes(&self) -> Vec<Outcome> {
        judge(&self.card, &self.plan.case, &self.watch.summary().drifts)
    }

    /// Warnings on invariants that were lost.
    #[must_use]
    pub fn lost(&self) -> Vec<String> {
        lost(&self.outcomes(), self.plan.case.h)
    }

    /// The verdict of the action as stated on the judged steps.
    #[must_use]
    pub fn stated(&self) -> Option<&Verdict> {
        self.judged.then(|| self.trajectory.verdict())
    }

    /// Steps that were subdivided.
    #[must_use]
    pub fn halvings(&self) -> Option<Halvings> {
        self.trajectory.halvings()
    }

    /// A warning on the kinetic energy at the start, if there is one.
    #[must_use]
    pub fn kinetic_warning(&self) -> Option<String> {
        self.trajectory.kinetic_warning().map(|w| w.to_string())
    }

    /// The rows so far.
    #[must_use]
    pub fn rows(&self) -> &Rows {
        &self.rows
    }

    /// Takes the rows away.
    pub fn take_rows(&mut self) -> Rows {
        std::mem::take(&mut self.rows)
    }

    /// Takes at most `steps` steps without sampling, for about this `time`. Returns the number of steps taken.
    ///
    /// # Errors
    /// The number of steps before the one that failed, and the reason.
    pub fn step(&mut self, steps: u64, time: Duration) -> Result<u64, (u64, StepError)> {
        let begun = Instant::now();
        let mut made = 0;
        while made < steps {
            self.trajectory.step().map_err(|error| (made, error))?;
            made += 1;
            // The clock is read only sometimes: a step of a body takes less time than a reading.
            if (made < 16 || made % 64 == 0) && begun.elapsed() >= time {
                break;
            }
        }
        Ok(made)
    }

    /// Node and time at hand.
    #[must_use]
    pub fn place(&self) -> (u64, f64) {
        (self.trajectory.node(), self.trajectory.time())
    }

    /// The row of the node at hand: observables, then invariants.
    #[must_use]
    pub fn row(&self) -> Vec<f64> {
        let observables = self.card.observable_count();
        let mut row = vec![0.0; observables + self.card.invariant_count()];
        let (first, second) = row.split_at_mut(observables);
        self.trajectory.observe(first);
        self.trajectory.invariants(second);
        row
    }

    /// The state as the bytes of a checkpoint; `None` if the trajectory cannot be saved.
    #[must_use]
    pub fn saved(&mut self) -> Option<Vec<u8>> {
        let mut words = Words::gathered();
        self.trajectory.words(&mut words);
        let checkpoint = Checkpoint {
            trajectory: words.into_list()?,
            watch: Vec::new(),
            rows: 0,
            sum: 0,
        };
        let mut bytes = Vec::new();
        checkpoint.put(&self.identity(), &mut bytes).ok()?;
        Some(bytes)
    }

    /// Restores the bytes of a checkpoint.
    ///
    /// # Errors
    /// Why they are not of this case, in words.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), String> {
        let checkpoint = Checkpoint::of_bytes(bytes, &self.identity())?;
        let mut words = Words::given(checkpoint.trajectory);
        self.trajectory.words(&mut words);
        match words.all_put() {
            true => Ok(()),
            false => Err(
                "it does not fit the state of this model: another build of clebsch wrote it"
                    .to_owned(),
            ),
        }
    }

    fn identity(&self) -> Identity {
        Identity::of(&self.card, &self.plan)
    }

    /// The stability limit of the step size of a plan, searched for at most this time.
    #[must_use]
    pub fn stability_limit(card: &Card, plan: &Plan, patience: Duration) -> StepLimits {
        let limit = StepLimit::of(card, plan, patience);
        let h = plan.case.h;
        let known = match &limit {
            StepLimit::Known(found) if found.step.is_finite() => Some(found),
            _ => None,
        };
        StepLimits {
            step: known.map(|found| found.step),
            frequency: known.map(clebsch::integrate::LongestStep::frequency),
            told: limit.summary_line(h),
            warning: limit.warning(h),
        }
    }
}
