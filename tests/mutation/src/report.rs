//! The table of what was caught by which tests, and the list of survivors, on standard output in Markdown.

use crate::place;
use std::collections::BTreeMap;
use std::fs;

/// Prints the result.
pub fn report() -> Result<(), String> {
    let read =
        |name: &str| fs::read_to_string(place().join(name)).map_err(|e| format!("{name}: {e}"));
    let (mutants, verdicts) = (read("mutants.tsv")?, read("verdicts.tsv")?);
    let judged: BTreeMap<&str, Vec<&str>> = verdicts
        .lines()
        .map(|l| l.split('\t').collect::<Vec<_>>())
        .filter_map(|parts| Some((*parts.first()?, parts)))
        .collect();
    let mut folders: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    let mut kinds: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
    let (mut survivors, mut seconds) = (Vec::new(), 0.0);
    for line in mutants.lines() {
        let parts: Vec<&str> = line.split('\t').collect();
        let [number, file, at, what, original, instead] = parts.as_slice() else {
            continue;
        };
        let Some(verdict) = judged.get(number) else {
            continue;
        };
        let caught = verdict.get(1).is_some_and(|v| *v != "survived");
        seconds += verdict
            .get(2)
            .and_then(|s| s.parse::<f64>().ok())
            .unwrap_or(0.0);
        let mut steps = file.split('/');
        let folder: Vec<&str> = match file.starts_with("macros") {
            true => steps.by_ref().take(4).collect(),
            false => steps.by_ref().take(3).collect(),
        };
        for count in [
            folders.entry(folder.join("/")).or_default(),
            kinds.entry(what).or_default(),
        ] {
            count[0] += 1;
            count[1] += usize::from(caught);
        }
        if !caught {
            survivors.push(format!(
                "- `{file}:{at}` {what}: `{original}` → `{instead}`"
            ));
        }
    }
    let total = folders
        .values()
        .fold([0, 0], |t, c| [t[0] + c[0], t[1] + c[1]]);
    println!(
        "{} of {} mutants are caught, in {:.1} hours of computing time.\n",
        total[1],
        total[0],
        seconds / 3600.0
    );
    println!("| where | mutants | caught |\n|---|---|---|");
    for (folder, count) in &folders {
        println!("| `{folder}` | {} | {} |", count[0], count[1]);
    }
    println!("\n| what is changed | mutants | caught |\n|---|---|---|");
    for (what, count) in &kinds {
        println!("| {what} | {} | {} |", count[0], count[1]);
    }
    println!("\n## Survivors\n");
    for line in survivors {
        println!("{line}");
    }
    Ok(())
}
