//! The samples of a run, kept in memory until they are written, and the progress bar.
//! Takes the samples of the integration loop; gives tables with one row per sample.

use crate::terminal::waiting::progress_bar;
use clebsch::card::Card;
use clebsch::integrate::Observer;
use clebsch::record::Record;
use indicatif::ProgressBar;

/// The largest number of values in a record: 2 GiB, which also keeps an npz within the classic zip format.
pub const LARGEST: u64 = 1 << 28;

/// The part of a run that is stored for its files.
#[derive(Clone, Debug, Default)]
pub struct Samples {
    /// The samples to write.
    pub record: Record,
    /// Every node of the first part of the run, for plots of fast oscillations; `None` if the record contains them.
    pub opening: Option<Record>,
}

/// Observes a run: stores the samples if they are requested, and draws the progress bar if there is one.
pub struct Recorder {
    record: Option<Record>,
    bar: Option<ProgressBar>,
}

impl Recorder {
    /// Stores samples if `keep` is true; draws a bar with the time left on standard error if `bar` is true.
    #[must_use]
    pub fn new(card: &Card, steps: u64, keep: bool, bar: bool) -> Self {
        Self {
            record: keep.then(|| Record::new(card)),
            bar: bar.then(|| progress_bar(steps, "steps")),
        }
    }

    /// Takes the bar away and gives the samples.
    #[must_use]
    pub fn finish(self) -> Option<Record> {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
        self.record
    }
}

impl Observer for Recorder {
    fn sample(&mut self, node: u64, time: f64, observables: &[f64], invariants: &[f64]) {
        if let Some(record) = &mut self.record {
            record.sample(node, time, observables, invariants);
        }
    }

    fn progress(&mut self, done: u64, _total: u64) {
        if let Some(bar) = &self.bar {
            bar.set_position(done);
        }
    }
}
