//! The plot of `clebsch converge`: errors against the step size, both logarithmic, with a line of the step's
//! order.
//! Takes the measured errors; gives SVG.

use super::levels::Measured;
use crate::plan::Plan;
use crate::plan::end;
use crate::plots::axis::{Axis, FLOOR};
use crate::plots::curve::{Curve, Marks, Stroke};
use crate::plots::figure::{Figure, Panel};
use crate::words::number::plain;
use crate::words::plain::shown;
use clebsch::card::Card;

/// Draws the figure.
pub(super) fn figure(card: &Card, plan: &Plan, done: &Measured) -> Result<String, String> {
    let case = &plan.case;
    let order = plan.order.unwrap_or(card.order);
    let steps: Vec<f64> = done.levels.iter().map(|level| level.h).collect();
    let mut curves: Vec<Curve> = Vec::new();
    for (index, name) in done.names.iter().enumerate() {
        let points = done.levels.iter().filter_map(|level| {
            let error = level.errors.get(index)?;
            Some((level.h.log10(), error.max(FLOOR).log10()))
        });
        curves.push(Curve {
            label: (*name).to_owned(),
            note: None,
            points: points.collect(),
            stroke: Stroke::number(index).marked(Marks::Full),
        });
    }
    if let Some(slope) = slope(&curves, &steps, f64::from(order)) {
        curves.push(Curve {
            label: format!("order {order}"),
            note: None,
            points: slope,
            stroke: Stroke::shared_bound(),
        });
    }
    let figure = Figure {
        paper: false,
        title: format!("{}, case {}: convergence", card.kebab, shown(&case.name)),
        subtitle: format!(
            "errors at time {} against the extrapolation to h = 0",
            plain(end(case.h, case.steps))
        ),
        x: Axis::logarithmic(&steps),
        x_label: "step size h".to_owned(),
        panels: vec![Panel {
            map: None,
            caption: "error at the end".to_owned(),
            y_label: "|x − x*| / max |x*|".to_owned(),
            y: Axis::decades(&curves),
            height: 380,
            curves,
        }],
    };
    figure.svg()
}

/// A line with the slope of the order below the curves, cut at the floor.
fn slope(curves: &[Curve], steps: &[f64], order: f64) -> Option<Vec<(f64, f64)>> {
    let firsts = curves.iter().filter_map(|curve| curve.points.first());
    let lowest = firsts.map(|point| point.1).fold(f64::INFINITY, f64::min) - 0.3;
    let first = steps.first()?.log10();
    let line = steps.iter().map(|h| {
        let x = h.log10();
        (x, lowest + order * (x - first))
    });
    let floor = FLOOR.log10();
    let points: Vec<_> = line.filter(|point| point.1 > floor).collect();
    (points.len() > 1).then_some(points)
}
