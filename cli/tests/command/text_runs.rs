//! Runs of models and cases that a test states as texts, and the numbers of the trajectory that they write.
#![allow(missing_docs)]

use crate::common::{Done, Folder, Samples};
use serde_json::Value;

/// Runs a model on a case, both given as texts, with additional arguments.
pub fn run(folder: &Folder, model: &str, case: &str, more: &str) -> Done {
    folder.write("model.clebsch", model);
    folder.write("case.toml", case);
    folder.clebsch(&format!("run @model.clebsch --case @case.toml {more}"))
}

/// The numbers of a run: the rows of `trajectory.csv`, and parameters.
#[derive(Debug)]
pub struct Ran {
    /// The standard output of the command.
    pub out: String,
    samples: Samples,
    parameters: Value,
}

impl Ran {
    /// Runs a model on a case, both given as texts, in a folder of this name.
    pub fn of(model: &str, case: &str, name: &str) -> Self {
        let folder = Folder::new(&format!("ran-{name}"));
        let done = run(&folder, model, case, "--out @out").succeeds();
        Self {
            out: done.out,
            samples: folder.samples("out/trajectory.csv"),
            parameters: folder.json("out/run.json")["parameters"].clone(),
        }
    }

    /// An observable at a node.
    #[track_caller]
    pub fn at(&self, name: &str, node: usize) -> f64 {
        self.samples.at(name, node)
    }

    /// A parameter.
    pub fn parameter(&self, name: &str) -> f64 {
        self.parameters[name].as_f64().expect("a number")
    }
}
