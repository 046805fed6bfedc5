//! `clebsch section`: where a motion crosses a surface. Takes a case and an expression; gives a table, JSON, CSV and a
//! plot of two quantities.

mod draw;

use crate::derivatives::coordinates;
use crate::derivatives::expression::{Expression, parts};
use crate::derivatives::flow::{State, Steps};
use crate::derivatives::problem::Problem;
use crate::models::gallery::Gallery;
use crate::output::results::{Results, csv, drawn};
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::terminal::waiting::Waiting;
use crate::words::columns::aligned;
use crate::words::number::{decimals, short};
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch::scalar::largest;
use clebsch_analysis::{Direction, Section, Sections, sections};
use serde_json::{Value, json};

/// Files of the command.
const FILES: [&str; 3] = ["section.csv", "section.json", "section.svg"];

/// The largest number of crossings that the terminal shows.
const SHOWN: usize = 20;

/// A crossing with the observables and invariants there.
struct Row {
    time: f64,
    value: f64,
    upward: bool,
    seen: Vec<f64>,
}

/// Runs the command.
///
/// # Errors
/// Usage: the request is wrong. Failed: a step fails, or the motion does not cross the surface.
pub(crate) fn section(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let problem = Problem::new(gallery, matches, streams)?;
    let text = matches.get_one::<String>("at").map_or("", String::as_str);
    let at = Expression::read(text, &problem.card, "--at")?;
    let chosen = chosen(matches, &problem)?;
    let flow = Steps::new(problem.open()?);
    let results = Results::begin(matches, &FILES)?;
    let found = {
        let _told = Waiting::showing("looking for crossings".to_owned(), streams.progress);
        crossings(&problem, &flow, &at, matches)?
    };
    let mut rows = Vec::new();
    for crossing in &found.crossings {
        rows.push(Row {
            time: crossing.time,
            value: crossing.value,
            upward: crossing.upward,
            seen: flow
                .seen(&crossing.state)
                .map_err(|why| problem.refused(&why))?,
        });
    }
    let [x, y] = chosen.map_or_else(|| two_that_vary(&problem, &rows), Ok)?;
    let names = coordinates::seen(&problem.card);
    let object = object(&problem, &at, &found, &rows, &names);
    let [table_name, json_name, svg_name] = FILES;
    let written = match results.is_wanted() {
        false => None,
        true => {
            let svg = drawn(draw::figure(&problem, &at, &rows, [&x, &y]), svg_name)?;
            let head = ["crossing", "time", "upward"].map(str::to_owned);
            let head: Vec<String> = head.into_iter().chain(names).collect();
            let table = rows.iter().enumerate().map(|(i, row)| {
                let first = [i as f64 + 1.0, row.time, f64::from(u8::from(row.upward))];
                first.into_iter().chain(row.seen.iter().copied()).collect()
            });
            results.end(&[
                (table_name, csv(&head, table)),
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
    let count = rows.len();
    let title = format!(
        "{}: {count} crossings of {} = 0 in {} steps",
        problem.title(),
        at.text(),
        found.steps
    );
    out.write_all(paragraph(&title, streams.width, 2).as_bytes())?;
    writeln!(out)?;
    out.write_all(table(&rows, [&x, &y], streams.width).as_bytes())?;
    writeln!(out)?;
    let most = largest(rows.iter().map(|row| row.value.abs()));
    let mut notes = vec![format!(
        "|{}| is at most {} at these states.",
        at.text(),
        short(most)
    )];
    if count > SHOWN {
        notes.push(format!(
            "The table shows the first {SHOWN} of {count} crossings."
        ));
    }
    if !found.complete {
        notes.push(
            "The run ended before the requested number of crossings. Use more --steps.".to_owned(),
        );
    }
    for line in notes.into_iter().chain(written) {
        out.write_all(paragraph(&line, streams.width, 2).as_bytes())?;
    }
    Ok(DONE)
}

fn crossings(
    problem: &Problem,
    flow: &Steps,
    at: &Expression,
    matches: &ArgMatches,
) -> Result<Sections<State>, Failure> {
    let value = |state: &State| flow.seen(state).map_or(f64::NAN, |seen| at.value(&seen));
    let direction = match (matches.get_flag("up"), matches.get_flag("down")) {
        (true, _) => Direction::Up,
        (_, true) => Direction::Down,
        _ => Direction::Both,
    };
    let section = Section {
        value: &value,
        rate: None,
        direction,
    };
    let count = matches.get_one::<u64>("count").copied().unwrap_or(100);
    let count = usize::try_from(count).unwrap_or(usize::MAX);
    let start = flow.start();
    let h = problem.plan.case.h;
    let found = sections(flow, &start, h, &section, count, problem.count());
    found.map_err(|why| Failure::Failed(format!("{}: {why}", at.text())))
}

/// The two quantities of `--plot`.
fn chosen(matches: &ArgMatches, problem: &Problem) -> Result<Option<[Expression; 2]>, Failure> {
    let Some(text) = matches.get_one::<String>("plot") else {
        return Ok(None);
    };
    let read = |text: &str| Expression::read(text, &problem.card, "--plot");
    match parts(text).as_slice() {
        [x, y] => Ok(Some([read(x)?, read(y)?])),
        other => Err(Failure::Usage(format!(
            "--plot names {} quantities. Give two, such as --plot 'X[1],X[2]'",
            other.len()
        ))),
    }
}

/// The first two observables that vary over the section.
fn two_that_vary(problem: &Problem, rows: &[Row]) -> Result<[Expression; 2], Failure> {
    let names = coordinates::seen(&problem.card);
    let observables = problem.card.observable_count();
    let numbers = rows
        .iter()
        .flat_map(|row| row.seen.iter().take(observables));
    let size = largest(numbers.map(|x| x.abs()));
    let varies = |at: usize| {
        let own = || rows.iter().filter_map(|row| row.seen.get(at).copied());
        let (low, high) = own().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        high - low > 1e-6 * size
    };
    let (mut first, mut rest) = (Vec::new(), Vec::new());
    for at in 0..observables {
        match varies(at) {
            true => first.push(at),
            false => rest.push(at),
        }
    }
    let mut order = first.into_iter().chain(rest).filter_map(|at| names.get(at));
    let name = |name: Option<&String>| name.cloned().unwrap_or_else(|| "energy".to_owned());
    let read = |name: String| Expression::read(&name, &problem.card, "--plot");
    let x = name(order.next());
    let y = order.next().cloned().unwrap_or_else(|| x.clone());
    Ok([read(x)?, read(y)?])
}

fn table(rows: &[Row], [x, y]: [&Expression; 2], width: Option<usize>) -> String {
    let head = ["", "time", "period", "direction", x.text(), y.text()];
    let mut all = vec![head.map(str::to_owned).to_vec()];
    let mut before: Option<f64> = None;
    for (i, row) in rows.iter().enumerate().take(SHOWN) {
        all.push(vec![
            (i + 1).to_string(),
            format!("{:.9}", row.time),
            before.map_or_else(|| "-".to_owned(), |t| format!("{:.9}", row.time - t)),
            if row.upward { "up" } else { "down" }.to_owned(),
            decimals(x.value(&row.seen), 9),
            decimals(y.value(&row.seen), 9),
        ]);
        before = Some(row.time);
    }
    aligned(&all, &[0, 1, 2, 4, 5], width)
}

fn object(
    problem: &Problem,
    at: &Expression,
    found: &Sections<State>,
    rows: &[Row],
    names: &[String],
) -> Value {
    let row = |row: &Row| json!({"time": row.time, "value": row.value, "upward": row.upward, "values": row.seen});
    problem.object(json!({
        "at": at.text(),
        "steps": found.steps,
        "complete": found.complete,
        "names": names,
        "crossings": rows.iter().map(row).collect::<Vec<_>>(),
    }))
}
