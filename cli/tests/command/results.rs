//! The results of a run: complete, repeatable, readable files, or none.

use crate::common::{Folder, has, on, rotor};
use clebsch_cli::gallery::Gallery;
use std::fs;

const FILES: [&str; 9] = [
    "advected.svg",
    "angles.svg",
    "attitude.svg",
    "invariants.svg",
    "momentum.svg",
    "run.html",
    "run.json",
    "trajectory.csv",
    "trajectory.npz",
];

fn names(path: &str) -> Vec<String> {
    let entries = fs::read_dir(path).expect("the folder is there");
    let mut names: Vec<String> = entries
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .into_string()
                .expect("UTF-8")
        })
        .collect();
    names.sort();
    names
}

#[test]
fn the_same_run_writes_the_same_bytes() {
    let folder = Folder::new("same_bytes");
    let first = folder.path("first");
    let second = folder.path("deep/er/second");
    for out in [&first, &second] {
        rotor(&format!("run harmonic-rotor --every 7 --out {out}"))
            .succeeds()
            .prints("\nwritten to ");
    }
    assert_eq!(names(&first), FILES);
    for file in FILES {
        let read = |out: &str| fs::read(format!("{out}/{file}")).expect("the file is there");
        assert!(read(&first) == read(&second), "{file} differs");
    }
    assert_eq!(folder.names(), ["deep", "first"]);
    assert_eq!(names(&folder.path("deep/er")), ["second"]);
}

#[test]
fn run_json_says_what_ran_and_what_came_out() {
    let folder = Folder::new("run_json");
    let out = folder.path("out");
    folder.rotor("run harmonic-rotor --steps 50 --out @out");
    let text = folder.read("out/run.json");
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(json["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(json["model"], "harmonic-rotor");
    assert_eq!(json["fingerprint"], "0123456789abcdef");
    assert_eq!(json["steps"], 50);
    assert_eq!(json["h"], 0.05);
    assert_eq!(json["arguments"]["steps"], 50);
    assert_eq!(json["initial"]["Lambda"][2][1], 0.8);
    assert_eq!(json["results"]["samples"], 51);
    assert_eq!(json["results"]["kept"], true);
    assert_eq!(json["results"]["invariants"][0]["verdict"], "kept");
    assert!(
        !text.contains(&out),
        "the name of the folder is not part of the results"
    );
}

#[test]
fn a_left_bound_is_code_three_and_the_results_are_written() {
    let folder = Folder::new("left_bound");
    let text = rotor("case harmonic-rotor").out;
    let file = folder.write(
        "tight.toml",
        text.replace("energy = 0.001", "energy = 1e-5"),
    );
    let out = folder.path("out");
    let done = folder
        .rotor("run harmonic-rotor --case @tight.toml --out @out")
        .exits(3);
    done.prints("1e-5  EXCEEDED  ");
    assert_eq!(done.err, "clebsch: bound exceeded: energy\n");
    assert_eq!(names(&out), FILES);
    let json = folder.read("out/run.json");
    assert!(json.contains("\"kept\": false"));
    // Checks a run that is already complete.
    let arguments = ["run", "harmonic-rotor", "--case", &file, "--out", &out];
    let again = rotor(&[&arguments[..], &["--resume"]].concat()).exits(3);
    assert!(again.out.starts_with("complete already: "), "{}", again.out);
    assert_eq!(
        again.err,
        "clebsch: an invariant exceeded its bound, see run.json\n"
    );
}

#[test]
fn an_existing_folder_is_kept_unless_forced() {
    let folder = Folder::new("existing");
    let out = folder.path("out");
    folder.rotor("run harmonic-rotor --out @out").ended(0);
    let before = folder.bytes("out/trajectory.csv");
    let again = ["run", "harmonic-rotor", "--steps", "9", "--out", &out];
    let done = rotor(&again).exits(2);
    done.says("this exists; replace it with --force");
    assert_eq!(folder.bytes("out/trajectory.csv"), before);
    rotor(&[&again[..], &["--force"]].concat()).succeeds();
    let after = folder.read("out/trajectory.csv");
    assert_eq!(after.lines().count(), 11);
    assert_eq!(names(&out), FILES);
    assert_eq!(folder.names(), ["out"]);
}

#[test]
fn force_never_removes_what_no_run_wrote() {
    let folder = Folder::new("foreign");
    let out = folder.path("out");
    fs::create_dir(&out).expect("a folder");
    fs::write(format!("{out}/thesis.tex"), "years of work").expect("a file");
    let done = folder
        .rotor("run harmonic-rotor --out @out --force")
        .exits(2);
    done.says("it contains `thesis.tex`");
    assert_eq!(names(&out), ["thesis.tex"]);
    folder.write("file", "a file");
    folder
        .rotor("run harmonic-rotor --out @file --force")
        .refuses("this exists and is not a folder");
}

#[test]
fn a_refused_file_system_is_code_one() {
    let folder = Folder::new("refused");
    let file = folder.write("file", "not a folder");
    rotor(&["run", "harmonic-rotor", "--out", &format!("{file}/out")]).fails("file/out");
    assert_eq!(folder.names(), ["file"]);
}

#[test]
fn plots_are_plain_svg() {
    let folder = Folder::new("plots");
    let out = folder.path("out");
    // A million oscillations: the plots show the first ones and say so.
    folder.rotor("run harmonic-rotor --steps 100000 --out @out");
    for (file, words) in [
        (
            "momentum.svg",
            &["μ₃", "body momentum μ", "time t", "shown: time 0 to "][..],
        ),
        (
            "invariants.svg",
            &[
                "energy",
                "bound 1e-3",
                "10⁻³",
                "I(t) − I(0)",
                "maxima over bins of about 67 samples",
            ],
        ),
        ("advected.svg", &["Γ₁", "vertical seen from the body"]),
    ] {
        let svg = fs::read_to_string(format!("{out}/{file}")).expect("the plot");
        assert!(svg.starts_with("<svg width=\"860\" "), "{file}");
        assert!(svg.trim_end().ends_with("</svg>"), "{file}");
        assert!(svg.len() < 500_000, "{file} has {} bytes", svg.len());
        assert!(!svg.contains("NaN"), "{file}");
        // Axes are labelled by quantities, as a paper prints them.
        assert!(!svg.contains("unit"), "{file}");
        for word in words {
            assert!(svg.contains(word), "{file}: {word:?} is missing");
        }
    }
}

/// A field is not an advected vector, and has its own plot.
#[test]
fn fields_are_plotted_as_fields() {
    let folder = Folder::new("fields");
    let out = folder.path("out");
    let run = ["run", "kepler", "--steps", "300", "--out", &out];
    on(&Gallery::shipped(), &run).succeeds().says_nothing();
    let files = names(&out);
    assert!(files.contains(&"fields.svg".to_owned()), "{files:?}");
    assert!(!files.contains(&"advected.svg".to_owned()), "{files:?}");
    let svg = folder.read("out/fields.svg");
    has(
        &svg,
        [
            "kepler, case circular: fields",
            "X₁",
            "X₃",
            "position of the planet",
        ],
    );
}
