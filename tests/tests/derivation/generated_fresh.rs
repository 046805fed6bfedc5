//! Checks that `generated/` equals the engine's current output for the gallery, byte for byte and without extra files, and that the
//! source text that a macro stores derives the same model.

use clebsch_cli::generated;
use clebsch_core::{derive_source, document};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../generated")
}

fn names(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).unwrap();
    entries
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect()
}

#[test]
fn committed_files_are_fresh() {
    let mut models = BTreeSet::new();
    for entry in clebsch_models::gallery() {
        let derivation = derive_source(entry.card.source).unwrap();
        let files = generated::files(&derivation, entry.citations).unwrap();
        let again = derive_source(entry.card.source).unwrap();
        let again = generated::files(&again, entry.citations).unwrap();
        assert_eq!(
            files, again,
            "two derivations of {} differ",
            entry.card.name
        );
        let folder = folder().join(entry.card.kebab);
        for (name, contents) in &files {
            let committed = fs::read_to_string(folder.join(name)).unwrap_or_default();
            assert!(
                committed == *contents,
                "generated/{}/{name} is stale: run `cargo clebsch derive --write`",
                entry.card.kebab
            );
        }
        let wanted = files.into_iter().map(|(name, _)| name).collect();
        assert_eq!(names(&folder), wanted);
        models.insert(entry.card.kebab.to_owned());
    }
    assert_eq!(names(&folder()), models);
}

#[test]
fn the_text_kept_by_the_macro_is_the_model() {
    for entry in clebsch_models::gallery() {
        let derivation = derive_source(entry.card.source).unwrap();
        assert_eq!(document::fingerprint(&derivation), entry.card.fingerprint);
        assert_eq!(document::source(&derivation), entry.card.source);
    }
}
