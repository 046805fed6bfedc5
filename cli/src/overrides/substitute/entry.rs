//! Replaces lists, tables and entries of tables in the text of a case: `R = {axis = [0, 0, 1], angle = 1}`,
//! `R.angle`.
//! Takes the text, a key with dots, and a value; gives the text with the same number of lines.

use crate::words::toml_value::quoted;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The tables of quantities.
const TABLES: [&str; 2] = ["parameters", "initial"];

/// The position of a key in the text.
struct KeyPosition {
    value: Range<usize>,
    /// The key, if the case gives the quantity under another name: the inertia `I` for the second moments `J`.
    key: Option<Range<usize>>,
    /// Whether the value is an entry of a table.
    within: bool,
}

/// The text with a new value for a list, a table or an entry of a table. `None` for other values, and if the case
/// does not contain it.
pub(super) fn put(text: &str, name: &str, value: &str) -> Option<String> {
    let found = found(text, name).filter(|found| is_own(found, value))?;
    let before = text.get(found.value.clone())?;
    let mut out = text.to_owned();
    let lines = "\n".repeat(before.matches('\n').count());
    let value = quoted(&value.replace(['\n', '\r'], " "));
    out.replace_range(found.value, &format!("{value}{lines}"));
    if let Some(key) = found.key {
        out.replace_range(key, name);
    }
    Some(out)
}

/// Whether a value is inserted into the text of the case, rather than number by number.
pub(crate) fn replaces(text: &str, name: &str, value: &str) -> bool {
    found(text, name).is_some_and(|found| is_own(&found, value))
}

/// Whether a name refers to an entry of a table, such as the angle of a rotation.
pub(crate) fn is_within_a_table(text: &str, name: &str) -> bool {
    found(text, name).is_some_and(|found| found.within)
}

fn is_own(found: &KeyPosition, value: &str) -> bool {
    found.within || value.trim_start().starts_with(['[', '{'])
}

fn found(text: &str, name: &str) -> Option<KeyPosition> {
    let document = DeTable::parse(text).ok()?;
    let mut path = name.split('.').map(str::trim);
    let root = path.next()?;
    let tables = TABLES.iter().filter_map(|table| {
        let own = document.get_ref().get(*table)?;
        own.get_ref().as_table()
    });
    let path: Vec<&str> = path.collect();
    for table in tables {
        if let Some(value) = table.get(root) {
            let (value, within) = descended(value, &path)?;
            let span = value.span();
            // The entries of a table with its own header, `[initial.R]`, are elsewhere.
            let is_inline = text.get(span.clone())?.starts_with(['[', '{']);
            let is_table = value.get_ref().is_table();
            return (is_inline || !is_table).then_some(KeyPosition {
                value: span,
                key: None,
                within,
            });
        }
        let other = other_key(root).filter(|_| path.is_empty());
        let other = other.and_then(|other| table.get_key_value(other.as_str()));
        if let Some((key, value)) = other {
            return Some(KeyPosition {
                value: value.span(),
                key: Some(key.span()),
                within: false,
            });
        }
    }
    None
}

/// The other key by which a case may give the same body: `J2` for `I2`.
fn other_key(name: &str) -> Option<String> {
    let of = |from: char, to: char| name.strip_prefix(from).map(|rest| format!("{to}{rest}"));
    of('I', 'J').or_else(|| of('J', 'I'))
}

/// Follows keys and indices of entries into a value. Returns the value there, and whether it is inside a table.
fn descended<'v, 'i>(
    value: &'v Spanned<DeValue<'i>>,
    path: &[&str],
) -> Option<(&'v Spanned<DeValue<'i>>, bool)> {
    let (mut at, mut within) = (value, false);
    for key in path {
        at = match at.get_ref() {
            DeValue::Table(table) => {
                within = true;
                table.get(*key)?
            }
            DeValue::Array(list) => {
                let letter = ["x", "y", "z"].iter().position(|letter| letter == key);
                let number = || key.parse::<usize>().ok()?.checked_sub(1);
                list.get(letter.or_else(number)?)?
            }
            _ => return None,
        };
    }
    Some((at, within))
}

#[cfg(test)]
mod tests {
    use super::{is_within_a_table, put, replaces};

    const CASE: &str = "h = 0.1\n[parameters]\nJ = [[1, 0],\n  [0, 2]] # body\ng = [0, 1]\n[initial]\n\
                        R = { axis = [0, 0, 1], angle = \"pi/2\" }\n";

    #[test]
    fn values_replace_values_on_the_same_lines() {
        let of = |name: &str, value: &str| put(CASE, name, value).unwrap_or_default();
        assert_eq!(of("R.angle", "pi/4"), CASE.replace("\"pi/2\"", "\"pi/4\""));
        assert_eq!(
            of("R.axis.z", "2"),
            CASE.replace("0, 1], angle", "0, 2], angle")
        );
        assert_eq!(
            of("R", "{euler = \"zyx\", angles = [0, 0, 1]}"),
            CASE.replace(
                "{ axis = [0, 0, 1], angle = \"pi/2\" }",
                "{euler = \"zyx\", angles = [0, 0, 1]}"
            )
        );
        let inertia = of("I", "[1, 2]");
        assert_eq!(
            inertia,
            CASE.replace("J = [[1, 0],\n  [0, 2]]", "I = [1, 2]\n")
        );
        assert!(is_within_a_table(CASE, "R.axis.1") && !is_within_a_table(CASE, "g.1"));
    }

    #[test]
    fn numbers_and_other_names_are_left() {
        for (name, value) in [("g", "1"), ("g.1", "2"), ("k", "[1]"), ("R.norm", "1")] {
            assert!(!replaces(CASE, name, value), "{name}");
        }
    }
}
