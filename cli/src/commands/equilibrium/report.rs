//! Reports of a branch: tables, remarks and JSON. Takes a branch; gives texts.

use super::branch::Followed;
use super::{stable, verdict, word};
use crate::derivatives::fixed::{Fixed, unproved};
use crate::derivatives::flow::State;
use crate::derivatives::problem::Problem;
use crate::output::results::csv;
use crate::words::columns::aligned;
use crate::words::number::short;
use clebsch_analysis::{BranchPoint, End, Event, Special};
use serde_json::{Value, json};

/// The points of a branch that the terminal shows.
const SHOWN: usize = 24;

/// The smallest eigenvalue of the second variation in size, with its sign.
fn nearest_to_zero<S>(point: &BranchPoint<S>) -> f64 {
    let all = point.variation.eigenvalues.iter().copied();
    all.min_by(|a, b| a.abs().total_cmp(&b.abs()))
        .unwrap_or(f64::NAN)
}

/// In one word.
fn stability<S>(point: &BranchPoint<S>, unproved: &[&str]) -> String {
    match stable(&point.variation, unproved) {
        Some(true) => "stable".to_owned(),
        _ => format!("{} negative", point.variation.negative),
    }
}

pub(super) fn table(followed: &Followed, unproved: &[&str], width: Option<usize>) -> String {
    let head = [
        "point",
        &followed.name,
        "second variation",
        "eigenvalue nearest to 0",
        "residual",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let points = &followed.branch.points;
    let every = points.len().div_ceil(SHOWN).max(1);
    for (i, point) in points.iter().enumerate() {
        if i % every != 0 && i + 1 != points.len() {
            continue;
        }
        rows.push(vec![
            (i + 1).to_string(),
            format!("{:.6}", point.p),
            stability(point, unproved),
            short(nearest_to_zero(point)),
            format!("{:.1e}", point.residual),
        ]);
    }
    aligned(&rows, &[0, 1, 3, 4], width)
}

fn special(of: &Special<State>, name: &str) -> String {
    let located = if of.located { "" } else { "near " };
    match of.event {
        Event::Fold => format!(
            "fold at {located}{name} = {:.9}: the branch turns back",
            of.at.p
        ),
        Event::BranchPoint { before, after } => format!(
            "change of stability at {located}{name} = {:.9}: from {before} to {after} negative directions; other branches may \
             meet here",
            of.at.p
        ),
    }
}

pub(super) fn notes(followed: &Followed, unproved: &[&str]) -> Vec<String> {
    let name = &followed.name;
    let mut notes: Vec<String> = followed
        .branch
        .specials
        .iter()
        .map(|s| special(s, name))
        .collect();
    if let Some(last) = followed.branch.points.last() {
        notes.push(format!(
            "at the end: {}",
            verdict(&last.variation, unproved)
        ));
        notes.push(match followed.branch.end {
            End::Reached => format!("The branch reaches {name} = {}.", last.p),
            End::Returned => format!("The branch turned back and returns to {name} = {}.", last.p),
            End::Points => format!(
                "The branch has {} points, the limit, and ends at {name} = {}.",
                followed.branch.points.len(),
                last.p
            ),
        });
    }
    notes
}

pub(super) fn object(problem: &Problem, fixed: &[Fixed], followed: &Followed) -> Value {
    let names: Vec<&str> = fixed.iter().map(|own| own.name.as_str()).collect();
    let point = |(point, numbers): (&BranchPoint<State>, &Vec<f64>)| {
        json!({
            "parameter": point.p,
            "state": numbers,
            "multipliers": point.multipliers.as_slice(),
            "residual": point.residual,
            "stability": word(&point.variation, &unproved(&problem.card, fixed)),
            "second_variation": point.variation.eigenvalues,
        })
    };
    let specials = followed
        .branch
        .specials
        .iter()
        .zip(&followed.specials)
        .map(|(own, numbers)| {
            let mut object = point((&own.at, numbers));
            object["event"] = match own.event {
                Event::Fold => json!("fold"),
                Event::BranchPoint { .. } => json!("change of stability"),
            };
            object["located"] = json!(own.located);
            object
        });
    let points = followed.branch.points.iter().zip(&followed.points);
    problem.object(json!({
        "parameter": followed.name,
        "fixed": names,
        "columns": followed.columns,
        "points": points.map(point).collect::<Vec<_>>(),
        "specials": specials.collect::<Vec<_>>(),
        "end": format!("{:?}", followed.branch.end),
    }))
}

pub(super) fn table_file(fixed: &[Fixed], followed: &Followed) -> String {
    let mut names = vec!["point".to_owned(), followed.name.clone()];
    names.extend(followed.columns.iter().cloned());
    names.extend(fixed.iter().map(|own| format!("multiplier_{}", own.name)));
    let last = [
        "residual",
        "negative_directions",
        "eigenvalue_nearest_to_zero",
    ];
    names.extend(last.map(str::to_owned));
    let points = followed
        .branch
        .points
        .iter()
        .zip(&followed.points)
        .enumerate();
    let rows = points.map(|(i, (point, numbers))| {
        let mut row = vec![i as f64 + 1.0, point.p];
        row.extend(numbers);
        row.extend(point.multipliers.iter());
        row.extend([
            point.residual,
            point.variation.negative as f64,
            nearest_to_zero(point),
        ]);
        row
    });
    csv(&names, rows)
}
