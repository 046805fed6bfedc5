//! `clebsch linearise`: modes and stability at an equilibrium of a step. Takes a case; gives a table, JSON, CSV and,
//! for chains, a plot of the modes.

mod draw;
mod report;

use crate::derivatives::flow::{State, Steps};
use crate::derivatives::problem::Problem;
use crate::models::gallery::Gallery;
use crate::output::results::{Results, drawn};
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::terminal::waiting::Waiting;
use crate::words::number::{plain, short};
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch::derivatives::NoDerivative;
use clebsch_analysis::{FIXED, Flow, LinearError, Mode, OrbitError, Search, linear, orbit};
use report::{SHOWN, object, state_table, table, table_file, verdict};

/// Files of the command. Only chains have a picture.
const FILES: [&str; 3] = ["linearise.csv", "linearise.json", "modes.svg"];

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
/// Usage: the request is wrong. Failed: the search for an equilibrium or a step fails.
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
    let more = half(&found.modes).len();
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

/// One mode of each pair of frequencies with opposite signs. Half of the modes without frequency and growth are kept,
/// since each comes with a drift.
fn half(modes: &[Mode]) -> Vec<&Mode> {
    let mut drifts = false;
    let mut keep = |mode: &&Mode| {
        let frequency = sure(mode.frequency, mode.error);
        match (frequency == 0.0, sure(mode.growth, mode.error) == 0.0) {
            (true, true) => {
                drifts = !drifts;
                drifts
            }
            (true, false) => true,
            (false, _) => frequency > 0.0,
        }
    };
    modes.iter().filter(|mode| keep(mode)).collect()
}

/// A number, or zero if it is within ten errors of zero.
fn sure(value: f64, error: f64) -> f64 {
    if value.abs() <= 10.0 * error {
        0.0
    } else {
        value
    }
}
