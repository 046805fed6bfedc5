//! The plot of a section: a point for each crossing. Takes crossings and two quantities; gives SVG.

use super::Row;
use crate::derivatives::expression::Expression;
use crate::derivatives::problem::Problem;
use crate::plots::axis::Axis;
use crate::plots::curve::{Curve, Marks, Stroke};
use crate::plots::figure::{Figure, Panel};
use crate::words::number::plain;

pub(super) fn figure(
    problem: &Problem,
    at: &Expression,
    rows: &[Row],
    [x, y]: [&Expression; 2],
) -> Result<String, String> {
    let mut curves = Vec::new();
    let ways = [(true, "up", Marks::Full), (false, "down", Marks::Hollow)];
    for (index, (upward, label, marks)) in ways.into_iter().enumerate() {
        let own = rows.iter().filter(|row| row.upward == upward);
        // Each crossing is a curve of one point, so that no line joins them.
        for (i, row) in own.enumerate() {
            curves.push(Curve {
                label: if i == 0 {
                    label.to_owned()
                } else {
                    String::new()
                },
                note: None,
                points: vec![(x.value(&row.seen), y.value(&row.seen))],
                stroke: Stroke::number(index).marked(marks),
            });
        }
    }
    let turned = |curve: &Curve| Curve {
        points: curve.points.iter().map(|(x, y)| (*y, *x)).collect(),
        ..curve.clone()
    };
    let turned: Vec<Curve> = curves.iter().map(turned).collect();
    let figure = Figure {
        paper: false,
        title: format!("{}: section {} = 0", problem.title(), at.text()),
        subtitle: format!(
            "{} crossings, h = {}",
            rows.len(),
            plain(problem.plan.case.h)
        ),
        x: Axis::around(&turned),
        x_label: x.text().to_owned(),
        panels: vec![Panel {
            map: None,
            caption: format!("{} against {}", y.text(), x.text()),
            y_label: y.text().to_owned(),
            y: Axis::around(&curves),
            height: 520,
            curves,
        }],
    };
    figure.svg()
}
