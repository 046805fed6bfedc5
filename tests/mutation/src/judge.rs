//! Runs the judges in turn on every mutant that no earlier judge has caught. Appends verdicts to `verdicts.tsv` (number, judge,
//! result, seconds), so that an interrupted run can resume.

use crate::place;
use crate::runs::{Tests, judges};
use std::collections::BTreeSet;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// The verdicts so far.
struct Verdicts {
    /// The caught mutants.
    caught: BTreeSet<usize>,
    /// The pairs of mutant and judge that have a verdict.
    asked: BTreeSet<(usize, String)>,
}

fn known() -> Verdicts {
    let text = fs::read_to_string(place().join("verdicts.tsv")).unwrap_or_default();
    let mut known = Verdicts {
        caught: BTreeSet::new(),
        asked: BTreeSet::new(),
    };
    for line in text.lines() {
        let mut parts = line.split('\t');
        let (Some(Ok(number)), Some(judge), Some(how)) = (
            parts.next().map(str::parse::<usize>),
            parts.next(),
            parts.next(),
        ) else {
            continue;
        };
        if how != "passes" {
            known.caught.insert(number);
        }
        known.asked.insert((number, judge.to_owned()));
    }
    known
}

/// Runs every judge, with its tests up to `longest`, on every mutant that is neither caught nor already tested by it.
pub fn judge(jobs: usize, longest: Duration) -> Result<(), String> {
    let listed =
        fs::read_to_string(place().join("mutants.tsv")).map_err(|e| format!("mutants.tsv: {e}"))?;
    let mutants: Vec<(usize, &str)> = listed
        .lines()
        .filter_map(|l| {
            let mut parts = l.split('\t');
            Some((parts.next()?.parse().ok()?, parts.next()?))
        })
        .collect();
    let out = OpenOptions::new()
        .create(true)
        .append(true)
        .open(place().join("verdicts.tsv"))
        .map_err(|e| format!("verdicts.tsv: {e}"))?;
    let out = Mutex::new(out);
    for (position, judge) in judges() {
        let known = known();
        let waiting: Vec<usize> = mutants
            .iter()
            .filter(|(n, file)| {
                judge.folders.iter().any(|f| file.starts_with(f))
                    && !known.caught.contains(n)
                    && !known.asked.contains(&(*n, judge.name.to_owned()))
            })
            .map(|(n, _)| *n)
            .collect();
        if waiting.is_empty() {
            continue;
        }
        let tests = Tests::of(position, judge, longest)?;
        eprintln!("{} mutants wait", waiting.len());
        if tests.is_empty() {
            continue;
        }
        let next = AtomicUsize::new(0);
        let work = || -> Result<(), String> {
            while let Some(number) = waiting.get(next.fetch_add(1, Ordering::Relaxed)) {
                let said = tests.judge(*number)?;
                let line = format!(
                    "{number}\t{}\t{}\t{:.1}\n",
                    judge.name,
                    said.how,
                    said.took.as_secs_f64()
                );
                let mut out = out.lock().map_err(|e| e.to_string())?;
                out.write_all(line.as_bytes()).map_err(|e| e.to_string())?;
            }
            Ok(())
        };
        std::thread::scope(|scope| {
            let workers: Vec<_> = (0..jobs.max(1)).map(|_| scope.spawn(work)).collect();
            let done = workers
                .into_iter()
                .map(|w| w.join().unwrap_or(Err("a thread failed".to_owned())));
            done.collect::<Result<Vec<()>, String>>()
        })?;
    }
    Ok(())
}
