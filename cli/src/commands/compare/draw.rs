//! The plot of a comparison: errors and drifts of all methods against time, logarithmic, one panel a
//! quantity. Takes a comparison; gives SVG.

use super::{Comparison, Score};
use crate::plan::Plan;
use crate::plan::end;
use crate::plots::axis::{Axis, FLOOR};
use crate::plots::curve::{Curve, Stroke};
use crate::plots::figure::{Figure, Panel};
use crate::plots::reduce;
use crate::words::number::plain;
use crate::words::plain::{shown, steps};
use clebsch::card::Card;
use clebsch_comparisons::gallery::Role;

/// Draws the comparison.
pub(super) fn comparison(card: &Card, plan: &Plan, done: &Comparison) -> Result<String, String> {
    let case = &plan.case;
    let to = end(case.h, case.steps);
    let mut panels = Vec::new();
    let Some(first) = done.scores.first() else {
        return Err("nothing was compared".to_owned());
    };
    for (index, curve) in first.errors.iter().enumerate() {
        // The error of the reference is zero by definition, so it is not drawn.
        let others = done
            .scores
            .iter()
            .filter(|score| score.role != Some(Role::Reference));
        panels.push(panel(
            &format!("error of {}", curve.name),
            "|x − x*| / max |x*|",
            others
                .enumerate()
                .filter_map(|(stroke, score)| Some((stroke, score, score.errors.get(index)?))),
            &|_| index == 0,
        ));
    }
    let errors = !first.errors.is_empty();
    for (index, curve) in first.drifts.iter().enumerate() {
        panels.push(panel(
            &format!("drift of {}", curve.name),
            "|I(t) − I(0)| / scale",
            done.scores
                .iter()
                .enumerate()
                .filter_map(|(stroke, score)| Some((stroke, score, score.drifts.get(index)?))),
            // If there are error panels, their legend names all methods except the reference, so only the
            // reference is named here.
            &|score| index == 0 && (!errors || score.role == Some(Role::Reference)),
        ));
    }
    let figure = Figure {
        paper: false,
        title: format!(
            "{}, case {}: methods compared",
            card.kebab,
            shown(&case.name)
        ),
        subtitle: format!(
            "h = {}, {}, to time {}; reference {}",
            case.h,
            steps(case.steps),
            plain(to),
            done.reference.split(':').next().unwrap_or_default(),
        ),
        x: Axis::linear(0.0, to, 8),
        x_label: "time t".to_owned(),
        panels,
    };
    figure.svg()
}

type Entry<'a> = (usize, &'a Score, &'a crate::commands::compare::Curve);

fn panel<'a>(
    caption: &str,
    y_label: &str,
    entries: impl Iterator<Item = Entry<'a>>,
    legend: &dyn Fn(&Score) -> bool,
) -> Panel {
    let logarithm = |(time, value): (f64, f64)| (time, value.max(FLOOR).log10());
    let curves: Vec<Curve> = entries
        .map(|(stroke, score, curve)| Curve {
            // One entry for all panels.
            label: match legend(score) {
                true => score.name.to_owned(),
                false => String::new(),
            },
            note: None,
            points: reduce::envelope(&curve.points)
                .into_iter()
                .map(logarithm)
                .collect(),
            // The curve coincides with the generated one, so it is dashed to show both.
            stroke: match score.role {
                Some(Role::ByHand) => Stroke::number(stroke).dashed(),
                _ => Stroke::number(stroke),
            },
        })
        .collect();
    Panel {
        map: None,
        caption: caption.to_owned(),
        y_label: y_label.to_owned(),
        y: Axis::decades(&curves),
        height: match curves
            .iter()
            .filter(|curve| !curve.label.is_empty())
            .count()
        {
            0 => 210,
            entries => 230.max(50 + 17 * u32::try_from(entries).unwrap_or(0)),
        },
        curves,
    }
}
