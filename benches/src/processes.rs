//! Every case in several processes, each with stack and heap shifted: how memory is laid out decides up to two thirds of the
//! time of a short step on some processors. Takes the rows of one process after the other; gives medians and the worst.

use crate::counted::Work;
use std::process::{Command, exit};

/// How many processes, and by how many bytes the environment of each is longer, which shifts its stack.
pub const SHIFTS: [usize; 8] = [0, 16, 512, 1040, 2064, 3000, 4080, 6160];

/// The variable that tells a process which one it is.
const NUMBER: &str = "CLEBSCH_BENCH_PROCESS";

/// The variable whose length shifts the stack.
const PADDING: &str = "CLEBSCH_BENCH_PADDING";

/// The number of this process among those that measure; none in the one that gathers.
pub fn number() -> Option<usize> {
    std::env::var(NUMBER).ok()?.parse().ok()
}

/// Shifts the heap of the process with this number: what is kept stays allocated.
pub fn shift_heap(number: usize) {
    let bytes = SHIFTS.get(number).copied().unwrap_or_default();
    std::mem::forget(vec![0_u8; 16 + bytes]);
}

/// What one process measured of a case.
#[derive(Clone, Debug)]
pub struct Row {
    /// The case.
    pub name: String,
    /// Nanoseconds a step of the generated stepper.
    pub generated: f64,
    /// And of the one by hand.
    pub hand: f64,
    /// What a generated step takes.
    pub work: Work,
}

/// A row as processes hand it on.
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

/// Runs all processes one after the other, and prints the table of what they measured.
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
