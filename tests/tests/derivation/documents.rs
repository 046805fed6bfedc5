//! The documents show what the programs do. The models on the language pages and on the first page derive. The
//! extract of a derivation is part of the printed derivation, and the figures equal the figures that the command
//! writes, byte for byte.

use clebsch_cli::gallery::Gallery;
use clebsch_cli::{Streams, execute};
use clebsch_core::document::{Citations, printed_telling};
use clebsch_core::print::Format;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

#[test]
fn every_model_of_the_language_pages_derives() {
    for (name, least) in [("tutorial", 5), ("language", 12), ("limits", 0)] {
        let page = fs::read_to_string(root().join(format!("docs/{name}.md"))).unwrap();
        let blocks: Vec<&str> = page
            .split("```clebsch\n")
            .skip(1)
            .filter_map(|rest| rest.split("```").next())
            .collect();
        assert!(blocks.len() >= least, "{name}.md has lost its models");
        for text in blocks {
            if let Err(errors) = clebsch_core::derive_source(text) {
                panic!("{name}.md: {text}\n{errors}");
            }
        }
    }
}

/// Links between the pages, which rustdoc also resolves, have their targets in the same folder.
#[test]
fn the_language_pages_link_to_each_other() {
    for name in ["tutorial", "language", "limits"] {
        let page = fs::read_to_string(root().join(format!("docs/{name}.md"))).unwrap();
        let targets: Vec<&str> = page
            .lines()
            .filter_map(|line| line.strip_prefix('[')?.split_once("]: "))
            .map(|(_, target)| target)
            .collect();
        assert!(!targets.is_empty(), "{name}.md has lost its links");
        for target in targets {
            assert!(
                root().join("docs").join(target).exists(),
                "{name}.md: {target}"
            );
        }
    }
}

/// The text without line breaks, which depend on the preceding words.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The first block of a kind after these words.
fn block_after<'a>(page: &'a str, words: &str, kind: &str) -> &'a str {
    let rest = page.split(words).nth(1).expect("the words");
    let block = rest.split(&format!("```{kind}\n")).nth(1).expect("a block");
    block.split("```").next().expect("its end")
}

#[test]
fn the_extract_on_the_first_page_is_what_is_printed() {
    let page = fs::read_to_string(root().join("README.md")).unwrap();
    let model = clebsch_models::find("heavy-top").expect("in the gallery");
    let d = clebsch_core::derive_source(model.card.source).expect("derives");
    let printed = printed_telling(&d, Format::Text, 100, model.citations, None);
    let printed = flat(&printed);
    // The model on the page gives the same equations.
    let shown = block_after(&page, "## A model", "clebsch");
    let shown = clebsch_core::derive_source(shown).expect("derives");
    let shown = flat(&printed_telling(
        &shown,
        Format::Text,
        100,
        Citations::NONE,
        None,
    ));
    let words = "derive heavy-top` prints the whole derivation";
    let extract = block_after(&page, words, "text");
    let equations: Vec<&str> = extract.split("\n\n").collect();
    assert!(equations.len() >= 5, "the page has lost its extract");
    for equation in equations {
        assert!(
            printed.contains(&flat(equation)),
            "not in the derivation any more: {equation}"
        );
        assert!(shown.contains(&flat(equation)), "{equation}");
        // A changed number or sign is detected.
        assert!(!printed.contains(&flat(&equation.replace("= ", "= -"))));
    }
    let refused = block_after(&page, "If a model is wrong", "text");
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
        let shown = fs::read(root().join("docs/book/src/heavy-top").join(name)).unwrap();
        let written = fs::read(folder.join(name)).unwrap();
        assert!(
            shown == written,
            "docs/book/src/heavy-top/{name} is stale: copy it from `clebsch run heavy-top --case general --out DIR`"
        );
    }
    fs::remove_dir_all(folder).unwrap();
}
