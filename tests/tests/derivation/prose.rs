//! Counts hard-to-read sentence patterns in documents and comments, folder by folder. The counts in `prose.txt` must not rise; if
//! you improve sentences, lower the number of the folder there.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A sentence with more words than this counts as long.
const LONG: usize = 32;

/// Phrases with a plainer alternative.
const SHAPES: [&str; 22] = [
    " is told",
    " are told",
    " is said",
    " are said",
    " is asked",
    " hardly ",
    " stands ",
    " stand ",
    " is no ",
    " are no ",
    " was no ",
    " has no ",
    " have no ",
    " that of ",
    " those of ",
    " this one",
    " goes along",
    " goes on with",
    " is made of",
    " are made of",
    " takes away",
    " lets ",
];

/// Phrases that contain one of the patterns but are plain.
const PLAIN: [&str; 5] = [
    " no longer ",
    " no more ",
    " no effect",
    " no error",
    " no limit",
];

/// Words that open a sentence with its topic or with a clause as its subject.
const OPENINGS: [&str; 2] = ["Of ", "What "];

#[test]
fn hard_sentences_do_not_become_more() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    count(&root, &root, &mut counts);
    let ceilings: BTreeMap<&str, usize> = include_str!("prose.txt")
        .lines()
        .filter_map(|line| line.split_once(' '))
        .map(|(folder, most)| (folder, most.trim().parse().expect("a count")))
        .collect();
    let above: Vec<String> = counts
        .iter()
        .filter(|(folder, found)| **found > ceilings.get(folder.as_str()).copied().unwrap_or(0))
        .map(|(folder, found)| format!("{folder} {found}"))
        .collect();
    assert!(
        above.is_empty(),
        "more hard sentences than `prose.txt` allows: {}",
        above.join(", ")
    );
    let low = counts.values().sum::<usize>() * 3 < ceilings.values().sum::<usize>() * 2;
    assert!(!low, "the counts fell by a third: lower `prose.txt`");
}

#[test]
fn shapes_are_seen() {
    let text =
        "//! Of chains whose ends move nothing is told.\n\nfn f() {}\n// You write the action.\n";
    assert_eq!(hard(&rust(text)), 2);
    assert_eq!(
        hard("clebsch names the site. The result no longer depends on it."),
        0
    );
    assert_eq!(hard(&"word ".repeat(LONG + 1)), 1);
}

/// Adds the counts of the files below a folder.
fn count(root: &Path, folder: &Path, counts: &mut BTreeMap<String, usize>) {
    let entries = fs::read_dir(folder).expect("a folder");
    for entry in entries.map(|e| e.expect("an entry").path()) {
        let name = entry.file_name().map(|n| n.to_string_lossy().into_owned());
        let name = name.unwrap_or_default();
        if entry.is_dir() {
            let skipped = ["target", "generated", "out"].contains(&name.as_str());
            if !skipped && !name.starts_with('.') {
                count(root, &entry, counts);
            }
            continue;
        }
        let prose = match entry.extension().and_then(|e| e.to_str()) {
            Some("md") => markdown(&fs::read_to_string(&entry).expect("a text")),
            Some("rs") => rust(&fs::read_to_string(&entry).expect("a text")),
            _ => continue,
        };
        let below = entry.strip_prefix(root).expect("below the root");
        let first = below.components().next().expect("a name");
        let first = first.as_os_str().to_string_lossy().into_owned();
        *counts.entry(first).or_default() += hard(&prose);
    }
}

/// A document without its code blocks.
fn markdown(text: &str) -> String {
    let parts = text.split("```").step_by(2);
    parts.collect::<Vec<_>>().join("\n\n").replace('`', "")
}

/// The comments of a program; adjacent lines form one paragraph.
fn rust(text: &str) -> String {
    let mut out = String::new();
    for line in text.lines() {
        match line.trim_start().strip_prefix("//") {
            Some(comment) => {
                out.push_str(comment.trim_start_matches(['/', '!']));
                out.push('\n');
            }
            None => out.push_str("\n\n"),
        }
    }
    out.replace('`', "")
}

/// The number of patterns in the sentences of a text.
fn hard(text: &str) -> usize {
    let paragraphs = text.split("\n\n");
    let sentences = paragraphs.flat_map(|p| {
        let flat = p.split_whitespace().collect::<Vec<_>>().join(" ");
        let ends = flat.replace(": ", ". ").replace("; ", ". ");
        ends.split(". ").map(str::to_owned).collect::<Vec<_>>()
    });
    sentences
        .map(|sentence| {
            let mut padded = format!(" {sentence} ");
            for plain in PLAIN {
                padded = padded.replace(plain, " ");
            }
            let opened =
                OPENINGS.iter().any(|o| sentence.starts_with(o)) && !sentence.ends_with('?');
            let long = sentence.split(' ').count() > LONG;
            let shapes = SHAPES.iter().filter(|shape| padded.contains(**shape));
            shapes.count() + usize::from(opened) + usize::from(long)
        })
        .sum()
}
