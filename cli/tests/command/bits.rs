//! The bits of every shipped model and case at nodes 1, 10 and a last one, against a list. A step that is built
//! differently gives bitwise identical numbers. If a change must alter bits, it alters the list in a commit of its
//! own.
//!
//! `CLEBSCH_WRITE_BITS=1 cargo test --profile quick -p clebsch-cli --test command -- bits` writes the list. Chains
//! end at node 100, since 100 steps also show a changed step. Fluids end at node 10, and other cases at node 1000.
//! The C library computes the sine and other functions, so the list belongs to one platform.
#![cfg(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu"))]

use super::common::{clebsch, runs};
use super::folder::Folder;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;

const LIST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/command/bits");

/// Models for which a step fails before node 1000, or which are not resolved there: two stretches become equal, where
/// the chart is singular.
const SHORT: [&str; 3] = [
    "pseudo-rigid-anisotropic",
    "pseudo-rigid-bipolar",
    "pseudo-rigid-positive",
];

/// The last node of a case whose bits are listed.
fn last(family: &str, name: &str) -> usize {
    match family {
        "fluid" => 10,
        "chain" => 100,
        _ if SHORT.contains(&name) => 10,
        _ => 1000,
    }
}

/// Fowler, Noll and Vo's hash of a row, whose numbers are written with all their digits.
fn hash(row: &str) -> u64 {
    row.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// The rows of the models of a family: model and case, node, hash.
fn rows(family: &str) -> String {
    let folder = Folder::new(&format!("bits-{family}"));
    let mut out = String::new();
    let list: serde_json::Value = serde_json::from_str(&runs("list --json").out).expect("a list");
    for model in list["models"].as_array().expect("models") {
        if model["family"] != family {
            continue;
        }
        let name = model["model"].as_str().expect("a name");
        for case in model["cases"].as_array().expect("cases") {
            let case = format!("{name}:{}", case["name"].as_str().expect("a name"));
            let steps = last(family, name);
            let path = folder.path(&case.replace(':', "-"));
            let watch = "--every 1 --csv --quiet --check none --stability-limit 0";
            // A run whose step fails keeps the results so far.
            clebsch(&format!(
                "run {case} --steps {steps} {watch} --force --out {path}"
            ));
            let table = fs::read_to_string(format!("{path}/trajectory.csv")).expect("a table");
            let all: Vec<&str> = table.lines().skip(1).collect();
            for node in BTreeSet::from([1, 10, steps]) {
                if let Some(row) = all.get(node) {
                    writeln!(out, "{case} {node} {:016x}", hash(row)).expect("into a text");
                }
            }
        }
    }
    out
}

fn agree(family: &str) {
    let (path, found) = (format!("{LIST}/{family}.txt"), rows(family));
    if std::env::var_os("CLEBSCH_WRITE_BITS").is_some() {
        fs::create_dir_all(LIST).expect("a folder");
        fs::write(&path, &found).expect("written");
    }
    let listed = fs::read_to_string(&path).expect("a list");
    let mut pairs = listed.lines().zip(found.lines());
    let differs = pairs.find(|(listed, found)| listed != found);
    assert_eq!(differs, None, "bits have changed: listed and found");
    assert_eq!(listed.lines().count(), found.lines().count());
}

#[test]
fn bits_of_rigid_bodies() {
    agree("rigid");
}

#[test]
fn bits_of_particles() {
    agree("particle");
}

#[test]
fn bits_of_elastic_bodies() {
    agree("elastic");
}

/// Long: 100 steps of each chain.
#[test]
fn bits_of_chains() {
    agree("chain");
}

/// Long: ten steps of several thousand particles, each with its grid or its mesh.
#[test]
fn bits_of_fluids() {
    agree("fluid");
}
