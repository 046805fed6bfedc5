//! `clebsch figures`: its files, and its answers to wrong requests. Takes the shipped gallery, and one without the
//! models of the figures.

use crate::common::{Folder, clebsch, rotor};

/// Long, since all figures are computed.
#[test]
fn every_figure_is_drawn_once() {
    let folder = Folder::new("figures");
    let done = folder.runs("figures --out @all --json");
    let object = done.says_nothing().json();
    let list = |key: &str| object[key].as_array().expect("a list").clone();
    assert_eq!(list("figures").len() + list("left_out").len(), 18);
    assert!(list("figures").len() >= 14);
    for figure in list("figures") {
        let file = figure["file"].as_str().expect("a name");
        let svg = folder.read(&format!("all/{file}"));
        assert!(
            svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"),
            "{file}"
        );
        // The figures contain curves, not only axes, and no invalid numbers.
        assert!(
            svg.len() > 5_000 && !svg.contains("NaN") && !svg.contains("inf"),
            "{file}"
        );
    }
    folder
        .clebsch("figures --out @all")
        .refuses("this exists; replace it with --force");
}

#[test]
fn figures_of_missing_models_are_left_out() {
    let folder = Folder::new("no_figures");
    let done = rotor(&format!("figures --out {}", folder.path("none")));
    done.ended(0).says_nothing();
    let line = "2.5     omitted: the gallery has no model `free-body`\n";
    done.prints(line);
}

#[test]
fn a_folder_must_be_named() {
    clebsch("figures").prints_nothing().refuses("--out");
}
