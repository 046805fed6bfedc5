//! Reports of a fit: tables, remarks and JSON. Takes a fit; gives texts.

use super::data::Data;
use super::vary::Vary;
use crate::derivatives::coordinates::entries;
use crate::derivatives::problem::Problem;
use crate::models::gallery::Case;
use crate::words::columns::aligned;
use crate::words::number::short;
use clebsch_analysis::Fit;
use serde_json::{Map, Value, json};

/// A fitted number.
pub(super) struct Row {
    name: String,
    /// The value at the start and after the fit. Angles of a rotation only have their change.
    before: Option<f64>,
    after: f64,
    error: Option<f64>,
}

pub(super) fn rows(problem: &Problem, vary: &[Vary], found: &Fit<Case>) -> Vec<Row> {
    let (start, end) = (&problem.plan.case, &found.parameters);
    let errors = found.standard_errors();
    let mut at = 0;
    let mut rows = Vec::new();
    for own in vary {
        for (i, name) in own.names().into_iter().enumerate() {
            let number = |case: &Case| match own {
                Vary::Parameter { places, .. } => {
                    let (field, entry, sign) = places.first()?;
                    Some(sign * case.parameters.get(*field)?.get(*entry)?)
                }
                Vary::Initial { field, .. } => {
                    let entries = entries(problem.card.initial.get(*field)?);
                    let entry = entries.iter().find(|entry| entry.name == name)?;
                    let (place, _) = entry.places.first()?;
                    case.initial.get(*field)?.get(*place).copied()
                }
            };
            let change = || found.moves.iter().filter_map(|by| by.get(at + i)).sum();
            rows.push(Row {
                before: number(start),
                after: number(end).unwrap_or_else(change),
                error: errors.as_ref().and_then(|all| all.get(at + i)).copied(),
                name,
            });
        }
        at += own.names().len();
    }
    rows
}

pub(super) fn table(rows: &[Row], width: Option<usize>) -> String {
    let head = ["", "start", "found", "standard error"]
        .map(str::to_owned)
        .to_vec();
    let body = rows.iter().map(|row| {
        vec![
            row.name.clone(),
            row.before
                .map_or_else(|| "-".to_owned(), |x| format!("{x:.9}")),
            match row.before {
                Some(_) => format!("{:.9}", row.after),
                None => format!("by {:.9}", row.after),
            },
            row.error
                .map_or_else(|| "-".to_owned(), |x| format!("{x:.2e}")),
        ]
    });
    let all: Vec<Vec<String>> = std::iter::once(head).chain(body).collect();
    aligned(&all, &[1, 2, 3], width)
}

pub(super) fn notes(
    problem: &Problem,
    data: &Data,
    rows: &[Row],
    found: &Fit<Case>,
) -> Vec<String> {
    let count = data.all.len() as f64;
    let mut notes = vec![format!(
        "root mean square residual {} after {} iterations",
        short(found.residual / count.sqrt()),
        found.iterations
    )];
    if found.variance.is_none() {
        notes.push(
            "There are as many data as varied numbers, so that errors are not known.".to_owned(),
        );
    }
    let correlation = found.correlation();
    let mut strongest: Option<(f64, usize, usize)> = None;
    for i in 0..rows.len() {
        for j in 0..i {
            let own = correlation.get((i, j)).copied().unwrap_or(0.0);
            if own.abs() > strongest.map_or(0.9, |(most, ..)| most.abs()) {
                strongest = Some((own, j, i));
            }
        }
    }
    if let Some((own, i, j)) = strongest
        && let (Some(a), Some(b)) = (rows.get(i), rows.get(j))
    {
        notes.push(format!(
            "`{}` and `{}` have the strongest correlation, {own:.3}.",
            a.name, b.name
        ));
    }
    if !problem.plan.starts(&problem.card).is_empty() {
        notes.push("The initial momenta that the case computes from velocities are fixed, unless you vary them.".to_owned());
    }
    notes
}

pub(super) fn object(problem: &Problem, data: &Data, rows: &[Row], found: &Fit<Case>) -> Value {
    let row = |row: &Row| {
        json!({
            "name": row.name,
            "start": row.before,
            "found": row.after,
            "standard_error": row.error,
        })
    };
    let correlation = found.correlation();
    let correlation: Vec<Vec<f64>> = (0..rows.len())
        .map(|i| correlation.row(i).iter().copied().collect())
        .collect();
    let numbers = |fields: &[clebsch::card::Field], values: &[Vec<f64>]| {
        let pairs = fields.iter().zip(values);
        let pairs = pairs.map(|(field, own)| (field.ascii.to_owned(), json!(own)));
        pairs.collect::<Map<String, Value>>()
    };
    problem.object(json!({
        "data": data.all.len(),
        "columns": data.columns.iter().map(|own| own.text()).collect::<Vec<_>>(),
        "fitted": rows.iter().map(row).collect::<Vec<_>>(),
        "correlation": correlation,
        "residual": found.residual,
        "variance": found.variance,
        "iterations": found.iterations,
        "parameters": numbers(problem.card.parameters, &found.parameters.parameters),
        "initial": numbers(problem.card.initial, &found.parameters.initial),
    }))
}

/// One row for each datum.
pub(super) fn table_file(problem: &Problem, data: &Data, fitted: &[f64]) -> String {
    let mut text = "time,quantity,observed,fitted
"
    .to_owned();
    let h = problem.plan.case.h;
    for (datum, fitted) in data.all.iter().zip(fitted) {
        let name = data.columns.get(datum.column).map_or("", |own| own.text());
        // A name such as A[1,2] has a comma.
        let name = match name.contains(',') {
            true => format!("\"{name}\""),
            false => name.to_owned(),
        };
        let time = datum.node as f64 * h;
        text.push_str(&format!(
            "{time:?},{name},{:?},{fitted:?}
",
            datum.value
        ));
    }
    text
}
