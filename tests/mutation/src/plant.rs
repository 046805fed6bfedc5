//! Chooses sites from a seed, writes the copy of the workspace with both forms of each, and removes mutants that do not compile.

use crate::build;
use crate::sites::{Site, sites};
use crate::{place, root};
use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folders with mutants, and their percentage of the total.
const FOLDERS: [(&str, usize); 2] = [("macros/core/src", 62), ("runtime/src", 38)];

/// Maximum number of rounds that remove mutants with compile errors: type errors first, then borrow errors, then errors that these
/// hid.
const ROUNDS: usize = 12;

/// A planted mutant.
#[derive(Clone, Debug)]
pub struct Mutant {
    /// Its number, from 1.
    pub number: usize,
    /// The file, relative to the workspace.
    pub file: String,
    /// Its line in the file.
    pub line: usize,
    /// The expression and its wrong form.
    pub site: Site,
    /// The unchanged expression.
    pub original: String,
}

/// Copies the files that git tracks to `target/mutation/copy`.
fn copy() -> Result<PathBuf, String> {
    let to = place().join("copy");
    let listed = Command::new("git")
        .args(["ls-files", "-z"])
        .current_dir(root())
        .output()
        .map_err(|e| format!("git ls-files: {e}"))?;
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    for name in listed.split('\0').filter(|n| !n.is_empty()) {
        let (from, to) = (root().join(name), to.join(name));
        let Ok(bytes) = fs::read(&from) else {
            continue;
        };
        write(&to, &bytes)?;
    }
    Ok(to)
}

/// Writes a file only if its content changes, so that cargo rebuilds nothing else.
fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    if fs::read(path).is_ok_and(|old| old == bytes) {
        return Ok(());
    }
    let told = |e: std::io::Error| format!("{}: {e}", path.display());
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(told)?;
    }
    fs::write(path, bytes).map_err(told)
}

fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    let mut entries: Vec<PathBuf> = entries.flatten().map(|e| e.path()).collect();
    entries.sort();
    for entry in entries {
        let name = entry.file_name().map(|n| n.to_string_lossy().into_owned());
        let name = name.unwrap_or_default();
        match entry.is_dir() {
            true if name != "tests" => sources(&entry, out),
            false if name.ends_with(".rs") && !name.contains("test") => out.push(entry),
            _ => {}
        }
    }
}

/// A hash of seed and location, the same on every machine (splitmix64 over the bytes).
fn drawn(seed: u64, file: &str, at: usize, end: usize) -> u64 {
    let mut x = seed;
    let bytes = file.bytes().map(u64::from);
    for b in bytes.chain([at as u64, end as u64]) {
        x = x.wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_add(b);
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^= x >> 31;
    }
    x
}

/// Chooses the sites of a folder in the order of their hashes; no site contains another.
fn choose(folder: &str, count: usize, seed: u64) -> Result<Vec<Mutant>, String> {
    let mut files = Vec::new();
    sources(&root().join(folder), &mut files);
    let mut all = Vec::new();
    for path in files {
        let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let file = path
            .strip_prefix(root())
            .unwrap_or(&path)
            .to_string_lossy()
            .into_owned();
        let found = sites(&text).map_err(|e| format!("{file}: {e}"))?;
        for site in found {
            let before = text.get(..site.range.start).unwrap_or_default();
            all.push(Mutant {
                number: 0,
                file: file.clone(),
                line: before.lines().count().max(1),
                original: text.get(site.range.clone()).unwrap_or_default().to_owned(),
                site,
            });
        }
    }
    eprintln!("{folder}: {} sites", all.len());
    all.sort_by_key(|m| drawn(seed, &m.file, m.site.range.start, m.site.range.end));
    let mut taken: BTreeMap<String, Vec<Range<usize>>> = BTreeMap::new();
    let mut chosen = Vec::new();
    for mutant in all {
        let own = taken.entry(mutant.file.clone()).or_default();
        let range = mutant.site.range.clone();
        if chosen.len() < count
            && own
                .iter()
                .all(|r| r.end <= range.start || range.end <= r.start)
        {
            own.push(range);
            chosen.push(mutant);
        }
    }
    Ok(chosen)
}

/// The switch function, appended to a crate.
const SWITCH: &str = "
/// Whether this mutant is switched on.
#[doc(hidden)]
pub fn mutant(number: u32) -> bool {
    static ON: std::sync::OnceLock<u32> = std::sync::OnceLock::new();
    let on = || std::env::var(\"CLEBSCH_MUTANT\").ok()?.parse().ok();
    *ON.get_or_init(|| on().unwrap_or(0)) == number
}
";

/// The byte range of each mutant in the files of the copy.
pub type Planted = BTreeMap<String, Vec<(Range<usize>, usize)>>;

/// Writes the files of the copy with these mutants.
fn write_all(copy: &Path, mutants: &[Mutant]) -> Result<Planted, String> {
    let mut planted = Planted::new();
    for (folder, _) in FOLDERS {
        let mut files = Vec::new();
        sources(&root().join(folder), &mut files);
        for path in files {
            let file = path
                .strip_prefix(root())
                .unwrap_or(&path)
                .to_string_lossy()
                .into_owned();
            let text = fs::read_to_string(&path).map_err(|e| format!("{file}: {e}"))?;
            let mut own: Vec<&Mutant> = mutants.iter().filter(|m| m.file == file).collect();
            own.sort_by_key(|m| m.site.range.start);
            let (mut out, mut at) = (String::new(), 0);
            for m in own {
                out.push_str(text.get(at..m.site.range.start).unwrap_or_default());
                let start = out.len();
                out.push_str(&format!(
                    "(if crate::mutant({}) {{ {} }} else {{ {} }})",
                    m.number, m.site.instead, m.original
                ));
                planted
                    .entry(file.clone())
                    .or_default()
                    .push((start..out.len(), m.number));
                at = m.site.range.end;
            }
            out.push_str(text.get(at..).unwrap_or_default());
            if file == format!("{folder}/lib.rs") {
                out.push_str(SWITCH);
            }
            write(&copy.join(&file), out.as_bytes())?;
        }
    }
    Ok(planted)
}

/// Plants mutants and builds the tests.
pub fn plant(count: usize, seed: u64) -> Result<(), String> {
    let copy = copy()?;
    let mut mutants = Vec::new();
    for (folder, share) in FOLDERS {
        // About one sixth does not compile.
        mutants.extend(choose(folder, count * share * 6 / 500, seed)?);
    }
    for (i, m) in mutants.iter_mut().enumerate() {
        m.number = i + 1;
    }
    for round in 1..=ROUNDS {
        let planted = write_all(&copy, &mutants)?;
        let refused = build::refused(&copy, &planted)?;
        eprintln!(
            "round {round}: {} mutants, {} do not compile",
            mutants.len(),
            refused.len()
        );
        if refused.is_empty() {
            build::tests(&copy)?;
            return list(&mutants);
        }
        mutants.retain(|m| !refused.contains(&m.number));
    }
    Err(format!(
        "after {ROUNDS} rounds some mutants still do not compile"
    ))
}

/// Writes `mutants.tsv`: number, file, line, description, expression, wrong form.
fn list(mutants: &[Mutant]) -> Result<(), String> {
    let short = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut out = String::new();
    for m in mutants {
        out.push_str(&format!(
            "{}\t{}\t{}\t{}\t{}\t{}\n",
            m.number,
            m.file,
            m.line,
            m.site.what,
            short(&m.original),
            short(&m.site.instead)
        ));
    }
    eprintln!("{} mutants are planted", mutants.len());
    write(&place().join("mutants.tsv"), out.as_bytes())
}
