//! The book, chapter by chapter, as a reader follows it: files are written, commands run in order, their output
//! contains the quoted lines, and models that the book calls rejected are rejected.

use crate::common::{Folder, clebsch};
use std::path::Path;

fn source() -> String {
    format!("{}/../docs/book/src", env!("CARGO_MANIFEST_DIR"))
}

/// A fenced block: its information string and its text.
fn blocks(page: &str) -> Vec<(String, String)> {
    let mut blocks = Vec::new();
    let mut open: Option<(String, String)> = None;
    for line in page.lines() {
        open = match (line.strip_prefix("```"), open) {
            (Some(info), None) => Some((info.to_owned(), String::new())),
            (Some(_), Some(block)) => {
                blocks.push(block);
                None
            }
            (None, Some((info, text))) => Some((info, format!("{text}{line}\n"))),
            (None, None) => None,
        };
    }
    assert!(open.is_none(), "a block is not closed");
    blocks
}

/// Runs a command of the book in `folder`, checks that it exits with `code`, and returns everything it printed.
fn run(line: &str, code: u8, folder: &Folder) -> String {
    let words = line.split_whitespace().skip(1);
    let words: Vec<String> = words
        .map(|word| {
            match word.starts_with("out/") || word.ends_with(".toml") || word.ends_with(".clebsch")
            {
                true => folder.path(word),
                false => word.to_owned(),
            }
        })
        .collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let done = clebsch(&words).exits(code);
    done.out + &done.err
}

fn follow(chapter: &str) {
    let page = std::fs::read_to_string(format!("{}/{chapter}.md", source())).expect("a chapter");
    let folder = Folder::new(&format!("book-{chapter}"));
    std::fs::create_dir_all(folder.path("out")).expect("a folder");
    let mut printed = String::new();
    for (info, text) in blocks(&page) {
        match info.split_once(",file=").unwrap_or((&info, "")) {
            ("clebsch" | "toml", file) if !file.is_empty() => {
                folder.write(file, &text);
                if info.starts_with("clebsch") {
                    run(&format!("clebsch derive {file}"), 0, &folder);
                }
            }
            ("clebsch,refused", _) => {
                folder.write("refused.clebsch", &text);
                let done = folder.clebsch("derive @refused.clebsch");
                assert_ne!(done.code, 0, "{text}");
                printed = done.err;
            }
            ("sh", _) => printed = text.lines().map(|line| run(line, 0, &folder)).collect(),
            ("sh,refused", _) => {
                printed = text.lines().map(|line| run(line, 2, &folder)).collect();
            }
            ("text", _) => {
                for line in text.lines() {
                    assert!(
                        printed.contains(line),
                        "{chapter}: `{line}` is not in\n{printed}"
                    );
                }
            }
            ("console" | "rust", _) => {}
            _ => panic!("{chapter}: a block of an unknown kind, {info}"),
        }
    }
    for (name, made) in [
        ("swing.svg", "out/swing/fields.svg"),
        ("toda-chain/momentum.svg", "out/toda/momentum.svg"),
    ] {
        if page.contains(name) {
            let shown = std::fs::read(format!("{}/{name}", source())).expect("a picture");
            let made = std::fs::read(folder.path(made)).expect("a picture");
            assert!(shown == made, "{name} is not what its command draws");
        }
    }
}

#[test]
fn fifteen_minutes() {
    follow("fifteen-minutes");
}

#[test]
fn rigid_body() {
    follow("rigid-body");
}

#[test]
fn chains() {
    follow("chains");
}

#[test]
fn constraints() {
    follow("constraints");
}

#[test]
fn fluids() {
    follow("fluids");
}

#[test]
fn results() {
    follow("results");
}

#[test]
fn derivatives() {
    follow("derivatives");
}

#[test]
fn long_runs() {
    follow("long-runs");
}

#[test]
fn how_it_works() {
    follow("how-it-works");
}

/// Chapters that include a page of `docs/` without its title define its links, which come before those of the page.
#[test]
fn included_pages() {
    for (chapter, name) in [("your-own-model", "tutorial"), ("limits", "limits")] {
        let read = |path: String| std::fs::read_to_string(path).expect("a page");
        let page = read(format!("{}/../../{name}.md", source()));
        let chapter = read(format!("{}/{chapter}.md", source()));
        let (links, after) = chapter
            .split_once(&format!("\n{{{{#include ../../{name}.md:3:}}}}\n"))
            .expect("the page");
        assert!(after.is_empty(), "{after}");
        let mut lines = page.lines();
        assert!(lines.next().is_some_and(|title| title.starts_with("# ")));
        assert_eq!(lines.next(), Some(""));
        let defined = lines.filter_map(|line| Some(line.strip_prefix('[')?.split_once("]: ")?.0));
        for link in defined {
            assert!(links.contains(&format!("\n[{link}]: ")), "{name}: {link}");
        }
    }
}

/// Follows the tutorial like a reader: saves each model with the case below it, derives and runs it, and checks the
/// printed lines.
#[test]
fn tutorial() {
    let path = format!("{}/../docs/tutorial.md", env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(path).expect("the tutorial");
    let folder = Folder::new("tutorial");
    let mut names = ["free", "top", "pendulum", "string", "water"].into_iter();
    let (mut name, mut printed) = ("", String::new());
    for (info, text) in blocks(&page) {
        match info.as_str() {
            "clebsch" => {
                name = names.next().expect("a name for each model");
                assert!(page.contains(&format!("`{name}.clebsch`")), "{name}");
                folder.write(&format!("{name}.clebsch"), &text);
                printed = folder.runs(&format!("derive @{name}.clebsch")).out;
            }
            "toml" => {
                assert!(page.contains(&format!("`{name}.toml`")), "{name}");
                folder.write(&format!("{name}.toml"), &text);
                printed = folder.runs(&format!("run @{name}.clebsch")).out;
            }
            "text" => {
                for line in text.lines() {
                    assert!(
                        printed.contains(line),
                        "{name}: `{line}` is not in\n{printed}"
                    );
                }
            }
            "sh" => {}
            _ => panic!("a block of an unknown kind, {info}"),
        }
    }
    assert!(names.next().is_none(), "the tutorial has lost a model");
}

/// The programs of the book are the examples, which run as separate tests.
#[test]
fn programs_are_the_examples() {
    let page = std::fs::read_to_string(format!("{}/programs.md", source())).expect("a chapter");
    let included: Vec<&str> = page
        .lines()
        .filter_map(|line| line.strip_prefix("{{#include ")?.strip_suffix("}}"))
        .collect();
    assert_eq!(included.len(), 6);
    for path in included {
        assert!(Path::new(&source()).join(path).exists(), "{path}");
    }
    let blocks = blocks(&page);
    let programs = blocks.iter().filter(|(info, _)| info == "rust");
    assert_eq!(programs.count(), 6);
}

#[test]
fn every_chapter_is_followed() {
    let summary = std::fs::read_to_string(format!("{}/SUMMARY.md", source())).expect("a summary");
    let chapters: Vec<&str> = summary
        .lines()
        .filter_map(|line| line.split_once("](")?.1.strip_suffix(".md)"))
        .collect();
    let followed = [
        "fifteen-minutes",
        // The tutorial.
        "your-own-model",
        "rigid-body",
        "chains",
        "constraints",
        "fluids",
        "results",
        "derivatives",
        "long-runs",
        // Its code runs in `python/tests/test_book.py`.
        "python",
        "programs",
        "how-it-works",
        // A page of `docs/` without commands.
        "limits",
    ];
    assert_eq!(chapters, followed);
}
