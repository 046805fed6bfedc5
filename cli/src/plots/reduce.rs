//! Reduces the number of points without hiding anything: extremes of each interval, or the envelope of a drift. Takes
//! samples; gives points in the order of time.

use clebsch::integrate::Drift;
use clebsch::record::Record;
use clebsch::scalar::larger;

/// Stretches of a curve. A plot is about 650 pixels wide and drawn four times finer; two points per interval then
/// leave no visible gap, and files stay small.
const STRETCHES: usize = 1000;

/// Points of an envelope: a smooth line rather than a band.
const ENVELOPE: usize = 150;

/// The smallest and the largest value of each interval, in the order in which they occur. NaNs are omitted.
pub(crate) fn extremes(times: &[f64], values: impl Iterator<Item = f64>) -> Vec<(f64, f64)> {
    let points = times.iter().copied().zip(values);
    let points: Vec<(f64, f64)> = points.filter(|point| !point.1.is_nan()).collect();
    let stretch = points.len().div_ceil(STRETCHES);
    if stretch <= 2 {
        return points;
    }
    let mut kept = Vec::with_capacity(2 * STRETCHES + 2);
    kept.extend(points.first());
    for stretch in points.chunks(stretch) {
        let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let pair = (
            stretch.iter().min_by(by_value),
            stretch.iter().max_by(by_value),
        );
        if let (Some(&least), Some(&greatest)) = pair {
            let in_order = least.0 <= greatest.0;
            kept.extend(if in_order {
                [least, greatest]
            } else {
                [greatest, least]
            });
        }
    }
    kept.extend(points.last());
    kept
}

/// Largest drift of the components that begin at column `from`, at every sample after the first, at which the
/// drift is zero by definition.
pub(super) fn drift(record: &Record, from: usize, components: &[Drift]) -> Vec<(f64, f64)> {
    let rows = || record.invariants.rows().map(|row| row.iter().skip(from));
    let start: Vec<f64> = rows()
        .next()
        .map_or_else(Vec::new, |row| row.copied().collect());
    let largest = |row: std::iter::Skip<std::slice::Iter<'_, f64>>| {
        let each = row.zip(&start).zip(components);
        each.fold(0.0, |most: f64, ((now, then), drift)| {
            larger(most, Drift::of(now - then, drift.scale).abs())
        })
    };
    let drifts = rows().map(largest);
    record.times.iter().copied().zip(drifts).skip(1).collect()
}

/// How many of `samples` samples share a point of an envelope.
pub(super) fn group(samples: usize) -> usize {
    samples.div_ceil(ENVELOPE).max(1)
}

/// The largest value of each group of samples, with its time. The sizes of the groups differ by at most one,
/// since a small last group would look like a decrease.
pub(crate) fn envelope(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let count = points.len().div_ceil(group(points.len()));
    let groups = (0..count).filter_map(|index| {
        points.get(index * points.len() / count..(index + 1) * points.len() / count)
    });
    groups
        .filter_map(|group| group.iter().max_by(|a, b| a.1.total_cmp(&b.1)).copied())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_spike_survives() {
        let times: Vec<f64> = (0..100_000).map(f64::from).collect();
        let spike = |time: f64| if time == 54_321.0 { 7.0 } else { 0.0 };
        let kept = extremes(&times, times.iter().copied().map(spike));
        assert!(kept.len() <= 2 * STRETCHES + 2);
        assert!(kept.contains(&(54_321.0, 7.0)));
        assert!(kept.is_sorted_by(|a, b| a.0 <= b.0));
        let undetermined = |time: f64| if time == 0.0 { f64::NAN } else { spike(time) };
        let kept = extremes(&times, times.iter().copied().map(undetermined));
        assert_eq!(kept.first(), Some(&(1.0, 0.0)));
        assert!(kept.contains(&(54_321.0, 7.0)));
        let points: Vec<_> = times.iter().map(|&time| (time, spike(time))).collect();
        let kept = envelope(&points);
        assert!(kept.len() <= ENVELOPE);
        assert!(kept.contains(&(54_321.0, 7.0)));
    }
}
