//! Runs of models and cases that a test states as texts, and the numbers of the trajectory that they write.
#![allow(missing_docs)]

use crate::common::{Done, Folder, program};
use std::collections::BTreeMap;

/// Runs a model on a case, both given as texts.
pub fn run(folder: &Folder, model: &str, case: &str, more: &[&str]) -> Done {
    let model = folder.write("model.clebsch", model);
    let case = folder.write("case.toml", case);
    let mut all = vec!["run", &model[..], "--case", &case];
    all.extend(more);
    program(&all)
}

/// The numbers of a run: a column of `trajectory.csv` for each name, and parameters.
#[derive(Debug)]
pub struct Ran {
    /// What the command printed.
    pub out: String,
    columns: BTreeMap<String, Vec<f64>>,
    parameters: serde_json::Value,
}

impl Ran {
    /// Runs a model on a case, both given as texts, in a folder of this name.
    pub fn of(model: &str, case: &str, name: &str) -> Self {
        let folder = Folder::new(&format!("ran-{name}"));
        let out = folder.path("out");
        let done = run(&folder, model, case, &["--out", &out]);
        assert_eq!(done.code, 0, "{}{}", done.out, done.err);
        let csv = std::fs::read_to_string(format!("{out}/trajectory.csv")).expect("is written");
        let mut lines = csv.lines();
        let names = lines.next().expect("a head").split(',').map(str::to_owned);
        let mut columns: BTreeMap<String, Vec<f64>> = names.clone().map(|n| (n, vec![])).collect();
        let names: Vec<String> = names.collect();
        for line in lines {
            for (name, x) in names.iter().zip(line.split(',')) {
                let own = columns.get_mut(name).expect("a column");
                own.push(x.parse().expect("a number"));
            }
        }
        let json = std::fs::read_to_string(format!("{out}/run.json")).expect("is written");
        let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        let parameters = json["parameters"].clone();
        Self {
            out: done.out,
            columns,
            parameters,
        }
    }

    /// An observable at a node.
    pub fn at(&self, name: &str, node: usize) -> f64 {
        self.columns
            .get(name)
            .unwrap_or_else(|| panic!("no {name}"))[node]
    }

    /// A parameter.
    pub fn parameter(&self, name: &str) -> f64 {
        self.parameters[name].as_f64().expect("a number")
    }
}
