//! A command line of your own: the example in the book is compiled and run.

// Users need not document the code in their own crate.
#![allow(missing_docs)]

#[allow(dead_code)]
#[path = "../../examples/own_models.rs"]
mod example;

use self::example::gallery;
use crate::common::{Folder, clebsch, on, runs};
use std::fs;

#[test]
fn it_lists_runs_and_derives_its_models() {
    let done = on(&gallery(), &["list"]).succeeds();
    done.prints("\ncompass  rigid   swinging  ");

    let folder = Folder::new("own_models");
    let case = folder.write("my.toml", &on(&gallery(), &["case", "compass"]).out);
    let out = folder.path("out");
    let run = ["run", "compass", "--case", &case, "--out", &out];
    let done = on(&gallery(), &run);
    done.ended(0).says_nothing();
    // The energy oscillates in its bound, and is not constant: the body does swing.
    let json = folder.json("out/run.json");
    let invariants = json["results"]["invariants"]
        .as_array()
        .expect("invariants");
    let energy = invariants.iter().find(|one| one["name"] == "energy");
    let drift = energy.expect("energy")["worst_drift"]
        .as_f64()
        .expect("a number");
    assert!(drift > 1e-6 && drift < 1e-2, "{drift:e}");

    let done = on(&gallery(), &["derive", "compass"]).succeeds();
    assert!(done.out.starts_with("Compass: "), "{}", done.out);
    // The shipped models are not among them.
    on(&gallery(), &["run", "heavy-top"]).ended(2);
}

#[test]
fn the_book_shows_it_whole() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
    let page = format!("{root}/docs/book/src/programs.md");
    let page = fs::read_to_string(page).expect("the page");
    let section = page.split("A command line of your own\n").nth(1);
    let block = section.and_then(|section| section.split("```rust\n").nth(1));
    let block = block.and_then(|block| block.split("```").next());
    assert_eq!(
        block,
        Some("{{#include ../../../cli/examples/own_models.rs}}\n")
    );
}

/// An invalid model name is rejected before anything is written; valid names run.
#[test]
fn a_new_model_has_a_name_that_models_can_have() {
    let folder = Folder::new("own-models-names");
    for name in ["Some", "Vec", "Self", "none", "result", "T"] {
        let path = folder.path(name);
        clebsch(&format!("new {path}")).refuses("choose another name for the model, such as my-");
    }
    assert!(folder.names().is_empty(), "{:?}", folder.names());
    for name in ["String", "my-some", "h", "f64", "model", "super"] {
        let path = folder.path(name);
        runs(&format!("new {path}"));
        runs(&["run", &format!("{path}.clebsch"), "--steps", "2"]);
    }
}
