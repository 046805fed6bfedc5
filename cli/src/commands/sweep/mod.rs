//! `clebsch sweep`: a case at every point of a grid of parameters, initial values and steps, on all cores.
//! Takes the gallery and the options; gives one table with a row a point. A row is computed from its point alone, so that
//! neither the number of cores, nor kills, nor a division into parts changes a bit of it.

mod collect;
mod points;
mod table;
mod vary;

pub(crate) use collect::collect;

use crate::arguments::Shard;
use crate::models::gallery::Gallery;
use crate::named::resolve::{Resolved, resolved};
use crate::output::{self, Found, Listening, Staging, run_json};
use crate::overrides::substitute::follow;
use crate::plan::Plan;
use crate::terminal::Streams;
use crate::terminal::failure::{BY_SIGNAL, Failure};
use crate::terminal::waiting::progress_bar;
use crate::trajectory::checkpoint::{Checkpoint, Identity};
use crate::trajectory::verdict::{Verdict, judge};
use crate::words::plain::shown;
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch::card::Card;
use clebsch::integrate::{Observer, RunError, Watch};
use points::Points;
use serde_json::{Value, json};
use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};
use table::Columns;
use vary::Axis;

/// Steps of a point between two looks at the signals.
const AT_A_TIME: u64 = 256;

/// A checkpoint, which makes a killed sweep worth keeping, is written when it has taken so long: the rows need none.
const WORTH_KEEPING: Duration = Duration::from_millis(200);

/// Everything that a point is computed from.
struct Sweep<'a> {
    card: &'a Card,
    plan: &'a Plan,
    axes: &'a [Axis],
    columns: &'a Columns,
    /// What a point is read from again, where expressions of the case hold what is varied.
    again: Option<(&'a Resolved<'a>, &'a ArgMatches)>,
}

/// Runs the command. The exit code is that of a run: 0 if every point came to its end within its bounds.
///
/// # Errors
/// Usage for a wrong request; failed when the file system gives up.
pub(crate) fn sweep(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let resolved = resolved(gallery, matches, streams)?;
    let entry = &resolved.entry;
    let plan = Plan::new(&resolved, matches)?;
    let card = &entry.card_of(&plan.case);
    let axes = matches.get_many::<String>("vary").into_iter().flatten();
    let axes: Vec<Axis> = axes
        .map(|axis| {
            let text = resolved.case.text().map(|case| case.text.as_str());
            Axis::read(axis, card, &plan.motion, text)
        })
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
    let all = vary::points(&axes)?;
    let shard = matches.get_one::<Shard>("shard").copied();
    let (first, end) = shard.map_or((0, all), |shard| shard.points(all));
    let Some(target) = matches.get_one::<PathBuf>("out") else {
        return Err(Failure::Usage(
            "--out DIR: name a folder for the table".to_owned(),
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
        false => Found::Nothing,
    };
    let mut staging = match found {
        Found::Results => return already(target, &description, as_json, streams),
        Found::Middle(both) => {
            let mut staging = both.0;
            staging.go_on();
            staging
        }
        Found::Nothing => Staging::new(target, matches.get_flag("force"), &table::FILES)?,
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
            done => format!("; {done} are there already"),
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
            "clebsch: interrupted; the points computed so far are kept, and --resume goes on with the others"
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
        0 => Err(Failure::Failed(format!("no point could be started; {why}"))),
        _ => {
            let _ = writeln!(streams.err, "clebsch: {why}");
            Ok(told)
        }
    }
}

/// What came out; the exit code says it too.
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

/// Asked to go on with a sweep that has come to its end.
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
            return Err(wrong(format!("it holds another sweep: its {key} differs")));
        }
    }
    output::remove_what_resumes(target);
    match as_json {
        true => writeln!(streams.out, "{there}")?,
        false => writeln!(streams.out, "complete already: {}", shown(target))?,
    }
    Ok(table::Tally::read(&there["results"]["points"]).code())
}

impl Sweep<'_> {
    /// Computes the rows that are left, on all cores; the signal that ended it, if one did.
    fn compute(
        &self,
        first: u64,
        left: &[u64],
        rows: &Mutex<Points>,
        progress: bool,
        keep: &mut dyn FnMut(u64) -> Result<(), Failure>,
    ) -> Result<Option<u8>, Failure> {
        let listening = Listening::begin();
        let bar = progress.then(|| progress_bar(left.len() as u64, "points"));
        let (next, made) = (AtomicU64::new(0), AtomicU64::new(0));
        let refused = Mutex::new(None);
        let ended = AtomicBool::new(false);
        let work = || {
            let mut row = vec![0; self.columns.names.len()];
            while !ended.load(Ordering::Relaxed) {
                let turn = next.fetch_add(1, Ordering::Relaxed);
                let Some(number) = usize::try_from(turn).ok().and_then(|n| left.get(n)) else {
                    break;
                };
                let point = first + number;
                if !self.row(point, &mut row, &|| listening.asked().is_some()) {
                    break;
                }
                let mut rows = rows
                    .lock()
                    .unwrap_or_else(std::sync::PoisonError::into_inner);
                if let Err(error) = rows.put(*number, &row) {
                    ended.store(true, Ordering::Relaxed);
                    let mut refused = refused
                        .lock()
                        .unwrap_or_else(std::sync::PoisonError::into_inner);
                    *refused = Some(error);
                    break;
                }
                made.fetch_add(1, Ordering::Relaxed);
            }
        };
        let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let kept = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..cores.min(left.len().max(1)))
                .map(|_| scope.spawn(work))
                .collect();
            let begun = Instant::now();
            let mut kept = false;
            loop {
                let over = workers
                    .iter()
                    .all(std::thread::ScopedJoinHandle::is_finished);
                let made = made.load(Ordering::Relaxed);
                if let Some(bar) = &bar {
                    bar.set_position(made);
                }
                if !kept && (begun.elapsed() > WORTH_KEEPING || listening.asked().is_some()) {
                    kept = true;
                    if let Err(failure) = keep(made) {
                        ended.store(true, Ordering::Relaxed);
                        return Err(failure);
                    }
                }
                if over {
                    return Ok(());
                }
                std::thread::sleep(Duration::from_millis(5));
            }
        });
        if let Some(bar) = bar {
            bar.finish_and_clear();
        }
        kept?;
        if let Some(error) = refused
            .into_inner()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
        {
            return Err(Failure::io("cannot write the points", &error));
        }
        let all = made.load(Ordering::Relaxed) == left.len() as u64;
        Ok(listening.asked().filter(|_| !all))
    }

    /// What is run at a point, and the values that are varied there. Velocities have the momenta of that point.
    fn at(&self, point: u64) -> (Result<Plan, Failure>, Vec<f64>) {
        let values = vary::at(self.axes, point);
        let mut plan = match self.read_again(&values) {
            Ok(plan) => plan,
            Err(failure) => return (Err(failure), values),
        };
        for (axis, value) in self.axes.iter().zip(&values) {
            match axis.quantity.is_step() {
                true => plan = plan.with_step(*value),
                false => axis.quantity.put(*value, &mut plan.case, &mut plan.motion),
            }
        }
        let started = plan.start_anew(self.card);
        (started.map(|()| plan), values)
    }

    /// The plan of a point before its values are put in: read again where expressions of the case follow them.
    fn read_again(&self, values: &[f64]) -> Result<Plan, Failure> {
        let Some((resolved, matches)) = self.again else {
            return Ok(self.plan.clone());
        };
        let names = self.axes.iter().map(|axis| axis.quantity.name.clone());
        let values: Vec<(String, String)> =
            names.zip(values.iter().map(|x| format!("{x:?}"))).collect();
        let there = Resolved {
            entry: Cow::Borrowed(&*resolved.entry),
            case: resolved.case.clone().with(&values),
            compiled: resolved.compiled,
        };
        let mut plan = Plan::new(&there, matches)?;
        // How long a point runs is that of the case.
        (plan.case.h, plan.case.steps) = (self.plan.case.h, self.plan.case.steps);
        Ok(plan)
    }

    /// Why a point is refused, in words.
    fn refusal(&self, point: u64) -> String {
        let (plan, _) = self.at(point);
        match plan.and_then(|plan| plan.open(self.card)) {
            Err(failure) => failure.to_string(),
            Ok(mut trajectory) => match trajectory.step() {
                Err(error) => error.to_string(),
                Ok(()) => "what is watched is no number at its start".to_owned(),
            },
        }
    }

    /// Computes the row of a point; false when `asked` to stop before its end.
    fn row(&self, point: u64, row: &mut [u64], asked: &dyn Fn() -> bool) -> bool {
        let (plan, values) = self.at(point);
        row.fill(f64::NAN.to_bits());
        let mut slots = row.iter_mut();
        if let Some(slot) = slots.next() {
            *slot = point;
        }
        let mut put = |x: f64| {
            if let Some(slot) = slots.next() {
                // One NaN in all rows, so that they do not depend on how it came about.
                *slot = if x.is_nan() { f64::NAN } else { x }.to_bits();
            }
        };
        values.into_iter().for_each(&mut put);
        let opened = plan.and_then(|plan| Ok((plan.open(self.card)?, plan)));
        let Ok((mut trajectory, plan)) = opened else {
            put(table::REFUSED);
            put(0.0);
            put(0.0);
            return true;
        };
        let steps = plan.case.steps;
        let mut watch = Watch::new(trajectory.as_ref(), steps, 0);
        let mut last = Last(vec![f64::NAN; self.card.observable_count()]);
        let status = loop {
            match watch.advance(trajectory.as_mut(), &mut last, AT_A_TIME) {
                Err(error) => {
                    watch.stop(trajectory.as_ref(), &mut last, &error);
                    break match (watch.summary().steps, error) {
                        (0, RunError::Step(_)) => table::REFUSED,
                        _ => table::STOPPED,
                    };
                }
                Ok(()) if watch.is_over() => break table::DONE,
                Ok(()) if asked() => return false,
                Ok(()) => {}
            }
        };
        let summary = watch.summary();
        let outcomes = judge(self.card, &plan.case, &summary.drifts);
        let kept = outcomes
            .iter()
            .all(|outcome| outcome.verdict != Verdict::Left);
        put(status);
        put(summary.steps as f64);
        put(summary.time);
        put(f64::from(u8::from(kept)));
        let mut drifts = summary.drifts.iter().map(|drift| drift.worst);
        (0..self.card.invariant_count()).for_each(|_| put(drifts.next().unwrap_or(f64::NAN)));
        last.0.into_iter().for_each(&mut put);
        true
    }
}

/// The observables of the last sample.
struct Last(Vec<f64>);

impl Observer for Last {
    fn sample(&mut self, _: u64, _: f64, observables: &[f64], _: &[f64]) {
        self.0.copy_from_slice(observables);
    }
}
