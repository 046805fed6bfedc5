//! The words of the card of a chain as data.

use super::json;
use clebsch_core::document::{CardWords as Words, InvariantWords};
use serde_json::{Value, json};

pub(super) fn of_words(words: &Words) -> Value {
    let each = words.invariants.iter();
    let invariants: Vec<Value> = each
        .map(|i| json!({ "name": i.name, "formula": i.formula, "count": i.count }))
        .collect();
    json!({ "summary": words.summary, "solver": words.solver, "invariants": invariants })
}

pub(super) fn words(json: &Value) -> Option<Words> {
    Some(Words {
        summary: json::text(json, "summary")?,
        solver: json::text(json, "solver")?,
        invariants: json::list(json, "invariants", |own| {
            Some(InvariantWords {
                name: json::text(own, "name")?,
                formula: json::text(own, "formula")?,
                count: json::count(own, "count")?,
            })
        })?,
    })
}
