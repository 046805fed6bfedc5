//! `clebsch equilibrium --continue`: a branch of critical points over a parameter. Takes a range; gives a table, JSON,
//! CSV and a plot.

use super::{FILES, case_at, none, verdict};
use crate::derivatives::coordinates::entries;
use crate::derivatives::energy::{CaseEnergy, Parameter};
use crate::derivatives::fixed::Fixed;
use crate::derivatives::flow::{State, Steps};
use crate::derivatives::problem::Problem;
use crate::output::results::{Results, csv, drawn};
use crate::overrides::quantity::Quantity;
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::terminal::waiting::Waiting;
use crate::words::columns::aligned;
use crate::words::number::{short, value};
use crate::words::plain::shown;
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch_analysis::{
    Branch, BranchPoint, ContinuationError, End, Event, Special, Track, continuation,
};
use serde_json::{Value, json};

/// The points of a branch that the terminal shows.
const SHOWN: usize = 24;

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
        continuation(
            &energy,
            &start,
            &values,
            from,
            to,
            &Track::between(from, to),
        )
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
    out.write_all(table(&followed, streams.width).as_bytes())?;
    writeln!(out)?;
    for line in notes(&followed).into_iter().chain(written) {
        out.write_all(paragraph(&line, streams.width, 2).as_bytes())?;
    }
    Ok(DONE)
}

/// The smallest eigenvalue of the second variation in size, with its sign.
fn nearest_to_zero<S>(point: &BranchPoint<S>) -> f64 {
    let all = point.variation.eigenvalues.iter().copied();
    all.min_by(|a, b| a.abs().total_cmp(&b.abs()))
        .unwrap_or(f64::NAN)
}

/// In one word.
fn stability<S>(point: &BranchPoint<S>) -> String {
    match (
        point.variation.definiteness.is_definite(),
        point.variation.negative,
    ) {
        (true, _) => "stable".to_owned(),
        (false, count) => format!("{count} negative"),
    }
}

fn table(followed: &Followed, width: Option<usize>) -> String {
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
            stability(point),
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

fn notes(followed: &Followed) -> Vec<String> {
    let name = &followed.name;
    let mut notes: Vec<String> = followed
        .branch
        .specials
        .iter()
        .map(|s| special(s, name))
        .collect();
    if let Some(last) = followed.branch.points.last() {
        notes.push(format!("at the end: {}", verdict(&last.variation)));
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

fn object(problem: &Problem, fixed: &[Fixed], followed: &Followed) -> Value {
    let names: Vec<&str> = fixed.iter().map(|own| own.name.as_str()).collect();
    let point = |(point, numbers): (&BranchPoint<State>, &Vec<f64>)| {
        json!({
            "parameter": point.p,
            "state": numbers,
            "multipliers": point.multipliers.as_slice(),
            "residual": point.residual,
            "stability": format!("{:?}", point.variation.definiteness),
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

fn table_file(fixed: &[Fixed], followed: &Followed) -> String {
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
