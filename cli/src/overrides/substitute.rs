//! Inserts values of options into the text of a case, so that its expressions use them. Takes the text and names with
//! values; gives the new text.

mod entry;

use clebsch_core::lattice::value::SiteData;
pub(crate) use entry::{is_within_a_table, replaces};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The text with these values. A name may be the step size `h`, a parameter with a single value, a list, a
/// table, or an entry of a table. A value is skipped, for later, if the text does not give the name or if the
/// value is not an expression in the parameters.
pub(crate) fn substituted(text: &str, values: &[(String, String)]) -> String {
    let mut out = text.to_owned();
    for (name, value) in values {
        if let Some(next) = entry::put(&out, name, value).or_else(|| one(&out, name, value)) {
            out = next;
        }
    }
    out
}

fn one(text: &str, name: &str, value: &str) -> Option<String> {
    let table = DeTable::parse(text).ok()?;
    let parameters = table
        .get_ref()
        .get("parameters")
        .and_then(|t| t.get_ref().as_table());
    let place: &Spanned<DeValue<'_>> = match name {
        "h" => table.get_ref().get("h")?,
        _ => parameters?.get(name)?,
    };
    let is_one = matches!(
        place.get_ref(),
        DeValue::Integer(_) | DeValue::Float(_) | DeValue::String(_)
    );
    let is_known = |n: &String| {
        n == "pi" || n == "h" || parameters.is_some_and(|all| all.contains_key(n.as_str()))
    };
    let data = SiteData::read(value).ok()?;
    let is_plain = !value.contains(['"', '\\', '\n', '\r']);
    if !(is_one && is_plain && data.names().iter().all(is_known)) {
        return None;
    }
    let span = place.span();
    Some(format!(
        "{}\"{value}\"{}",
        text.get(..span.start)?,
        text.get(span.end..)?
    ))
}

/// Whether an expression of the case uses one of these names.
pub(crate) fn follow(text: &str, names: &[&str]) -> bool {
    let Ok(table) = DeTable::parse(text) else {
        return false;
    };
    table
        .get_ref()
        .iter()
        .any(|(_, value)| holds(value.get_ref(), names))
}

fn holds(value: &DeValue<'_>, names: &[&str]) -> bool {
    match value {
        DeValue::String(text) => SiteData::read(text)
            .is_ok_and(|data| data.names().iter().any(|n| names.contains(&n.as_str()))),
        DeValue::Array(list) => list.iter().any(|own| holds(own.get_ref(), names)),
        DeValue::Table(table) => table.iter().any(|(_, own)| holds(own.get_ref(), names)),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::{follow, substituted};

    const CASE: &str = "h = 0.1 # step\n[parameters]\nk = 2\nc = \"k/10\"\ng = [0, \"-h\"]\n";

    #[test]
    fn values_take_their_places_and_the_rest_stays() {
        let put = |values: &[(&str, &str)]| {
            let values: Vec<_> = values
                .iter()
                .map(|(n, v)| ((*n).to_owned(), (*v).to_owned()))
                .collect();
            substituted(CASE, &values)
        };
        assert_eq!(
            put(&[("k", "c*3"), ("h", "1/4")]),
            CASE.replace("k = 2", "k = \"c*3\"")
                .replace("h = 0.1", "h = \"1/4\"")
        );
        // Not a single number, a missing key, not an expression, another name.
        for (name, value) in [
            ("g", "1"),
            ("m", "1"),
            ("k", "1\""),
            ("k", "two"),
            ("k", "1+"),
        ] {
            assert_eq!(put(&[(name, value)]), CASE);
        }
    }

    #[test]
    fn expressions_follow_the_names_they_hold() {
        assert!(follow(CASE, &["k"]) && follow(CASE, &["h"]) && follow(CASE, &["m", "k"]));
        assert!(!follow(CASE, &["c"]) && !follow(CASE, &[]) && !follow("k = ", &["k"]));
    }
}
