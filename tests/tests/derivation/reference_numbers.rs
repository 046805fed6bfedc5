//! Checks that the tables of reference numbers equal the output of tests/reference/generate.py, which evaluates the equations with
//! fifty digits. Compares every number of every table with the committed output.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Constants that are neither results nor initial data of a run.
const SETTINGS: [&str; 4] = ["H", "NODES", "TOLERANCE", "coupled_sym.TOLERANCE"];

/// Errors have five or six digits; states are the nearest `f64`.
const ERRORS: &str = "asymmetric_body_errors.ATTITUDE";

fn page(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(root.join(name)).expect("a file of the tests")
}

/// The tables of a source file: module and name, with their numbers as text.
fn tables(file: &str, source: &str) -> BTreeMap<String, Vec<String>> {
    let mut found = BTreeMap::new();
    let mut module = file.to_owned();
    let mut rest = source;
    while let Some(at) = rest.find("pub ") {
        rest = &rest[at + 4..];
        if let Some(name) = rest.strip_prefix("mod ") {
            if let Some((name, _)) = name.split_once(" {").filter(|(n, _)| !n.contains(';')) {
                module = format!("{name}.");
            }
        } else if let Some((name, typed)) = rest
            .strip_prefix("const ")
            .and_then(|item| item.split_once(':'))
        {
            let (_, value) = typed.split_once('=').expect("a value");
            // Every constant ends before the next, and the last `;` of its type precedes `=`.
            let (value, _) = value.split_once(';').expect("an end");
            let numbers = value.split(|c: char| c.is_whitespace() || "[],".contains(c));
            let numbers = numbers.filter(|n| !n.is_empty()).map(str::to_owned);
            found.insert(format!("{module}{name}"), numbers.collect());
        }
    }
    found
}

fn all_tables() -> BTreeMap<String, Vec<String>> {
    let mut all = tables("", &page("oracle/src/reference.rs"));
    for file in ["coupled_sym", "quaternion", "spatial"] {
        let source = page(&format!("oracle/src/reference/{file}.rs"));
        all.extend(tables(&format!("{file}."), &source));
    }
    all
}

/// The output of the generator, with the rows of a table concatenated.
fn generated() -> BTreeMap<String, Vec<String>> {
    let mut all: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut rows: BTreeMap<String, usize> = BTreeMap::new();
    for line in page("reference/states.txt").lines() {
        let mut words = line.split_whitespace();
        let name = words.next().expect("a name").to_owned();
        let row = rows.entry(name.clone()).or_default();
        assert_eq!(words.next(), Some(row.to_string().as_str()), "{name}");
        *row += 1;
        all.entry(name)
            .or_default()
            .extend(words.map(str::to_owned));
    }
    all
}

/// Half a unit in the last written digit of a number.
fn half_a_unit(written: &str) -> f64 {
    let (digits, exponent) = written.split_once('e').unwrap_or((written, "0"));
    let after = digits.split_once('.').map_or(0, |(_, d)| d.len());
    let exponent: i32 = exponent.parse().expect("an exponent");
    0.5 * 10_f64.powi(exponent - i32::try_from(after).expect("few digits"))
}

/// The numbers that differ from the computed ones.
fn differences(tables: &BTreeMap<String, Vec<String>>) -> Vec<String> {
    let computed = generated();
    let mut found = Vec::new();
    for name in computed.keys().filter(|name| !tables.contains_key(*name)) {
        found.push(format!("{name} is in no table"));
    }
    for (name, written) in tables {
        if SETTINGS.contains(&name.as_str()) {
            continue;
        }
        let Some(computed) = computed.get(name).filter(|c| c.len() == written.len()) else {
            found.push(format!("{name} is not generated"));
            continue;
        };
        for (place, (a, b)) in written.iter().zip(computed).enumerate() {
            let [x, y] = [a, b].map(|n| n.parse::<f64>().expect("a number"));
            let room = if name == ERRORS { half_a_unit(a) } else { 0.0 };
            let apart = (x - y).abs();
            if apart > room || apart.is_nan() {
                found.push(format!("{name}, number {place}: {a}, computed {b}"));
            }
        }
    }
    found
}

#[test]
fn every_number_is_the_one_computed() {
    let tables = all_tables();
    let numbers: usize = tables.values().map(Vec::len).sum();
    assert!(numbers > 400, "{numbers}");
    let found = differences(&tables);
    assert!(found.is_empty(), "{found:#?}");
    // The output has 32 digits, except for zeros and integers.
    let computed = generated();
    for number in computed.values().flatten().filter(|n| *n != "0") {
        let digits = number.split('e').next().unwrap_or_default();
        let digits = digits.chars().filter(char::is_ascii_digit).count();
        assert_eq!(digits, 32, "{number}");
    }
}

#[test]
fn another_number_is_found() {
    let tables = all_tables();
    // Mistakes: the last bit of any state, two exchanged numbers, an extra table, a missing table.
    for name in [
        "body_sym.MOMENTUM",
        "spatial.OMEGA",
        "quaternion.MOMENTUM_C1",
    ] {
        let mut wrong = tables.clone();
        let numbers = wrong.get_mut(name).expect("a table");
        let number: f64 = numbers[4].parse().expect("a number");
        numbers[4] = number.next_up().to_string();
        assert_eq!(differences(&wrong).len(), 1, "{name}");
        let numbers = wrong.get_mut(name).expect("a table");
        numbers[4] = number.to_string();
        numbers.swap(0, 4);
        assert_eq!(differences(&wrong).len(), 2, "{name}");
    }
    let mut wrong = tables.clone();
    wrong.get_mut(ERRORS).expect("a table")[2] = "3.9496e-4".to_owned();
    assert_eq!(differences(&wrong).len(), 1);
    let mut wrong = tables.clone();
    wrong.insert("spatial.MORE".to_owned(), vec!["1.0".to_owned()]);
    assert_eq!(differences(&wrong).len(), 1);
    let mut wrong = tables;
    wrong.remove("coupled_sym.CASIMIR");
    assert_eq!(differences(&wrong).len(), 1);
}

/// The runtime's tests cannot use this crate, and repeat the first two nodes of one run.
#[test]
fn the_numbers_that_the_runtime_repeats_are_the_same() {
    let source = page("../runtime/tests/runtime/free.rs");
    let (_, list) = source.split_once("let expected = [").expect("the numbers");
    let (list, _) = list.split_once("];").expect("their end");
    let words = list.split(|c: char| c.is_whitespace() || "[](),".contains(c));
    let repeated: Vec<f64> = words
        .filter(|word| word.contains('.'))
        .map(|word| word.replace('_', "").parse().expect("a number"))
        .collect();
    let computed = generated();
    let rows = |name: &str, width: usize, row: usize| -> Vec<f64> {
        let row = &computed[name][width * row..width * (row + 1)];
        row.iter().map(|n| n.parse().expect("a number")).collect()
    };
    let expected: Vec<f64> = (0..2)
        .flat_map(|node| {
            let momentum = rows("body_sym.MOMENTUM", 3, node);
            momentum
                .into_iter()
                .chain(rows("body_sym.ATTITUDE", 9, node))
        })
        .collect();
    assert_eq!(repeated, expected);
}
