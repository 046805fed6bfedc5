//! Inserts values into the text of a case and leaves everything else unchanged. Takes the text, a key and a
//! value written as TOML; gives the text with the value.

use std::ops::Range;
use toml::de::DeTable;

/// A value for a key of a table. If the table name is empty, the key is at the top level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// The table.
    pub table: String,
    /// The key.
    pub key: String,
    /// The value as TOML on one line; `None` to remove the key.
    pub value: Option<String>,
}

/// The ranges of a key and of its value.
fn place(top: &DeTable<'_>, table: &str, key: &str) -> Option<(Range<usize>, Range<usize>)> {
    let own = match table {
        "" => top,
        name => top.get(name)?.get_ref().as_table()?,
    };
    let (key, value) = own.get_key_value(key)?;
    Some((key.span(), value.span()))
}

/// The start of the line after the header of a table; `None` if the text lacks this header.
fn behind_head(text: &str, table: &str) -> Option<usize> {
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        at += line.len();
        let bare = line.split('#').next().unwrap_or_default().trim();
        let inside = bare
            .strip_prefix('[')
            .and_then(|rest| rest.strip_suffix(']'));
        if inside.is_some_and(|name| name.trim() == table) {
            return Some(at);
        }
    }
    None
}

/// A key in TOML: in quotes unless all its characters may occur in a bare key.
#[must_use]
pub fn quoted_key(key: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    match !key.is_empty() && key.chars().all(is_bare) {
        true => key.to_owned(),
        false => quoted(key),
    }
}

/// A text as TOML has it, in quotes.
#[must_use]
pub fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// The text with these values, which must have different keys. A text that is not TOML stays unchanged, since its
/// reader reports the mistake.
#[must_use]
pub fn edited(text: &str, edits: &[Edit]) -> String {
    let Ok(document) = DeTable::parse(text) else {
        return text.to_owned();
    };
    // Ranges of the text, each with its new text.
    let mut changes: Vec<(Range<usize>, String)> = Vec::new();
    let mut tables: Vec<(&str, String)> = Vec::new();
    for Edit { table, key, value } in edits {
        match (place(document.get_ref(), table, key), value) {
            (Some((_, span)), Some(value)) => changes.push((span, value.clone())),
            (Some((key, span)), None) => changes.push((key.start..span.end, String::new())),
            (None, None) => {}
            (None, Some(value)) => {
                let line = format!("{} = {value}\n", quoted_key(key));
                match tables.iter_mut().find(|(own, _)| own == table) {
                    Some((_, lines)) => lines.push_str(&line),
                    None => tables.push((table, line)),
                }
            }
        }
    }
    let mut end = String::new();
    for (table, lines) in tables {
        match (table, behind_head(text, table)) {
            ("", _) => changes.push((0..0, lines)),
            (_, Some(at)) => {
                // The header may be the last line, without a line end.
                let is_ended = text.get(..at).is_some_and(|before| before.ends_with('\n'));
                changes.push((
                    at..at,
                    if is_ended {
                        lines
                    } else {
                        format!("\n{lines}")
                    },
                ));
            }
            (_, None) => end.push_str(&format!("[{table}]\n{lines}")),
        }
    }
    changes.sort_by_key(|(range, _)| range.start);
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    for (range, words) in changes {
        out.push_str(text.get(at..range.start).unwrap_or_default());
        out.push_str(&words);
        at = range.end;
    }
    out.push_str(text.get(at..).unwrap_or_default());
    if !end.is_empty() && !out.is_empty() && !out.ends_with('\n') {
        out.push('\n');
    }
    out + &end
}

#[cfg(test)]
mod tests {
    use super::{Edit, edited};

    const CASE: &str = "h = 0.1 # step\n[parameters]\nk = 2 # stiff\ng = [0,\n 1]\n";

    fn put(edits: &[(&str, &str, Option<&str>)]) -> String {
        let edits = edits.iter().map(|(table, key, value)| Edit {
            table: (*table).to_owned(),
            key: (*key).to_owned(),
            value: value.map(str::to_owned),
        });
        edited(CASE, &edits.collect::<Vec<_>>())
    }

    #[test]
    fn values_are_replaced_added_and_removed() {
        assert_eq!(
            put(&[("parameters", "g", Some("[1, 2]"))]),
            CASE.replace("[0,\n 1]", "[1, 2]")
        );
        assert_eq!(
            put(&[
                ("parameters", "m", Some("3")),
                ("parameters", "n", Some("4"))
            ]),
            CASE.replace("k = 2", "m = 3\nn = 4\nk = 2")
        );
        assert_eq!(put(&[("", "h", Some("0.5"))]), CASE.replace("0.1", "0.5"));
        assert_eq!(
            put(&[("", "steps", Some("7"))]),
            format!("steps = 7\n{CASE}")
        );
        assert_eq!(
            put(&[("initial", "R q", Some("1"))]),
            format!("{CASE}[initial]\n\"R q\" = 1\n")
        );
        assert_eq!(put(&[("parameters", "k", None)]), CASE.replace("k = 2", ""));
        assert_eq!(put(&[("parameters", "x", None)]), CASE);
        assert_eq!(
            put(&[
                ("parameters", "g", None),
                ("", "h", Some("1")),
                ("ends", "i", Some("2"))
            ]),
            "h = 1 # step\n[parameters]\nk = 2 # stiff\n\n[ends]\ni = 2\n"
        );
    }

    #[test]
    fn a_text_that_is_not_toml_stays() {
        let edit = Edit {
            table: String::new(),
            key: "h".to_owned(),
            value: Some("1".to_owned()),
        };
        assert_eq!(edited("h = ", &[edit]), "h = ");
    }
}
