//! The loop of a run: steps in batches, and between them signals, checkpoints and the progress bar. Takes a
//! trajectory and its observations; gives the end of the run. The size of the batches does not affect the result.

use crate::output::samples::Stream;
use crate::output::{SignalListener, Staging};
use crate::terminal::failure::Failure;
use crate::terminal::waiting::progress_bar;
use crate::trajectory::checkpoint::{Checkpoint, Identity};
use crate::words::plain::shown;
use clebsch::card::Trajectory;
use clebsch::integrate::{Observer, RunError, Watch};
use clebsch::saved::{Saved, Words};
use indicatif::ProgressBar;
use std::io;
use std::time::{Duration, Instant};

/// The duration of a batch of steps.
const AT_A_TIME: Duration = Duration::from_millis(50);

/// The end of a run.
pub(crate) enum End {
    /// All steps are complete.
    Whole,
    /// A step failed, or a number after it is not finite.
    Stopped(RunError),
    /// By this signal.
    Interrupted(u8),
}

/// A run in progress.
pub(crate) struct Run<'a> {
    /// The motion.
    pub(crate) trajectory: &'a mut dyn Trajectory,
    /// The observations of the motion so far.
    pub(crate) watch: Watch,
    /// Number of steps in all.
    pub(crate) steps: u64,
    /// Whether to draw a bar.
    pub(crate) progress: bool,
}

/// The output of a run while it computes.
pub(crate) struct RunOutput<'a> {
    /// Its folder.
    pub(crate) staging: &'a mut Staging,
    /// Its samples.
    pub(crate) stream: Stream,
    /// The identity of the run.
    pub(crate) identity: Identity,
    /// Seconds between checkpoints.
    pub(crate) seconds: f64,
}

impl Run<'_> {
    /// Restores a checkpoint into a newly started trajectory and its watch.
    ///
    /// # Errors
    /// Usage: it does not fit them.
    pub(crate) fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), Failure> {
        let (mut words, mut seen) = (
            Words::given(checkpoint.trajectory.clone()),
            Words::given(checkpoint.watch.clone()),
        );
        self.trajectory.words(&mut words);
        self.watch.words(&mut seen);
        match words.all_put() && seen.all_put() {
            true => Ok(()),
            false => Err(Failure::Usage(
                "--resume: the checkpoint does not fit the state of this model: another build of clebsch wrote it. Start over \
                 with --force instead"
                    .to_owned(),
            )),
        }
    }

    /// Takes the remaining steps.
    ///
    /// # Errors
    /// Failed: samples or checkpoints cannot be written. The run can be resumed from the last checkpoint that
    /// was written.
    pub(crate) fn follow(&mut self, kept: Option<&mut RunOutput<'_>>) -> Result<End, Failure> {
        let listening = SignalListener::begin();
        let bar = self.progress.then(|| progress_bar(self.steps, "steps"));
        if let Some(bar) = &bar {
            bar.set_position(self.watch.summary().steps);
            bar.reset_eta();
        }
        let end = self.steps_left(&listening, kept, bar.as_ref());
        if let Some(bar) = bar {
            bar.finish_and_clear();
        }
        end
    }

    fn steps_left(
        &mut self,
        listening: &SignalListener,
        mut kept: Option<&mut RunOutput<'_>>,
        bar: Option<&ProgressBar>,
    ) -> Result<End, Failure> {
        let begun = Instant::now();
        let mut last_checkpoint = begun;
        let mut most = 1;
        let mut done = self.watch.summary().steps;
        loop {
            let from = Instant::now();
            let mut samples = Samples(kept.as_deref_mut().map(|kept| &mut kept.stream));
            let advanced = self.watch.advance(self.trajectory, &mut samples, most);
            if let Some(kept) = &mut kept {
                kept.stream.check().map_err(|error| kept.refused(&error))?;
            }
            if let Err(error) = advanced {
                let mut samples = Samples(kept.map(|kept| &mut kept.stream));
                self.watch.stop(self.trajectory, &mut samples, &error);
                return Ok(End::Stopped(error));
            }
            done = self.steps.min(done.saturating_add(most));
            if let Some(bar) = bar {
                bar.set_position(done);
            }
            let over = self.watch.is_over();
            let asked = listening.stop_signal().filter(|_| !over);
            if let Some(kept) = &mut kept {
                let due = last_checkpoint.elapsed().as_secs_f64() >= kept.seconds;
                // Also at the end, since writing the files may take long and may be interrupted.
                let at_the_end = over && begun.elapsed() > AT_A_TIME;
                if due || asked.is_some() || at_the_end {
                    self.checkpoint(kept)?;
                    last_checkpoint = Instant::now();
                }
            }
            if let Some(signal) = asked {
                let mut samples = Samples(kept.map(|kept| &mut kept.stream));
                self.watch.sample_here(self.trajectory, &mut samples);
                return Ok(End::Interrupted(signal));
            }
            if over {
                return Ok(End::Whole);
            }
            most = match from.elapsed() {
                short if short < AT_A_TIME / 2 => most.saturating_mul(2),
                long if long > AT_A_TIME => (most / 2).max(1),
                _ => most,
            };
        }
    }

    /// Writes a checkpoint, if the trajectory can be written down.
    fn checkpoint(&mut self, kept: &mut RunOutput<'_>) -> Result<(), Failure> {
        let (mut trajectory, mut watch) = (Words::gathered(), Words::gathered());
        self.trajectory.words(&mut trajectory);
        self.watch.words(&mut watch);
        let (Some(trajectory), Some(watch)) = (trajectory.into_list(), watch.into_list()) else {
            return Ok(());
        };
        let (rows, sum) = kept
            .stream
            .settled()
            .map_err(|error| kept.refused(&error))?;
        let checkpoint = Checkpoint {
            trajectory,
            watch,
            rows,
            sum,
        };
        let folder = kept.staging.folder();
        checkpoint
            .write(folder, &kept.identity)
            .map_err(|error| kept.refused(&error))?;
        kept.staging.keep();
        Ok(())
    }
}

impl RunOutput<'_> {
    fn refused(&self, error: &io::Error) -> Failure {
        let folder = self.staging.folder();
        let message = format!("cannot write into {}", shown(folder));
        let Failure::Failed(message) = Failure::io(&message, error) else {
            return Failure::Failed(message);
        };
        Failure::Failed(
            match folder.join(crate::trajectory::checkpoint::NAME).is_file() {
                true => format!("{message}; --resume continues from the last checkpoint"),
                false => message,
            },
        )
    }
}

/// The rows of the samples, if they are stored.
struct Samples<'a>(Option<&'a mut Stream>);

impl Observer for Samples<'_> {
    fn sample(&mut self, node: u64, time: f64, observables: &[f64], invariants: &[f64]) {
        if let Some(stream) = &mut self.0 {
            stream.push(node, time, observables, invariants);
        }
    }
}
