//! Time of the macro for each gallery model, in an unoptimised engine, as rustc builds it. Prints the minimum, median and maximum
//! over 25 processes in milliseconds, each the first expansion of its process.
//! `cargo run --release --manifest-path benches/Cargo.toml --bin expansion`

use std::io::Write as _;
use std::process::{Command, Stdio};

/// Processes per model.
const RUNS: usize = 25;

fn once(source: &str) -> Option<u32> {
    let mut engine = Command::new(env!("UNOPTIMISED_ENGINE"))
        .arg("measure")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .ok()?;
    engine.stdin.take()?.write_all(source.as_bytes()).ok()?;
    let output = engine.wait_with_output().ok()?;
    String::from_utf8(output.stdout).ok()?.trim().parse().ok()
}

fn main() {
    println!("{:<28} {:>8} {:>8} {:>8}", "ms", "least", "median", "most");
    for entry in clebsch_models::gallery() {
        let mut times: Vec<u32> = (0..RUNS).filter_map(|_| once(entry.card.source)).collect();
        times.sort_unstable();
        let at = |place: usize| times.get(place).map_or(f64::NAN, |t| f64::from(*t) / 1e3);
        let (median, last) = (times.len() / 2, times.len().saturating_sub(1));
        println!(
            "{:<28} {:>8.2} {:>8.2} {:>8.2}",
            entry.card.kebab,
            at(0),
            at(median),
            at(last)
        );
    }
}
