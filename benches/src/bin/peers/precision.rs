//! Error of the free body at time 100 against CPU time, for the generated stepper of every order and for other methods. Takes the
//! Python measurements, or the reason why they are missing; prints tables and returns all points.

use super::timing::{self, Measured};
use super::{drawing, methods};

/// Principal moments of the problem.
pub const MOMENTS: [f64; 3] = [3.5, 2.5, 2.0];
/// Initial body momentum.
pub const MOMENTUM: [f64; 3] = [-0.5, 0.0, 1.0];
/// End time.
pub const TIME: f64 = 100.0;

/// Errors at which methods are compared.
const LEVELS: [f64; 6] = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 5e-14];

/// Measures the methods written in Rust, and prints the tables.
pub fn tables(peers: Result<(String, Vec<Measured>), String>) -> Vec<Measured> {
    let mut measured = timing::measure(methods::all());
    match peers {
        Ok((versions, others)) => {
            println!("\n{versions}");
            measured.extend(others);
        }
        Err(reason) => println!("\nheyoka, SciPy, PyElastica: {reason}"),
    }
    println!("\nMicroseconds until time {TIME} of the cheapest setting whose error is at most\n");
    levels(&measured);
    ratios(&measured);
    println!("\nEvery setting\n");
    println!("| method | setting | error | us |");
    println!("|---|---|---|---|");
    for m in &measured {
        println!(
            "| {} | {} | {:.1e} | {:.2} |",
            m.method, m.setting, m.error, m.micros
        );
    }
    measured
}

/// Time of other methods relative to the generated stepper of order ten, with the cheapest step size for an error level and with
/// step size 0.1; lanes are compared with lanes.
fn ratios(measured: &[Measured]) {
    let cheapest = |method: &str, level: f64| {
        let good = measured
            .iter()
            .filter(|m| m.method == method && m.error <= level);
        good.map(|m| m.micros).fold(f64::INFINITY, f64::min)
    };
    let (alone, lanes) = ("generated, order 10", "generated, order 10, lanes");
    let of_step = |method: &str| {
        let found = measured
            .iter()
            .find(|m| m.method == method && m.setting == "h = 0.1");
        found.map_or((f64::NAN, f64::NAN), |m| (m.micros, m.error))
    };
    println!(
        "\nOrder 10, h = 0.1: error {:.1e} in {:.1} us. How many times longer others take than order 10\n",
        of_step(alone).1,
        of_step(alone).0
    );
    println!("| method | to 1e-6 | to 1e-10 | to 5e-14 | to 5e-14, order 10 with h = 0.1 |");
    println!("|---|---|---|---|---|");
    for method in drawing::methods(measured) {
        if method.starts_with("generated, order 10") {
            continue;
        }
        let own = if method.ends_with("batch") {
            lanes
        } else {
            alone
        };
        let said = |ratio: f64| match ratio.is_finite() {
            true => format!("{ratio:.1}"),
            false => "-".to_owned(),
        };
        let cells =
            [1e-6, 1e-10, 5e-14].map(|level| said(cheapest(method, level) / cheapest(own, level)));
        let last = said(cheapest(method, 5e-14) / of_step(own).0);
        println!("| {method} | {} | {last} |", cells.join(" | "));
    }
}

/// One row per method, one column per error level.
fn levels(measured: &[Measured]) {
    let heads: Vec<String> = LEVELS.iter().map(|level| format!("{level:.0e}")).collect();
    println!("| method | {} |", heads.join(" | "));
    println!("|---|{}", "---|".repeat(LEVELS.len()));
    for method in drawing::methods(measured) {
        let cells = LEVELS.map(|level| {
            let good = measured
                .iter()
                .filter(|m| m.method == method && m.error <= level);
            match good.min_by(|a, b| a.micros.total_cmp(&b.micros)) {
                Some(best) => format!("{:.1} ({})", best.micros, best.setting),
                None => "-".to_owned(),
            }
        });
        println!("| {method} | {} |", cells.join(" | "));
    }
}
