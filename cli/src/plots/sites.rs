//! Space-time maps of the quantities at the sites of a label.
//! Takes the samples of a run; gives one map for each component of each quantity.

use super::axis::Axis;
use super::figure::Panel;
use super::map::Map;
use super::{figure, letter, place};
use crate::output::Finished;
use crate::output::sites::{AtSites, at_sites};
use crate::plots::Plot;
use crate::plots::window::Window;
use crate::trajectory::record::Samples;
use crate::words::number;
use clebsch::card::{Field, Kind};
use clebsch::record::Record;
use clebsch::scalar::largest;
use std::ops::Range;

/// The largest number of columns of a map. More columns could not be distinguished on a page.
const COLUMNS: usize = 160;

/// The largest number of sites with rows in a map. If there are more, a selection is drawn.
const ROWS: usize = 240;

/// Height of a panel with a sentence.
const SENTENCE: u32 = 84;

/// The largest number of components that are drawn as maps. Maps of the entries of a rotation would be hard to
/// read.
const COMPONENTS: usize = 3;

/// Maps of the wanted quantities; `None` if the model has no sites.
pub(super) fn maps(
    run: &Finished<'_>,
    samples: &Samples,
    what: &str,
    wanted: &dyn Fn(&Field, bool) -> bool,
) -> Option<Plot> {
    let all = at_sites(run.card);
    if all.is_empty() {
        return None;
    }
    let own = all
        .iter()
        .filter(|q| wanted(q.field, q.moves) && q.field.count() <= COMPONENTS);
    let panels: Vec<Panel> = own.flat_map(|q| of_quantity(q, &samples.record)).collect();
    if panels.is_empty() {
        return Some(Ok(None));
    }
    let window = Window {
        record: &samples.record,
        count: samples.record.times.len(),
        cut: false,
    };
    Some(figure(run, window, what, panels))
}

fn of_quantity(q: &AtSites<'_>, record: &Record) -> Vec<Panel> {
    // Components of one quantity have one unit, so a component within the rounding error of another is zero.
    let columns = q.members.iter().flat_map(|(_, columns)| columns.clone());
    let values = columns.flat_map(|c| record.observables.column(c));
    let size = largest(values.filter(|v| v.is_finite()).map(f64::abs));
    let components = 0..q.field.count();
    components.map(|c| panel(q, c, record, size)).collect()
}

fn panel(q: &AtSites<'_>, component: usize, record: &Record, size: f64) -> Panel {
    let frame = match q.field.kind {
        Kind::BodyMomentum => Some(", body frame"),
        Kind::SpatialMomentum => Some(", space frame"),
        Kind::FieldMomentum => Some(""),
        _ => None,
    };
    // A position is drawn as its change since the start.
    let change = q.moves && frame.is_none() && (q.grows || q.field.count() > 1);
    let column = |columns: &Range<usize>| -> Vec<f64> {
        let all = record.observables.column(columns.start + component);
        let mut all: Vec<f64> = all.collect();
        let first = all.first().copied().filter(|_| change).unwrap_or(0.0);
        all.iter_mut().for_each(|v| *v -= first);
        all
    };
    let rows = shown(&q.members).map(|(site, columns)| (*site, column(columns)));
    let letter = match letter(q.field) {
        own if own == q.field.name => q.name.as_str(),
        other => other,
    };
    let mark = match q.field.count() {
        1 => String::new(),
        _ => place(q.field, component),
    };
    let caption = match frame {
        Some(frame) => format!("{letter}{mark}, momentum of {}{frame}", q.name),
        None if change => format!("{letter}{mark}, change since the start"),
        None => format!("{letter}{mark}"),
    };
    mapped(caption, &q.index, &record.times, rows.collect(), size)
}

/// The sites that have rows in the map.
pub(super) fn shown<T>(members: &[T]) -> impl Iterator<Item = &T> {
    members.iter().step_by(members.len().div_ceil(ROWS).max(1))
}

/// A map of values at these sites and times, with rows in the order of the sites. If all values are equal, up
/// to rounding in quantities of this `size`, a sentence replaces the map.
pub(super) fn mapped(
    caption: String,
    index: &str,
    times: &[f64],
    rows: Vec<(usize, Vec<f64>)>,
    size: f64,
) -> Panel {
    let said = same(rows.iter().flat_map(|(_, row)| row), size);
    let group = times.len().div_ceil(COLUMNS).max(1);
    let picked = |row: Vec<f64>| row.into_iter().step_by(group).collect();
    let rows: Vec<(usize, Vec<f64>)> = rows.into_iter().map(|(i, row)| (i, picked(row))).collect();
    let site =
        |row: Option<&(usize, Vec<f64>)>| row.map_or(0.0, |(site, _)| f64::from(small(*site)));
    let (low, high) = (site(rows.first()) - 0.5, site(rows.last()) + 0.5);
    Panel {
        caption,
        y_label: format!("site {index}"),
        y: Axis::whole(low, high, if said.is_some() { 2 } else { 5 }),
        curves: Vec::new(),
        height: if said.is_some() { SENTENCE } else { 210 },
        map: Some(Map {
            times: times.iter().copied().step_by(group).collect(),
            end: times.last().copied().unwrap_or(1.0),
            rows,
            said,
        }),
    }
}

/// The sentence for values that are all equal, up to rounding in quantities of this size; `None` if they differ.
fn same<'a>(values: impl Iterator<Item = &'a f64>, size: f64) -> Option<String> {
    let mut values = values.copied().filter(|v| v.is_finite()).peekable();
    if values.peek().is_none() {
        return Some("not determined throughout".to_owned());
    }
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
        (a.min(v), b.max(v))
    });
    let most = low.abs().max(high.abs());
    let of = |value: f64| number::short(value).replace('-', "−");
    if most == 0.0 {
        return Some("zero throughout".to_owned());
    }
    // The tolerance exceeds a single rounding error, since errors accumulate over many steps.
    let rounding = 1e-12 * size.max(most);
    if most <= rounding {
        return Some(format!(
            "zero throughout, up to rounding: {} at most",
            of(most)
        ));
    }
    (high - low <= rounding).then(|| format!("{} throughout", of(low)))
}

fn small(site: usize) -> u32 {
    u32::try_from(site).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::same;

    #[test]
    fn what_is_the_same_throughout_is_said() {
        let said = |values: &[f64], size: f64| same(values.iter(), size);
        assert_eq!(said(&[0.0, 0.0], 0.0).as_deref(), Some("zero throughout"));
        assert_eq!(
            said(&[0.25, 0.25], 0.25).as_deref(),
            Some("0.25 throughout")
        );
        assert_eq!(
            said(&[1e-17, -3e-17], 1.0).as_deref(),
            Some("zero throughout, up to rounding: 3e−17 at most")
        );
        // No larger quantity is present: the values are significant.
        assert_eq!(said(&[1e-17, -3e-17], 3e-17), None);
        assert_eq!(said(&[1.0, 2.0, f64::NAN], 1.0), None);
    }
}
