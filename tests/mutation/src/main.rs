//! Mutation testing of the engine and the runtime. A copy of the workspace contains several hundred expressions with a second,
//! wrong form. The number in `CLEBSCH_MUTANT` selects which one is active. The copy is built once, and the tests run for every
//! mutant.
//!
//! ```text
//! cargo run --release --manifest-path tests/mutation/Cargo.toml -- plant --count 500
//! cargo run --release --manifest-path tests/mutation/Cargo.toml -- judge
//! cargo run --release --manifest-path tests/mutation/Cargo.toml -- report
//! ```

mod build;
mod judge;
mod plant;
mod report;
mod runs;
mod sites;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

/// The folder of the copy, the list of mutants and the verdicts, below the workspace.
pub fn place() -> PathBuf {
    root().join("target/mutation")
}

/// The workspace.
pub fn root() -> PathBuf {
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).map_or(here.clone(), PathBuf::from)
}

/// The number after an option on the command line.
fn number(arguments: &[String], name: &str, otherwise: u64) -> Result<u64, String> {
    let Some(at) = arguments.iter().position(|a| a == name) else {
        return Ok(otherwise);
    };
    let given = arguments.get(at + 1).map_or("", String::as_str);
    given
        .parse()
        .map_err(|_| format!("{name} takes a whole number, not `{given}`"))
}

fn run() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.first().map(String::as_str) {
        Some("plant") => {
            let count = number(&arguments, "--count", 500)?;
            let seed = number(&arguments, "--seed", 1)?;
            plant::plant(count as usize, seed)
        }
        Some("judge") => {
            let jobs = number(&arguments, "--jobs", 2)?;
            let longest = number(&arguments, "--longest", 600)?;
            judge::judge(jobs as usize, Duration::from_secs(longest))
        }
        Some("report") => report::report(),
        _ => Err(
            "one of: plant [--count 500] [--seed 1], judge [--jobs 2] [--longest 600], report"
                .to_owned(),
        ),
    }
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}
