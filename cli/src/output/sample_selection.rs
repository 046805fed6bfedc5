//! Selects the samples for a picture: all samples of a short run, the extremes of each interval of a long run. Takes
//! the rows of a run; gives a record of bounded size.

use super::samples::Rows;
use clebsch::card::Card;
use clebsch::record::{Record, Rows as _, Table};
use std::io;

/// If a record has more numbers than this, stretches of samples are drawn by their extremes.
const MOST: u64 = 1 << 22;

/// The smallest number of samples that is reduced: a picture has about as many columns of pixels, drawn four times
/// finer.
const FEWEST: u64 = 20_000;

/// The rows as a record. Each interval of a long run becomes two rows, which contain the two extremes of every number
/// in the order in which they occur.
pub(crate) fn record(card: &Card, rows: &Rows) -> io::Result<Record> {
    let [observables, invariants] = [card.observable_count(), card.invariant_count()];
    let most = (MOST / (2 + observables + invariants) as u64).max(FEWEST);
    // A stretch gives two rows; a stretch of one or two samples gives its samples.
    let stretch = (rows.count().saturating_mul(2)).div_ceil(most).max(1);
    let stretch = if rows.count() <= most { 1 } else { stretch };
    let table = |width| Table {
        width,
        numbers: Vec::new(),
    };
    let mut out = Record {
        observables: table(observables),
        invariants: table(invariants),
        ..Record::default()
    };
    let mut push = |node: u64, numbers: &[f64]| {
        let Some((time, numbers)) = numbers.split_first() else {
            return;
        };
        let (first, second) = numbers.split_at(observables.min(numbers.len()));
        out.nodes.push(node);
        out.times.push(*time);
        out.observables.numbers.extend_from_slice(first);
        out.invariants.numbers.extend_from_slice(second);
    };
    let mut here: Option<Stretch> = None;
    let mut met = 0;
    rows.each(&mut |row| {
        let Some((node, bits)) = row.split_first() else {
            return Ok(());
        };
        let numbers = || bits.iter().map(|x| f64::from_bits(*x));
        met += 1;
        // The first and the last sample are kept unchanged: drifts are measured from the first, and the run
        // ends at the last.
        if stretch == 1 || met == 1 || met == rows.count() {
            if let Some(done) = here.take() {
                done.tell(&mut push);
            }
            push(*node, &numbers().collect::<Vec<_>>());
            return Ok(());
        }
        let own = here.get_or_insert_with(|| Stretch::new(*node, numbers().collect()));
        own.take_in(*node, numbers());
        if own.count == stretch {
            here.take()
                .into_iter()
                .for_each(|done| done.tell(&mut push));
        }
        Ok(())
    })?;
    Ok(out)
}

/// Consecutive samples.
struct Stretch {
    count: u64,
    nodes: [u64; 2],
    /// For every number the least value with its node, and the greatest value with its node.
    least: Vec<(f64, u64)>,
    greatest: Vec<(f64, u64)>,
}

impl Stretch {
    fn new(node: u64, numbers: Vec<f64>) -> Self {
        let least: Vec<(f64, u64)> = numbers.into_iter().map(|x| (x, 0)).collect();
        Self {
            count: 0,
            nodes: [node, node],
            greatest: least.clone(),
            least,
        }
    }

    fn take_in(&mut self, node: u64, numbers: impl Iterator<Item = f64>) {
        for ((x, least), greatest) in numbers.zip(&mut self.least).zip(&mut self.greatest) {
            if x < least.0 {
                *least = (x, self.count);
            }
            if x > greatest.0 {
                *greatest = (x, self.count);
            }
        }
        self.nodes[1] = node;
        self.count += 1;
    }

    fn tell(self, push: &mut impl FnMut(u64, &[f64])) {
        let both = || self.least.iter().zip(&self.greatest);
        let earlier = both().map(|(a, b)| if a.1 <= b.1 { a.0 } else { b.0 });
        let later = both().map(|(a, b)| if a.1 <= b.1 { b.0 } else { a.0 });
        push(self.nodes[0], &earlier.collect::<Vec<_>>());
        push(self.nodes[1], &later.collect::<Vec<_>>());
    }
}
