//! What the gallery cites: every line of a model's table is printed, at equations that the model has, and nothing else is.
//! At which equation a line stands is shown by the snapshots and by `generated/`.

use clebsch_core::document::{Citations, printed_telling};
use clebsch_core::print::Format;
use clebsch_core::{Derivation, derive_source};
use std::collections::BTreeSet;

/// The derivation with its paragraphs in one line each.
fn text(d: &Derivation, citations: Citations) -> String {
    printed_telling(d, Format::Text, 1_000_000, citations, None)
}

/// What stands in brackets behind or below the equations of a text, as sources of equations do.
fn sources(text: &str) -> BTreeSet<String> {
    let behind = text
        .split("[thesis ")
        .skip(1)
        .filter_map(|rest| rest.split(']').next());
    behind.map(str::to_owned).collect()
}

#[test]
fn all_that_is_cited_of_a_model_is_printed() {
    let mut cited = Vec::new();
    for entry in clebsch_models::gallery() {
        let name = entry.card.kebab;
        let d = derive_source(entry.card.source).expect("derives");
        let printed = text(&d, entry.citations);
        let places = entry.citations.places.iter();
        let wanted: BTreeSet<String> = places.map(|(_, said)| said.replace('$', "")).collect();
        assert_eq!(sources(&printed), wanted, "{name}");
        for place in entry.citations.places {
            let only = Citations {
                places: std::slice::from_ref(place),
                ..entry.citations
            };
            assert_eq!(sources(&text(&d, only)).len(), 1, "{name}: {place:?}");
        }
        let statement = entry.citations.statement.replace('$', "");
        assert!(printed.contains(&statement), "{name}: {statement}");
        if entry.citations != Citations::NONE {
            cited.push(name);
        }
        let bare = text(&d, Citations::NONE);
        assert!(
            sources(&bare).is_empty() && !bare.contains("cited below"),
            "{name}"
        );
    }
    assert_eq!(cited.len(), 11, "{cited:?}");
}
