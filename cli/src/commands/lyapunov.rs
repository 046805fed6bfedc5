//! `clebsch lyapunov`: the largest Lyapunov exponents of a motion. Takes a case; gives a table, JSON, CSV and a plot of
//! the convergence.

use crate::derivatives::problem::Problem;
use crate::models::gallery::Gallery;
use crate::output::results::{Results, csv, drawn};
use crate::plan::end;
use crate::plots::axis::Axis;
use crate::plots::curve::{Curve, Stroke};
use crate::plots::figure::{Figure, Panel};
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::terminal::waiting::Waiting;
use crate::words::columns::aligned;
use crate::words::number::{plain, short};
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch_analysis::{Flow, Lyapunov};
use serde_json::{Value, json};

/// Files of the command.
const FILES: [&str; 3] = ["lyapunov.csv", "lyapunov.json", "lyapunov.svg"];

/// Runs the command.
///
/// # Errors
/// Usage: the request is wrong. Failed: a step or its tangent fails.
pub(crate) fn lyapunov(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let problem = Problem::new(gallery, matches, streams)?;
    let flow = problem.steps()?;
    let count = matches.get_one::<u64>("count").copied().unwrap_or(1);
    let n = flow.dimension();
    let count = match usize::try_from(count) {
        Ok(count) if count <= n => count,
        _ => {
            return Err(Failure::Usage(format!(
                "--count {count}: the states of `{}` have {n} coordinates. Ask for at most {n} exponents",
                problem.card.kebab
            )));
        }
    };
    let results = Results::begin(matches, &FILES)?;
    let start = flow.start();
    let h = problem.plan.case.h;
    let found = {
        let _told = Waiting::showing("following tangents".to_owned(), streams.progress);
        clebsch_analysis::lyapunov(&flow, &start, h, problem.count(), count)
    };
    let found = found.map_err(|why| Failure::Failed(why.to_string()))?;
    let time = end(h, problem.plan.case.steps);
    let object = object(&problem, &found, time);
    let [table_name, json_name, svg_name] = FILES;
    let written = match results.is_wanted() {
        false => None,
        true => {
            let svg = drawn(figure(&problem, &found), svg_name)?;
            let names = std::iter::once("time".to_owned());
            let names: Vec<String> = names
                .chain((1..=count).map(|i| format!("exponent_{i}")))
                .collect();
            let rows = found.estimates.iter().map(|e| {
                std::iter::once(e.time)
                    .chain(e.exponents.iter().copied())
                    .collect()
            });
            results.end(&[
                (table_name, csv(&names, rows)),
                (json_name, format!("{object:#}\n")),
                (svg_name, svg),
            ])?
        }
    };
    let out = &mut *streams.out;
    if matches.get_flag("json") {
        writeln!(out, "{object}")?;
        return Ok(DONE);
    }
    let title = format!(
        "{}: Lyapunov exponents over time {}, {} steps of {}",
        problem.title(),
        plain(time),
        problem.plan.case.steps,
        plain(h)
    );
    out.write_all(paragraph(&title, streams.width, 2).as_bytes())?;
    writeln!(out)?;
    let mut rows = vec![
        ["", "exponent", "standard error", "growth by e in"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for (i, (exponent, error)) in found.exponents.iter().zip(&found.errors).enumerate() {
        rows.push(vec![
            (i + 1).to_string(),
            format!("{exponent:.6e}"),
            match error.is_finite() {
                true => format!("{error:.1e}"),
                false => "-".to_owned(),
            },
            match is_positive(*exponent, *error) {
                true => format!("time {}", short(1.0 / exponent)),
                false => "-".to_owned(),
            },
        ]);
    }
    out.write_all(aligned(&rows, &[1, 2], streams.width).as_bytes())?;
    writeln!(out)?;
    for line in std::iter::once(verdict(&found)).chain(written) {
        out.write_all(paragraph(&line, streams.width, 2).as_bytes())?;
    }
    Ok(DONE)
}

/// Whether an exponent is above zero by four errors.
fn is_positive(exponent: f64, error: f64) -> bool {
    exponent > 4.0 * error
}

/// The verdict of the largest exponent. A regular motion has an exponent that falls like 1/t.
fn verdict<S>(found: &Lyapunov<S>) -> String {
    let first = |values: &[f64]| values.first().copied().unwrap_or(f64::NAN);
    let (exponent, error) = (first(&found.exponents), first(&found.errors));
    let half = found.estimates.get(found.estimates.len() / 2);
    let before = half.map_or(f64::NAN, |half| first(&half.exponents));
    if !error.is_finite() {
        return "Fewer than 40 steps give no error. Use more --steps.".to_owned();
    }
    if !is_positive(exponent, error) {
        return "The largest exponent is at most four standard errors above zero: the motion looks regular."
            .to_owned();
    }
    match exponent < 0.75 * before {
        true => format!(
            "The largest exponent still falls, from {} at half the time. Use more --steps to tell it from zero.",
            short(before)
        ),
        false => "The largest exponent is positive: the motion is chaotic.".to_owned(),
    }
}

fn object<S>(problem: &Problem, found: &Lyapunov<S>, time: f64) -> Value {
    let estimate =
        |e: &clebsch_analysis::Estimate| json!({"time": e.time, "exponents": e.exponents});
    problem.object(json!({
        "steps": problem.plan.case.steps,
        "time": time,
        "exponents": found.exponents,
        "standard_errors": found.errors,
        "estimates": found.estimates.iter().map(estimate).collect::<Vec<_>>(),
    }))
}

/// The running estimates over time.
fn figure<S>(problem: &Problem, found: &Lyapunov<S>) -> Result<String, String> {
    let curve = |i: usize| Curve {
        label: format!("exponent {}", i + 1),
        note: found.exponents.get(i).map(|x| short(*x)),
        // The first averages are large, and would hide the others.
        points: found
            .estimates
            .iter()
            .skip(found.estimates.len() / 40)
            .filter_map(|e| Some((e.time, *e.exponents.get(i)?)))
            .collect(),
        stroke: Stroke::number(i),
    };
    let curves: Vec<Curve> = (0..found.exponents.len()).map(curve).collect();
    let last = found.estimates.last().map_or(1.0, |e| e.time);
    let figure = Figure {
        paper: false,
        title: format!("{}: Lyapunov exponents", problem.title()),
        subtitle: format!(
            "averages from the start, h = {}",
            plain(problem.plan.case.h)
        ),
        x: Axis::linear(0.0, last, 8),
        x_label: "time t".to_owned(),
        panels: vec![Panel {
            map: None,
            caption: "exponents up to time t".to_owned(),
            y_label: "exponent per unit of time".to_owned(),
            y: Axis::around(&curves),
            height: 380,
            curves,
        }],
    };
    figure.svg()
}
