//! What the documents show is what the programs do: every model of the language page derives, the
//! extract of a derivation is part of what is printed, and the figures are those that the command
//! beside them writes, byte for byte.

use clebsch_cli::gallery::Gallery;
use clebsch_cli::{Streams, execute};
use clebsch_core::document::printed_telling;
use clebsch_core::print::Format;
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

/// Words and signs without the breaks between lines, which depend on what stands before.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The indented block of the page that follows these words.
fn block_after<'a>(page: &'a str, words: &str) -> &'a str {
    let rest = page.split(words).nth(1).expect("the words");
    let block = rest.split("```text\n").nth(1).expect("a block");
    block.split("```").next().expect("its end")
}

#[test]
fn the_extract_on_the_first_page_is_what_is_printed() {
    let page = fs::read_to_string(root().join("README.md")).unwrap();
    let model = clebsch_models::find("heavy-top").expect("in the gallery");
    let d = clebsch_core::derive_source(model.card.source).expect("derives");
    let printed = printed_telling(&d, Format::Text, 100, model.citations, None);
    let printed = flat(&printed);
    let extract = block_after(&page, "derive heavy-top` prints the whole derivation");
    let equations: Vec<&str> = extract.split("\n\n").collect();
    assert!(equations.len() >= 5, "the page has lost its extract");
    for equation in equations {
        assert!(
            printed.contains(&flat(equation)),
            "not in the derivation any more: {equation}"
        );
        // A changed number or sign is noticed.
        assert!(!printed.contains(&flat(&equation.replace("= ", "= -"))));
    }
    let refused = block_after(&page, "A model that is wrong is told where and why");
    let wrong = model.card.source.replace("Ω^T*Γ", "Ω*Γ");
    assert_ne!(wrong, model.card.source);
    let told = clebsch_core::derive_source(&wrong).expect_err("refused");
    let told = flat(&format!("error: {told}"));
    assert!(told.starts_with(&flat(refused)), "{told}");
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
            input: &mut std::io::empty(),
            out: &mut out,
            err: &mut err,
            progress: false,
            width: None,
        },
    );
    assert_eq!(code, 0, "{}", String::from_utf8_lossy(&err));
    for name in ["momentum.svg", "invariants.svg", "attitude.svg"] {
        let shown = fs::read(root().join("docs/heavy-top").join(name)).unwrap();
        let written = fs::read(folder.join(name)).unwrap();
        assert!(
            shown == written,
            "docs/heavy-top/{name} is stale: copy it from `clebsch run heavy-top --case general --out DIR`"
        );
    }
    fs::remove_dir_all(folder).unwrap();
}
