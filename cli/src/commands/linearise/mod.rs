//! `clebsch linearise`: modes and stability at an equilibrium of a step. Takes a case; gives a table, JSON, CSV and,
//! for chains, a plot of the modes.

mod draw;

use crate::derivatives::coordinates;
use crate::derivatives::flow::{State, Steps};
use crate::derivatives::problem::Problem;
use crate::models::gallery::Gallery;
use crate::output::results::{Results, csv, drawn};
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::terminal::waiting::Waiting;
use crate::words::columns::aligned;
use crate::words::number::{plain, short};
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch::derivatives::NoDerivative;
use clebsch_analysis::{
    FIXED, Flow, Linear, LinearError, Mode, OrbitError, Search, Stability, Verdict, linear, orbit,
};
use serde_json::{Value, json};

/// Files of the command. Only chains have a picture.
const FILES: [&str; 3] = ["linearise.csv", "linearise.json", "modes.svg"];

/// The largest number of modes that the terminal shows.
const SHOWN: usize = 40;

/// A fixed point, and where it was found.
struct Found {
    state: State,
    /// The displacement of the start by one step.
    moved: f64,
    /// The distance of the start from the fixed point; `None` if the start is one.
    away: Option<f64>,
}

/// Runs the command.
///
/// # Errors
/// Usage: the request is wrong. Failed: there is no equilibrium, or a step fails.
pub(crate) fn linearise(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let problem = Problem::new(gallery, matches, streams)?;
    let flow = problem.steps()?;
    let results = Results::begin(matches, &FILES)?;
    let h = problem.plan.case.h;
    let (fixed, found) = {
        let _told = Waiting::showing("linearising a step".to_owned(), streams.progress);
        let fixed = fixed_point(&flow, h)?;
        let found = linear(&flow, &fixed.state, h, problem.card.reversible);
        (fixed, found.map_err(told)?)
    };
    let object = object(&problem, &flow, &fixed, &found)?;
    let [table_name, json_name, svg_name] = FILES;
    let written = match results.is_wanted() {
        false => None,
        true => {
            let mut files = vec![
                (table_name, table_file(&found)),
                (json_name, format!("{object:#}\n")),
            ];
            let dimensions = flow.with(|own| own.dimensions());
            if let Some(figure) = draw::figure(&problem, &dimensions, &found) {
                files.push((svg_name, drawn(figure, svg_name)?));
            }
            results.end(&files)?
        }
    };
    let out = &mut *streams.out;
    if matches.get_flag("json") {
        writeln!(out, "{object}")?;
        return Ok(DONE);
    }
    let title = format!("{}: modes of a step of h = {}", problem.title(), plain(h));
    out.write_all(paragraph(&title, streams.width, 2).as_bytes())?;
    let at = match fixed.away {
        None => format!(
            "The state of the case is an equilibrium: a step moves it by {}.",
            short(found.residual)
        ),
        Some(away) => format!(
            "The state of the case is no equilibrium: a step moves it by {}. clebsch found one at distance {}.",
            short(fixed.moved),
            short(away)
        ),
    };
    out.write_all(paragraph(&at, streams.width, 2).as_bytes())?;
    writeln!(out)?;
    if fixed.away.is_some() {
        out.write_all(state_table(&problem, &flow, &fixed.state, streams.width)?.as_bytes())?;
        writeln!(out)?;
    }
    out.write_all(table(&found, streams.width).as_bytes())?;
    writeln!(out)?;
    let mut notes = vec![
        format!("discrete system: {}", verdict(&found.verdict)),
        format!("continuous system: {}", verdict(&found.limit_verdict)),
    ];
    let more = half(&found.modes).count();
    if more > SHOWN {
        notes.push(format!(
            "The table shows {SHOWN} of {more} modes; --out writes all."
        ));
    }
    for line in notes.into_iter().chain(written) {
        out.write_all(paragraph(&line, streams.width, 2).as_bytes())?;
    }
    Ok(DONE)
}

/// The fixed point of a step at the start or near it.
fn fixed_point(flow: &Steps, h: f64) -> Result<Found, Failure> {
    let start = flow.start();
    let next = flow.step(&start, h);
    let next = next.map_err(|why| Failure::Failed(why.to_string()))?;
    let norm = |from: &State, to: &State| {
        let parts = flow.difference(from, to).into_iter();
        parts.map(|x| x * x).sum::<f64>().sqrt()
    };
    let moved = norm(&start, &next);
    if moved <= FIXED {
        return Ok(Found {
            state: start,
            moved,
            away: None,
        });
    }
    let found = orbit(flow, &start, h, 1, &Search::default());
    let found = found.map_err(|why| match why {
        OrbitError::NoConvergence { residual, .. } => Failure::Failed(format!(
            "no equilibrium near the state of the case: a step moves it by {}, and Newton's method stops at {}. Start closer to \
             an equilibrium; a steady rotation is one of `clebsch equilibrium` or `clebsch orbit`",
            short(moved),
            short(residual)
        )),
        other => Failure::Failed(other.to_string()),
    })?;
    Ok(Found {
        away: Some(norm(&start, &found.state)),
        state: found.state,
        moved,
    })
}

fn told(why: LinearError<NoDerivative>) -> Failure {
    Failure::Failed(why.to_string())
}

/// Modes with a frequency that is not negative: one of each pair.
fn half(modes: &[Mode]) -> impl Iterator<Item = &Mode> {
    modes.iter().filter(|mode| mode.eigenvalue.im >= 0.0)
}

fn verdict(of: &Verdict) -> String {
    let growth = format!("growth {} with error {}", short(of.growth), short(of.error));
    match of.stability {
        Stability::Unstable => format!("unstable ({growth})"),
        Stability::Undecided => format!("undecided: a growth may be rounding ({growth})"),
        Stability::SpectrallyStable => "spectrally stable: no mode grows".to_owned(),
        Stability::Attracting => format!("attracting: all modes decay ({growth})"),
    }
}

/// A number, or zero if it is within ten errors of zero.
fn sure(value: f64, error: f64) -> f64 {
    if value.abs() <= 10.0 * error {
        0.0
    } else {
        value
    }
}

fn table(found: &Linear, width: Option<usize>) -> String {
    let head = [
        "mode",
        "frequency",
        "growth",
        "period",
        "continuous: frequency",
        "growth",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let mut limits = half(&found.limit_modes);
    let number = |x: f64| {
        if x == 0.0 {
            "0".to_owned()
        } else {
            format!("{x:.9}")
        }
    };
    for (i, mode) in half(&found.modes).enumerate().take(SHOWN) {
        let frequency = sure(mode.frequency, mode.error);
        let mut row = vec![
            (i + 1).to_string(),
            number(frequency),
            number(sure(mode.growth, mode.error)),
            match frequency > 0.0 {
                true => format!("{:.6}", std::f64::consts::TAU / frequency),
                false => "-".to_owned(),
            },
        ];
        row.extend(match limits.next() {
            Some(limit) => [
                sure(limit.frequency, limit.error),
                sure(limit.growth, limit.error),
            ]
            .map(number),
            None => ["-", "-"].map(str::to_owned),
        });
        rows.push(row);
    }
    aligned(&rows, &[0, 1, 2, 3, 4, 5], width)
}

/// The initial values of the case and of a state.
fn state_table(
    problem: &Problem,
    flow: &Steps,
    at: &State,
    width: Option<usize>,
) -> Result<String, Failure> {
    let found = at
        .clone()
        .and_then(|at| flow.with(|own| problem.case_at(&problem.plan.case, own, &at)));
    let found = found.map_err(|why| problem.refused(&why))?;
    Ok(coordinates::compared(
        &problem.card,
        &problem.plan.case.initial,
        &found.initial,
        width,
    ))
}

fn object(
    problem: &Problem,
    flow: &Steps,
    fixed: &Found,
    found: &Linear,
) -> Result<Value, Failure> {
    let mode = |mode: &Mode| {
        let parts = |part: &dyn Fn(&clebsch::nalgebra::Complex<f64>) -> f64| {
            mode.vector.iter().map(part).collect::<Vec<f64>>()
        };
        json!({
            "eigenvalue": [mode.eigenvalue.re, mode.eigenvalue.im],
            "frequency": mode.frequency,
            "growth": mode.growth,
            "error": mode.error,
            "vector": {"re": parts(&|z| z.re), "im": parts(&|z| z.im)},
        })
    };
    let modes = |all: &[Mode]| all.iter().map(mode).collect::<Vec<_>>();
    let dimensions = flow.with(|own| own.dimensions());
    let at = fixed
        .state
        .clone()
        .and_then(|at| flow.with(|own| problem.case_at(&problem.plan.case, own, &at)));
    let at = at.map_err(|why| problem.refused(&why))?;
    let initial = problem.card.initial.iter().zip(&at.initial);
    let initial: serde_json::Map<String, Value> = initial
        .map(|(field, values)| (field.ascii.to_owned(), json!(values)))
        .collect();
    Ok(problem.object(json!({
        "state": initial,
        "found_nearby": fixed.away.is_some(),
        "distance": fixed.away.unwrap_or(0.0),
        "displacement": found.residual,
        "coordinates": coordinates::local(&problem.card, &dimensions),
        "stability": format!("{:?}", found.verdict.stability),
        "modes": modes(&found.modes),
        "continuous": {
            "stability": format!("{:?}", found.limit_verdict.stability),
            "modes": modes(&found.limit_modes),
        },
    })))
}

fn table_file(found: &Linear) -> String {
    let names = [
        "mode",
        "frequency",
        "growth",
        "error",
        "multiplier_re",
        "multiplier_im",
    ];
    let names = names.map(str::to_owned).to_vec();
    let rows = found.modes.iter().enumerate().map(|(i, mode)| {
        vec![
            i as f64 + 1.0,
            mode.frequency,
            mode.growth,
            mode.error,
            mode.eigenvalue.re,
            mode.eigenvalue.im,
        ]
    });
    csv(&names, rows)
}
