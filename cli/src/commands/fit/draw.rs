//! The plot of a fit: data as discs, the fitted motion as a line, one panel for each column. Takes a fit; gives SVG.

use super::residuals::Misfit;
use crate::derivatives::flow::seen;
use crate::models::gallery::Case;
use crate::plots::axis::Axis;
use crate::plots::curve::{Curve, Marks, Stroke};
use crate::plots::figure::{Figure, Panel};
use clebsch::derivatives::NoDerivative;

/// The most panels.
const PANELS: usize = 8;

/// The most points of a line, about.
const POINTS: u64 = 2000;

pub(super) fn figure(misfit: &Misfit<'_>, case: &Case) -> Result<String, String> {
    let lines = lines(misfit, case).map_err(|why| why.to_string())?;
    let (data, h) = (misfit.data, case.h);
    let panels = data.columns.iter().zip(lines).enumerate().take(PANELS);
    let panels = panels.map(|(column, (own, points))| {
        let mut curves = vec![Curve {
            label: "fit".to_owned(),
            note: None,
            points,
            stroke: Stroke::number(0),
        }];
        let all = data.all.iter().filter(|datum| datum.column == column);
        for (i, datum) in all.enumerate() {
            // Each datum is a curve of one point, so that no line joins them.
            curves.push(Curve {
                label: if i == 0 {
                    "data".to_owned()
                } else {
                    String::new()
                },
                note: None,
                points: vec![(datum.node as f64 * h, datum.value)],
                stroke: Stroke::number(1).marked(Marks::Full),
            });
        }
        Panel {
            map: None,
            caption: own.text().to_owned(),
            y_label: own.text().to_owned(),
            y: Axis::around(&curves),
            height: 190,
            curves,
        }
    });
    let figure = Figure {
        paper: false,
        title: format!("{}: least squares", misfit.problem.title()),
        subtitle: format!("{} data, h = {h}", data.all.len()),
        x: Axis::linear(0.0, data.last() as f64 * h, 8),
        x_label: "time t".to_owned(),
        panels: panels.collect(),
    };
    figure.svg()
}

/// The fitted motion in each column.
fn lines(misfit: &Misfit<'_>, case: &Case) -> Result<Vec<Vec<(f64, f64)>>, NoDerivative> {
    let data = misfit.data;
    let mut flow = misfit.problem.open_case(case)?;
    let mut at = flow.start();
    let mut lines = vec![Vec::new(); data.columns.len()];
    let last = data.last();
    let every = last.div_ceil(POINTS).max(1);
    for node in 0..=last {
        if node % every == 0 || node == last {
            let all = seen(&mut *flow, &at)?;
            for (line, column) in lines.iter_mut().zip(&data.columns) {
                line.push((node as f64 * case.h, column.value(&all)));
            }
        }
        if node < last {
            at = flow.step(&at)?;
        }
    }
    Ok(lines)
}
