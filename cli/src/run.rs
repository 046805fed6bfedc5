//! `clebsch run`: from a case to a checked trajectory.
//! Takes the gallery and the options; gives files, a table of what was conserved, and the exit code.

use crate::Streams;
use crate::asked;
use crate::failure::{BOUND_LEFT, DONE, FAILED, Failure};
use crate::gallery::Gallery;
use crate::list::first_line;
use crate::output::{self, Finished, Staging, Stopped, run_json};
use crate::plain::shown;
use crate::plan::Plan;
use crate::plots::axis;
use crate::record::{LARGEST, Record, Recorder, Samples};
use crate::verdict::{Verdict, judge, table};
use crate::width::paragraph;
use clap::ArgMatches;
use clebsch::card::Card;
use clebsch::integrate;
use serde_json::json;
use std::path::PathBuf;

/// Steps whose every node is kept for the plots: all the swings there is room for, of 150 steps each.
const OPENING: u64 = 10_000;

/// Where the texts of a summary begin, behind their names.
const SUMMARY: usize = 21;

/// Runs the command; the code is 0, 3 when an invariant exceeded its bound, or 1 when a step after the
/// first failed: what was computed before is shown and written then, marked as stopped.
///
/// # Errors
/// Usage for a wrong request, failed when the solver refuses the first step or the file system gives
/// up. Nothing is left behind then.
pub fn run(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let model = matches
        .get_one::<String>("model")
        .map_or("", String::as_str);
    let case = matches.get_one::<String>("case").map(String::as_str);
    let entry = asked::model(gallery, model, case, &mut streams.err)?;
    let plan = Plan::new(&entry, matches)?;
    let card = &entry.card_of(&plan.case);
    let target = matches.get_one::<PathBuf>("out");
    let as_json = matches.get_flag("json");
    let staging = match target {
        None => None,
        Some(target) => {
            fits(card, &plan)?;
            Some(Staging::new(
                target,
                matches.get_flag("force"),
                &output::FILES,
            )?)
        }
    };
    let mut trajectory = plan.open(card)?;
    let warning = trajectory.kinetic_warning().map(|w| w.to_string());
    if let Some(warning) = &warning {
        // With `--json` it stands in the object as well; nothing is lost when it cannot be written.
        let _ = writeln!(streams.err, "clebsch: warning: {warning}");
    }
    if !as_json {
        introduce(streams, card, &plan)?;
    }
    let steps = plan.case.steps;
    let mut recorder = Recorder::new(card, steps, staging.is_some(), streams.progress);
    let (summary, stopped) =
        integrate::run_until_stopped(trajectory.as_mut(), steps, plan.every, &mut recorder);
    let record = recorder.finish();
    let stopped = match stopped {
        // A run without a step has no results.
        Some(error) if summary.steps == 0 => return Err(Failure::Failed(error.to_string())),
        error => error.map(|error| Stopped {
            node: summary.node,
            time: summary.time,
            why: error.to_string(),
        }),
    };
    let outcomes = judge(card, &plan.case, &summary.drifts);
    let run = Finished {
        card,
        plan: &plan,
        outcomes: &outcomes,
        samples: summary.samples,
        residual: summary.residual,
        stopped,
    };
    let (mut files, mut place) = (Vec::new(), None);
    if let (Some(staging), Some(record), Some(target)) = (staging, record, target) {
        let write = |files: &mut Vec<&'static str>| {
            let opening = opening(card, &plan, summary.steps)?;
            *files = output::write(&staging, &run, &Samples { record, opening })?;
            match &run.stopped {
                None => staging.commit().map(|()| shown(target)),
                Some(_) => staging.commit_stopped(),
            }
        };
        // Of two things that went wrong both are said.
        place = Some(write(&mut files).map_err(|failure| match &run.stopped {
            None => failure,
            Some(stopped) => Failure::Failed(format!("{}; {failure}", stopped.why)),
        })?);
    }
    let left: Vec<&str> = outcomes
        .iter()
        .filter(|outcome| outcome.verdict == Verdict::Left)
        .map(|outcome| outcome.invariant.name)
        .collect();
    let lost = run.residual.filter(|residual| residual.relative.is_nan());
    let code = match (&run.stopped, left.is_empty() && lost.is_none()) {
        (Some(_), _) => FAILED,
        (None, true) => DONE,
        (None, false) => BOUND_LEFT,
    };
    if as_json {
        let mut object = run_json(&run, &files);
        if let Some(object) = object.as_object_mut() {
            let place = place.as_ref().map(ToString::to_string);
            object.insert("out".to_owned(), json!(place));
            object.insert("exit_code".to_owned(), json!(code));
            object.insert(
                "warnings".to_owned(),
                json!(warning.iter().collect::<Vec<_>>()),
            );
            if let Some(stopped) = &run.stopped {
                object.insert("error".to_owned(), json!(stopped.why));
            }
        }
        writeln!(streams.out, "{object}")?;
    } else {
        write!(streams.out, "\n{}", table(&outcomes, streams.width))?;
        for line in below_the_table(&run, summary.steps) {
            write!(streams.out, "\n{}", paragraph(&line, streams.width, 2))?;
        }
        if let Some(place) = place {
            let written = format!("written to {place}: {}", files.join(", "));
            let written = paragraph(&written, streams.width, 2);
            write!(streams.out, "\n{written}")?;
        }
    }
    // The exit code says the same; nothing is lost when these cannot be written.
    if !left.is_empty() {
        let message = format!("bound exceeded: {}", left.join(", "));
        let _ = writeln!(streams.err, "clebsch: {message}");
    }
    if let Some(residual) = lost {
        let _ = writeln!(
            streams.err,
            "clebsch: the residual is not a number, at node {}: terms of the equations are beyond the \
             range of double precision; take another step or other units",
            residual.node
        );
    }
    if let Some(stopped) = &run.stopped {
        let _ = writeln!(streams.err, "clebsch: {}", stopped.why);
    }
    Ok(code)
}

/// How well the steps are solved, and whether all were made.
fn below_the_table(run: &Finished<'_>, made: u64) -> Vec<String> {
    let residual = run.residual.map(|residual| {
        format!(
            "discrete Euler-Lagrange equations: max relative residual {:.3e}, at node {}",
            residual.relative, residual.node
        )
    });
    let stopped = run.stopped.as_ref().map(|stopped| {
        let time = axis::plain(stopped.time);
        let steps = run.plan.case.steps;
        format!(
            "stopped at node {} (time {time}), after {made} of {steps} steps: these are the results \
             up to there",
            stopped.node
        )
    });
    residual.into_iter().chain(stopped).collect()
}

/// The beginning of the run once more with every node kept, when the record is sparser than that.
fn opening(card: &Card, plan: &Plan, made: u64) -> Result<Option<Record>, Failure> {
    if plan.every == 1 {
        return Ok(None);
    }
    let steps = made.min(OPENING);
    let mut recorder = Recorder::new(card, steps, true, false);
    let mut trajectory = plan.open(card)?;
    integrate::run(trajectory.as_mut(), steps, 1, &mut recorder)
        .map_err(|error| Failure::Failed(error.to_string()))?;
    Ok(recorder.finish())
}

/// The samples must fit into memory.
fn fits(card: &Card, plan: &Plan) -> Result<(), Failure> {
    let size = Record::size(card, plan.case.steps, plan.every);
    if size <= LARGEST {
        return Ok(());
    }
    let every = plan.every.saturating_mul(size.div_ceil(LARGEST));
    Err(Failure::Usage(format!(
        "--every {}: {size} numbers would be written, at most {LARGEST} can be; give --every {every} or more",
        plan.every
    )))
}

/// What runs, and what was derived for it.
fn introduce(streams: &mut Streams<'_>, card: &Card, plan: &Plan) -> Result<(), Failure> {
    let (case, width) = (&plan.case, streams.width);
    let mut say = |text: &str, indent: usize| {
        let text = paragraph(text, width, indent);
        streams.out.write_all(text.as_bytes())
    };
    say(&format!("{}: {}", card.kebab, first_line(card.doc)), 2)?;
    for line in card.summary.trim().lines() {
        say(line, SUMMARY)?;
    }
    let reversible = if card.reversible {
        "reversible"
    } else {
        "not reversible"
    };
    let order = plan.order.unwrap_or(card.order);
    say(
        &format!("solver: {}; order {order}, {reversible}", card.solver),
        2,
    )?;
    if order > card.order {
        say(&card.method_of_order(order, plan.compensated), 2)?;
    }
    let doc = first_line(&case.doc);
    let colon = if doc.is_empty() { "" } else { ": " };
    say(&format!("case {}{colon}{doc}", shown(&case.name)), 2)?;
    let end = end(case.h, case.steps);
    say(
        &format!("h = {}, {} steps, to time {end}", case.h, case.steps),
        2,
    )?;
    Ok(())
}

/// The time at the last node, for print.
#[allow(clippy::cast_precision_loss)]
pub(crate) fn end(h: f64, steps: u64) -> f64 {
    h * steps as f64
}

/// The object that stands for a run that did not come to its end.
#[must_use]
pub fn failure_json(failure: &Failure) -> serde_json::Value {
    json!({"error": failure.to_string(), "exit_code": failure.code()})
}
