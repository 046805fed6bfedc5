//! The tests of a judge. Each test is timed once without a mutant; then the fastest run first, because the first failure decides.
//! Times determine the order and the timeout, and no other verdict.

use crate::build::{JUDGES, Judge};
use crate::place;
use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Tests faster than this run together, because starting a process costs as much.
const QUICK: Duration = Duration::from_millis(100);

/// Tests of one binary that run in one process.
struct Group {
    binary: String,
    within: String,
    names: Vec<String>,
    /// The timeout, a multiple of the time without a mutant.
    limit: Duration,
}

/// The result of the tests on a mutant.
pub struct RunOutput {
    /// `passes`, `fails` or `hangs`, and the name of the test if it ran alone.
    pub how: String,
    /// The time it took.
    pub took: Duration,
}

impl Group {
    fn run(&self, mutant: usize) -> Result<(&'static str, Duration), String> {
        let started = Instant::now();
        let mut child = command(&self.binary, &self.within)
            .args(["--quiet", "--exact", "--test-threads", "1"])
            .args(&self.names)
            .env("CLEBSCH_MUTANT", mutant.to_string())
            .stdout(Stdio::null())
            .spawn()
            .map_err(|e| format!("{}: {e}", self.binary))?;
        loop {
            if let Some(status) = child.try_wait().map_err(|e| e.to_string())? {
                let how = if status.success() { "passes" } else { "fails" };
                return Ok((how, started.elapsed()));
            }
            if started.elapsed() > self.limit {
                child.kill().map_err(|e| e.to_string())?;
                child.wait().map_err(|e| e.to_string())?;
                return Ok(("hangs", started.elapsed()));
            }
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

fn command(binary: &str, within: &str) -> Command {
    let mut command = Command::new(binary);
    command
        .current_dir(within)
        .env("INSTA_UPDATE", "no")
        .env("CARGO_MANIFEST_DIR", within)
        .stderr(Stdio::null());
    command
}

/// The tests of a judge, fastest first. Tests that fail without a mutant are reported and left out.
pub struct Tests(Vec<Group>);

impl Tests {
    /// Finds and times the tests of a judge, without those that take longer than `longest`.
    pub fn of(number: usize, judge: &Judge, longest: Duration) -> Result<Self, String> {
        let listed =
            fs::read_to_string(place().join("tests.tsv")).map_err(|e| format!("tests.tsv: {e}"))?;
        let (mut timed, mut groups, mut longer) = (Vec::new(), Vec::new(), 0);
        for line in listed.lines() {
            let mut parts = line.split('\t');
            let (Some(by), Some(binary), Some(within)) = (parts.next(), parts.next(), parts.next())
            else {
                continue;
            };
            if by.parse() != Ok(number) {
                continue;
            }
            let told = command(binary, within)
                .args(["--list", "--format", "terse"])
                .output()
                .map_err(|e| format!("{binary}: {e}"))?;
            let told = String::from_utf8_lossy(&told.stdout).into_owned();
            let names = told
                .lines()
                .filter_map(|l| l.strip_suffix(": test"))
                .filter(|n| n.starts_with(judge.filter));
            let mut quick = Vec::new();
            for name in names {
                let group = Group {
                    binary: binary.to_owned(),
                    within: within.to_owned(),
                    names: vec![name.to_owned()],
                    limit: longest,
                };
                let (how, took) = group.run(0)?;
                if how == "hangs" {
                    longer += 1;
                } else if how != "passes" {
                    eprintln!("{name} fails without a mutant: left out");
                } else if took < QUICK {
                    quick.push(name.to_owned());
                } else {
                    timed.push((took, group));
                }
            }
            if !quick.is_empty() {
                groups.push(Group {
                    binary: binary.to_owned(),
                    within: within.to_owned(),
                    limit: QUICK * quick.len() as u32 * 5,
                    names: quick,
                });
            }
        }
        timed.sort_by_key(|(took, _)| *took);
        let whole: Duration = timed.iter().map(|(took, _)| *took).sum();
        eprintln!(
            "{} of {}: {} tests, {:.1} s without a mutant; {longer} tests take longer than {} s",
            judge.name,
            judge.folders.join(" and "),
            groups.iter().map(|g| g.names.len()).sum::<usize>() + timed.len(),
            whole.as_secs_f64(),
            longest.as_secs_f64()
        );
        groups.extend(timed.into_iter().map(|(took, mut group)| {
            group.limit = took * 5;
            group
        }));
        for group in &mut groups {
            group.limit += Duration::from_secs(10);
        }
        Ok(Self(groups))
    }

    /// Whether the judge has no tests.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Runs tests until one fails.
    pub fn judge(&self, mutant: usize) -> Result<RunOutput, String> {
        let mut spent = Duration::ZERO;
        for group in &self.0 {
            let (how, took) = group.run(mutant)?;
            spent += took;
            if how != "passes" {
                let which = match group.names.as_slice() {
                    [one] => format!(" {one}"),
                    _ => String::new(),
                };
                return Ok(RunOutput {
                    how: format!("{how}{which}"),
                    took: spent,
                });
            }
        }
        Ok(RunOutput {
            how: "passes".to_owned(),
            took: spent,
        })
    }
}

/// The judges with their indices.
pub fn judges() -> impl Iterator<Item = (usize, &'static Judge)> {
    JUDGES.iter().enumerate()
}
