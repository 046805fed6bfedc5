//! `clebsch equilibrium --continue`: a branch of critical points over a parameter. Takes a range; gives a table, JSON,
//! CSV and a plot.

use super::report::{notes, object, table, table_file};
use super::{FILES, case_at, none};
use crate::derivatives::coordinates::entries;
use crate::derivatives::energy::{CaseEnergy, Parameter};
use crate::derivatives::fixed::{self, Fixed};
use crate::derivatives::flow::{State, Steps};
use crate::derivatives::problem::Problem;
use crate::output::results::{Results, drawn};
use crate::overrides::quantity::Quantity;
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::terminal::waiting::Waiting;
use crate::words::number::value;
use crate::words::plain::shown;
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch_analysis::{Branch, ContinuationError, Track, continuation};

/// A parameter and its range.
pub(super) struct Request {
    quantity: Quantity,
    from: f64,
    to: f64,
}

impl Request {
    /// Reads `NAME=FROM:TO`.
    pub(super) fn read(text: &str, problem: &Problem) -> Result<Self, Failure> {
        let wrong = |why: String| Failure::Usage(format!("--continue {}: {why}", shown(text)));
        let parts = text.split_once('=');
        let range = parts.and_then(|(name, range)| Some((name, range.split_once(':')?)));
        let Some((name, (from, to))) = range else {
            return Err(wrong("give NAME=FROM:TO, such as gU.3=0.5:2".to_owned()));
        };
        let quantity = Quantity::read(name, &problem.card, &problem.plan.motion).map_err(wrong)?;
        if quantity.of_parameter().is_none() {
            return Err(wrong(format!(
                "`{}` is no parameter. Give a parameter of the model",
                shown(name)
            )));
        }
        let number = |text: &str| value(text, &|_| None).map_err(wrong);
        let (from, to) = (number(from)?, number(to)?);
        match from == to {
            true => Err(wrong(
                "both ends are equal. Give two different values".to_owned(),
            )),
            false => Ok(Self { quantity, from, to }),
        }
    }
}

/// A branch with the initial values of its points.
pub(super) struct Followed {
    pub name: String,
    pub branch: Branch<State>,
    /// The numbers of the initial values at each point, and at each special point.
    pub points: Vec<Vec<f64>>,
    pub specials: Vec<Vec<f64>>,
    pub columns: Vec<String>,
}

/// Follows the branch.
pub(super) fn branch(
    problem: &Problem,
    flow: &Steps,
    fixed: Vec<Fixed>,
    request: Request,
    results: Results,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let Request { quantity, from, to } = request;
    let name = quantity.name.clone();
    let size = from.abs().max(to.abs()).max((to - from).abs());
    let energy = CaseEnergy::new(
        problem,
        flow,
        fixed.clone(),
        Some(Parameter { quantity, size }),
    )?;
    let found = {
        let _told = Waiting::showing("following the branch".to_owned(), streams.progress);
        let start = flow.start();
        let values = energy
            .values(&start, from)
            .map_err(|why| problem.refused(&why))?;
        continuation(&energy, &start, &values, from, to, &track(from, to))
    };
    let found = found.map_err(|why| match why {
        ContinuationError::Start(why) => none(problem, &why),
        other => Failure::Failed(other.to_string()),
    })?;
    let numbers = |state: &State| Ok::<_, Failure>(case_at(problem, flow, state)?.initial.concat());
    let entries = problem.card.initial.iter().flat_map(|field| {
        let whole = field.count();
        let own = entries(field);
        // Every number has a column, also those below the diagonal of a symmetric matrix.
        (0..whole).map(move |at| {
            let named = own
                .iter()
                .find(|e| e.places.iter().any(|(place, _)| *place == at));
            named.map_or_else(|| format!("{}.{at}", field.ascii), |e| e.name.clone())
        })
    });
    let followed = Followed {
        name,
        points: found
            .points
            .iter()
            .map(|p| numbers(&p.state))
            .collect::<Result<_, _>>()?,
        specials: found
            .specials
            .iter()
            .map(|s| numbers(&s.at.state))
            .collect::<Result<_, _>>()?,
        columns: entries.collect(),
        branch: found,
    };
    let object = object(problem, &fixed, &followed);
    let [csv_name, json_name, svg_name] = FILES;
    let written = match results.is_wanted() {
        false => None,
        true => results.end(&[
            (csv_name, table_file(&fixed, &followed)),
            (json_name, format!("{object:#}\n")),
            (
                svg_name,
                drawn(super::draw::figure(problem, &followed), svg_name)?,
            ),
        ])?,
    };
    let out = &mut *streams.out;
    if matches.get_flag("json") {
        writeln!(out, "{object}")?;
        return Ok(DONE);
    }
    let title = format!(
        "{}: branch of critical points from {} = {from}{}",
        problem.title(),
        followed.name,
        super::at_fixed(&fixed)
    );
    out.write_all(paragraph(&title, streams.width, 2).as_bytes())?;
    writeln!(out)?;
    let unproved = fixed::unproved(&problem.card, &fixed);
    out.write_all(table(&followed, &unproved, streams.width).as_bytes())?;
    writeln!(out)?;
    for line in notes(&followed, &unproved).into_iter().chain(written) {
        out.write_all(paragraph(&line, streams.width, 2).as_bytes())?;
    }
    Ok(DONE)
}

/// Steps that are short enough for a picture.
fn track(from: f64, to: f64) -> Track {
    let span = (to - from).abs();
    Track {
        first: span / 100.0,
        largest: span / 40.0,
        ..Track::between(from, to)
    }
}
