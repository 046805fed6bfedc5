//! What the documents show is what the programs do: every model of the language page derives, and
//! the figures are those that the command beside them writes, byte for byte.

use clebsch_cli::gallery::Gallery;
use clebsch_cli::{Streams, execute};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

#[test]
fn every_model_of_the_language_page_derives() {
    let page = fs::read_to_string(root().join("docs/language.md")).unwrap();
    let blocks: Vec<&str> = page
        .split("```clebsch\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next())
        .collect();
    assert!(blocks.len() >= 4, "the page has lost its models");
    for text in blocks {
        if let Err(errors) = clebsch_core::derive_source(text) {
            panic!("{text}\n{errors}");
        }
    }
}

#[test]
fn the_figures_are_what_the_command_writes() {
    let folder = std::env::temp_dir().join(format!("clebsch-figures-{}", std::process::id()));
    let arguments = ["clebsch", "run", "heavy-top", "--case", "general", "--out"];
    let mut arguments: Vec<OsString> = arguments.iter().map(OsString::from).collect();
    arguments.push(folder.clone().into());
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let code = execute(
        arguments,
        &Gallery::shipped(),
        &mut Streams {
            out: &mut out,
            err: &mut err,
            progress: false,
        },
    );
    assert_eq!(code, 0, "{}", String::from_utf8_lossy(&err));
    for name in ["momentum.svg", "invariants.svg"] {
        let shown = fs::read(root().join("docs/heavy-top").join(name)).unwrap();
        let written = fs::read(folder.join(name)).unwrap();
        assert!(
            shown == written,
            "docs/heavy-top/{name} is stale: copy it from `clebsch run heavy-top --case general --out DIR`"
        );
    }
    fs::remove_dir_all(folder).unwrap();
}
