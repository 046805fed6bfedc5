//! `clebsch fit`: parameters and initial values of a case by least squares. Takes a case and data; gives values with
//! standard errors, JSON, CSV and a plot.

mod data;
mod draw;
mod report;
mod residuals;
mod rows;
mod vary;

use crate::derivatives::expression::parts;
use crate::derivatives::problem::Problem;
use crate::models::gallery::Gallery;
use crate::output::results::{Results, drawn};
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::terminal::waiting::Waiting;
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch::derivatives::NoDerivative;
use clebsch_analysis::{FitError, fit as least_squares};
use data::Data;
use report::{notes, object, rows, table, table_file};
use residuals::Misfit;
use std::path::PathBuf;
use vary::Vary;

/// Files of the command.
const FILES: [&str; 3] = ["fit.csv", "fit.json", "fit.svg"];

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
        "{}: least squares of {} numbers in {}, up to node {}",
        problem.title(),
        data.all.len(),
        match data.columns.len() {
            1 => "1 column".to_owned(),
            count => format!("{count} columns"),
        },
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
