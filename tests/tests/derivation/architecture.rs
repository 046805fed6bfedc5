//! Checks that every path in ARCHITECTURE.md, README.md and docs/errata.md exists. Also enforces a rule that no compiler checks:
//! code must not fold deviations with `f64::max`, which ignores NaN.

use std::fs;
use std::path::Path;

/// Words in backticks that look like paths of the repository.
fn paths(text: &str) -> Vec<&str> {
    let quoted = text.split('`').skip(1).step_by(2);
    quoted
        .filter(|w| w.contains('/') && !w.contains([' ', '<', '*', '$']))
        .collect()
}

/// Targets of links inside the repository.
fn links(text: &str) -> Vec<&str> {
    let targets = text.split("](").skip(1).filter_map(|t| t.split(')').next());
    targets.filter(|t| !t.contains("://")).collect()
}

#[test]
fn every_named_path_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut named = 0;
    for page in ["ARCHITECTURE.md", "README.md", "docs/errata.md"] {
        let text = fs::read_to_string(root.join(page)).unwrap();
        for path in paths(&text).into_iter().chain(links(&text)) {
            assert!(
                root.join(path).exists(),
                "{page} names {path}, which does not exist"
            );
            named += 1;
        }
    }
    assert!(named > 40, "the maps name {named} paths only");
}

/// Every Rust source below `folder`.
pub fn sources(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            sources(&path, found);
        } else if name.ends_with(".rs") {
            found.push(path);
        }
    }
}

#[test]
fn no_nan_is_passed_over_when_deviations_are_folded() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    sources(&root, &mut found);
    assert!(found.len() > 300, "{} sources only", found.len());
    // Assembled here, so that this file does not contain them.
    let folds = ["0.0", "0.0_f64", "0.0f64"].map(|from| format!("fold({from}, {})", "f64::max"));
    for path in found {
        let text = fs::read_to_string(&path).unwrap();
        let here = folds.iter().find(|fold| text.contains(fold.as_str()));
        assert!(
            here.is_none(),
            "{}: {}: with a NaN among the numbers this gives the largest of the others; take \
             clebsch::scalar::largest, or worse of the tests",
            path.display(),
            here.unwrap()
        );
    }
}

/// Names of planar rigid motions in the engine's sources: its record, its table entry, its runtime type.
const NAMES_OF_THE_PLANE: [&str; 5] = [
    "PlaneMotion",
    "PlaneImpulse",
    "plane_motion",
    "SE(2)",
    "SE<2>",
];

#[test]
fn the_engine_knows_the_motions_of_the_plane_by_their_record_alone() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../macros/core/src");
    let mut found = Vec::new();
    sources(&root, &mut found);
    assert!(found.len() > 150, "{} sources only", found.len());
    let mut knowing: Vec<String> = Vec::new();
    for path in found {
        let text = fs::read_to_string(&path).unwrap();
        let own = path.strip_prefix(&root).unwrap();
        let own = own.to_string_lossy().replace('\\', "/");
        let is_test = own.contains("tests");
        if !is_test && NAMES_OF_THE_PLANE.iter().any(|name| text.contains(name)) {
            knowing.push(own);
        }
    }
    knowing.sort();
    // The record, and the table with its entry.
    assert_eq!(
        knowing,
        ["groups/mod.rs", "groups/plane_motions.rs"],
        "what these ask of the group belongs into a method of `Record`"
    );
}
