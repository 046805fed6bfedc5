//! The samples of a run, kept in memory until they are written, and the progress bar.
//! Takes what the integration loop shows; gives tables with one row per sample.

use clebsch::card::Card;
use clebsch::integrate::Observer;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Most numbers a record may hold: 2 GiB, which also keeps an npz within the classic zip format.
pub const LARGEST: u64 = 1 << 28;

/// A rectangular table of numbers, row-major.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Numbers in a row.
    pub width: usize,
    /// All rows, one after another.
    pub numbers: Vec<f64>,
}

impl Table {
    /// The rows; none when a row has no numbers.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.numbers.chunks_exact(self.width.max(1))
    }

    /// Column `index` from top to bottom.
    pub fn column(&self, index: usize) -> impl Iterator<Item = f64> {
        self.rows().filter_map(move |row| row.get(index).copied())
    }
}

/// Samples of a trajectory, the first at node 0.
#[derive(Clone, Debug, Default)]
pub struct Record {
    /// Node of each sample.
    pub nodes: Vec<u64>,
    /// Time of each sample.
    pub times: Vec<f64>,
    /// Observables of each sample, in the order of the card.
    pub observables: Table,
    /// Components of the invariants of each sample, in the order of the card.
    pub invariants: Table,
}

impl Record {
    /// How many numbers a record of `steps` steps holds when every `every`-th node is kept.
    #[must_use]
    pub fn size(card: &Card, steps: u64, every: u64) -> u64 {
        let row = 2 + card.observable_count() + card.invariant_count();
        (steps / every.max(1))
            .saturating_add(2)
            .saturating_mul(row as u64)
    }

    /// Drops samples at the end, down to the last node that is wanted.
    pub fn keep(&mut self, wanted: impl Fn(u64) -> bool) {
        while self.nodes.last().is_some_and(|node| !wanted(*node)) {
            self.nodes.pop();
            self.times.pop();
            for table in [&mut self.observables, &mut self.invariants] {
                let left = table.numbers.len().saturating_sub(table.width);
                table.numbers.truncate(left);
            }
        }
    }
}

/// What is kept of a run for its files.
#[derive(Clone, Debug, Default)]
pub struct Samples {
    /// The samples to write.
    pub record: Record,
    /// Every node of the beginning, for plots of quick oscillations; `None` when the record has them.
    pub opening: Option<Record>,
}

/// What watches a run: it keeps the samples if they are wanted, and draws the bar if there is one.
pub struct Recorder {
    record: Option<Record>,
    bar: Option<ProgressBar>,
}

impl Recorder {
    /// Keeps samples when `keep`; draws a bar with the time left on standard error when `bar`.
    #[must_use]
    pub fn new(card: &Card, steps: u64, keep: bool, bar: bool) -> Self {
        let table = |width| Table {
            width,
            numbers: Vec::new(),
        };
        Self {
            record: keep.then(|| Record {
                observables: table(card.observable_count()),
                invariants: table(card.invariant_count()),
                ..Record::default()
            }),
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

/// A bar on standard error with the time left, for so many `what`.
pub(crate) fn progress_bar(steps: u64, what: &str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr());
    let template = format!("{{wide_bar}} {{human_pos}}/{{human_len}} {what}, {{eta}} left");
    match ProgressStyle::with_template(&template) {
        Ok(style) => bar.with_style(style),
        // The template is fixed; should it ever be wrong, the plain bar does.
        Err(_) => bar,
    }
}

impl Observer for Recorder {
    fn sample(&mut self, node: u64, time: f64, observables: &[f64], invariants: &[f64]) {
        if let Some(record) = &mut self.record {
            record.nodes.push(node);
            record.times.push(time);
            record.observables.numbers.extend_from_slice(observables);
            record.invariants.numbers.extend_from_slice(invariants);
        }
    }

    fn progress(&mut self, done: u64, _total: u64) {
        if let Some(bar) = &self.bar {
            bar.set_position(done);
        }
    }
}
