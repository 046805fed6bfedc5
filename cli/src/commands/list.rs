//! `clebsch list`: all models, the models of one family, or the cases of one model.
//! Takes the gallery; gives a table, or one JSON object.

use crate::models::gallery::{Case, Entry, Family, Gallery, declared, family};
use crate::named::cases::NamedCases;
use crate::named::resolve::{NamedModel, named};
use crate::terminal::Streams;
use crate::terminal::failure::Failure;
use crate::words::columns::aligned;
use crate::words::lines::first_line;
use crate::words::plain::shown;
use crate::words::step_method::step_method;
use crate::words::suggestion::slip;
use clap::ArgMatches;
use clebsch::card::Conserved;
use clebsch_core::pipeline;
use serde_json::{Value, json};

/// A model as the table shows it.
struct Row {
    family: Family,
    name: String,
    cases: Vec<String>,
    doc: String,
    json: Value,
}

/// Runs the command.
///
/// # Errors
/// Usage: the argument names neither a family nor a model. Failed: the output cannot be written.
pub fn list(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<(), Failure> {
    let which = matches.get_one::<String>("which").map(String::as_str);
    let of_family = which.and_then(|which| Family::ALL.into_iter().find(|f| f.name() == which));
    if let (Some(model), None) = (which, of_family) {
        let families = Family::ALL.map(Family::name);
        if let Some(near) = slip(model, &families) {
            return Err(Failure::Usage(format!(
                "no family or model `{}`; did you mean `{near}`?",
                shown(model)
            )));
        }
        return cases(gallery, model, matches.get_flag("json"), streams);
    }
    let mut rows: Vec<Row> = gallery.entries.iter().map(compiled).collect();
    rows.extend(gallery.files.iter().map(|file| {
        let cases = NamedCases::shipped(file);
        text_row(file.family, file.name, file.text, &cases)
    }));
    rows.retain(|row| of_family.is_none_or(|family| family == row.family));
    let place = |family: Family| Family::ALL.iter().position(|f| *f == family);
    rows.sort_by_key(|row| place(row.family));
    if matches.get_flag("json") {
        let models: Vec<Value> = rows.into_iter().map(|row| row.json).collect();
        writeln!(streams.out, "{}", json!({ "models": models }))?;
        return Ok(());
    }
    let head = ["model", "family", "cases", "description"];
    let mut table = vec![head.map(str::to_owned).to_vec()];
    table.extend(rows.into_iter().map(|row| {
        let family = row.family.name().to_owned();
        vec![row.name, family, row.cases.join(", "), row.doc]
    }));
    streams
        .out
        .write_all(aligned(&table, &[], streams.width).as_bytes())?;
    Ok(())
}

/// The first sentence of a documentation, on one line.
fn first_sentence(doc: &str) -> String {
    let paragraph = doc.split("\n\n").next().unwrap_or_default();
    let line = paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.split_once(". ") {
        Some((sentence, _)) => format!("{sentence}."),
        None => line,
    }
}

/// The documentation of a model's text; empty if the text does not parse.
fn documentation(text: &str) -> String {
    let Ok(model) = pipeline::parse_source(text) else {
        return String::new();
    };
    let lines: Vec<&str> = model.docs.iter().map(|line| line.trim()).collect();
    lines.join("\n").trim().to_owned()
}

/// Lists the cases of one model with their descriptions.
fn cases(
    gallery: &Gallery,
    model: &str,
    as_json: bool,
    streams: &mut Streams<'_>,
) -> Result<(), Failure> {
    let named = named(gallery, model, "`list` takes a model").map_err(|failure| match failure {
        Failure::Usage(message) => Failure::Usage(format!(
            "{message}; or give a family: {}",
            Family::ALL.map(Family::name).join(", ")
        )),
        other => other,
    })?;
    let (name, doc, runs, cases, json) = match &named {
        NamedModel::Compiled(entry) => {
            let cases = entry.cases.iter();
            let cases: Vec<_> = cases.map(|c| (c.name.clone(), c.doc.clone())).collect();
            let row = compiled(entry);
            (
                row.name,
                entry.card.doc.trim().to_owned(),
                step_method(true),
                cases,
                row.json,
            )
        }
        NamedModel::Text(text) => {
            let family = gallery.files.iter().find(|file| file.name == text.name);
            let family = family.map_or(Family::Particle, |file| file.family);
            let row = text_row(family, &text.name, &text.text, &text.cases);
            let doc = documentation(&text.text);
            (
                row.name,
                doc,
                step_method(false),
                text.cases.described(),
                row.json,
            )
        }
    };
    let out = &mut *streams.out;
    if as_json {
        writeln!(out, "{json}")?;
        return Ok(());
    }
    let name = shown(&name);
    let doc = crate::words::width::paragraph(&doc.replace('\n', " "), streams.width, 0);
    writeln!(out, "{name}, {runs}\n{doc}")?;
    let mut table = vec![["case", "what it shows"].map(str::to_owned).to_vec()];
    table.extend(
        cases
            .into_iter()
            .map(|(name, doc)| vec![name, first_line(&doc)]),
    );
    out.write_all(aligned(&table, &[], streams.width).as_bytes())?;
    writeln!(
        out,
        "\nclebsch show {name}      its text and first case\nclebsch run {name}:CASE  one of its cases"
    )?;
    Ok(())
}

fn compiled(entry: &Entry) -> Row {
    Row {
        family: family(&entry.card),
        name: entry.card.kebab.to_owned(),
        cases: entry.cases.iter().map(|case| case.name.clone()).collect(),
        doc: first_sentence(entry.card.doc),
        json: compiled_json(entry),
    }
}

fn text_row(family: Family, name: &str, text: &str, cases: &NamedCases) -> Row {
    let doc = documentation(text);
    let described = cases.described().into_iter();
    let described: Vec<Value> = described
        .map(|(name, doc)| json!({"name": name, "doc": doc}))
        .collect();
    Row {
        family,
        name: name.to_owned(),
        cases: cases.names().map(str::to_owned).collect(),
        doc: first_sentence(&doc),
        json: json!({
            "model": name,
            "name": declared(text),
            "family": family.name(),
            "runs": step_method(false),
            "doc": doc,
            "cases": described,
        }),
    }
}

fn compiled_json(entry: &Entry) -> Value {
    let card = &entry.card;
    let case =
        |case: &Case| json!({"name": case.name, "doc": case.doc, "h": case.h, "steps": case.steps});
    json!({
        "model": card.kebab,
        "name": card.name,
        "family": family(card).name(),
        "runs": step_method(true),
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
