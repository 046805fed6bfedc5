//! `clebsch list`: the models and their cases.
//! Takes the gallery; gives a table, or one JSON object.

use crate::Streams;
use crate::columns::aligned;
use crate::failure::Failure;
use crate::gallery::{Case, Entry, Gallery};
use clebsch::card::Conserved;
use serde_json::{Value, json};

/// Runs the command.
///
/// # Errors
/// Those of writing.
pub fn list(gallery: &Gallery, as_json: bool, streams: &mut Streams<'_>) -> Result<(), Failure> {
    let out = &mut *streams.out;
    if as_json {
        let models: Vec<Value> = gallery.entries.iter().map(model).collect();
        writeln!(out, "{}", json!({ "models": models }))?;
        return Ok(());
    }
    let mut rows = vec![["model", "cases", "what it is"].map(str::to_owned).to_vec()];
    rows.extend(gallery.entries.iter().map(|entry| {
        let cases: Vec<&str> = entry.cases.iter().map(|case| case.name.as_str()).collect();
        let doc = first_line(entry.card.doc);
        vec![entry.card.kebab.to_owned(), cases.join(", "), doc]
    }));
    out.write_all(aligned(&rows, &[], streams.width).as_bytes())?;
    Ok(())
}

/// The first line of a text that is not empty.
pub(crate) fn first_line(doc: &str) -> String {
    let mut lines = doc.lines().map(str::trim);
    lines.find(|line| !line.is_empty()).unwrap_or("").to_owned()
}

fn model(entry: &Entry) -> Value {
    let card = &entry.card;
    let case =
        |case: &Case| json!({"name": case.name, "doc": case.doc, "h": case.h, "steps": case.steps});
    json!({
        "model": card.kebab,
        "name": card.name,
        "doc": card.doc.trim(),
        "solver": card.solver,
        "order": card.order,
        "reversible": card.reversible,
        "discrete_energy": {
            "formula": card.discrete_energy.formula,
            "conserved": match card.discrete_energy.conserved {
                Conserved::Exactly => "exactly",
                Conserved::Boundedly => "boundedly",
            },
        },
        "fingerprint": format!("{:016x}", card.fingerprint),
        "cases": entry.cases.iter().map(case).collect::<Vec<_>>(),
    })
}
