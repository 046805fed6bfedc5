//! Incomplete runs: if the first step fails, nothing is written. If a later step fails, the results so far are
//! written and marked as incomplete.

use crate::common::{Done, Folder, on, rotor};
use clebsch_cli::gallery::Gallery;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A torque so stiff that the step fails after some steps.
fn failing(folder: &Folder) -> String {
    let text = rotor("case harmonic-rotor").out;
    folder.write(
        "failing.toml",
        text.replace("kappa = 1.0", "kappa = -400.0"),
    )
}

fn run(file: &str, more: &[&str]) -> Done {
    rotor(&[&["run", "harmonic-rotor", "--case", file][..], more].concat())
}

fn read(folder: &str, name: &str) -> String {
    fs::read_to_string(format!("{folder}/{name}")).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

/// The node at which the run stopped, according to the message.
fn node_of(message: &str) -> u64 {
    let from = message.split("step from node ").nth(1);
    let digits = from.and_then(|rest| rest.split(' ').next());
    digits
        .and_then(|n| n.parse().ok())
        .unwrap_or_else(|| panic!("{message}"))
}

#[test]
fn a_run_that_stops_leaves_what_it_computed_marked_as_stopped() {
    let folder = Folder::new("stopped");
    let file = failing(&folder);
    for every in ["1", "4"] {
        let out = folder.path(&format!("new/out-{every}"));
        let done = run(&file, &["--every", every, "--out", &out]).exits(1);
        let node = node_of(&done.err);
        assert!(node > 4, "{}", done.err);
        // On the terminal.
        let said = format!("stopped at node {node} (time ");
        done.prints(&said);
        done.prints("\nenergy ");
        done.prints("written to ");
        // In the manifest.
        let manifest = json(&read(&out, "run.json"));
        let stopped = &manifest["results"]["stopped"];
        assert_eq!(stopped["node"], node);
        assert_eq!(stopped["time"], 0.05 * node as f64);
        let why = stopped["why"].as_str().expect("a sentence");
        let ending = format!("clebsch: {why}\n");
        assert!(done.err.ends_with(&ending), "{}", done.err);
        assert_eq!(manifest["steps"], 2000);
        // The samples extend to the last node reached, even if it was not to be sampled.
        let text = read(&out, "trajectory.csv");
        let nodes: Vec<u64> = text
            .lines()
            .skip(1)
            .filter_map(|line| line.split(',').next()?.parse().ok())
            .collect();
        assert_eq!(nodes.last(), Some(&node));
        assert_eq!(manifest["results"]["samples"], nodes.len());
        // In the plots.
        for file in manifest["results"]["files"].as_array().expect("files") {
            let name = file.as_str().expect("a name");
            if name.ends_with(".svg") {
                let svg = read(&out, name);
                assert!(
                    svg.contains(&format!("; stopped at node {node} (")),
                    "{svg}"
                );
            }
        }
    }
    assert_eq!(folder.names(), ["failing.toml", "new"]);
}

#[test]
fn it_says_so_without_files_and_as_json() {
    let folder = Folder::new("stopped_json");
    let file = failing(&folder);
    let done = run(&file, &["--json"]).exits(1);
    assert_eq!(done.out.lines().count(), 1, "{}", done.out);
    let object = json(&done.out);
    assert_eq!(object["exit_code"], 1);
    assert_eq!(object["out"], Value::Null);
    assert_eq!(object["error"], object["results"]["stopped"]["why"]);
    assert_eq!(object["results"]["stopped"]["node"], node_of(&done.err));
    // A complete run does not report a stop.
    let done = rotor("run harmonic-rotor --json");
    assert_eq!(json(&done.out)["results"]["stopped"], Value::Null);
}

#[test]
fn a_run_that_stops_replaces_the_earlier_results() {
    let folder = Folder::new("stopped_force");
    let file = failing(&folder);
    let out = folder.path("out");
    folder.rotor("run harmonic-rotor --out @out").ended(0);
    let done = run(&file, &["--out", &out, "--force"]).exits(1);
    // Its results have the name that the user gave.
    assert_eq!(folder.names(), ["failing.toml", "out"]);
    done.prints(format!("written to {out}: "));
    let manifest = json(&read(&out, "run.json"));
    assert_eq!(manifest["results"]["stopped"]["node"], node_of(&done.err));
}

#[test]
fn a_run_refused_before_its_first_step_leaves_nothing() {
    let folder = Folder::new("refused_start");
    let out = folder.path("new/out");
    folder
        .rotor("run harmonic-rotor --h 10 --out @new/out")
        .fails("cannot take the first step");
    assert!(folder.names().is_empty());
    // Existing results stay.
    folder.rotor("run harmonic-rotor --out @new/out").ended(0);
    let before = read(&out, "run.json");
    let run = [
        "run",
        "harmonic-rotor",
        "--h",
        "10",
        "--out",
        &out,
        "--force",
    ];
    rotor(&run).ended(1);
    assert_eq!(read(&out, "run.json"), before);
    assert_eq!(folder.names(), ["new"]);
}

/// A kinetic energy that is not positive is the commonest reason for a first step without solution.
#[test]
fn a_refused_first_step_says_what_is_wrong_with_the_kinetic_energy() {
    type Change = fn(&str, &mut Vec<f64>);
    let changes: [(&str, &str, Change); 4] = [
        ("coupled-bodies", "indefinite", |name, values| {
            if name == "eps" {
                values[0] = 1e6;
            }
        }),
        // Neither an added mass nor a mass of its own.
        ("kirchhoff-body", "degenerate", |name, values| {
            if name == "M" || name == "D" {
                values.fill(0.0);
            }
        }),
        ("kirchhoff-body", "indefinite", |name, values| {
            if name == "M" {
                values.iter_mut().for_each(|m| *m = -*m);
            }
        }),
        ("kirchhoff-body", "indefinite", |name, values| {
            if name == "D" {
                for i in [0, 4, 8] {
                    values[i] = 1e4;
                }
            }
        }),
    ];
    let mut refused = 0;
    for (model, sort, change) in changes {
        let mut gallery = Gallery::shipped();
        gallery.entries.retain(|e| e.card.kebab == model);
        let entry = &mut gallery.entries[0];
        let values = entry.cases[0].parameters.iter_mut();
        for (field, values) in entry.card.parameters.iter().zip(values) {
            change(field.ascii, values);
        }
        let run = ["run", model, "--steps", "5"];
        let done = on(&gallery, &run);
        let words = format!("the kinetic energy at the start is {sort}: ");
        done.says(&words);
        if done.err.contains("cannot take the first step: ") {
            done.ended(1);
            refused += 1;
            let done = on(&gallery, &[&run[..], &["--json"]].concat());
            let object = json(&done.out);
            let said = object["error"].as_str().expect("a message");
            assert!(said.contains(&words), "{model}: {said}");
            // Other commands that start with a step.
            on(&gallery, &["compare", model, "--steps", "5"]).says(&words);
        }
    }
    assert!(refused >= 2, "{refused} first steps were refused");
}

#[test]
fn a_comparison_that_stops_leaves_what_it_computed() {
    let folder = Folder::new("compared");
    let file = failing(&folder);
    for every in ["1", "4"] {
        let out = folder.path(&format!("out-{every}"));
        let arguments = [
            "compare",
            "harmonic-rotor",
            "--case",
            &file,
            "--every",
            every,
        ];
        let done = rotor(&[&arguments[..], &["--out", &out]].concat()).exits(1);
        let node = node_of(&done.err);
        let said = format!("failed at node {}: step from node {node} ", node + 1);
        let words = done.out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(&said), "{}", done.out);
        assert!(words.contains("written to "), "{}", done.out);
        let object = json(&read(&out, "comparison.json"));
        let own = &object["methods"][0];
        assert_eq!(own["name"], "generated");
        assert_eq!(own["stopped"]["node"], node + 1);
        // The samples up to the stop, at the same nodes as in the other runs.
        let text = read(&out, "comparison.csv");
        let times: Vec<f64> = text
            .lines()
            .filter(|line| line.starts_with("generated,"))
            .filter_map(|line| line.split(',').nth(1)?.parse().ok())
            .collect();
        let step: u64 = every.parse().expect("a number");
        assert_eq!(times.len() as u64, node / step, "{text}");
        assert!(Path::new(&format!("{out}/comparison.svg")).exists());
        // The same values in the JSON object.
        let done = rotor(&[&arguments[..], &["--json"]].concat()).exits(1);
        let object = json(&done.out);
        assert_eq!(object["exit_code"], 1);
        assert!(
            object["error"]
                .as_str()
                .is_some_and(|why| done.err.contains(why))
        );
    }
}
