//! Values put into the text of a case, so that everything else stays as the case has it. Takes the text, a key and a value written
//! as TOML; gives the text with the value in its place.

use std::ops::Range;
use toml::de::DeTable;

/// The place of a key in a text: of a top-level key if `table` is empty.
fn place(text: &str, table: &str, key: &str) -> Option<(Range<usize>, Range<usize>)> {
    let document = DeTable::parse(text).ok()?;
    let top = document.get_ref();
    let own = match table {
        "" => top,
        name => top.get(name)?.get_ref().as_table()?,
    };
    let (key, value) = own.get_key_value(key)?;
    Some((key.span(), value.span()))
}

/// Where the line behind the head of a table begins; none if the text lacks that head.
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

/// A key as TOML has it: in quotes unless all its letters may appear in a bare key.
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

/// The text with a value, written as TOML on one line, under a key of a table; at the top level if `table` is empty.
#[must_use]
pub fn with_value(text: &str, table: &str, key: &str, value: &str) -> String {
    let mut out = text.to_owned();
    if let Some((_, span)) = place(text, table, key) {
        out.replace_range(span, value);
        return out;
    }
    let line = format!("{} = {value}\n", quoted_key(key));
    if table.is_empty() {
        return line + text;
    }
    match behind_head(text, table) {
        Some(at) => {
            // The head may be the last line, without an end.
            let line = match text.get(..at).is_some_and(|before| before.ends_with('\n')) {
                true => line,
                false => format!("\n{line}"),
            };
            out.insert_str(at, &line);
        }
        None => {
            if !out.ends_with('\n') {
                out.push('\n');
            }
            out.push_str(&format!("[{table}]\n{line}"));
        }
    }
    out
}

/// The text without a key of a table.
#[must_use]
pub fn without(text: &str, table: &str, key: &str) -> String {
    let mut out = text.to_owned();
    if let Some((key, value)) = place(text, table, key) {
        out.replace_range(key.start..value.end, "");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{with_value, without};

    const CASE: &str = "h = 0.1 # step\n[parameters]\nk = 2 # stiff\ng = [0,\n 1]\n";

    #[test]
    fn values_are_replaced_added_and_removed() {
        assert_eq!(
            with_value(CASE, "parameters", "g", "[1, 2]"),
            CASE.replace("[0,\n 1]", "[1, 2]")
        );
        assert_eq!(
            with_value(CASE, "parameters", "m", "3"),
            CASE.replace("k = 2", "m = 3\nk = 2")
        );
        assert_eq!(with_value(CASE, "", "h", "0.5"), CASE.replace("0.1", "0.5"));
        assert_eq!(
            with_value(CASE, "", "steps", "7"),
            format!("steps = 7\n{CASE}")
        );
        assert_eq!(
            with_value(CASE, "initial", "R q", "1"),
            format!("{CASE}[initial]\n\"R q\" = 1\n")
        );
        assert_eq!(without(CASE, "parameters", "k"), CASE.replace("k = 2", ""));
        assert_eq!(without(CASE, "parameters", "x"), CASE);
    }
}
