//! `clebsch gradient`: the derivative of an observed quantity in all parameters, initial values and the step size.
//! Takes a case and an expression; gives a table, JSON and CSV.

use crate::derivatives::coordinates::{self, turns};
use crate::derivatives::expression::Expression;
use crate::derivatives::problem::Problem;
use crate::models::gallery::Gallery;
use crate::output::results::Results;
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::terminal::waiting::Waiting;
use crate::words::columns::aligned;
use crate::words::number::plain;
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch::derivatives::{Cost, Gradient, Seen};
use serde_json::{Value, json};

/// Files of the command.
const FILES: [&str; 2] = ["gradient.csv", "gradient.json"];

/// An expression at the last node, or its sum over all nodes.
struct Observed<'a> {
    of: &'a Expression,
    last: u64,
    sum: bool,
    value: f64,
}

impl Cost for Observed<'_> {
    fn is_at(&self, node: u64) -> bool {
        self.sum || node == self.last
    }

    fn weigh(
        &mut self,
        node: u64,
        seen: &Seen<'_>,
        weights: &mut [f64],
        of_invariants: &mut [f64],
    ) {
        if !self.is_at(node) {
            return;
        }
        let all = [seen.observables, seen.invariants].concat();
        self.value += self.of.value(&all);
        self.of.weigh(&all, weights, of_invariants);
    }
}

/// One row of the result: name, value and derivative.
struct Row {
    kind: &'static str,
    name: String,
    value: Option<f64>,
    derivative: f64,
}

/// Runs the command.
///
/// # Errors
/// Usage: the request is wrong. Failed: a step fails, or the derivative does not exist.
pub(crate) fn gradient(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let problem = Problem::new(gallery, matches, streams)?;
    let text = matches.get_one::<String>("of").map_or("", String::as_str);
    let of = Expression::read(text, &problem.card, "--of")?;
    let results = Results::begin(matches, &FILES)?;
    let steps = problem.plan.case.steps;
    let mut cost = Observed {
        of: &of,
        last: steps,
        sum: matches.get_flag("sum"),
        value: 0.0,
    };
    let mut flow = problem.open()?;
    let found = {
        let _told = Waiting::showing("differentiating the run".to_owned(), streams.progress);
        flow.gradient(steps, &mut cost)
    };
    let found = found.map_err(|why| problem.refused(&why))?;
    let rows = rows(&problem, &flow.dimensions(), &found);
    if let Some(row) = rows.iter().find(|row| !row.derivative.is_finite()) {
        return Err(Failure::Failed(format!(
            "the derivative of `{}` in {} is {}. Choose a quantity that is smooth at the end of the run",
            of.text(),
            row.name,
            row.derivative
        )));
    }
    let value = cost.value;
    if !value.is_finite() {
        return Err(Failure::Failed(format!(
            "`{}` is {value} on this run. Choose a quantity that is a number there",
            of.text()
        )));
    }
    let row = |row: &Row| json!({"kind": row.kind, "name": row.name, "value": row.value, "derivative": row.derivative});
    let object = problem.object(json!({
        "of": of.text(),
        "sum": cost.sum,
        "steps": steps,
        "quantity": value,
        "derivatives": rows.iter().map(row).collect::<Vec<Value>>(),
    }));
    let [csv, json] = FILES;
    let written = results.end(&[(csv, table_file(&rows)), (json, format!("{object:#}\n"))])?;
    let out = &mut *streams.out;
    if matches.get_flag("json") {
        writeln!(out, "{object}")?;
        return Ok(DONE);
    }
    let place = match cost.sum {
        true => format!("summed over nodes 0 to {steps}"),
        false => format!("at node {steps}"),
    };
    let title = format!("{}: {} {place} is {value:?}", problem.title(), of.text());
    out.write_all(paragraph(&title, streams.width, 2).as_bytes())?;
    writeln!(out)?;
    out.write_all(table(&rows, streams.width).as_bytes())?;
    writeln!(out)?;
    let mut notes = vec![
        "Derivatives are exact for the discrete motion, at fixed momenta and a fixed number of steps.".to_owned(),
    ];
    if problem.card.initial.iter().any(turns) {
        notes.push("turn_i(X) turns X about body axis i, in radians.".to_owned());
    }
    for line in notes.into_iter().chain(written) {
        out.write_all(paragraph(&line, streams.width, 2).as_bytes())?;
    }
    Ok(DONE)
}

fn rows(problem: &Problem, dimensions: &[usize], found: &Gradient) -> Vec<Row> {
    let card = &problem.card;
    let case = &problem.plan.case;
    let value = |own: Option<&Vec<f64>>, at: usize| own.and_then(|own| own.get(at)).copied();
    let mut all = Vec::new();
    let mut derivatives = coordinates::of_parameters(card, found).into_iter();
    for (at, field) in card.parameters.iter().enumerate() {
        for entry in coordinates::entries(field) {
            let place = entry.places.first().map_or(0, |(place, _)| *place);
            all.push(Row {
                kind: "parameter",
                name: entry.name,
                value: value(case.parameters.get(at), place),
                derivative: derivatives.next().map_or(f64::NAN, |(_, d)| d),
            });
        }
    }
    let mut names = coordinates::local(card, dimensions).into_iter();
    for (at, own) in found.initial.iter().enumerate() {
        let field = card.initial.get(at);
        let entries = field.map(coordinates::entries).unwrap_or_default();
        let plain = field.is_some_and(|field| !turns(field)) && entries.len() == own.len();
        for (i, derivative) in own.iter().enumerate() {
            let place = entries.get(i).and_then(|entry| entry.places.first());
            let place = place.map(|(place, _)| *place).filter(|_| plain);
            all.push(Row {
                kind: "initial value",
                name: names.next().unwrap_or_default(),
                value: place.and_then(|place| value(case.initial.get(at), place)),
                derivative: *derivative,
            });
        }
    }
    all.push(Row {
        kind: "step size",
        name: "h".to_owned(),
        value: Some(case.h),
        derivative: found.step,
    });
    all
}

fn table(rows: &[Row], width: Option<usize>) -> String {
    let head = ["", "name", "value", "derivative"]
        .map(str::to_owned)
        .to_vec();
    let mut kind = "";
    let body = rows.iter().map(|row| {
        let first = if row.kind == kind { "" } else { row.kind };
        kind = row.kind;
        vec![
            first.to_owned(),
            row.name.clone(),
            row.value.map_or_else(|| "-".to_owned(), plain),
            format!("{:.9e}", row.derivative),
        ]
    });
    let all: Vec<Vec<String>> = std::iter::once(head).chain(body).collect();
    aligned(&all, &[2, 3], width)
}

fn table_file(rows: &[Row]) -> String {
    let mut text = "kind,name,value,derivative\n".to_owned();
    for row in rows {
        let value = row.value.map_or_else(String::new, |x| format!("{x:?}"));
        text.push_str(&format!(
            "{},{},{value},{:?}\n",
            row.kind, row.name, row.derivative
        ));
    }
    text
}
