//! Runs every case in several processes, each with a shifted stack and heap, because on some processors the memory layout
//! determines up to two thirds of the time of a short step. Takes the rows of each process; gives medians and the worst.

use crate::operation_counts::Work;
use std::process::{Command, exit};

/// The number of processes, and the extra bytes in the environment of each, which shift its stack.
pub const SHIFTS: [usize; 8] = [0, 16, 512, 1040, 2064, 3000, 4080, 6160];

/// The variable with the number of a process.
const NUMBER: &str = "CLEBSCH_BENCH_PROCESS";

/// The variable whose length shifts the stack.
const PADDING: &str = "CLEBSCH_BENCH_PADDING";

/// The number of this measuring process; `None` in the process that gathers the results.
pub fn number() -> Option<usize> {
    std::env::var(NUMBER).ok()?.parse().ok()
}

/// Shifts the heap of the process with this number by an allocation that is never freed.
pub fn shift_heap(number: usize) {
    let bytes = SHIFTS.get(number).copied().unwrap_or_default();
    std::mem::forget(vec![0_u8; 16 + bytes]);
}

/// The measurement of a case in one process.
#[derive(Clone, Debug)]
pub struct Row {
    /// The case.
    pub name: String,
    /// Nanoseconds per step of the generated stepper.
    pub generated: f64,
    /// Nanoseconds per step of the hand-written stepper.
    pub hand: f64,
    /// The work of a generated step.
    pub work: Work,
}

/// Prints a row in the format that `gather` parses.
pub fn hand_on(row: &Row) {
    let Work {
        operations,
        divisions,
        functions,
        bytes,
    } = row.work;
    println!(
        "{}\t{}\t{}\t{operations}\t{divisions}\t{functions}\t{bytes}",
        row.name, row.generated, row.hand
    );
}

fn read(line: &str) -> Option<Row> {
    let mut parts = line.split('\t');
    Some(Row {
        name: parts.next()?.to_owned(),
        generated: parts.next()?.parse().ok()?,
        hand: parts.next()?.parse().ok()?,
        work: Work {
            operations: parts.next()?.parse().ok()?,
            divisions: parts.next()?.parse().ok()?,
            functions: parts.next()?.parse().ok()?,
            bytes: parts.next()?.parse().ok()?,
        },
    })
}

/// Runs all processes in sequence, and prints the table of their measurements.
pub fn gather(only: Option<&str>) {
    let mut all: Vec<Vec<Row>> = Vec::new();
    for (number, bytes) in SHIFTS.into_iter().enumerate() {
        eprint!("\rprocess {} of {} ", number + 1, SHIFTS.len());
        let program =
            std::env::current_exe().unwrap_or_else(|e| refuse(&format!("no program: {e}")));
        let done = Command::new(program)
            .args(only)
            .env(NUMBER, number.to_string())
            .env(PADDING, "x".repeat(bytes))
            .output();
        match done {
            Ok(done) if done.status.success() => {
                let text = String::from_utf8_lossy(&done.stdout).into_owned();
                all.push(text.lines().filter_map(read).collect());
            }
            Ok(done) => refuse(&String::from_utf8_lossy(&done.stderr)),
            Err(e) => refuse(&format!("a process did not start: {e}")),
        }
    }
    eprintln!();
    println!(
        "{:<34} {:>9} {:>9} {:>7} {:>7} {:>7}   {:>7} {:>7} {:>7} {:>7}",
        "case",
        "generated",
        "hand",
        "ratio",
        "best",
        "worst",
        "+ - x",
        "/ sqrt",
        "exp sin",
        "bytes"
    );
    for (place, first) in all.first().into_iter().flatten().enumerate() {
        let rows: Vec<&Row> = all.iter().filter_map(|rows| rows.get(place)).collect();
        let of = |f: fn(&Row) -> f64| rows.iter().map(|r| f(r)).collect::<Vec<f64>>();
        let mut ratios = of(|r| r.generated / r.hand);
        ratios.sort_by(f64::total_cmp);
        let [best, .., worst] = ratios[..] else {
            continue;
        };
        println!(
            "{:<34} {:>9.2} {:>9.2} {:>7.3} {best:>7.3} {worst:>7.3}   {:>7.1} {:>7.1} {:>7.1} {:>7}",
            first.name,
            median(of(|r| r.generated)),
            median(of(|r| r.hand)),
            median(ratios),
            first.work.operations,
            first.work.divisions,
            first.work.functions,
            first.work.bytes,
        );
    }
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    let n = numbers.len();
    match (numbers.get(n.saturating_sub(1) / 2), numbers.get(n / 2)) {
        (Some(a), Some(b)) => 0.5 * (a + b),
        _ => f64::NAN,
    }
}

fn refuse(why: &str) -> ! {
    eprintln!("{why}");
    exit(1)
}
