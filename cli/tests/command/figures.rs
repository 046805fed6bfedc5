//! `clebsch figures`: what is written, and how wrong requests are answered. Takes the shipped gallery,
//! and one without the models of the figures.

use super::common::{Folder, clebsch};
use clebsch_cli::gallery::Gallery;
use clebsch_cli::{Streams, execute};
use std::ffi::OsString;

fn shipped(arguments: &[&str]) -> (u8, String, String) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let mut streams = Streams {
        input: &mut std::io::empty(),
        out: &mut out,
        err: &mut err,
        progress: false,
        width: None,
    };
    let words = std::iter::once("clebsch").chain(arguments.iter().copied());
    let code = execute(words.map(OsString::from), &Gallery::shipped(), &mut streams);
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (code, text(out), text(err))
}

#[test]
fn every_figure_is_drawn_once() {
    let folder = Folder::new("figures");
    let out = folder.path("all");
    let (code, text, err) = shipped(&["figures", "--out", &out, "--json"]);
    assert_eq!((code, err.as_str()), (0, ""));
    let object: serde_json::Value = serde_json::from_str(&text).expect("one JSON object");
    let list = |key: &str| object[key].as_array().expect("a list").clone();
    assert_eq!(list("figures").len() + list("left_out").len(), 18);
    assert!(list("figures").len() >= 14);
    for figure in list("figures") {
        let file = figure["file"].as_str().expect("a name");
        let svg = std::fs::read_to_string(format!("{out}/{file}")).expect("written");
        assert!(
            svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"),
            "{file}"
        );
        // Curves, not only axes; and no number that is none.
        assert!(
            svg.len() > 5_000 && !svg.contains("NaN") && !svg.contains("inf"),
            "{file}"
        );
    }
    let (code, _, err) = shipped(&["figures", "--out", &out]);
    assert_eq!(code, 2);
    assert!(err.contains("give --force to replace it"), "{err}");
}

#[test]
fn figures_of_missing_models_are_left_out() {
    let folder = Folder::new("no_figures");
    let done = clebsch(&["figures", "--out", &folder.path("none")]);
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    let line = "2.5     left out: the gallery has no model `free-body`\n";
    assert!(done.out.contains(line), "{}", done.out);
}

#[test]
fn a_folder_must_be_named() {
    let (code, out, err) = shipped(&["figures"]);
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains("--out"), "{err}");
}
