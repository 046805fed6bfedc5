//! `clebsch fit`: parameters and initial values of a case by least squares. Takes a case and data; gives values with
//! standard errors, JSON, CSV and a plot.

mod data;
mod draw;
mod residuals;
mod vary;

use crate::derivatives::coordinates::entries;
use crate::derivatives::expression::parts;
use crate::derivatives::problem::Problem;
use crate::models::gallery::{Case, Gallery};
use crate::output::results::{Results, drawn};
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::terminal::waiting::Waiting;
use crate::words::columns::aligned;
use crate::words::number::short;
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch::derivatives::NoDerivative;
use clebsch_analysis::{Fit, FitError, fit as least_squares};
use data::Data;
use residuals::Misfit;
use serde_json::{Map, Value, json};
use std::path::PathBuf;
use vary::Vary;

/// Files of the command.
const FILES: [&str; 3] = ["fit.csv", "fit.json", "fit.svg"];

/// A fitted number.
struct Row {
    name: String,
    /// The value at the start and after the fit. Angles of a rotation only have their change.
    before: Option<f64>,
    after: f64,
    error: Option<f64>,
}

/// Runs the command.
///
/// # Errors
/// Usage: the request or the data are wrong. Failed: the fit does not converge, or a step fails.
pub(crate) fn fit(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let problem = Problem::new(gallery, matches, streams)?;
    let dimensions = problem.open()?.dimensions();
    let names = matches.get_one::<String>("vary").map_or("", String::as_str);
    let vary = parts(names)
        .into_iter()
        .map(|name| Vary::read(name, &problem, &dimensions));
    let vary: Vec<Vary> = vary.collect::<Result<_, _>>()?;
    if vary.iter().any(|own| matches!(own, Vary::Initial { .. })) {
        // States of some models do not have coordinates; the message says so.
        problem.steps()?;
    }
    let file = matches
        .get_one::<PathBuf>("data")
        .cloned()
        .unwrap_or_default();
    let columns = matches.get_one::<String>("columns").map(String::as_str);
    let data = Data::read(&file, columns, &problem)?;
    let misfit = Misfit {
        problem: &problem,
        data: &data,
        vary: &vary,
        states: dimensions.iter().sum(),
    };
    let names: Vec<String> = vary.iter().flat_map(Vary::names).collect();
    if data.all.len() < names.len() {
        return Err(Failure::Usage(format!(
            "{} data cannot determine {} numbers. Give more data, or vary fewer quantities",
            data.all.len(),
            names.len()
        )));
    }
    let results = Results::begin(matches, &FILES)?;
    let found = {
        let _told = Waiting::showing("fitting".to_owned(), streams.progress);
        least_squares(&misfit, &problem.plan.case)
    };
    let found = found.map_err(|why| told(why, &names))?;
    let rows = rows(&problem, &vary, &found);
    let fitted = misfit.observed(&found.parameters);
    let fitted = fitted.map_err(|why| problem.refused(&why))?;
    let object = object(&problem, &data, &rows, &found);
    let [csv_name, json_name, svg_name] = FILES;
    let written = match results.is_wanted() {
        false => None,
        true => results.end(&[
            (csv_name, table_file(&problem, &data, &fitted)),
            (json_name, format!("{object:#}\n")),
            (
                svg_name,
                drawn(draw::figure(&misfit, &found.parameters), svg_name)?,
            ),
        ])?,
    };
    let out = &mut *streams.out;
    if matches.get_flag("json") {
        writeln!(out, "{object}")?;
        return Ok(DONE);
    }
    let title = format!(
        "{}: least squares of {} numbers in {} columns, up to node {}",
        problem.title(),
        data.all.len(),
        data.columns.len(),
        data.last()
    );
    out.write_all(paragraph(&title, streams.width, 2).as_bytes())?;
    writeln!(out)?;
    out.write_all(table(&rows, streams.width).as_bytes())?;
    writeln!(out)?;
    for line in notes(&problem, &data, &rows, &found)
        .into_iter()
        .chain(written)
    {
        out.write_all(paragraph(&line, streams.width, 2).as_bytes())?;
    }
    Ok(DONE)
}

/// The message of a failed fit, with names.
fn told(why: FitError<NoDerivative>, names: &[String]) -> Failure {
    match why {
        FitError::Undetermined { combination, .. } => {
            let most = clebsch::scalar::largest(combination.iter().map(|x| x.abs()));
            let terms = names.iter().zip(&combination);
            let terms: Vec<String> = terms
                .filter(|(_, x)| x.abs() > 1e-3 * most)
                .map(|(name, x)| format!("{x:+.3} {name}"))
                .collect();
            Failure::Failed(format!(
                "the data do not determine the combination {}. Vary fewer quantities, or add data",
                terms.join(" ")
            ))
        }
        other => Failure::Failed(other.to_string()),
    }
}

fn rows(problem: &Problem, vary: &[Vary], found: &Fit<Case>) -> Vec<Row> {
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

fn table(rows: &[Row], width: Option<usize>) -> String {
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

fn notes(problem: &Problem, data: &Data, rows: &[Row], found: &Fit<Case>) -> Vec<String> {
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

fn object(problem: &Problem, data: &Data, rows: &[Row], found: &Fit<Case>) -> Value {
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
fn table_file(problem: &Problem, data: &Data, fitted: &[f64]) -> String {
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
