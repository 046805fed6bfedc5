//! `--resume` for a run that is already complete.

use crate::output::{self, run_json};
use crate::plan::Plan;
use crate::terminal::Streams;
use crate::terminal::failure::{BOUND_LEFT, DONE, Failure};
use crate::words::plain::shown;
use clebsch::card::Card;
use serde_json::json;
use std::path::Path;

/// Handles `--resume` for a run that is already complete.
pub(super) fn already(
    card: &Card,
    plan: &Plan,
    target: &Path,
    (as_json, vtk): (bool, bool),
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let wrong = |words: &str| Failure::Usage(format!("--resume: {}: {words}", shown(target)));
    let text = std::fs::read_to_string(target.join("run.json")).unwrap_or_default();
    let Ok(there) = text.parse::<serde_json::Value>() else {
        return Err(wrong("this is not the folder of a run"));
    };
    let own = run_json::plan_json(card, plan)
        .to_string()
        .parse::<serde_json::Value>();
    let own = own.unwrap_or_default();
    let mut different = Vec::new();
    for (key, value) in own.as_object().into_iter().flatten() {
        if there.get(key) != Some(value) {
            different.push(key.as_str());
        }
    }
    for key in ["order", "solver", "compensated", "halve"] {
        if there["arguments"][key] != plan.arguments[key] {
            different.push(key);
        }
    }
    match different.as_slice() {
        [] => {}
        keys if keys.contains(&"steps") && keys.iter().all(|k| ["steps", "every"].contains(k)) => {
            return Err(wrong(&format!(
                "this run is complete, with steps = {}; to continue it, start a new run with its final values in [initial], \
                 such as x = {{ npz = \"{}\", sample = -1 }}",
                there["steps"],
                shown(target.join("trajectory.npz").as_path())
            )));
        }
        [key, ..] => {
            return Err(wrong(&format!(
                "it contains another run, with another `{key}`; choose another folder with --out"
            )));
        }
    }
    let there_files = there["results"]["files"].as_array();
    let has_vtk = there_files.is_some_and(|all| {
        all.iter().any(|f| {
            f.as_str()
                .is_some_and(|f| f.starts_with(output::vtk::FOLDER))
        })
    });
    if vtk && !has_vtk {
        return Err(wrong(
            "the run there is complete and was written without --vtk; run it again with --force",
        ));
    }
    if there["results"]["complete"] != json!(true) {
        let why = there["results"]["stopped"]["why"].as_str().unwrap_or("?");
        return Err(wrong(&format!("the run there cannot be resumed: {why}")));
    }
    output::remove_what_resumes(target);
    match as_json {
        true => writeln!(streams.out, "{there}")?,
        false => writeln!(streams.out, "complete already: {}", shown(target))?,
    }
    // The failures of the completed run are reported again.
    let results = &there["results"];
    let refuted = results["action_as_stated"]["holds"] == json!(false);
    if results["kept"] == json!(false) {
        let _ = writeln!(
            streams.err,
            "clebsch: an invariant exceeded its bound, see run.json"
        );
    }
    if refuted {
        let _ = writeln!(
            streams.err,
            "clebsch: steps do not solve the equations of the stated action, see run.json"
        );
    }
    match refuted || results["kept"] == json!(false) {
        true => Ok(BOUND_LEFT),
        false => Ok(DONE),
    }
}
