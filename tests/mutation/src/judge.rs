//! Runs the tests for every mutant until one fails. Verdicts are appended to `verdicts.tsv`, so that a run
//! that was interrupted goes on.

use crate::place;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// A binary of tests.
struct Test {
    folder: String,
    binary: String,
    within: String,
    /// How long it may take: one that takes much longer than without a mutant hangs.
    limit: Duration,
}

/// Whether a test passes with a mutant (0: none), and how long it took.
fn passes(test: &Test, mutant: usize) -> Result<(bool, Duration), String> {
    let started = Instant::now();
    let mut child = Command::new(&test.binary)
        .args(["--quiet", "--test-threads", "1"])
        .current_dir(&test.within)
        .env("CLEBSCH_MUTANT", mutant.to_string())
        .env("INSTA_UPDATE", "no")
        .env("CARGO_MANIFEST_DIR", &test.within)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|e| format!("{}: {e}", test.binary))?;
    loop {
        if let Some(status) = child.try_wait().map_err(|e| e.to_string())? {
            return Ok((status.success(), started.elapsed()));
        }
        if started.elapsed() > test.limit {
            child.kill().map_err(|e| e.to_string())?;
            child.wait().map_err(|e| e.to_string())?;
            return Ok((false, started.elapsed()));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The tests, each run once without a mutant.
fn tests() -> Result<Vec<Test>, String> {
    let text =
        fs::read_to_string(place().join("tests.tsv")).map_err(|e| format!("tests.tsv: {e}"))?;
    let mut all = Vec::new();
    for line in text.lines() {
        let mut parts = line.split('\t').map(str::to_owned);
        let (Some(folder), Some(binary), Some(within)) = (parts.next(), parts.next(), parts.next())
        else {
            continue;
        };
        let mut test = Test {
            folder,
            binary,
            within,
            limit: Duration::from_secs(3600),
        };
        let (passed, took) = passes(&test, 0)?;
        eprintln!(
            "{} {:.1} s without a mutant{}",
            test.binary,
            took.as_secs_f64(),
            if passed { "" } else { ": FAILS, left out" }
        );
        test.limit = took * 5 + Duration::from_secs(10);
        if passed {
            all.push(test);
        }
    }
    Ok(all)
}

/// Judges every mutant that has no verdict yet.
pub fn judge(jobs: usize) -> Result<(), String> {
    let read = |name: &str| fs::read_to_string(place().join(name)).unwrap_or_default();
    let first = |text: &str| -> Vec<usize> {
        text.lines()
            .filter_map(|l| l.split('\t').next()?.parse().ok())
            .collect()
    };
    let known = first(&read("verdicts.tsv"));
    let listed = read("mutants.tsv");
    let waiting: Vec<(usize, String)> = listed
        .lines()
        .filter_map(|l| {
            let mut parts = l.split('\t');
            Some((parts.next()?.parse().ok()?, parts.next()?.to_owned()))
        })
        .filter(|(n, _)| !known.contains(n))
        .collect();
    let tests = tests()?;
    let out = OpenOptions::new()
        .create(true)
        .append(true)
        .open(place().join("verdicts.tsv"))
        .map_err(|e| format!("verdicts.tsv: {e}"))?;
    let (out, next) = (Mutex::new(out), AtomicUsize::new(0));
    let one = |number: usize, file: &str| -> Result<String, String> {
        let (mut spent, mut by) = (Duration::ZERO, "survived".to_owned());
        for test in tests.iter().filter(|t| file.starts_with(&t.folder)) {
            let (passed, took) = passes(test, number)?;
            spent += took;
            if !passed {
                let name = test.binary.rsplit('/').next().unwrap_or_default();
                let name = name.rsplit_once('-').map_or(name, |(stem, _)| stem);
                let how = if took > test.limit { "hangs" } else { "fails" };
                by = format!("{how} {name}");
                break;
            }
        }
        Ok(format!("{number}\t{by}\t{:.1}\n", spent.as_secs_f64()))
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..jobs.max(1))
            .map(|_| {
                scope.spawn(|| -> Result<(), String> {
                    while let Some((number, file)) =
                        waiting.get(next.fetch_add(1, Ordering::Relaxed))
                    {
                        let line = one(*number, file)?;
                        let mut out = out.lock().map_err(|e| e.to_string())?;
                        out.write_all(line.as_bytes()).map_err(|e| e.to_string())?;
                    }
                    Ok(())
                })
            })
            .collect();
        let done = workers
            .into_iter()
            .map(|w| w.join().unwrap_or(Err("a thread failed".to_owned())));
        done.collect::<Result<Vec<()>, String>>()
    })?;
    Ok(())
}
