//! Citations of the gallery: the derivation prints every entry of a model's citation table, at equations of the
//! model, and prints no other citations. Snapshots and `generated/` show at which equation an entry appears.

use clebsch_core::document::{Citations, printed_telling};
use clebsch_core::print::Format;
use clebsch_core::{Derivation, derive_source};
use std::collections::BTreeSet;

/// The derivation with each paragraph on one line.
fn text(d: &Derivation, citations: Citations) -> String {
    printed_telling(d, Format::Text, 1_000_000, citations, None)
}

/// The bracketed citations that follow or accompany equations in a text.
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
