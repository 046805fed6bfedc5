//! The samples of a run in memory and in files: tables, CSV, files for ParaView, and with the feature `npz` archives
//! for numpy.
//! Takes the samples of the integration loop; gives tables with one row per sample.

mod csv;
mod names;
#[cfg(feature = "npz")]
pub mod npz;
pub mod vtk;

pub use csv::write as write_csv;
pub use names::{columns, invariant as invariant_name};

use crate::card::Card;
use crate::integrate::Observer;
use std::io;

/// A rectangular table of numbers, row-major.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Numbers in a row.
    pub width: usize,
    /// All rows, one after another.
    pub numbers: Vec<f64>,
}

impl Table {
    /// The rows; empty if the width is zero.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.numbers.chunks_exact(self.width.max(1))
    }

    /// Column `index` from top to bottom.
    pub fn column(&self, index: usize) -> impl Iterator<Item = f64> {
        self.rows().filter_map(move |row| row.get(index).copied())
    }
}

/// Samples of a trajectory, the first at node 0. It watches a run itself:
///
/// ```
/// use clebsch::integrate::run;
/// use clebsch::record::{Record, write_csv};
///
/// clebsch::model! {
///     model Oscillator {
///         param m, c: Real;
///         field q: Real;
///         lagrangian = m*(next(q) - q)^2/(2*h) - h*c*q^2/2;
///     }
/// }
///
/// let settings = clebsch::card::Settings::step(0.1);
/// let mut running = (Oscillator::CARD.open)(&[vec![1.0], vec![4.0]], &[vec![1.0], vec![0.0]], settings)?;
/// let mut record = Record::new(running.card());
/// run(running.as_mut(), 100, 10, &mut record)?;
/// assert_eq!(record.times.len(), 11);
///
/// let mut file = Vec::new(); // or a std::fs::File
/// write_csv(&mut file, running.card(), &record)?;
/// assert!(file.starts_with(b"node,time,q,"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
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
    /// An empty one for a model.
    #[must_use]
    pub fn new(card: &Card) -> Self {
        let table = |width| Table {
            width,
            numbers: Vec::new(),
        };
        Self {
            observables: table(card.observable_count()),
            invariants: table(card.invariant_count()),
            ..Self::default()
        }
    }

    /// The number of values in a record of `steps` steps if every `every`-th node is recorded.
    #[must_use]
    pub fn size(card: &Card, steps: u64, every: u64) -> u64 {
        let row = 2 + card.observable_count() + card.invariant_count();
        (steps / every.max(1))
            .saturating_add(2)
            .saturating_mul(row as u64)
    }

    /// Drops samples at the end, down to the last requested node.
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

impl Observer for Record {
    fn sample(&mut self, node: u64, time: f64, observables: &[f64], invariants: &[f64]) {
        self.nodes.push(node);
        self.times.push(time);
        self.observables.numbers.extend_from_slice(observables);
        self.invariants.numbers.extend_from_slice(invariants);
    }
}

/// Samples that are written row by row, from any storage.
pub trait Rows {
    /// How many.
    fn count(&self) -> u64;

    /// Calls a function with one row after the other, each as words: the node, then the bits of all numbers (time,
    /// observables, invariants).
    ///
    /// # Errors
    /// Errors of `show`, and of the storage of the rows.
    fn each(&self, show: &mut dyn FnMut(&[u64]) -> io::Result<()>) -> io::Result<()>;
}

impl Rows for Record {
    fn count(&self) -> u64 {
        self.nodes.len() as u64
    }

    fn each(&self, show: &mut dyn FnMut(&[u64]) -> io::Result<()>) -> io::Result<()> {
        let mut row = Vec::new();
        for (at, (node, time)) in self.nodes.iter().zip(&self.times).enumerate() {
            row.clear();
            row.extend([*node, time.to_bits()]);
            for table in [&self.observables, &self.invariants] {
                let from = at * table.width;
                let own = table.numbers.get(from..from + table.width);
                row.extend(own.unwrap_or_default().iter().map(|x| x.to_bits()));
            }
            show(&row)?;
        }
        Ok(())
    }
}
