//! Plots of a run as SVG: momenta, drift of the invariants, advected vectors, fields.
//! Takes a finished run and its samples; gives SVG text, or `None` if there is nothing to draw.

mod angles;
pub(crate) mod attitude;
pub mod axis;
mod cells;
pub mod curve;
pub mod figure;
pub mod map;
pub(crate) mod particles;
pub(crate) mod reduce;
mod sites;
mod snapshots;
mod sphere;
pub(crate) mod window;

pub(crate) use angles::angles;
pub(crate) use attitude::attitude;
pub(crate) use particles::{particles, vorticity};
pub(crate) use snapshots::snapshots;

use crate::output::points::{Diagonals, Linear};
use crate::output::{Finished, is_multiplier};
use crate::plan::end;
use crate::trajectory::record::Samples;
use crate::words::number;
use crate::words::plain::steps;
use axis::{Axis, FLOOR, superscript};
use clebsch::card::{Card, Conserved, Field, Kind};
use clebsch::integrate::Drift;
use clebsch::nalgebra::DMatrix;
use clebsch::record::Record;
use clebsch::scalar::largest;
use curve::{Curve, Stroke};
use figure::{Figure, Panel};
use std::ops::Range;
use window::{Window, window};

/// The largest number of panels for invariants whose error is only bounded.
const CHANGES: usize = 4;

/// A drawn plot; `None` if the model has nothing of this kind.
pub(crate) type Plot = Result<Option<String>, String>;

/// Momentum components against time, one panel per momentum; `None` for particles in the plane.
pub(crate) fn momentum(run: &Finished<'_>, samples: &Samples) -> Plot {
    if particles::in_plane(run) {
        return Ok(None);
    }
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

/// Components of the fields against time, one panel per field; `None` for particles in the plane.
pub(crate) fn fields(run: &Finished<'_>, samples: &Samples) -> Plot {
    if particles::in_plane(run) {
        return Ok(None);
    }
    let linear = Linear::of(run.card);
    observables(run, samples, "fields", |field, moves| {
        moves || linear.have(field)
    })
}

/// Drift of every invariant on a logarithmic axis, with the bounds of the case. Below it, for each invariant that is
/// only bounded, its signed change, divided by the power of the step with which it decreases.
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
        // An invariant that is zero for every motion has no drift to draw.
        if !outcome.zero_by.is_empty() {
            curves.push(Curve {
                label: outcome.invariant.name.to_owned(),
                note: Some(format!("zero with {} = 0", outcome.zero_by.join(" = "))),
                points: Vec::new(),
                stroke: Stroke::number(index),
            });
            continue;
        }
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
    let shown = run.outcomes.iter().filter(|o| o.zero_by.is_empty());
    let mut components = shown.flat_map(|outcome| &outcome.components);
    let relative = match components.any(Drift::is_absolute) {
        true => "",
        false => "relative ",
    };
    let group = reduce::group(record.times.len().saturating_sub(1));
    let caption = match group {
        1 => format!("{relative}drift at each sample"),
        group => format!("{relative}drift, maxima over bins of about {group} samples"),
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
    let mut panels = vec![panel];
    panels.extend(changes(run, record));
    figure(run, shown, "drift of the invariants", panels)
}

/// A panel for each invariant whose error is only bounded, such as the energy. It shows the change since time 0,
/// divided by the step size to the power of the order. This quotient is about the same for all step sizes. At most
/// [`CHANGES`] panels.
fn changes(run: &Finished<'_>, record: &Record) -> Vec<Panel> {
    let order = run.plan.order.unwrap_or(run.card.order);
    let unit = run.plan.case.h.abs().powi(order.cast_signed());
    let power = match order {
        1 => "h".to_owned(),
        order => format!("h{}", superscript(order.cast_signed())),
    };
    let mut from = 0;
    let mut panels = Vec::new();
    for outcome in run.outcomes {
        let invariant = outcome.invariant;
        let columns = from..from + outcome.components.len();
        from = columns.end;
        if invariant.conserved != Conserved::Boundedly || panels.len() == CHANGES {
            continue;
        }
        let curves: Vec<Curve> = columns
            .enumerate()
            .map(|(number, column)| {
                let start = record.invariants.column(column).next().unwrap_or(0.0);
                let change = record.invariants.column(column).map(|x| (x - start) / unit);
                Curve {
                    label: match outcome.components.len() {
                        1 => invariant.name.to_owned(),
                        _ => format!("{}{}", invariant.name, subscript(number + 1)),
                    },
                    note: None,
                    points: reduce::extremes(&record.times, change),
                    stroke: Stroke::number(number),
                }
            })
            .collect();
        panels.push(Panel {
            caption: format!("{}: change since time 0, over {power}", invariant.name),
            y_label: format!("(I(t) − I(0))/{power}"),
            y: Axis::around(&curves),
            height: 230,
            curves,
            map: None,
        });
    }
    panels
}

fn figure(run: &Finished<'_>, shown: Window<'_>, what: &str, panels: Vec<Panel>) -> Plot {
    let times = shown.record.times.get(..shown.count).unwrap_or_default();
    let (title, subtitle) = titles(run, shown, what);
    let paper = run.plan.paper;
    let figure = Figure {
        title,
        subtitle,
        x: Axis::linear(first(times), last(times), if paper { 4 } else { 8 }),
        x_label: "time t".to_owned(),
        panels,
        paper,
    };
    figure.svg().map(Some)
}

/// The title and subtitle of a picture: model, case and quantity; step size, duration and order.
fn titles(run: &Finished<'_>, shown: Window<'_>, what: &str) -> (String, String) {
    let case = &run.plan.case;
    let times = shown.record.times.get(..shown.count).unwrap_or_default();
    let to = number::plain(last(times));
    let part = if shown.cut {
        format!("; shown: time 0 to {to} (more: clebsch plot)")
    } else {
        String::new()
    };
    let stopped = run.stopped.as_ref().map_or_else(String::new, |stopped| {
        let time = number::plain(stopped.time);
        format!("; stopped at node {} (time {time})", stopped.node)
    });
    let title = format!(
        "{}, case {}: {what}",
        run.card.kebab,
        crate::words::plain::shown(&case.name)
    );
    let subtitle = format!(
        "h = {}, {}, to time {}; order {}{stopped}{part}",
        case.h,
        steps(case.steps),
        number::plain(end(case.h, case.steps)),
        run.plan.order.unwrap_or(run.card.order)
    );
    (title, subtitle)
}

/// A figure with one panel for each observable that `wanted` accepts. The second argument of `wanted` is true for a
/// field, which is followed by a momentum of the same shape.
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
    let diagonals = Diagonals::of(run.card);
    let mut panels = Vec::new();
    for (field, columns) in fields.into_iter().zip(columns) {
        let from = usize::from(begins_undetermined(run.card, field.name, shown.record));
        panels.push(panel(field, columns.clone(), from, shown));
        panels.extend(volume(field, &columns, shown, diagonals.have(field)));
    }
    figure(run, shown, what, panels)
}

/// The determinant of a placement, which is the volume ratio. `None` for other fields and for momenta.
fn volume(
    field: &Field,
    columns: &Range<usize>,
    shown: Window<'_>,
    is_diagonal: bool,
) -> Option<Panel> {
    let size = field.rows;
    let square = field.kind == Kind::Matrix && field.cols == size && size > 1;
    if !is_diagonal && !square {
        return None;
    }
    let of = |row: &[f64]| {
        let own = row.get(columns.clone()).unwrap_or_default();
        match is_diagonal {
            true => own.iter().product(),
            false => DMatrix::from_row_slice(size, size, own).determinant(),
        }
    };
    let times = shown.record.times.get(..shown.count).unwrap_or_default();
    let values = shown.record.observables.rows().take(shown.count).map(of);
    let label = format!("det {}", field.name);
    let curves = vec![Curve {
        label: label.clone(),
        note: None,
        points: reduce::extremes(times, values),
        stroke: Stroke::number(0),
    }];
    Some(Panel {
        caption: format!("{label}: the ratio of volumes"),
        y_label: label,
        y: Axis::around(&curves),
        height: 230,
        curves,
        map: None,
    })
}

/// Whether the first sample of an observable is undefined: a multiplier has no value at node 0, before any
/// step.
fn begins_undetermined(card: &Card, name: &str, record: &Record) -> bool {
    let said = |invariant: &str| card.invariants.iter().any(|own| own.name == invariant);
    record.nodes.first() == Some(&0) && is_multiplier(name, said)
}

/// The components of one observable, in the given columns of the record, from sample `from` on.
fn panel(field: &Field, columns: Range<usize>, from: usize, shown: Window<'_>) -> Panel {
    let letter = letter(field);
    let times = shown.record.times.get(from..shown.count);
    let times = times.unwrap_or_default();
    let column = |component: usize| {
        let values = shown.record.observables.column(columns.start + component);
        values.take(shown.count).skip(from)
    };
    let skew = is_skew(field, &column);
    let above = |component: &usize| !skew || component / field.cols < component % field.cols;
    let drawn: Vec<usize> = (0..field.count()).filter(above).collect();
    let mut curves: Vec<Curve> = drawn
        .iter()
        .enumerate()
        .map(|(number, component)| Curve {
            label: format!("{letter}{}", place(field, *component)),
            note: None,
            points: reduce::extremes(times, column(*component)),
            stroke: Stroke::number(number),
        })
        .collect();
    let hidden = coincident(&drawn, &column);
    for (over, under) in &hidden {
        let label = curves.get(*over).map(|curve| curve.label.clone());
        if let (Some(label), Some(curve)) = (label, curves.get_mut(*under)) {
            curve.note = Some(format!("under {label}"));
        }
    }
    let entries = |count: usize, tall: u32| tall * u32::try_from(count).unwrap_or(0);
    Panel {
        caption: match skew {
            true => format!("{}; skew, entries above the diagonal", caption(field)),
            false => caption(field),
        },
        y_label: quantity(field),
        y: Axis::around(&curves),
        // As high as its legend, if that is long: the entries of a large matrix.
        height: 230.max(45 + entries(curves.len(), 17) + entries(hidden.len(), 20)),
        curves,
        map: None,
    }
}

/// Whether a square matrix is skew at every sample, so that each of its numbers is drawn once.
fn is_skew<I: Iterator<Item = f64>>(field: &Field, column: &impl Fn(usize) -> I) -> bool {
    let size = field.rows;
    if size < 2 || field.cols != size {
        return false;
    }
    let pairs = || (0..size).flat_map(|i| (0..=i).map(move |j| (i * size + j, j * size + i)));
    let most = largest((0..size * size).flat_map(column));
    most > 0.0
        && pairs().all(|(a, b)| {
            let mut both = column(a).zip(column(b));
            both.all(|(x, y)| (x + y).abs() <= 1e-12 * most)
        })
}

/// Hidden curves: each with the later curve that covers it, by index. At every sample their distance is less than the
/// width of a line.
fn coincident<I: Iterator<Item = f64>>(
    drawn: &[usize],
    column: &impl Fn(usize) -> I,
) -> Vec<(usize, usize)> {
    let all = || drawn.iter().flat_map(|component| column(*component));
    let all = || all().filter(|x| x.is_finite());
    let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
        (a.min(x), b.max(x))
    });
    let near = 0.004 * (high - low);
    let covers = |under: usize, over: usize| {
        let both = drawn.get(under).zip(drawn.get(over));
        both.is_some_and(|(under, over)| {
            column(*under)
                .zip(column(*over))
                .all(|(x, y)| (x - y).abs() <= near)
        })
    };
    let over = |under: usize| {
        (under + 1..drawn.len())
            .rev()
            .find(|over| covers(under, *over))
    };
    (0..drawn.len())
        .filter_map(|under| Some((over(under)?, under)))
        .collect()
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

/// The label of the axis: `body momentum μ`.
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
        _ => format!("{name}: {}", crate::words::lines::first_line(field.doc)),
    }
}

/// The index of a component: `₂`, or `₂₁` for a matrix. Empty for a number.
fn place(field: &Field, component: usize) -> String {
    match field.cols {
        _ if field.count() == 1 => String::new(),
        0 | 1 => subscript(component + 1),
        cols => subscript(component / cols + 1) + &subscript(component % cols + 1),
    }
}

fn subscript(number: usize) -> String {
    clebsch_core::print::lowered(&number.to_string()).unwrap_or_default()
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
