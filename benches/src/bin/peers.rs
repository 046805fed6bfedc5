//! The generated free body against other methods: time per step, and time to reach an error, from one run.
//! `cargo run --release --manifest-path benches/Cargo.toml --bin peers`, about four minutes; an argument after `--` names a folder
//! for the figure. If Python is available, heyoka, SciPy and PyElastica are installed and measured, unless `--without-python`.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables)]

#[path = "peers/drawing.rs"]
mod drawing;
#[path = "peers/methods.rs"]
mod methods;
#[path = "peers/one_step.rs"]
mod one_step;
#[path = "peers/precision.rs"]
mod precision;
#[path = "peers/python.rs"]
mod python;
#[path = "peers/timing.rs"]
mod timing;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (options, folders): (Vec<&String>, Vec<&String>) =
        arguments.iter().partition(|a| a.starts_with("--"));
    if options.iter().any(|a| *a != "--without-python") || folders.len() > 1 {
        eprintln!("arguments: [FOLDER] [--without-python]; FOLDER gets the picture");
        return ExitCode::from(2);
    }
    println!("{}\n", env!("RUSTC_VERSION"));
    one_step::tables();
    let peers = match options.is_empty() {
        true => python::measured(),
        false => Err("not asked for".to_owned()),
    };
    let measured = precision::tables(peers);
    let Some(folder) = folders.first() else {
        return ExitCode::SUCCESS;
    };
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
