//! Space-time maps of what a model has at the sites of a label.
//! Takes the samples of a run; gives one map for each component of each quantity.

use super::axis::Axis;
use super::figure::Panel;
use super::map::Map;
use super::{figure, letter, place};
use crate::output::Finished;
use crate::output::sites::{AtSites, at_sites};
use crate::plots::Plot;
use crate::plots::window::Window;
use crate::record::Samples;
use clebsch::card::{Field, Kind};
use clebsch::record::Record;
use std::ops::Range;

/// Most columns of a map: more are not told apart across a page.
const COLUMNS: usize = 160;

/// Most sites that have rows of their own: of more, some are shown.
const ROWS: usize = 240;

/// Most components that have maps of their own: the entries of a rotation are no picture of it.
const COMPONENTS: usize = 3;

/// Maps of the quantities that are wanted; `None` where the model has no sites.
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
    let shown = all
        .iter()
        .filter(|q| wanted(q.field, q.moves) && q.field.count() <= COMPONENTS);
    let panels: Vec<Panel> = shown
        .flat_map(|q| of_quantity(q, &samples.record))
        .collect();
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
    let components = 0..q.field.count();
    components.map(|c| panel(q, c, record)).collect()
}

fn panel(q: &AtSites<'_>, component: usize, record: &Record) -> Panel {
    let count = record.times.len();
    let group = count.div_ceil(COLUMNS).max(1);
    let picked: Vec<usize> = (0..count).step_by(group).collect();
    let momentum = matches!(
        q.field.kind,
        Kind::BodyMomentum | Kind::SpatialMomentum | Kind::FieldMomentum
    );
    // Of a place what is seen is how far it has moved.
    let change = q.moves && !momentum && (q.grows || q.field.count() > 1);
    let members = q.members.iter();
    let rows = members.step_by(q.members.len().div_ceil(ROWS).max(1)).map(
        |(site, columns): &(usize, Range<usize>)| {
            let column: Vec<f64> = record
                .observables
                .column(columns.start + component)
                .collect();
            let first = column.first().copied().filter(|_| change).unwrap_or(0.0);
            let values = picked.iter().filter_map(|i| column.get(*i));
            (*site, values.map(|v| v - first).collect::<Vec<f64>>())
        },
    );
    let rows: Vec<(usize, Vec<f64>)> = rows.collect();
    let times = picked.iter().filter_map(|i| record.times.get(*i).copied());
    let letter = match letter(q.field) {
        own if own == q.field.name => q.name.as_str(),
        other => other,
    };
    let mark = match q.field.count() {
        1 => String::new(),
        _ => place(q.field, component),
    };
    let sites: Vec<f64> = rows
        .iter()
        .map(|(site, _)| f64::from(small(*site)))
        .collect();
    let (low, high) = (
        sites.first().copied().unwrap_or(0.0) - 0.5,
        sites.last().copied().unwrap_or(0.0) + 0.5,
    );
    let name = match momentum {
        true => format!("{letter}{mark}, momentum of {}", q.name),
        false if change => format!("{letter}{mark}, change since the start"),
        false => format!("{letter}{mark}"),
    };
    Panel {
        caption: name,
        y_label: format!("site {}", q.index),
        y: Axis::whole(low, high, 5),
        curves: Vec::new(),
        map: Some(Map {
            times: times.collect(),
            end: record.times.last().copied().unwrap_or(1.0),
            rows,
        }),
        height: 210,
    }
}

fn small(site: usize) -> u32 {
    u32::try_from(site).unwrap_or(u32::MAX)
}
