//! `clebsch run`: from a case to a checked trajectory.
//! Takes the gallery and the options; gives files, a table of the drift of invariants, and the exit code.

mod complete;
mod files;
mod follow;
mod listener;
mod pdf;
mod summary;

use crate::models::gallery::Gallery;
use crate::named::resolve::resolved;
use crate::output::samples::{self, Stream};
use crate::output::{self, Finished, ResumableRun, Staging, Stopped, run_json};
use crate::plan::Plan;
use crate::terminal::Streams;
use crate::terminal::failure::{BOUND_LEFT, BY_SIGNAL, DONE, FAILED, Failure};
use crate::terminal::waiting::Waiting;
use crate::trajectory::checkpoint::{Checkpoint, Identity};
use crate::trajectory::record::{LARGEST, Recorder};
use crate::trajectory::stated::JudgedTrajectory;
use crate::trajectory::step_limit::{self, StepLimit};
use crate::trajectory::verdict::{Verdict, judge, lost, table};
use crate::words::plain::shown;
use crate::words::step_method::step_method;
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch::card::{Card, Trajectory as _};
use clebsch::integrate::{self, Halved, RunError, Watch};
use clebsch::record::Record;
use clebsch_check::StepSelection;
use complete::already;
use follow::{End, Run, RunOutput};
use listener::Listener;
use serde_json::json;
use std::io::{self, Write};
use std::path::PathBuf;
use summary::Verbosity;

/// Steps of which every node is stored for the plots: enough for the largest number of drawn oscillations, with 150
/// steps each.
const OPENING: u64 = 10_000;

/// The largest number of values in these samples, a quarter of a gigabyte. For a fluid this limits the number
/// of steps.
const OPENING_NUMBERS: u64 = 1 << 25;

/// Runs the command. The exit code is 0 for a complete run, and 3 if an invariant exceeded its bound or a step
/// contradicts the action as stated. It is 1 if a step after the first failed; the results so far are then
/// shown and written, marked as stopped.
///
/// # Errors
/// Usage: the request is wrong. Failed: the solver fails in the first step, or a file cannot be written. No folder
/// remains.
pub fn run(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let resolved = resolved(gallery, matches, streams)?;
    let entry = &resolved.entry;
    let plan = {
        let _told = Waiting::showing("reading the case".to_owned(), streams.progress);
        Plan::new(&resolved, matches)?
    };
    let card = &entry.card_of(&plan.case);
    let target = matches.get_one::<PathBuf>("out");
    let as_json = matches.get_flag("json");
    let identity = Identity::of(card, &plan);
    let drawn = match matches.get_flag("vtk") {
        true => output::vtk::drawn(card, &plan)?,
        false => Vec::new(),
    };
    let (mut staging, checkpoint) = match target {
        None => (None, None),
        Some(target) => {
            fits(card, &plan)?;
            let found = match matches.get_flag("resume") {
                true => Staging::resume(target, &output::FILES, &identity)?,
                false => ResumableRun::Nothing,
            };
            match found {
                ResumableRun::Results => {
                    return already(card, &plan, target, (as_json, !drawn.is_empty()), streams);
                }
                ResumableRun::Middle(both) => (Some(both.0), Some(both.1)),
                ResumableRun::Nothing => {
                    let force = matches.get_flag("force");
                    (Some(Staging::new(target, force, &output::FILES)?), None)
                }
            }
        }
    };
    // With `--json` the object contains the warnings as well, so a warning that cannot be written is not lost.
    let mut warn = |warning: &str| {
        let _ = writeln!(streams.err, "clebsch: warning: {warning}");
    };
    let started = {
        let numbers: usize = plan.case.initial.iter().map(Vec::len).sum();
        let what = format!("taking the first step, from a state of {numbers} numbers");
        let _told = Waiting::showing(what, streams.progress);
        plan.open(card)
    };
    // Values that the model rejects are reported before the search for a stability limit.
    let started = match started {
        Err(wrong @ Failure::Usage(_)) => return Err(wrong),
        other => other,
    };
    let limit = {
        let what = "searching for the stability limit of the step size".to_owned();
        let _told = Waiting::showing(what, streams.progress);
        StepLimit::of(card, &plan, step_limit::patience(matches))
    };
    let too_long = limit.warning(plan.case.h);
    // If the first step fails, the usual cause is a step size above the stability limit, so this warning comes
    // first.
    let trajectory = started.inspect_err(|_| {
        too_long.iter().for_each(|warning| warn(warning));
    })?;
    let which = judged_steps(matches);
    let mut trajectory = JudgedTrajectory::new(card, &plan, which, trajectory);
    let kinetic = trajectory.kinetic_warning().map(|w| w.to_string());
    let warnings: Vec<String> = kinetic.into_iter().chain(too_long).collect();
    warnings.iter().for_each(|warning| warn(warning));
    let mut out = Listener {
        out: &mut *streams.out,
        // Results that are written to files are worth the work, whoever listens.
        may_go: target.is_some(),
        gone: false,
    };
    let width = streams.width;
    let told = match matches.get_flag("quiet") || as_json {
        true => Verbosity::Nothing,
        false if matches.get_flag("verbose") => Verbosity::All,
        false => Verbosity::Result,
    };
    let way = step_method(resolved.compiled);
    summary::title(&mut out, width, card, &plan, (told, way))?;
    let steps = plan.case.steps;
    let watch = Watch::new(&trajectory, steps, plan.every);
    let mut following = Run {
        trajectory: &mut trajectory,
        watch,
        steps,
        progress: streams.progress,
    };
    let mut kept = match &mut staging {
        None => None,
        Some(staging) => {
            let stream = match &checkpoint {
                None => {
                    Stream::new(staging.folder(), card).map_err(|error| cannot(staging, &error))?
                }
                Some(checkpoint) => {
                    following.restore(checkpoint)?;
                    resumed(staging, card, checkpoint)?
                }
            };
            let seconds = matches.get_one::<f64>("checkpoint").copied();
            Some(RunOutput {
                staging,
                stream,
                identity,
                seconds: seconds.unwrap_or(f64::INFINITY),
            })
        }
    };
    if let (Some(kept), Some(_)) = (&mut kept, &checkpoint) {
        kept.staging.go_on();
    }
    if checkpoint.is_some() && told != Verbosity::Nothing {
        let node = following.watch.summary().node;
        let text = format!("resumed at node {node}");
        out.write_all(paragraph(&text, width, 2).as_bytes())?;
    }
    let end = following.follow(kept.as_mut())?;
    let summary = following.watch.summary();
    let halvings = following.trajectory.halvings();
    // Steps before an interruption may have been judged.
    let stated = trajectory.verdict();
    let stated = (which != StepSelection::None || stated.judged > 0).then(|| stated.clone());
    let why = match &end {
        End::Whole => None,
        // Without a step there are no results.
        End::Stopped(error) if summary.steps == 0 => {
            return Err(Failure::Failed(refused(error, &plan)));
        }
        End::Stopped(error) => Some(refused(error, &plan)),
        End::Interrupted(signal) => Some(interrupted(*signal)),
    };
    let stopped = why.map(|why| Stopped {
        node: summary.node,
        time: summary.time,
        why,
    });
    let outcomes = judge(card, &plan.case, &summary.drifts);
    let lost = lost(&outcomes, plan.case.h);
    let warnings: Vec<String> = warnings.into_iter().chain(lost.iter().cloned()).collect();
    let run = Finished {
        card,
        plan: &plan,
        outcomes: &outcomes,
        samples: summary.samples,
        halvings,
        stated,
        stopped,
    };
    let stream = kept.map(|kept| kept.stream);
    let (mut files, mut place) = (Vec::<String>::new(), None);
    if let (Some(staging), Some(stream), Some(target)) = (staging, stream, target) {
        let write = |files: &mut Vec<String>| {
            let rows = stream.into_rows();
            let rows = rows.map_err(|error| cannot(&staging, &error))?;
            // A user who has interrupted a run should not have to wait for the opening.
            let opening = match end {
                End::Interrupted(_) => None,
                _ => opening(card, &plan, summary.steps)?,
            };
            *files = files::write(&staging, &run, &rows, opening, drawn)?;
            match (&end, &run.stopped) {
                (End::Interrupted(_), _) => staging.commit_interrupted(),
                (_, None) => staging.commit().map(|()| {
                    output::remove_what_resumes(target);
                    shown(target)
                }),
                (_, Some(_)) => {
                    output::remove_what_resumes(staging.folder());
                    staging.commit().map(|()| shown(target))
                }
            }
        };
        // If the run stopped and the files cannot be written, the message reports both.
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
    let refuted = run.stated.as_ref().filter(|verdict| !verdict.holds());
    let kept = left.is_empty() && refuted.is_none();
    let code = match (&run.stopped, kept) {
        (Some(_), _) if matches!(end, End::Interrupted(_)) => match end {
            End::Interrupted(signal) => BY_SIGNAL.saturating_add(signal),
            _ => FAILED,
        },
        (Some(_), _) => FAILED,
        (None, true) => DONE,
        (None, false) => BOUND_LEFT,
    };
    if as_json {
        let mut object = run_json::run_json(&run, &files);
        if let Some(object) = object.as_object_mut() {
            let place = place.as_ref().map(ToString::to_string);
            object.insert("out".to_owned(), json!(place));
            object.insert("exit_code".to_owned(), json!(code));
            object.insert("warnings".to_owned(), json!(warnings));
            object.insert("longest_step".to_owned(), limit.json(plan.case.h));
            if let Some(stopped) = &run.stopped {
                object.insert("error".to_owned(), json!(stopped.why));
            }
        }
        writeln!(out, "{object}")?;
    } else if told != Verbosity::Nothing {
        if !outcomes.is_empty() {
            write!(out, "\n{}", table(&outcomes, width))?;
        }
        let mut lines = summary::below_the_table(&run, summary.steps);
        lines.extend(limit.summary_line(plan.case.h));
        if let Some(place) = place {
            lines.push(format!("written to {place}: {}", files.join(", ")));
            if !files.iter().any(|file| file == output::FILES[0]) {
                lines.push(format!(
                    "{} was not written because it would be long; write it with --csv",
                    output::FILES[0]
                ));
            }
        }
        writeln!(out)?;
        for line in lines {
            out.write_all(paragraph(&line, width, 2).as_bytes())?;
        }
    }
    for warning in lost {
        let _ = writeln!(streams.err, "clebsch: warning: {warning}");
    }
    // The exit code reports this as well, so a message that cannot be written is not lost.
    if !left.is_empty() {
        let message = format!("bound exceeded: {}", left.join(", "));
        let _ = writeln!(streams.err, "clebsch: {message}");
    }
    if let Some(verdict) = refuted {
        let _ = writeln!(streams.err, "clebsch: {verdict}");
    }
    if let Some(stopped) = &run.stopped {
        let _ = writeln!(streams.err, "clebsch: {}", stopped.why);
    }
    Ok(code)
}

/// The steps to judge by the action as stated.
fn judged_steps(matches: &ArgMatches) -> StepSelection {
    match matches.get_one::<String>("check").map(String::as_str) {
        Some("all") => StepSelection::All,
        Some("none") => StepSelection::None,
        _ => StepSelection::Sample,
    }
}

/// The samples of a run that is resumed.
fn resumed(staging: &Staging, card: &Card, checkpoint: &Checkpoint) -> Result<Stream, Failure> {
    let (rows, sum) = (checkpoint.rows, checkpoint.sum);
    let again = Stream::again(staging.folder(), card, rows, sum);
    again.map_err(|error| cannot(staging, &error))?.ok_or_else(|| {
        let file = staging.folder().join(samples::NAME);
        Failure::Usage(format!(
            "--resume: {}: the samples before the checkpoint are damaged: their checksum differs. Start over with --force \
             instead",
            shown(&file)
        ))
    })
}

fn cannot(staging: &Staging, error: &io::Error) -> Failure {
    let path = staging.folder().join(samples::NAME);
    Failure::io(&format!("cannot write {}", shown(&path)), error)
}

/// The reason why a step failed. With `--halve`, smaller steps were tried as well.
fn refused(error: &RunError, plan: &Plan) -> String {
    match (error, plan.halve) {
        (RunError::Step(_), true) => format!(
            "{error}; --halve tried 2, 4, ... up to {} substeps, and all failed",
            Halved::MOST_PARTS
        ),
        _ => error.to_string(),
    }
}

/// The message for a run that a signal interrupted.
fn interrupted(signal: u8) -> String {
    let by = match signal {
        2 => "SIGINT".to_owned(),
        15 => "SIGTERM".to_owned(),
        other => format!("signal {other}"),
    };
    format!("interrupted by {by}; if the run has --out, resume it with --resume")
}

/// Repeats the first part of the run with every node stored, if the record is sparser.
fn opening(card: &Card, plan: &Plan, made: u64) -> Result<Option<Record>, Failure> {
    if plan.every == 1 {
        return Ok(None);
    }
    let width = samples::width(card) as u64;
    let steps = made.min(OPENING).min(OPENING_NUMBERS / width.max(1));
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
        "--every {}: {size} numbers would be written, and the limit is {LARGEST}; give --every {every} or more",
        plan.every
    )))
}
