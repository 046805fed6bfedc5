//! The part of a run that a plot of oscillating quantities can show.
//! Takes the samples of a run; gives the samples to draw: all, or a first part with every oscillation resolved.

use crate::trajectory::record::Samples;
use clebsch::record::{Record, Table};
use std::ops::Range;

/// The largest number of oscillations that can be distinguished across the width of a plot.
const SWINGS: usize = 60;

/// Samples needed per swing for it to look like one.
const SAMPLES_PER_SWING: usize = 12;

/// A turning point counts if the curve has moved by this fraction of the panel's height since the last one; smaller
/// changes are ripples.
const RIPPLE: f64 = 0.05;

/// The samples to draw: the rows of `record` with index below `count`.
#[derive(Clone, Copy)]
pub(crate) struct Window<'a> {
    pub record: &'a Record,
    pub count: usize,
    /// Whether the run continues beyond.
    pub cut: bool,
}

/// Chooses the samples for panels that show the given columns of the observables.
pub(crate) fn window<'a>(samples: &'a Samples, panels: &[Range<usize>]) -> Window<'a> {
    let record = &samples.record;
    let all = Window {
        record,
        count: record.times.len(),
        cut: false,
    };
    let start = samples.opening.as_ref().unwrap_or(record);
    // The number of nodes until some curve has completed the largest number of oscillations, and the shortest
    // mean period up to that node.
    let turns = panels
        .iter()
        .flat_map(|panel| turns(&start.observables, panel));
    let busiest = turns
        .map(|turns| (turns.get(SWINGS).copied(), turns))
        .min_by_key(|(full, turns)| (full.unwrap_or(usize::MAX), usize::MAX - turns.len()));
    let Some((full, turns)) = busiest else {
        return all;
    };
    let nodes = start.times.len();
    let coarse = samples.opening.is_some() && {
        // Nodes per swing against nodes per sample of the record.
        let swing = turns.last().map_or(nodes, |last| last / turns.len());
        let step = record
            .nodes
            .get(1)
            .map_or(1, |node| usize::try_from(*node).unwrap_or(usize::MAX));
        swing < step.saturating_mul(SAMPLES_PER_SWING)
    };
    let crowded = match (full, turns.last()) {
        // If the opening ends before the oscillations fill the plot, the whole run decides.
        (None, Some(last)) => {
            let run = record
                .nodes
                .last()
                .map_or(0, |node| usize::try_from(*node).unwrap_or(usize::MAX));
            run / (last / turns.len()).max(1) > SWINGS
        }
        (full, _) => full.is_some(),
    };
    if !(coarse || crowded) {
        return all;
    }
    Window {
        record: start,
        count: full.map_or(nodes, |node| node + 1).min(nodes),
        cut: true,
    }
}

/// For each column of a panel, the rows of its turning points.
fn turns(table: &Table, panel: &Range<usize>) -> Vec<Vec<usize>> {
    let columns = || panel.clone().map(|index| table.column(index));
    let bounds = columns().flatten().filter(|value| value.is_finite());
    let (low, high) = bounds.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    // The rounding noise of a constant does not count as an oscillation.
    let ripple = (RIPPLE * (high - low)).max(1e-9 * low.abs().max(high.abs()));
    columns().map(|column| turns_of(column, ripple)).collect()
}

fn turns_of(column: impl Iterator<Item = f64>, ripple: f64) -> Vec<usize> {
    let mut turns = Vec::new();
    let mut column = column.enumerate();
    let Some((_, first)) = column.next() else {
        return turns;
    };
    // Extremes since the last turning point, and the direction since then (0: none yet).
    let (mut low, mut high, mut direction) = ((0, first), (0, first), 0);
    for (row, value) in column {
        if value > high.1 {
            high = (row, value);
        }
        if value < low.1 {
            low = (row, value);
        }
        if direction >= 0 && high.1 - value > ripple {
            if direction > 0 {
                turns.push(high.0);
            }
            (low, high, direction) = ((row, value), (row, value), -1);
        } else if direction <= 0 && value - low.1 > ripple {
            if direction < 0 {
                turns.push(low.0);
            }
            (low, high, direction) = ((row, value), (row, value), 1);
        }
    }
    turns
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(nodes: u64, every: u64) -> Record {
        let nodes: Vec<u64> = (0..=nodes).filter(|node| node % every == 0).collect();
        Record {
            times: nodes.iter().map(|&node| node as f64).collect(),
            observables: Table {
                width: 2,
                // Half a period is ten nodes; the other column is constant up to rounding.
                numbers: nodes
                    .iter()
                    .flat_map(|&node| {
                        let phase = std::f64::consts::PI * (node as f64 + 0.3) / 10.0;
                        [phase.sin(), 1.0 + 1e-16 * node as f64]
                    })
                    .collect(),
            },
            invariants: Table::default(),
            nodes,
        }
    }

    #[test]
    fn short_runs_are_shown_whole() {
        let samples = Samples {
            record: record(500, 1),
            opening: None,
        };
        let window = window(&samples, std::slice::from_ref(&(0..2)));
        assert!(!window.cut);
        assert_eq!(window.count, 501);
    }

    #[test]
    fn long_runs_are_shown_up_to_the_swings_that_fit() {
        let dense = Samples {
            record: record(100_000, 1),
            opening: None,
        };
        let sparse = Samples {
            record: record(100_000, 7),
            opening: Some(record(10_000, 1)),
        };
        for samples in [dense, sparse] {
            let window = window(&samples, std::slice::from_ref(&(0..2)));
            assert!(window.cut);
            assert!((600..620).contains(&window.count), "{}", window.count);
            assert_eq!(window.record.nodes[1], 1);
        }
    }

    #[test]
    fn slow_motion_is_shown_whole_from_few_samples() {
        let slow = |nodes: u64, every: u64| {
            let mut record = record(nodes, every);
            let wave = |row: usize| (record.nodes[row / 2] as f64 / 1e5).cos();
            record.observables.numbers = (0..2 * record.nodes.len()).map(wave).collect();
            record
        };
        let samples = Samples {
            record: slow(1_000_000, 100),
            opening: Some(slow(10_000, 1)),
        };
        assert!(!window(&samples, std::slice::from_ref(&(0..2))).cut);
    }
}
