//! Every figure that the README quotes about speed and accuracy stands in benches/RESULTS.md, which has its command.
//! Takes the two pages; a figure that is not there fails, shown here too.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn page(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    fs::read_to_string(root.join(name)).expect("a page of the project")
}

/// The numbers of a text, as they are written: `5.446`, `3.7e-15`.
fn numbers(text: &str) -> BTreeSet<&str> {
    let parts = text.split(|c: char| !(c.is_ascii_digit() || ".e-".contains(c)));
    let trimmed = parts.map(|part| part.trim_matches(|c: char| !c.is_ascii_digit()));
    trimmed.filter(|part| part.parse::<f64>().is_ok()).collect()
}

/// The section under a heading, without its links and pictures.
fn section<'a>(text: &'a str, heading: &str) -> &'a str {
    let from = text.find(heading).expect("the section") + heading.len();
    let rest = &text[from..];
    rest.split("\n## ").next().unwrap_or_default()
}

/// Measured figures: the last cells of the table, and numbers with an exponent in the sentences.
fn quoted(section: &str) -> Vec<&str> {
    let mut found = Vec::new();
    for line in section.lines() {
        match line.strip_prefix('|') {
            Some(row) => found.extend(numbers(
                row.trim_end_matches('|')
                    .rsplit('|')
                    .next()
                    .unwrap_or_default(),
            )),
            None => found.extend(numbers(line).into_iter().filter(|n| n.contains('e'))),
        }
    }
    found
}

#[test]
fn what_the_readme_quotes_was_measured() {
    let (readme, results) = (page("README.md"), page("benches/RESULTS.md"));
    let known = numbers(&results);
    let quoted = quoted(section(&readme, "\n## How fast\n"));
    assert!(quoted.len() >= 10, "{quoted:?}");
    for figure in &quoted {
        assert!(
            known.contains(figure),
            "README.md quotes {figure}, which is not in benches/RESULTS.md"
        );
        // A digit more is another figure.
        let other = format!("{figure}7");
        assert!(!known.contains(other.as_str()), "{other}");
    }
    for program in ["--bin peers", "--bin dimensions"] {
        assert!(results.contains(program), "no command for {program}");
    }
}

#[test]
fn numbers_are_read_as_they_are_written() {
    let found = numbers("| a | 5.446 | x 3.7e-15, 82.0. 5(4) |");
    assert_eq!(found, ["3.7e-15", "4", "5", "5.446", "82.0"].into());
}
