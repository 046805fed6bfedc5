//! The plot of a branch: the initial values that vary, and the second variation, over the parameter. Takes a branch;
//! gives SVG.

use super::branch::Followed;
use crate::derivatives::problem::Problem;
use crate::plots::axis::Axis;
use crate::plots::curve::{Curve, Marks, Stroke};
use crate::plots::figure::{Figure, Panel};
use clebsch_analysis::Event;

/// The largest number of curves of states.
const MOST: usize = 6;

/// Variation below this part of the largest one is not drawn.
const FLAT: f64 = 1e-6;

pub(super) fn figure(problem: &Problem, followed: &Followed) -> Result<String, String> {
    let branch = &followed.branch;
    let parameters: Vec<f64> = branch.points.iter().map(|point| point.p).collect();
    let spread = |column: usize| {
        let own = || followed.points.iter().filter_map(|row| row.get(column));
        let low = own().copied().fold(f64::INFINITY, f64::min);
        own().copied().fold(f64::NEG_INFINITY, f64::max) - low
    };
    let mut columns: Vec<(usize, f64)> = (0..followed.columns.len())
        .map(|c| (c, spread(c)))
        .collect();
    columns.sort_by(|a, b| b.1.total_cmp(&a.1));
    let widest = columns.first().map_or(0.0, |(_, spread)| *spread);
    columns.retain(|(_, spread)| *spread > FLAT * widest);
    columns.truncate(MOST);
    columns.sort_unstable_by_key(|(column, _)| *column);
    let mut states = Vec::new();
    for (index, (column, _)) in columns.iter().enumerate() {
        let label = followed.columns.get(*column).cloned().unwrap_or_default();
        let value = |row: &Vec<f64>| row.get(*column).copied().unwrap_or(f64::NAN);
        let points = followed.points.iter().zip(&branch.points);
        let points = points.map(|(row, point)| {
            (
                point.p,
                value(row),
                point.variation.definiteness.is_definite(),
            )
        });
        states.extend(pieces(&label, points, Stroke::number(index)));
        for (row, special) in followed.specials.iter().zip(&branch.specials) {
            states.push(mark(
                special.event,
                (special.at.p, value(row)),
                Stroke::number(index),
            ));
        }
    }
    let mut second = Vec::new();
    let count = branch
        .points
        .iter()
        .map(|p| p.variation.eigenvalues.len())
        .min()
        .unwrap_or(0);
    for index in 0..count.min(3) {
        let points = branch
            .points
            .iter()
            .filter_map(|point| Some((point.p, *point.variation.eigenvalues.get(index)?)));
        second.push(Curve {
            label: format!("eigenvalue {}", index + 1),
            note: None,
            points: points.collect(),
            stroke: Stroke::number(index),
        });
    }
    let folds = branch
        .specials
        .iter()
        .filter(|s| s.event == Event::Fold)
        .count();
    let low = parameters.iter().copied().fold(f64::INFINITY, f64::min);
    let high = parameters.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let panel = |caption: &str, y_label: &str, curves: Vec<Curve>| Panel {
        map: None,
        caption: caption.to_owned(),
        y_label: y_label.to_owned(),
        y: Axis::around(&curves),
        height: 300,
        curves,
    };
    let mut panels = Vec::new();
    if !states.is_empty() {
        panels.push(panel(
            "state: solid where stable by the second variation, otherwise dashed",
            "initial value",
            states,
        ));
    }
    panels.push(panel(
        "smallest eigenvalues of the second variation",
        "eigenvalue",
        second,
    ));
    let figure = Figure {
        paper: false,
        title: format!("{}: branch of critical points", problem.title()),
        subtitle: format!(
            "{} points; folds (discs): {folds}, changes of stability (circles): {}",
            branch.points.len(),
            branch.specials.len() - folds
        ),
        x: Axis::linear(low, high, 8),
        x_label: followed.name.clone(),
        panels,
    };
    figure.svg()
}

/// Pieces of a curve: solid where it is stable, dashed elsewhere. The first has the label.
fn pieces(
    label: &str,
    points: impl Iterator<Item = (f64, f64, bool)>,
    stroke: Stroke,
) -> Vec<Curve> {
    let mut all: Vec<(bool, Curve)> = Vec::new();
    for (x, y, stable) in points {
        match all.last_mut() {
            Some((own, curve)) if *own == stable => curve.points.push((x, y)),
            last => {
                // A piece begins where the last one ends.
                let joint = last.and_then(|(_, curve)| curve.points.last().copied());
                let points = joint.into_iter().chain([(x, y)]).collect();
                all.push((
                    stable,
                    Curve {
                        label: String::new(),
                        note: None,
                        points,
                        stroke: if stable { stroke } else { stroke.dashed() },
                    },
                ));
            }
        }
    }
    if let Some((_, first)) = all.first_mut() {
        first.label = label.to_owned();
    }
    all.into_iter().map(|(_, curve)| curve).collect()
}

fn mark(event: Event, point: (f64, f64), stroke: Stroke) -> Curve {
    let marks = match event {
        Event::Fold => Marks::Full,
        Event::BranchPoint { .. } => Marks::Hollow,
    };
    Curve {
        label: String::new(),
        note: None,
        points: vec![point],
        stroke: stroke.marked(marks),
    }
}
