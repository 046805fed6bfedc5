//! `clebsch sweep`: runs a case at every point of a grid of parameters, initial values and step sizes, on all cores.
//! Takes the gallery and the options; gives one table with a row per point. A row depends only on its point. The
//! result is bitwise independent of the number of cores, of restarts, and of a division into parts.

mod collect;
mod points;
mod row;
mod table;
mod vary;
mod workers;

pub(crate) use collect::collect;

use crate::arguments::Shard;
use crate::models::gallery::Gallery;
use crate::named::resolve::{Resolved, resolved};
use crate::output::{self, ResumableRun, Staging, run_json};
use crate::overrides::substitute::follow;
use crate::plan::Plan;
use crate::terminal::Streams;
use crate::terminal::failure::{BY_SIGNAL, Failure};
use crate::trajectory::checkpoint::{Checkpoint, Identity};
use crate::words::plain::shown;
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch::card::Card;
use points::Points;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Mutex;
use table::Columns;
use vary::Axis;

/// Everything that a point is computed from.
struct Sweep<'a> {
    card: &'a Card,
    plan: &'a Plan,
    axes: &'a [Axis],
    columns: &'a Columns,
    /// The case and the arguments from which the case is read again at each point, if expressions of the case contain
    /// a varied quantity.
    again: Option<(&'a Resolved<'a>, &'a ArgMatches)>,
}

/// Runs the command. The exit code is 0 if every point completes its run within its bounds.
///
/// # Errors
/// Usage: the request is wrong. Failed: a file cannot be read or written.
pub(crate) fn sweep(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let resolved = resolved(gallery, matches, streams)?;
    let entry = &resolved.entry;
    let plan = Plan::new(&resolved, matches)?;
    let card = &entry.card_of(&plan.case);
    let text = resolved.case.text().map(|case| case.text.as_str());
    let axes = matches.get_many::<String>("vary").into_iter().flatten();
    let axes: Vec<Axis> = axes
        .map(|axis| Axis::read(axis, card, &plan.motion, text))
        .collect::<Result<_, _>>()?;
    let mut pairs = axes
        .iter()
        .enumerate()
        .flat_map(|(i, axis)| axes.iter().take(i).map(move |other| (other, axis)));
    if let Some((other, axis)) = pairs.find(|(other, axis)| axis.quantity.meets(&other.quantity)) {
        let name = shown(&axis.quantity.name);
        return Err(Failure::Usage(
            match other.quantity.name == axis.quantity.name {
                true => format!("--vary {name}: given twice"),
                false => format!(
                    "--vary {name}: given twice, since --vary {} sets the same number; give one of them",
                    shown(&other.quantity.name)
                ),
            },
        ));
    }
    for set in matches.get_many::<String>("set").into_iter().flatten() {
        // A list or a table is not an axis: an axis may vary one of its components.
        let Ok(fixed) = Axis::read(set, card, &plan.motion, text) else {
            continue;
        };
        if let Some(axis) = axes
            .iter()
            .find(|axis| axis.quantity.meets(&fixed.quantity))
        {
            return Err(Failure::Usage(format!(
                "--vary {}: `--set {}` sets the same number; remove one of them",
                shown(&axis.quantity.name),
                shown(set)
            )));
        }
    }
    let all = vary::points(&axes)?;
    let shard = matches.get_one::<Shard>("shard").copied();
    let (first, end) = shard.map_or((0, all), |shard| shard.points(all));
    let Some(target) = matches.get_one::<PathBuf>("out") else {
        return Err(Failure::Usage(
            "--out DIR: give a folder for the table".to_owned(),
        ));
    };
    let as_json = matches.get_flag("json");
    let mut description = run_json::plan_json(card, &plan);
    description["vary"] = axes
        .iter()
        .map(|axis| json!({"name": axis.quantity.name, "values": axis.values}))
        .collect();
    description["points"] = json!(all);
    description["stepped"] = json!({
        "order": plan.order,
        "solver": plan.solver.map(clebsch::solvers::Method::name),
        "compensated": plan.compensated,
    });
    description["shard"] = json!(
        shard.map(|shard| json!({"part": shard.part, "of": shard.of, "first": first, "end": end}))
    );
    let identity = Identity::of(card, &plan)
        .with("vary", description["vary"].to_string())
        .with("shard", description["shard"].to_string());
    let found = match matches.get_flag("resume") {
        true => Staging::resume(target, &table::FILES, &identity)?,
        false => ResumableRun::Nothing,
    };
    let mut staging = match found {
        ResumableRun::Results => return already(target, &description, as_json, streams),
        ResumableRun::Middle(both) => {
            let mut staging = both.0;
            staging.go_on();
            staging
        }
        ResumableRun::Nothing => Staging::new(target, matches.get_flag("force"), &table::FILES)?,
    };
    let columns = Columns::of(card, &axes);
    let names: Vec<&str> = axes
        .iter()
        .map(|axis| axis.quantity.name.as_str())
        .collect();
    let follows = resolved
        .case
        .text()
        .is_some_and(|case| follow(&case.text, &names))
        || axes.iter().any(|axis| axis.quantity.is_of_text());
    let sweep = Sweep {
        card,
        plan: &plan,
        axes: &axes,
        columns: &columns,
        again: follows.then_some((&resolved, matches)),
    };
    let failed = |error: std::io::Error| {
        Failure::io(&format!("cannot write into {}", shown(target)), &error)
    };
    let width = columns.names.len();
    let mut rows = Points::open(staging.folder(), width, end - first).map_err(failed)?;
    let there = rows.there(first).map_err(failed)?;
    let left: Vec<u64> = (0..)
        .zip(&there)
        .filter(|(_, there)| !**there)
        .map(|(n, _)| n)
        .collect();
    if !as_json {
        let here = match shard {
            None => String::new(),
            Some(shard) => format!(
                ", of which part {} of {} has {}",
                shard.part,
                shard.of,
                end - first
            ),
        };
        let done = match there.len() - left.len() {
            0 => String::new(),
            done => format!("; {done} are done already"),
        };
        let told = format!("{}: {all} points{here}{done}", card.kebab);
        streams
            .out
            .write_all(paragraph(&told, streams.width, 2).as_bytes())?;
    }
    let rows = Mutex::new(rows);
    let signal = sweep.compute(first, &left, &rows, streams.progress, &mut |n| {
        let checkpoint = Checkpoint {
            trajectory: Vec::new(),
            watch: Vec::new(),
            rows: n,
            sum: 0,
        };
        checkpoint
            .write(staging.folder(), &identity)
            .map_err(failed)?;
        staging.keep();
        Ok(())
    })?;
    if let Some(signal) = signal {
        let _ = writeln!(
            streams.err,
            "clebsch: interrupted; the finished points are kept, and --resume computes the rest"
        );
        return Ok(BY_SIGNAL.saturating_add(signal));
    }
    let rows = rows
        .into_inner()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    let rows = rows.into_rows(staging.folder()).map_err(failed)?;
    let tally = table::write(&staging, &columns, &rows)?;
    let object = table::describe(&staging, &description, &tally)?;
    staging.commit()?;
    output::remove_what_resumes(target);
    let told = tell(&object, &tally, target, as_json, streams)?;
    let Some(point) = tally.first_refused else {
        return Ok(told);
    };
    let why = format!("the first refused point, {point}: {}", sweep.refusal(point));
    match tally.done + tally.stopped {
        0 => Err(Failure::Failed(format!("no point started; {why}"))),
        _ => {
            let _ = writeln!(streams.err, "clebsch: {why}");
            Ok(told)
        }
    }
}

/// Prints the result and returns the exit code.
fn tell(
    object: &Value,
    tally: &table::Tally,
    target: &std::path::Path,
    as_json: bool,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    if as_json {
        writeln!(streams.out, "{object}")?;
        return Ok(tally.code());
    }
    let [csv, npz, json, ..] = table::FILES;
    let lines = [
        tally.text(),
        format!("written to {}: {csv}, {npz}, {json}", shown(target)),
    ];
    for line in lines {
        streams
            .out
            .write_all(paragraph(&line, streams.width, 2).as_bytes())?;
    }
    Ok(tally.code())
}

/// Handles `--resume` for a sweep that is already complete.
fn already(
    target: &std::path::Path,
    own: &Value,
    as_json: bool,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let wrong = |words: String| Failure::Usage(format!("--resume: {}: {words}", shown(target)));
    let there = collect::description(target).map_err(wrong)?;
    for (key, value) in own.as_object().into_iter().flatten() {
        if there.get(key) != Some(value) {
            return Err(wrong(format!(
                "it contains another sweep: its {key} differs"
            )));
        }
    }
    output::remove_what_resumes(target);
    match as_json {
        true => writeln!(streams.out, "{there}")?,
        false => writeln!(streams.out, "complete already: {}", shown(target))?,
    }
    Ok(table::Tally::read(&there["results"]["points"]).code())
}
