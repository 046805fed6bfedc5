//! The pictures of `clebsch plot`. Takes series; gives SVG.

use super::columns::Series;
use crate::output::MARK;
use crate::plots::axis::{Axis, ROUNDING};
use crate::plots::curve::{Curve, Stroke};
use crate::plots::figure::{Figure, Panel};
use crate::plots::reduce;
use crate::words::number::plain;

/// The largest number of points of a curve that is not a function of time.
const MOST: usize = 20_000;

/// Width over height of a chart of the size below.
const SHAPE: f64 = 1.45;
const HEIGHT: u32 = 520;

/// Plots series against time, with one panel per array.
pub(super) fn against_time(title: &str, time: &Series, all: &[Series]) -> Result<String, String> {
    let mut panels: Vec<(&Series, Vec<Curve>)> = Vec::new();
    for series in all {
        let points = reduce::extremes(&time.values, series.values.iter().copied());
        match panels.iter_mut().find(|(first, _)| first.of == series.of) {
            Some((_, curves)) => curves.push(curve(series, curves.len(), points)),
            None => panels.push((series, vec![curve(series, 0, points)])),
        }
    }
    let panels = panels.into_iter().map(|(first, curves)| {
        let lines = |count: usize, tall: u32| tall * u32::try_from(count).unwrap_or(0);
        let notes = curves.iter().filter(|curve| curve.note.is_some()).count();
        Panel {
            map: None,
            caption: first.of.clone(),
            y_label: first.of.clone(),
            y: Axis::around_parts(&curves, first.size),
            height: 240.max(60 + lines(curves.len(), 17) + lines(notes, 20)),
            curves,
        }
    });
    let (from, to) = ends(time);
    let figure = Figure {
        paper: false,
        title: title.to_owned(),
        subtitle: format!("{MARK}{} to {}", plain(from), plain(to)),
        x: Axis::linear(from, to, 8),
        x_label: "time t".to_owned(),
        panels: panels.collect(),
    };
    figure.svg()
}

/// Series against other series, in pairs. Components of one vector have the same scale.
pub(super) fn against(
    title: &str,
    time: &Series,
    x: &[Series],
    all: &[Series],
) -> Result<String, String> {
    let pairs = || x.iter().zip(all);
    let several = pairs().any(|(x, _)| pairs().any(|(other, _)| other.name != x.name));
    let curves = pairs().enumerate().map(|(index, (x, series))| {
        let stride = series.values.len().div_ceil(MOST).max(1);
        let points = x.values.iter().copied().zip(series.values.iter().copied());
        let points = points.filter(|(x, y)| !x.is_nan() && !y.is_nan());
        let own = curve(series, index, points.step_by(stride).collect());
        match several {
            true => Curve {
                label: format!("{} against {}", series.name, x.name),
                ..own
            },
            false => own,
        }
    });
    let curves: Vec<Curve> = curves.collect();
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let mut across = spread(points().map(|point| point.0));
    let mut up = spread(points().map(|point| point.1));
    if pairs().all(|(x, series)| series.of == x.of) {
        let unit = ((across.1 - across.0) / SHAPE).max(up.1 - up.0);
        across = widened(across, unit * SHAPE);
        up = widened(up, unit);
    }
    let joined = |series: &[Series]| {
        let mut names: Vec<&str> = series.iter().map(|series| series.name.as_str()).collect();
        names.dedup();
        names.join(", ")
    };
    let (from, to) = ends(time);
    let figure = Figure {
        paper: false,
        title: title.to_owned(),
        subtitle: format!("{MARK}{} to {}", plain(from), plain(to)),
        x: Axis::linear(across.0, across.1, 8),
        x_label: joined(x),
        panels: vec![Panel {
            map: None,
            caption: format!("{} against {}", joined(all), joined(x)),
            y_label: joined(all),
            y: Axis::linear(up.0, up.1, 6),
            height: HEIGHT,
            curves,
        }],
    };
    figure.svg()
}

fn curve(series: &Series, index: usize, points: Vec<(f64, f64)>) -> Curve {
    Curve {
        label: series.name.clone(),
        note: rounding(series),
        points,
        stroke: Stroke::number(index),
    }
}

/// The note on values that differ only by the rounding of numbers of their size.
fn rounding(series: &Series) -> Option<String> {
    let finite = series.values.iter().filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(*value), high.max(*value))
    });
    let varies = high > low && high - low <= ROUNDING * series.size;
    varies.then(|| "constant to rounding".to_owned())
}

fn ends(time: &Series) -> (f64, f64) {
    let [first, last] = [time.values.first(), time.values.last()];
    (first.copied().unwrap_or(0.0), last.copied().unwrap_or(1.0))
}

/// The range of values with a margin.
fn spread(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let finite = values.filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    if low > high {
        return (0.0, 1.0);
    }
    // A constant is drawn in the middle of a range of its own size.
    let margin = match high > low {
        true => 0.05 * (high - low),
        false => (0.5 * high.abs()).max(0.5),
    };
    (low - margin, high + margin)
}

/// The range with the same centre and this length.
fn widened((low, high): (f64, f64), length: f64) -> (f64, f64) {
    let middle = 0.5 * (low + high);
    (middle - 0.5 * length, middle + 0.5 * length)
}
