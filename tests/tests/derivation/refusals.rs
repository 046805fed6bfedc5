//! Wrong models and the engine's error messages. Each file of `tests/refusals/tests/ui/` contains one fault, and its `.stderr` the
//! messages in the layout of the compiler. The `compiler` test in the same folder runs the compiler on a few of them.

use clebsch_core::diagnostic::{Diagnostic, Place};
use clebsch_core::{lattice, pipeline};
use std::path::{Path, PathBuf};

/// The folder of the faults.
const FOLDER: &str = "refusals/tests/ui";

/// Warnings are not errors of the engine; only the compiler with denied warnings stops at these.
const WARNED: &str = "warnings_on_their_tokens";

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

/// The files with faults, sorted.
fn faults() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(FOLDER);
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "rs"))
        .collect();
    files.sort();
    files
}

/// The engine's messages for a file in the compiler's layout; empty if the model is accepted.
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

/// A message with its source line and carets below the tokens, in the layout of rustc.
fn printed(source: &str, file: &Path, place: Place, text: &str) -> String {
    let (start, end) = (place.first.start(), place.last.end());
    assert_eq!(start.line, end.line, "a range of tokens over several lines");
    let line = source.lines().nth(start.line - 1).unwrap();
    let number = start.line.to_string();
    let margin = " ".repeat(number.len());
    let name = file.file_name().unwrap().to_string_lossy();
    format!(
        "error: {}\n{margin}--> tests/ui/{name}:{number}:{}\n{margin} |\n{number} | {line}\n{margin} | {}{}\n",
        text.replace('\n', "\n       "),
        start.column + 1,
        " ".repeat(start.column),
        "^".repeat(end.column - start.column),
    )
}
