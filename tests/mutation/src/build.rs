//! Builds the copy with cargo, finds mutants that do not compile, and locates the test binaries.

use crate::place;
use crate::plant::Planted;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// A set of tests that runs against mutants.
pub struct Judge {
    /// Its name in the verdicts.
    pub name: &'static str,
    /// The folders whose mutants it tests.
    pub folders: &'static [&'static str],
    /// Only tests whose names start with this prefix.
    pub filter: &'static str,
    /// The cargo arguments that build it.
    pub arguments: &'static [&'static str],
}

const ENGINE: &str = "macros/core/src";
const RUNTIME: &str = "runtime/src";

/// The judges in the order of their runs: those close to the code first, then fast ones that detect much.
pub const JUDGES: [Judge; 7] = [
    Judge {
        name: "unit tests",
        folders: &[ENGINE],
        filter: "",
        arguments: &["-p", "clebsch-core", "--lib", "--all-features"],
    },
    Judge {
        name: "unit tests",
        folders: &[RUNTIME],
        filter: "",
        arguments: &[
            "-p",
            "clebsch",
            "--lib",
            "--tests",
            "--all-features",
            "--config",
            QUICKLY,
        ],
    },
    Judge {
        name: "generated files",
        folders: &[ENGINE],
        filter: "generated_fresh::",
        arguments: &["-p", "clebsch-tests", "--test", "derivation"],
    },
    Judge {
        name: "motion",
        folders: &[RUNTIME],
        filter: "",
        arguments: &[
            "-p",
            "clebsch-motion",
            "--test",
            "motion",
            "--test",
            "lines",
        ],
    },
    Judge {
        name: "interpreted gallery",
        folders: &[ENGINE, RUNTIME],
        filter: "gallery::",
        arguments: &["-p", "clebsch-interpret", "--test", "interpret"],
    },
    Judge {
        name: "interpreted",
        folders: &[ENGINE, RUNTIME],
        filter: "",
        arguments: &["-p", "clebsch-interpret", "--tests"],
    },
    Judge {
        name: "derivation",
        folders: &[ENGINE, RUNTIME],
        filter: "",
        arguments: &[
            "-p",
            "clebsch-tests",
            "--test",
            "derivation",
            "--test",
            "many_models",
        ],
    },
];

/// With a mutant in every other line, full optimisation takes long.
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

/// The mutants whose expressions contain a compile error.
pub fn refused(copy: &Path, planted: &Planted) -> Result<BTreeSet<usize>, String> {
    let mut refused = BTreeSet::new();
    for package in ["clebsch-core", "clebsch"] {
        let told = cargo(
            copy,
            &[
                "check",
                "--profile",
                "quick",
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

/// Builds the tests and writes `tests.tsv`: judge number, binary, working directory.
pub fn tests(copy: &Path) -> Result<(), String> {
    let (mut out, mut known) = (String::new(), BTreeSet::new());
    for (number, judge) in JUDGES.iter().enumerate() {
        let all = [&["test", "--profile", "quick", "--no-run"], judge.arguments].concat();
        for message in cargo(copy, &all)? {
            let (Some(binary), true) = (
                message["executable"].as_str(),
                message["profile"]["test"] == true,
            ) else {
                continue;
            };
            let manifest = message["manifest_path"].as_str().unwrap_or_default();
            let within = Path::new(manifest).parent().unwrap_or(copy);
            // Skips a binary that an earlier judge runs completely.
            if known.insert((binary.to_owned(), judge.filter)) {
                out.push_str(&format!("{number}\t{binary}\t{}\n", within.display()));
            }
        }
    }
    fs::write(place().join("tests.tsv"), out).map_err(|e| format!("tests.tsv: {e}"))
}
