//! Plots of a run as SVG: momenta, drift of the invariants, advected vectors, fields.
//! Takes a finished run and its samples; gives SVG text, or nothing when there is nothing to show.

pub mod axis;
mod comparison;
pub mod curve;
pub mod figure;
pub mod map;
pub(crate) mod reduce;
mod sites;
mod window;

pub(crate) use comparison::comparison;

use crate::output::Finished;
use crate::record::{Record, Samples};
use crate::run::end;
use axis::{Axis, FLOOR, superscript};
use clebsch::card::{Field, Kind};
use clebsch::integrate::Drift;
use curve::{Curve, Stroke};
use figure::{Figure, Panel};
use std::ops::Range;
use window::{Window, window};

/// A drawn plot; `None` when the model has nothing of the kind.
pub(crate) type Plot = Result<Option<String>, String>;

/// Momentum components against time, one panel per momentum.
pub(crate) fn momentum(run: &Finished<'_>, samples: &Samples) -> Plot {
    observables(run, samples, "momentum", |field, _| {
        let kinds = [
            Kind::BodyMomentum,
            Kind::SpatialMomentum,
            Kind::FieldMomentum,
        ];
        kinds.contains(&field.kind)
    })
}

/// Components of the advected vectors against time, one panel per vector.
pub(crate) fn advected(run: &Finished<'_>, samples: &Samples) -> Plot {
    observables(run, samples, "advected vectors", |field, moves| {
        field.kind == Kind::Vector && !moves
    })
}

/// Components of the fields against time, one panel per field.
pub(crate) fn fields(run: &Finished<'_>, samples: &Samples) -> Plot {
    observables(run, samples, "fields", |_, moves| moves)
}

/// Drift of every invariant on a logarithmic axis, with the bounds of the case.
pub(crate) fn invariants(run: &Finished<'_>, record: &Record) -> Plot {
    if run.outcomes.is_empty() {
        return Ok(None);
    }
    let mut curves = Vec::new();
    let mut bounds: Vec<(f64, Vec<usize>)> = Vec::new();
    let mut from = 0;
    for (index, outcome) in run.outcomes.iter().enumerate() {
        let drift = reduce::drift(record, from, &outcome.components);
        from += outcome.components.len();
        let points = reduce::envelope(&drift);
        let logarithm = |(time, drift): (f64, f64)| (time, drift.max(FLOOR).log10());
        let absolute = match outcome.components.iter().any(Drift::is_absolute) {
            true => ", absolute: scale 0",
            false => "",
        };
        curves.push(Curve {
            label: outcome.invariant.name.to_owned(),
            note: match outcome.bound {
                Some(bound) => Some(format!("bound {bound:e} (dashed){absolute}")),
                None => Some(format!("no bound{absolute}")),
            },
            points: points.into_iter().map(logarithm).collect(),
            stroke: Stroke::number(index),
        });
        if let Some(bound) = outcome.bound.filter(|bound| *bound > 0.0) {
            match bounds.iter_mut().find(|(known, _)| *known == bound) {
                Some((_, of)) => of.push(index),
                None => bounds.push((bound, vec![index])),
            }
        }
    }
    let span = (first(&record.times), last(&record.times));
    for (bound, of) in bounds {
        let level = bound.max(FLOOR).log10();
        curves.push(Curve {
            label: String::new(),
            note: None,
            points: vec![(span.0, level), (span.1, level)],
            stroke: match *of {
                [index] => Stroke::number(index).dashed(),
                _ => Stroke::shared_bound(),
            },
        });
    }
    let mut components = run.outcomes.iter().flat_map(|outcome| &outcome.components);
    let relative = match components.any(Drift::is_absolute) {
        true => "",
        false => "relative ",
    };
    let group = reduce::group(record.times.len().saturating_sub(1));
    let caption = match group {
        1 => format!("{relative}drift at each sample"),
        group => format!("{relative}drift, each point the largest of about {group} samples"),
    };
    let panel = Panel {
        caption,
        y_label: "|I(t) − I(0)| / scale".to_owned(),
        y: Axis::decades(&curves),
        curves,
        map: None,
        // Room for the legend, two lines an entry.
        height: 380.max(50 + 37 * u32::try_from(run.outcomes.len()).unwrap_or(0)),
    };
    let shown = Window {
        record,
        count: record.times.len(),
        cut: false,
    };
    figure(run, shown, "drift of the invariants", vec![panel])
}

fn figure(run: &Finished<'_>, shown: Window<'_>, what: &str, panels: Vec<Panel>) -> Plot {
    let case = &run.plan.case;
    let times = shown.record.times.get(..shown.count).unwrap_or_default();
    let to = axis::plain(last(times));
    let part = if shown.cut {
        format!("; shown: time 0 to {to}")
    } else {
        String::new()
    };
    let stopped = run.stopped.as_ref().map_or_else(String::new, |stopped| {
        let time = axis::plain(stopped.time);
        format!("; stopped at node {} (time {time})", stopped.node)
    });
    let figure = Figure {
        title: format!(
            "{}, case {}: {what}",
            run.card.kebab,
            crate::plain::shown(&case.name)
        ),
        subtitle: format!(
            "h = {}, {} steps, to time {}; order {}{stopped}{part}",
            case.h,
            case.steps,
            axis::plain(end(case.h, case.steps)),
            run.card.order
        ),
        x: Axis::linear(first(times), last(times), 8),
        x_label: "time t".to_owned(),
        panels,
    };
    figure.svg().map(Some)
}

/// A figure with one panel for each observable that `wanted` accepts, which is also told whether it is a field:
/// what has a momentum of its own shape behind it.
fn observables(
    run: &Finished<'_>,
    samples: &Samples,
    what: &str,
    wanted: impl Fn(&Field, bool) -> bool,
) -> Plot {
    if let Some(maps) = sites::maps(run, samples, what, &wanted) {
        return maps;
    }
    let mut from = 0;
    let all = run.card.observables;
    let placed = all.iter().enumerate().map(|(index, field)| {
        let columns = from..from + field.count();
        from = columns.end;
        let behind = all.get(index + 1);
        let moves = behind.is_some_and(|next| next.kind == Kind::FieldMomentum);
        (field, moves, columns)
    });
    let (fields, columns): (Vec<&Field>, Vec<Range<usize>>) = placed
        .filter(|(field, moves, _)| wanted(field, *moves))
        .map(|(field, _, columns)| (field, columns))
        .unzip();
    if fields.is_empty() {
        return Ok(None);
    }
    let shown = window(samples, &columns);
    let panels = fields.into_iter().zip(columns);
    let panels = panels
        .map(|(field, columns)| panel(field, columns, shown))
        .collect();
    figure(run, shown, what, panels)
}

/// The components of one observable, which are the given columns of the record.
fn panel(field: &Field, columns: Range<usize>, shown: Window<'_>) -> Panel {
    let letter = letter(field);
    let times = shown.record.times.get(..shown.count).unwrap_or_default();
    let curves: Vec<Curve> = columns
        .enumerate()
        .map(|(component, column)| Curve {
            label: format!("{letter}{}", place(field, component)),
            note: None,
            points: reduce::extremes(times, shown.record.observables.column(column)),
            stroke: Stroke::number(component),
        })
        .collect();
    Panel {
        caption: caption(field),
        y_label: quantity(field),
        y: Axis::around(&curves),
        // As high as its legend, if that is long: the entries of a large matrix.
        height: 230.max(45 + 17 * u32::try_from(curves.len()).unwrap_or(0)),
        curves,
        map: None,
    }
}

/// Body momenta are written μ and spatial ones m, as in the equations.
fn letter(field: &Field) -> &str {
    match field.kind {
        Kind::BodyMomentum => "μ",
        Kind::SpatialMomentum => "m",
        Kind::FieldMomentum => "p",
        _ => field.name,
    }
}

/// What stands beside the axis: `body momentum μ`.
fn quantity(field: &Field) -> String {
    let letter = letter(field);
    match field.kind {
        Kind::BodyMomentum => format!("body momentum {letter}"),
        Kind::SpatialMomentum => format!("spatial momentum {letter}"),
        Kind::FieldMomentum => format!("momentum {letter}"),
        _ => letter.to_owned(),
    }
}

fn caption(field: &Field) -> String {
    let name = field.name.replace('_', " ");
    match field.kind {
        Kind::BodyMomentum => format!("{name}, body frame"),
        Kind::SpatialMomentum => format!("{name}, space frame"),
        Kind::FieldMomentum => field.doc.to_owned(),
        _ if field.doc.is_empty() => name,
        _ => format!("{name}: {}", crate::list::first_line(field.doc)),
    }
}

/// The place of a component: `₂`, of a matrix `₂₁`; a number has none.
fn place(field: &Field, component: usize) -> String {
    match field.cols {
        _ if field.count() == 1 => String::new(),
        0 | 1 => subscript(component + 1),
        cols => subscript(component / cols + 1) + &subscript(component % cols + 1),
    }
}

fn subscript(number: usize) -> String {
    let digits = number.to_string();
    digits
        .chars()
        .filter_map(|digit| {
            digit
                .to_digit(10)
                .and_then(|digit| char::from_u32(0x2080 + digit))
        })
        .collect()
}

fn first(times: &[f64]) -> f64 {
    times.first().copied().unwrap_or(0.0)
}

fn last(times: &[f64]) -> f64 {
    times.last().copied().unwrap_or(1.0)
}

/// `10⁻¹²`.
fn power_of_ten(exponent: i32) -> String {
    format!("10{}", superscript(exponent))
}
