//! Reads values of a JSON object by name. Each function gives `None` if the value has another form.

use clebsch_core::diagnostic::{Report, TextRange};
use serde_json::{Value, json};

pub(super) fn text(json: &Value, name: &str) -> Option<String> {
    Some(json.get(name)?.as_str()?.to_owned())
}

pub(super) fn count(json: &Value, name: &str) -> Option<usize> {
    number(json.get(name)?)
}

pub(super) fn truth(json: &Value, name: &str) -> Option<bool> {
    json.get(name)?.as_bool()
}

/// A list whose entries `one` reads.
pub(super) fn list<V>(
    json: &Value,
    name: &str,
    one: impl Fn(&Value) -> Option<V>,
) -> Option<Vec<V>> {
    json.get(name)?.as_array()?.iter().map(one).collect()
}

pub(super) fn texts(json: &Value, name: &str) -> Option<Vec<String>> {
    list(json, name, |own| Some(own.as_str()?.to_owned()))
}

pub(super) fn number(json: &Value) -> Option<usize> {
    usize::try_from(json.as_u64()?).ok()
}

/// Warnings on a text.
pub(super) fn of_reports(reports: &[Report]) -> Value {
    let each = reports.iter().map(|report| {
        let also = report.also.iter();
        let also: Vec<Value> = also
            .map(|(range, note)| json!({ "range": of_range(*range), "note": note }))
            .collect();
        json!({
            "range": of_range(report.range),
            "message": report.message,
            "help": report.help,
            "also": also,
        })
    });
    each.collect()
}

pub(super) fn reports(json: &Value, name: &str) -> Option<Vec<Report>> {
    list(json, name, |own| {
        Some(Report {
            range: range(own.get("range")?)?,
            message: text(own, "message")?,
            help: texts(own, "help")?,
            also: list(own, "also", |also| {
                Some((range(also.get("range")?)?, text(also, "note")?))
            })?,
        })
    })
}

fn of_range(range: TextRange) -> Value {
    json!([range.start.0, range.start.1, range.end.0, range.end.1])
}

fn range(json: &Value) -> Option<TextRange> {
    let numbers: Option<Vec<usize>> = json.as_array()?.iter().map(number).collect();
    let [line, column, last_line, end] = <[usize; 4]>::try_from(numbers?).ok()?;
    Some(TextRange {
        start: (line, column),
        end: (last_line, end),
    })
}
