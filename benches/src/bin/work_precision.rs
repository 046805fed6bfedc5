//! Error of the free body at time 100 against processor time, for the generated stepper of every order and for other
//! methods. `cargo run --release --manifest-path benches/Cargo.toml --bin work_precision -- FOLDER [--python]`, a minute or
//! two. Writes the picture into the folder and prints tables; `--python` measures heyoka, SciPy and PyElastica too.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables)]

#[path = "work_precision/drawing.rs"]
mod drawing;
#[path = "work_precision/methods.rs"]
mod methods;
#[path = "work_precision/python.rs"]
mod python;
#[path = "work_precision/timing.rs"]
mod timing;

use std::path::Path;
use std::process::ExitCode;
use timing::Measured;

/// Principal moments, momentum and time of the problem.
const MOMENTS: [f64; 3] = [3.5, 2.5, 2.0];
const MOMENTUM: [f64; 3] = [-0.5, 0.0, 1.0];
const TIME: f64 = 100.0;

/// Errors at which methods are compared.
const LEVELS: [f64; 6] = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 5e-14];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some(folder) = arguments.iter().find(|a| !a.starts_with("--")) else {
        eprintln!("which folder shall the picture go to?");
        return ExitCode::from(2);
    };
    let mut measured = timing::measure(methods::all());
    let peers = match arguments.iter().any(|a| a == "--python") {
        true => python::measured(),
        false => Err("not asked for (--python)".to_owned()),
    };
    println!(
        "{}, {} lanes of {}",
        env!("RUSTC_VERSION"),
        methods::LANES,
        vectors()
    );
    match peers {
        Ok((versions, others)) => {
            println!("{versions}");
            measured.extend(others);
        }
        Err(reason) => println!("heyoka, SciPy, PyElastica: {reason}"),
    }
    println!("\nMicroseconds until time {TIME} of the cheapest setting whose error is at most\n");
    levels(&measured);
    headline(&measured);
    println!("\nEvery setting\n");
    println!("| method | setting | error | us |");
    println!("|---|---|---|---|");
    for m in &measured {
        println!(
            "| {} | {} | {:.1e} | {:.2} |",
            m.method, m.setting, m.error, m.micros
        );
    }
    let file = Path::new(folder).join("work-precision.svg");
    let drawn = drawing::svg(&measured)
        .and_then(|svg| std::fs::write(&file, svg).map_err(|e| e.to_string()));
    match drawn {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("{}: {reason}", file.display());
            ExitCode::FAILURE
        }
    }
}

/// How much longer other methods take to the error of order 10 at h = 0.1, or to the last level where they do not get
/// so far.
fn headline(measured: &[Measured]) {
    let own = measured
        .iter()
        .find(|m| m.method == "generated, order 10" && m.setting == "h = 0.1");
    let Some(own) = own else {
        return;
    };
    println!(
        "\nOrder 10, h = 0.1: error {:.1e} in {:.1} us. Times that of others:\n",
        own.error, own.micros
    );
    println!("| method | to an error of 5e-14 | to {:.1e} |", own.error);
    println!("|---|---|---|");
    for method in drawing::methods(measured) {
        let times = |level: f64| {
            let all = measured.iter().filter(|m| m.method == method);
            let good = all.filter(|m| m.error <= level).map(|m| m.micros);
            let best = good.fold(f64::INFINITY, f64::min);
            match best.is_finite() {
                true => format!("{:.1}", best / own.micros),
                false => "-".to_owned(),
            }
        };
        println!("| {method} | {} | {} |", times(5e-14), times(own.error));
    }
}

/// The vector instructions that this program was built for.
fn vectors() -> &'static str {
    match () {
        () if cfg!(target_feature = "avx512f") => "AVX-512",
        () if cfg!(target_feature = "avx2") => "AVX2",
        () if cfg!(target_feature = "sse2") => "SSE2",
        () => "plain numbers",
    }
}

/// One row a method, one column a level of the error.
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
