//! Wrong models and what is said of them: one fault a file of `tests/ui/`, whose `.stderr` holds
//! the messages as the compiler prints them. All are judged by the engine alone, a few by the
//! compiler too. To write messages anew: `TRYBUILD=overwrite cargo test --release --test refusals`.

use clebsch_core::diagnostic::{Diagnostic, Place};
use clebsch_core::{lattice, pipeline};
use std::path::{Path, PathBuf};

/// Where the faults are.
const FOLDER: &str = "tests/ui";

/// Faults that the compiler judges too, one for each way in which a message reaches it: several
/// at once, a refusal of the emitter, names that other code uses, warnings, a range of tokens.
const COMPILED: [&str; 5] = [
    "several_faults",
    "group_too_large",
    "used_elsewhere",
    "warnings_on_their_tokens",
    "wrong_sided_action",
];

/// Warnings are no errors of the engine: only the compiler, told to deny them, stops there.
const WARNED: &str = "warnings_on_their_tokens";

#[test]
fn the_compiler_shows_what_the_engine_says() {
    let compiler = trybuild::TestCases::new();
    if std::env::var_os("TRYBUILD").is_some() {
        compiler.compile_fail(format!("{FOLDER}/*.rs"));
    } else {
        for name in COMPILED {
            compiler.compile_fail(format!("{FOLDER}/{name}.rs"));
        }
    }
}

#[test]
fn every_fault_is_refused_on_its_tokens() {
    let faults = faults();
    assert!(faults.len() >= 60, "{} faults only", faults.len());
    let mut wrong = Vec::new();
    for file in faults
        .iter()
        .filter(|f| f.file_stem().is_some_and(|n| n != WARNED))
    {
        let expected = std::fs::read_to_string(file.with_extension("stderr")).unwrap_or_default();
        let found = messages(file);
        if found.trim() != expected.trim() {
            wrong.push(format!("expected:\n{expected}\nfound:\n{found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// The files of faults, in order.
fn faults() -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(FOLDER)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "rs"))
        .collect();
    files.sort();
    files
}

/// What the engine says of a file, as the compiler would print it; empty where it finds no fault.
fn messages(file: &Path) -> String {
    let source = std::fs::read_to_string(file).unwrap();
    let model = pipeline::parse_source(&source);
    let stepper = model.and_then(|m| match lattice::has_labels(&m) {
        true => pipeline::emitted_line(&m, &source).map(|_| ()),
        false => pipeline::emitted(&m).map(|_| ()),
    });
    let list: Vec<Diagnostic> = match stepper {
        Err(errors) => errors.iter().cloned().collect(),
        Ok(()) => Vec::new(),
    };
    list.iter()
        .flat_map(|d| {
            let also = d.also.iter().map(|(place, text)| (*place, text.clone()));
            std::iter::once((d.place, d.text())).chain(also)
        })
        .map(|(place, text)| printed(&source, file, place, &text))
        .collect::<Vec<_>>()
        .join("\n")
}

/// A message with its line and carets below the tokens, in the layout of rustc.
fn printed(source: &str, file: &Path, place: Place, text: &str) -> String {
    let (start, end) = (place.first.start(), place.last.end());
    assert_eq!(start.line, end.line, "a range of tokens over several lines");
    let line = source.lines().nth(start.line - 1).unwrap();
    let number = start.line.to_string();
    let margin = " ".repeat(number.len());
    format!(
        "error: {}\n{margin}--> {}:{number}:{}\n{margin} |\n{number} | {line}\n{margin} | {}{}\n",
        text.replace('\n', "\n       "),
        file.display(),
        start.column + 1,
        " ".repeat(start.column),
        "^".repeat(end.column - start.column),
    )
}
