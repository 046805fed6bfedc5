//! Builds the copy by cargo: which mutants the compiler refuses, and where the binaries of the tests are.

use crate::place;
use crate::plant::Planted;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// The tests that judge, in the order in which they are asked: mutants of a folder, arguments of cargo.
pub const TESTS: [(&str, &[&str]); 4] = [
    ("macros/core/src", &["-p", "clebsch-core", "--lib"]),
    (
        "macros/core/src",
        &["-p", "clebsch-tests", "--test", "derivation"],
    ),
    ("macros/core/src", &["-p", "clebsch-interpret", "--tests"]),
    (
        "runtime/src",
        &[
            "-p",
            "clebsch",
            "--lib",
            "--tests",
            "--all-features",
            "--config",
            QUICKLY,
        ],
    ),
];

/// With a mutant in every other line, code takes long to optimise.
const QUICKLY: &str = "profile.release.package.clebsch.opt-level=1";

fn cargo(copy: &Path, arguments: &[&str]) -> Result<Vec<Value>, String> {
    let done = Command::new(env!("CARGO"))
        .args(arguments)
        .arg("--message-format=json")
        .current_dir(copy)
        .env("CARGO_TARGET_DIR", place().join("build"))
        .env("RUSTFLAGS", "--cap-lints allow")
        .env_remove("CLEBSCH_MUTANT")
        .stderr(Stdio::inherit())
        .output()
        .map_err(|e| format!("cargo: {e}"))?;
    let text = String::from_utf8_lossy(&done.stdout);
    Ok(text
        .lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .collect())
}

/// The mutants in whose expressions the compiler finds an error.
pub fn refused(copy: &Path, planted: &Planted) -> Result<BTreeSet<usize>, String> {
    let mut refused = BTreeSet::new();
    for package in ["clebsch-core", "clebsch"] {
        let told = cargo(
            copy,
            &[
                "check",
                "--release",
                "-p",
                package,
                "--lib",
                "--all-features",
            ],
        )?;
        let mut broken = false;
        for message in told.iter().map(|t| &t["message"]) {
            if message["level"] != "error" {
                continue;
            }
            broken = true;
            let spans = message["spans"].as_array().cloned().unwrap_or_default();
            for span in spans {
                let file = span["file_name"].as_str().unwrap_or_default();
                let at = span["byte_start"].as_u64().unwrap_or(0) as usize;
                let own = planted.get(file).into_iter().flatten();
                refused.extend(own.filter(|(r, _)| r.contains(&at)).map(|(_, n)| *n));
            }
        }
        if broken && refused.is_empty() {
            return Err(format!(
                "{package} does not build, and no mutant is at fault"
            ));
        }
        if broken {
            return Ok(refused);
        }
    }
    Ok(refused)
}

/// Builds the tests and writes `tests.tsv`: folder, binary, directory it is run in.
pub fn tests(copy: &Path) -> Result<(), String> {
    let mut out = String::new();
    for (folder, arguments) in TESTS {
        let all = [&["test", "--release", "--no-run"], arguments].concat();
        for message in cargo(copy, &all)? {
            let (Some(binary), true) = (
                message["executable"].as_str(),
                message["profile"]["test"] == true,
            ) else {
                continue;
            };
            let manifest = message["manifest_path"].as_str().unwrap_or_default();
            let within = Path::new(manifest).parent().unwrap_or(copy);
            out.push_str(&format!("{folder}\t{binary}\t{}\n", within.display()));
        }
    }
    fs::write(place().join("tests.tsv"), out).map_err(|e| format!("tests.tsv: {e}"))
}
