//! `clebsch converge`: the error of a case at a fixed time against the step size, with the measured order.
//! Takes a model and a case; gives a table, JSON, CSV and a plot.

mod draw;
mod levels;

use crate::models::gallery::Gallery;
use crate::named::resolve::resolved;
use crate::output::Staging;
use crate::plan::Plan;
use crate::plan::end;
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::words::columns::aligned;
use crate::words::number::{plain, short};
use crate::words::plain::shown;
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch::card::Card;
use levels::{Level, Measured};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::PathBuf;

/// Files of the command.
const FILES: [&str; 3] = ["convergence.csv", "convergence.json", "convergence.svg"];

/// Runs the command.
///
/// # Errors
/// Usage: the request is wrong. Failed: a run does not reach the end time, or a file cannot be written.
pub(crate) fn converge(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let resolved = resolved(gallery, matches, streams)?;
    let plan = Plan::new(&resolved, matches)?;
    let card = &resolved.entry.card_of(&plan.case);
    let count = matches.get_one::<u32>("levels").copied().unwrap_or(6);
    let target = matches.get_one::<PathBuf>("out");
    let staging = target
        .map(|target| Staging::new(target, matches.get_flag("force"), &FILES))
        .transpose()?;
    let done = Measured::of(card, &plan, count, streams.progress)?;
    let object = object(card, &plan, &done);
    let mut written = None;
    if let (Some(staging), Some(target)) = (staging, target) {
        let [csv, json, svg] = FILES;
        staging.write(csv, |file| write_csv(file, &done))?;
        let text = format!("{object:#}\n");
        staging.write(json, |file| file.write_all(text.as_bytes()))?;
        let drawn = draw::figure(card, &plan, &done)
            .map_err(|error| Failure::Failed(format!("cannot draw {svg}: {error}")))?;
        staging.write(svg, |file| file.write_all(drawn.as_bytes()))?;
        staging.commit()?;
        written = Some(format!(
            "written to {}: {}",
            shown(target),
            FILES.join(", ")
        ));
    }
    let out = &mut *streams.out;
    if matches.get_flag("json") {
        writeln!(out, "{object}")?;
        return Ok(DONE);
    }
    let time = plain(end(plan.case.h, plan.case.steps));
    let title = format!(
        "{}, case {}: error at time {time} against the extrapolation of these runs to h = 0 (Richardson)",
        card.kebab,
        shown(&plan.case.name)
    );
    out.write_all(paragraph(&title, streams.width, 2).as_bytes())?;
    writeln!(out)?;
    out.write_all(table(&done, streams.width).as_bytes())?;
    let order = plan.order.unwrap_or(card.order);
    writeln!(out)?;
    for line in [
        format!("the step has order {order}; each order compares a row with the row above, and the last row fits all rows"),
        format!("errors are relative to the largest size of each quantity; \"-\" marks errors near rounding ({:.0e})", levels::ROUNDING),
    ]
    .into_iter()
    .chain(lower(&done, order))
    .chain(written)
    {
        out.write_all(paragraph(&line, streams.width, 2).as_bytes())?;
    }
    Ok(DONE)
}

/// The message about quantities whose errors decrease more slowly than the order of the step predicts.
fn lower(done: &Measured, order: u32) -> Option<String> {
    let all = || done.names.iter().zip(&done.fitted);
    let is_lower = |fitted: &Option<f64>| fitted.is_some_and(|p| p < f64::from(order) - LOWER);
    let own = all().filter(|(_, fitted)| is_lower(fitted));
    let named: Vec<String> = own
        .filter_map(|(name, fitted)| Some(format!("`{name}` ({:.2})", (*fitted)?)))
        .collect();
    let settles = |at: usize| done.is_settled(at);
    let unsettled = all()
        .enumerate()
        .any(|(at, (_, fitted))| is_lower(fitted) && !settles(at));
    // If another quantity converges with the order of the step, the motion itself does too.
    let as_the_step = all().find(|(_, fitted)| fitted.is_some() && !is_lower(fitted));
    let cause = match as_the_step {
        _ if unsettled => format!(
            "the orders still change between rows, so the largest steps are too large to show an order: start with a smaller \
             `--h`, or use more than {} levels",
            done.levels.len()
        ),
        Some((name, _)) => format!(
            "`{name}` converges with the order of the step, so this error does not accumulate: it arises at each node, as for a \
             momentum that is not projected"
        ),
        None => "use more levels, or smaller steps, to check whether it persists".to_owned(),
    };
    (!named.is_empty()).then(|| {
        format!(
            "measured order below {order}: {}; {cause}",
            named.join(", ")
        )
    })
}

/// How far a fitted order may be below the order of the step.
const LOWER: f64 = 0.4;

fn table(done: &Measured, width: Option<usize>) -> String {
    let mut head = vec!["h".to_owned(), "steps".to_owned()];
    for name in &done.names {
        head.push(format!("error {name}"));
        head.push("order".to_owned());
    }
    let right: Vec<usize> = (0..head.len()).collect();
    let mut rows = vec![head];
    rows.extend(done.levels.iter().map(
        |Level {
             h,
             steps,
             errors,
             orders,
         }| {
            let mut row = vec![plain(*h), steps.to_string()];
            for (error, order) in errors.iter().zip(orders) {
                row.push(short(*error));
                row.push(order.map_or_else(|| "-".to_owned(), |order| format!("{order:.2}")));
            }
            row
        },
    ));
    let mut fit = vec!["fit".to_owned(), String::new()];
    for order in &done.fitted {
        fit.push(String::new());
        fit.push(order.map_or_else(|| "-".to_owned(), |order| format!("{order:.2}")));
    }
    rows.push(fit);
    aligned(&rows, &right, width)
}

fn object(card: &Card, plan: &Plan, done: &Measured) -> Value {
    let level = |level: &Level| json!({"h": level.h, "steps": level.steps, "errors": level.errors, "orders": level.orders});
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "model": card.kebab,
        "fingerprint": format!("{:016x}", card.fingerprint),
        "case": plan.case.name,
        "time": end(plan.case.h, plan.case.steps),
        "order": plan.order.unwrap_or(card.order),
        "arguments": plan.arguments,
        "quantities": done.names,
        "fitted_orders": done.fitted,
        "levels": done.levels.iter().map(level).collect::<Vec<_>>(),
    })
}

fn write_csv(file: &mut dyn Write, done: &Measured) -> io::Result<()> {
    write!(file, "h,steps")?;
    for name in &done.names {
        write!(file, ",error_{name},order_{name}")?;
    }
    writeln!(file)?;
    for Level {
        h,
        steps,
        errors,
        orders,
    } in &done.levels
    {
        write!(file, "{h:?},{steps}")?;
        for (error, order) in errors.iter().zip(orders) {
            write!(file, ",{error:?},{:?}", order.unwrap_or(f64::NAN))?;
        }
        writeln!(file)?;
    }
    Ok(())
}
