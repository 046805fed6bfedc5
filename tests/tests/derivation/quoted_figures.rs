//! Checks that every speed and accuracy figure in the README equals the value in the named row and column of the benchmark page.
//! Tests check that a figure in another row fails, and that a figure without a named row fails.

use std::fs;
use std::path::Path;

/// A table cell: its section, its row, and the head of its column.
struct Place {
    section: &'static str,
    row: &'static str,
    column: &'static str,
}

const PEERS: &str = "## The free body compared with other methods";

const fn place(row: &'static str, column: &'static str) -> Place {
    Place {
        section: PEERS,
        row,
        column,
    }
}

/// Rows of the README's table, and where in benches/RESULTS.md each is measured.
const QUOTED: [(&str, Place); 6] = [
    (
        "one step: the same method, hand-written",
        place("by hand", "one step"),
    ),
    (
        "one step: splitting, order 2",
        place("splitting", "one step"),
    ),
    (
        "one step: Newton's method on the same equation",
        place("Newton", "one step"),
    ),
    (
        "to 1e-10: Dormand-Prince 8(5,3)",
        place("Dormand-Prince 8(5,3)", "to 1e-10"),
    ),
    (
        "to 1e-10: heyoka, compiled Taylor series",
        place("heyoka", "to 1e-10"),
    ),
    (
        "to 1e-10: heyoka in 8 SIMD lanes, clebsch in 16",
        place("heyoka, batch of eight lanes", "to 1e-10"),
    ),
];

fn page(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    fs::read_to_string(root.join(name)).expect("a page of the project")
}

/// The section under a heading.
fn section<'a>(text: &'a str, heading: &str) -> Result<&'a str, String> {
    let from = text
        .find(&format!("\n{heading}\n"))
        .ok_or_else(|| format!("no section {heading}"))?;
    let rest = &text[from + heading.len() + 2..];
    Ok(rest.split("\n## ").next().unwrap_or_default())
}

fn cells(line: &str) -> Option<Vec<&str>> {
    let inner = line.trim().strip_prefix('|')?.strip_suffix('|')?;
    Some(inner.split('|').map(str::trim).collect())
}

/// The tables of a section: the head, and the rows.
fn tables(section: &str) -> Vec<Vec<Vec<&str>>> {
    let mut found: Vec<Vec<Vec<&str>>> = Vec::new();
    let mut inside = false;
    for line in section.lines() {
        let row = cells(line);
        if let Some(row) = row.as_ref().filter(|r| !r[0].starts_with("---")) {
            if !inside {
                found.push(Vec::new());
            }
            found.last_mut().expect("begun").push(row.clone());
        }
        inside = row.is_some();
    }
    found
}

/// The unique cell with this row and column in the tables of a section.
fn cell<'a>(text: &'a str, at: &Place) -> Result<&'a str, String> {
    let mut found = Vec::new();
    for table in tables(section(text, at.section)?) {
        let Some(place) = table[0].iter().position(|head| *head == at.column) else {
            continue;
        };
        let rows = table.iter().skip(1).filter(|row| row[0] == at.row);
        found.extend(rows.filter_map(|row| row.get(place).copied()));
    }
    match found[..] {
        [one] => Ok(one),
        _ => Err(format!(
            "{} cells at ({}, {})",
            found.len(),
            at.row,
            at.column
        )),
    }
}

/// The numbers with an exponent in the prose of a section.
fn exponents(section: &str) -> Vec<&str> {
    let sentences = section
        .lines()
        .filter(|line| !line.starts_with('|') && !line.starts_with('!'));
    let words = sentences.flat_map(str::split_whitespace);
    let words = words.map(|word| word.trim_matches(|c: char| !c.is_ascii_alphanumeric()));
    words
        .filter(|word| word.contains('e') && word.parse::<f64>().is_ok())
        .collect()
}

/// The largest number of a column in the projected runs of benches/LONG_RUNS.md.
fn largest(long: &str, column: &str) -> Result<f64, String> {
    let mut largest = 0.0_f64;
    for order in ["2", "10"] {
        let heading = format!("## Order {order}, projection every 64 steps");
        for table in tables(section(long, &heading)?) {
            let Some(place) = table[0].iter().position(|head| *head == column) else {
                continue;
            };
            for row in &table[1..] {
                let number: f64 = row[place]
                    .parse()
                    .map_err(|_| format!("{} is no number", row[place]))?;
                largest = largest.max(number);
            }
        }
    }
    Ok(largest)
}

/// An error if a quoted figure differs from its measurement.
fn check(readme: &str, results: &str, long: &str) -> Result<(), String> {
    let quoting = section(readme, "## How fast")?;
    let rows = tables(quoting);
    let [table] = &rows[..] else {
        return Err("one table is expected".to_owned());
    };
    if table.len() != 1 + QUOTED.len() {
        return Err(format!(
            "{} rows are quoted, {} are known",
            table.len() - 1,
            QUOTED.len()
        ));
    }
    for row in &table[1..] {
        let known = QUOTED.iter().find(|(label, _)| *label == row[0]);
        let (label, at) = known.ok_or_else(|| format!("no row is named for {}", row[0]))?;
        let measured = cell(results, at)?;
        if row[1] != measured || measured.parse::<f64>().is_err() {
            return Err(format!(
                "{label}: {} is quoted, {measured} was measured",
                row[1]
            ));
        }
    }
    // Long runs: the README quotes the momentum, RESULTS.md the momentum and the energy.
    let momentum = largest(long, "whole run")?;
    let energy = largest(long, "energy")?;
    let numbers = |text: &str| -> Vec<f64> {
        let read = exponents(text).into_iter().filter_map(|n| n.parse().ok());
        read.collect()
    };
    if numbers(quoting) != [momentum] {
        return Err(format!("{:?}, not {momentum:e}", numbers(quoting)));
    }
    let said = section(results, PEERS)?;
    let said = &said[said
        .find("hundred million")
        .ok_or("no sentence on long runs")?..];
    if numbers(said) != [momentum, energy] {
        return Err(format!("{:?}, not {momentum:e}, {energy:e}", numbers(said)));
    }
    Ok(())
}

#[test]
fn what_the_readme_quotes_was_measured() {
    let [readme, results, long] =
        ["README.md", "benches/RESULTS.md", "benches/LONG_RUNS.md"].map(page);
    assert_eq!(check(&readme, &results, &long), Ok(()));
    for program in ["--bin peers", "--bin dimensions"] {
        assert!(results.contains(program), "no command for {program}");
    }
    assert!(long.contains("--bin long_run"));

    // Moves each figure to another row of its table.
    for (label, at) in &QUOTED {
        let figure = cell(&results, at).expect("just checked");
        let row = results
            .lines()
            .find(|line| line.starts_with(&format!("| {} |", at.row)) && line.contains(figure))
            .expect("just checked");
        let emptied = row.replacen(&format!("| {figure} |"), "| 0.123 |", 1);
        let moved = format!("{emptied}\n| another method | {figure} | {figure} | {figure} |");
        let wrong = results.replacen(row, &moved, 1);
        assert!(wrong.contains(figure));
        let refused = check(&readme, &wrong, &long).expect_err("a figure was moved");
        assert!(refused.contains(label), "{refused}");
    }
    // Exchanges two rows of the README, adds a row, and changes a number in a sentence.
    let quote = |old: &str, new: &str| {
        let wrong = readme.replacen(old, new, 1);
        assert_ne!(wrong, readme, "{old}");
        check(&wrong, &results, &long)
    };
    assert!(quote("splitting, order 2 | 5.839", "splitting, order 2 | 3.433").is_err());
    assert!(quote("| to 1e-10: heyoka,", "| to 1e-11: heyoka,").is_err());
    assert!(quote("\n| to 1e-10: h", "\n| new | 24.8 |\n| to 1e-10: h").is_err());
    assert!(quote("at most 4.2e-15", "at most 4.1e-15").is_err());
    assert!(check(&readme, &results, &long.replace("4.2e-15", "4.3e-15")).is_err());
}

#[test]
fn one_step_is_that_of_the_body_it_names() {
    let [results, peers] = ["benches/RESULTS.md", "benches/PEERS.md"].map(page);
    // The same body on the page with all rows, which uses other solver names.
    let (_, body) = peers
        .split_once("\n### I = (3.5, 2.5, 2), M = (-0.5, 0, 1)\n")
        .expect("the body");
    let body = body.split("\n#").next().unwrap_or_default();
    let all = tables(body);
    let place = all[0][0]
        .iter()
        .position(|head| head.starts_with("× generated"));
    let place = place.expect("the ratios");
    let mut compared = 0;
    for table in tables(section(&results, PEERS).expect("a section")) {
        for row in table[1..].iter().filter(|row| !row[1].is_empty()) {
            let solver = format!("solver {}", row[0].to_lowercase());
            let measured = all[0]
                .iter()
                .find(|other| other[0] == row[0] || other[0] == solver)
                .unwrap_or_else(|| panic!("{} is in no row", row[0]));
            let ratio = measured[place].split_whitespace().next();
            assert_eq!(ratio, Some(row[1]), "{}", row[0]);
            compared += 1;
        }
    }
    assert!(compared >= 7, "{compared}");
}
