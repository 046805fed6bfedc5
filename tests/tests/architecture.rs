//! The maps are true: every path that ARCHITECTURE.md, README.md and docs/errata.md name exists.

use std::fs;
use std::path::Path;

/// Words in backticks that look like paths of the project.
fn paths(text: &str) -> Vec<&str> {
    let quoted = text.split('`').skip(1).step_by(2);
    quoted
        .filter(|w| w.contains('/') && !w.contains([' ', '<', '*', '$']))
        .collect()
}

/// Targets of links that stay inside the project.
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
