//! Prints a table of caught mutants by judge, and the list of survivors, as Markdown on standard output.

use crate::place;
use crate::runs::judges;
use std::collections::BTreeMap;
use std::fs;

/// The verdict on a mutant: the judge that caught it, and the seconds spent.
#[derive(Default)]
struct Verdict {
    by: Option<String>,
    seconds: f64,
}

/// The names of the judges, without duplicates, in the order of their runs.
fn names() -> Vec<&'static str> {
    let mut names = Vec::new();
    for (_, judge) in judges() {
        if !names.contains(&judge.name) {
            names.push(judge.name);
        }
    }
    names
}

/// The folder of a source file, up to one level below `src/`.
fn folder(file: &str) -> String {
    let depth = if file.starts_with("macros") { 4 } else { 3 };
    let steps: Vec<&str> = file.split('/').collect();
    let within = steps.split_last().map_or(&[][..], |(_, before)| before);
    within
        .iter()
        .take(depth)
        .copied()
        .collect::<Vec<_>>()
        .join("/")
}

fn table(title: &str, rows: &BTreeMap<String, Vec<usize>>) {
    let names = names();
    println!("| {title} | mutants | {} | survive |", names.join(" | "));
    println!("|---|---|{}---|", "---|".repeat(names.len()));
    for (row, counts) in rows {
        let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
        println!("| {row} | {} |", counts.join(" | "));
    }
    println!();
}

/// Prints the report.
pub fn report() -> Result<(), String> {
    let read =
        |name: &str| fs::read_to_string(place().join(name)).map_err(|e| format!("{name}: {e}"));
    let (mutants, told) = (read("mutants.tsv")?, read("verdicts.tsv")?);
    let mut verdicts: BTreeMap<&str, Verdict> = BTreeMap::new();
    for line in told.lines() {
        let parts: Vec<&str> = line.split('\t').collect();
        let [number, judge, how, seconds] = parts.as_slice() else {
            continue;
        };
        let verdict = verdicts.entry(number).or_default();
        verdict.seconds += seconds.parse::<f64>().unwrap_or(0.0);
        if *how != "passes" {
            verdict.by = Some((*judge).to_owned());
        }
    }
    let names = names();
    let mut folders: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    let mut kinds: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    let (mut survivors, mut judged, mut seconds) = (Vec::new(), 0, 0.0);
    for line in mutants.lines() {
        let parts: Vec<&str> = line.split('\t').collect();
        let [number, file, at, what, original, instead] = parts.as_slice() else {
            continue;
        };
        let Some(verdict) = verdicts.get(number) else {
            continue;
        };
        judged += 1;
        seconds += verdict.seconds;
        let by = names
            .iter()
            .position(|n| Some(*n) == verdict.by.as_deref())
            .unwrap_or(names.len());
        for counts in [
            folders.entry(format!("`{}`", folder(file))).or_default(),
            kinds.entry((*what).to_owned()).or_default(),
        ] {
            counts.resize(names.len() + 2, 0);
            counts[0] += 1;
            counts[by + 1] += 1;
        }
        if verdict.by.is_none() {
            survivors.push(format!(
                "- {number}: `{file}:{at}` {what}: `{original}` → `{instead}`"
            ));
        }
    }
    println!(
        "{} of {judged} mutants are caught, in {:.1} hours of computing time.\n",
        judged - survivors.len(),
        seconds / 3600.0
    );
    table("where", &folders);
    table("what is changed", &kinds);
    println!("## Survivors\n");
    for line in survivors {
        println!("{line}");
    }
    Ok(())
}
