//! `derive --format program`: each heading counts the operations below it, and each operation uses names that are defined
//! above it.

use crate::common::{Folder, clebsch, runs};
use std::collections::BTreeSet;

fn program(model: &str) -> String {
    let run = runs(&["derive", model, "--format", "program"]);
    run.out
}

/// Whether a word is a number, or a name that is defined.
fn is_known(word: &str, names: &BTreeSet<String>) -> bool {
    names.contains(word) || word.parse::<f64>().is_ok()
}

/// Checks one section and returns its title.
fn checked(section: &str) -> &str {
    let (heading, body) = section.split_once('\n').unwrap_or((section, ""));
    let (title, counts) = heading.split_once(" (").expect("a heading");
    let (mut names, mut operations) = (BTreeSet::new(), 0);
    for line in body.lines().map(str::trim) {
        if let Some(given) = line.strip_prefix("given ") {
            names.extend(given.split(", ").map(str::to_owned));
        } else if let Some((results, value)) = line
            .split_once(" = ")
            .filter(|(r, _)| !r.contains("only if"))
        {
            let words = value
                .split([' ', '(', ')', ','])
                .map(|w| w.trim_start_matches('-'));
            let mut used = words.filter(|w| {
                !w.is_empty() && !["+", "*", "/", ">", "if", "otherwise", "call", "of"].contains(w)
            });
            let functions = [
                "sqrt", "exp", "log", "sin", "cos", "sinh", "cosh", "tanh", "balance",
            ];
            let unknown = used.find(|w| !is_known(w, &names) && !functions.contains(w));
            assert_eq!(unknown, None, "{line}");
            names.extend(results.split(", ").map(str::to_owned));
            operations += 1;
        }
    }
    let counted = counts.split([' ', ')']).next().and_then(|n| n.parse().ok());
    assert_eq!(counted, Some(operations), "{heading}");
    title
}

#[test]
fn a_program_counts_and_lists_the_operations_of_a_step() {
    let titles = |model: &str| -> Vec<String> {
        let text = program(model);
        let sections = text.split("\n\n").skip(1);
        sections
            .map(|section| checked(section).to_owned())
            .collect()
    };
    for model in ["heavy-top", "kepler:eccentric"] {
        let found = titles(model);
        for title in ["step", "observables", "invariants", "scales"] {
            assert!(found.iter().any(|x| x == title), "{model}: {found:?}");
        }
    }
    // The solver of a free body is a function of the runtime.
    let free = program("free-body");
    assert!(free.contains("which is not recorded"), "{free}");
    // Newton's method evaluates these functions between two parts of a step.
    let newton = titles("coupled-bodies");
    let own = [
        "residual of the equations at a trial",
        "tangent of the equations at a trial",
    ];
    assert!(
        own.iter().all(|title| newton.iter().any(|x| x == title)),
        "{newton:?}"
    );
    // A fluid runs loops over its particles.
    let loops = titles("particle-mesh-1d");
    assert!(
        loops
            .iter()
            .any(|title| title.starts_with("loop over sites k")),
        "{loops:?}"
    );
}

#[test]
fn names_are_those_of_the_numbers() {
    // Four numbers of the attitude and three of the momentum; the last number of the workspace is another attitude.
    let text = program("heavy-top");
    let step = text
        .split("\n\n")
        .find(|section| section.starts_with("step ("));
    let given = step
        .and_then(|section| section.lines().nth(1))
        .unwrap_or("");
    for name in ["Λ.1", "Λ.4", "momentum.3", "workspace.h"] {
        assert!(
            given
                .split(", ")
                .any(|x| x.trim_start_matches("    given ") == name),
            "{name}: {given}"
        );
    }
    assert!(!given.contains("Λ.5"), "{given}");
    // Standard input gives a model without a case.
    let run = clebsch(&["derive", "-", "--format", "program"]);
    assert_eq!(run.code, 2, "{}", run.err);
    assert!(run.err.contains("no case"), "{}", run.err);
}

#[test]
fn the_program_of_a_file_needs_a_case() {
    let folder = Folder::new("programs");
    let file = folder.write("spring.clebsch", "model Spring { param k: Real; field q: Real; lagrangian = (next(q) - q)^2/(2*h) - h*k*q^2/2; }");
    let run = clebsch(&["derive", &file, "--format", "program"]);
    assert_eq!(run.code, 2, "{}", run.err);
    assert!(run.err.contains("spring.toml"), "{}", run.err);
}
