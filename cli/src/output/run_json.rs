//! run.json: everything needed to repeat a run, and its results.
//! Takes a finished run; gives a JSON object with sorted keys. The object does not depend on the time or the
//! machine.

use super::Finished;
use crate::plan::Plan;
use crate::trajectory::verdict::{Outcome, Verdict};
use clebsch::card::{Card, Field, Kind};
use serde_json::{Map, Value, json};

/// The object written as run.json and printed by `--json`; `files` are the names of the files next to it.
#[must_use]
pub fn run_json(run: &Finished<'_>, files: &[String]) -> Value {
    let Finished {
        card,
        plan,
        outcomes,
        samples,
        halvings,
        stated,
        stopped,
    } = run;
    let mut object = plan_json(card, plan);
    let mut results = json!({
        "samples": samples,
        "complete": stopped.is_none(),
        "invariants": outcomes.iter().map(Outcome::json).collect::<Vec<_>>(),
        "kept": outcomes.iter().all(|outcome| outcome.verdict != Verdict::Left),
        "files": files,
        "stopped": stopped.as_ref().map(|s| json!({"node": s.node, "time": s.time, "why": s.why})),
    });
    if let (Some(h), Some(results)) = (halvings, results.as_object_mut()) {
        let made = json!({"steps": h.steps, "most": h.parts, "symplectic": h.steps == 0});
        results.insert("made_by_parts".to_owned(), made);
    }
    if let (Some(verdict), Some(results)) = (stated, results.as_object_mut()) {
        let verdict = crate::trajectory::stated::verdict_json(verdict);
        results.insert("action_as_stated".to_owned(), verdict);
    }
    if let Some(object) = object.as_object_mut() {
        object.insert("results".to_owned(), results);
        object.insert("arguments".to_owned(), plan.arguments.clone());
    }
    object
}

/// The request and the model: the part that is known before the run.
pub(crate) fn plan_json(card: &Card, plan: &Plan) -> Value {
    let case = &plan.case;
    let bounds = case.bounds.iter();
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "model": card.kebab,
        "fingerprint": format!("{:016x}", card.fingerprint),
        "case": case.name,
        "doc": case.doc,
        "parameters": values(card.parameters, &case.parameters),
        "initial": values(card.initial, &case.initial),
        "bounds": bounds.map(|(name, bound)| (name.clone(), json!(bound))).collect::<Map<_, _>>(),
        "h": case.h,
        "steps": case.steps,
        "every": plan.every,
        "derived": {
            "summary": card.summary,
            "solver": card.solver,
            "order": card.order,
            "reversible": card.reversible,
        },
    })
}

/// Values by ASCII name: numbers, arrays, arrays of rows.
fn values(fields: &[Field], values: &[Vec<f64>]) -> Value {
    let pairs = fields.iter().zip(values);
    let value = |field: &Field, numbers: &[f64]| match field.kind {
        Kind::Scalar => json!(numbers.first()),
        _ if field.cols == 1 => json!(numbers),
        _ => json!(numbers.chunks(field.cols.max(1)).collect::<Vec<_>>()),
    };
    pairs
        .map(|(field, numbers)| (field.ascii.to_owned(), value(field, numbers)))
        .collect::<Map<_, _>>()
        .into()
}
