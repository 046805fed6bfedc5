//! Values in the notation of other languages in a case that is not TOML: `2*pi**2`, `(3.0, 0.0)`, `None`.
//! Takes the text and the position at which TOML stopped; gives the correct notation.

use crate::words::plain::shown;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::value::translated;
use std::fmt;
use std::ops::Range;
use toml::de::DeValue;

/// Words for a missing value.
const NOTHING: [&str; 5] = ["None", "null", "nil", "NULL", "NaN"];

/// The correct notation for the value at which TOML stopped; `None` if the value is of none of these kinds.
pub(super) fn instead(text: &str, span: &Range<usize>) -> Option<String> {
    let start = text.get(..span.start)?.rfind('\n').map_or(0, |at| at + 1);
    let line = text.get(start..)?.lines().next()?;
    let (key, whole) = line.split_once('=')?;
    let name = key.trim();
    if !name.is_ascii() && !name.starts_with(['"', '\'']) && ascii(name).is_ascii() {
        return Some(format!(
            "write the key `{}` as `{}`",
            shown(name),
            ascii(name)
        ));
    }
    let whole = without_remark(whole);
    if let Some(list) = list(whole) {
        return Some(format!("write {list}"));
    }
    // First the entry of a list, then the whole value.
    let offset = start + key.len() + 1;
    let entry = span
        .start
        .checked_sub(offset)
        .and_then(|at| entry(whole, at));
    [entry.unwrap_or(whole), whole].into_iter().find_map(one)
}

fn one(value: &str) -> Option<String> {
    let value = value.trim();
    if NOTHING.contains(&value) {
        return Some(format!("expected a number, found `{value}`"));
    }
    let is_quoted = value.starts_with(['"', '\'']) || value.is_empty();
    // If the value itself is TOML, the error has another cause.
    if is_quoted || DeValue::parse(value).is_ok() {
        return None;
    }
    let written = translated(value)?;
    Some(format!(
        "put expressions in quotes: \"{}\"",
        shown(&written)
    ))
}

/// A bracket of a case that nothing closes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Unclosed {
    /// Its position in the text.
    pub at: usize,
    bracket: char,
    /// Whether it begins the line of a table, as in `[initial]`.
    is_header: bool,
}

impl fmt::Display for Unclosed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (what, closing) = match self.bracket {
            '[' if self.is_header => ("name of the table", ']'),
            '[' => ("list", ']'),
            _ => ("table", '}'),
        };
        let bracket = self.bracket;
        write!(
            f,
            "the bracket `{bracket}` on this line is not closed; write `{closing}` at the end of the {what}"
        )
    }
}

/// The outermost bracket before `stop`, where TOML stopped, that is not closed in the whole text. Brackets in strings
/// and remarks do not count.
pub(super) fn unclosed(text: &str, stop: usize) -> Option<Unclosed> {
    let mut open: Vec<Unclosed> = Vec::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let at = text.len() - rest.len();
        let length = match c {
            '#' => rest.find('\n').unwrap_or(rest.len()),
            '"' | '\'' => string(rest, c),
            _ => c.len_utf8(),
        };
        match c {
            '[' | '{' => {
                let before = text.get(..at)?.rsplit('\n').next()?;
                open.push(Unclosed {
                    at,
                    bracket: c,
                    is_header: before.trim().is_empty(),
                });
            }
            ']' | '}' => {
                let is_own = |o: &Unclosed| (o.bracket == '[') == (c == ']');
                // A closing bracket of the other kind is a mistake of its own.
                open.pop().filter(is_own)?;
            }
            _ => {}
        }
        rest = rest.get(length..)?;
    }
    open.first().copied().filter(|o| o.at < stop)
}

/// The length of the string at the start of a text; a string on one line ends with the line.
fn string(text: &str, quote: char) -> usize {
    let three: String = [quote; 3].iter().collect();
    let is_long = text.starts_with(&three);
    let end = if is_long { 3 } else { 1 };
    let (mut escaped, mut quotes) = (false, 0);
    for (at, c) in text.char_indices().skip(end) {
        quotes = match c == quote && !escaped {
            true => quotes + 1,
            false => 0,
        };
        if quotes == end {
            return at + 1;
        }
        if !is_long && c == '\n' {
            return at;
        }
        escaped = c == '\\' && quote == '"' && !escaped;
    }
    text.len()
}

/// A value without the remark behind it.
fn without_remark(value: &str) -> &str {
    let is_quoted = value.contains(['"', '\'']);
    let end = value.find('#').filter(|_| !is_quoted);
    value
        .get(..end.unwrap_or(value.len()))
        .unwrap_or(value)
        .trim_end()
}

/// A list in round brackets as one in square brackets.
fn list(value: &str) -> Option<String> {
    let inside = value.trim().strip_prefix('(')?.strip_suffix(')')?;
    let is_list = inside.contains(',') && !inside.contains(['(', ')', '"', '\'']);
    let inside = inside.trim_end().trim_end_matches(',');
    is_list.then(|| format!("[{}]", shown(inside)))
}

/// The entry of a list that contains a position.
fn entry(value: &str, at: usize) -> Option<&str> {
    let separators = ['[', ']', ','];
    let start = value.get(..at)?.rfind(separators).map_or(0, |at| at + 1);
    let rest = value.get(start..)?;
    let end = rest.find(separators).unwrap_or(rest.len());
    rest.get(..end)
}

#[cfg(test)]
mod tests {
    use super::{instead, unclosed};

    #[test]
    fn values_of_other_languages_are_told_how_to_be_written() {
        let of = |value: &str, stop: &str| {
            let text = format!("h = 0.1\nG = {value}\n");
            let at = text.find(stop).unwrap_or(0);
            instead(&text, &(at..at + 1))
        };
        let told = |value: &str, stop: &str| of(value, stop).unwrap_or_default();
        assert_eq!(
            told("2*pi**2 # area", "*"),
            "put expressions in quotes: \"2*pi^2\""
        );
        assert_eq!(
            told("[0, 2*np.pi, 1]", "2*"),
            "put expressions in quotes: \"2*pi\""
        );
        assert_eq!(told("(3.0, 0.0)", "("), "write [3.0, 0.0]");
        assert_eq!(told("None", "N"), "expected a number, found `None`");
        assert_eq!(
            instead("Λ = 1\n", &(0..2)).as_deref(),
            Some("write the key `Λ` as `Lambda`")
        );
        for (value, stop) in [("[1, 2,, 3]", ",,"), ("\"pi", "\""), ("", "\n")] {
            assert_eq!(of(value, stop), None, "{value}");
        }
    }

    #[test]
    fn a_bracket_that_nothing_closes_is_found() {
        let of = |text: &str| {
            let stop = toml::de::DeTable::parse(text).expect_err(text).span();
            let stop = stop.map_or(text.len(), |span| span.start);
            unclosed(text, stop).map(|open| (open.at, open.bracket))
        };
        for (text, found) in [
            ("h = 1\nx = [1, 2\nv = [0, 0]\n", (10, '[')),
            ("x = [[1, 2], [3, 4]\n[initial]\n", (4, '[')),
            ("J = { I = [1, 2, 3]\nk = 1.0\n", (4, '{')),
            ("[initial\nx = 1\n", (0, '[')),
            ("# [\na = \"\\\"[\"\nb = '''\n['''\nx = [1", (31, '[')),
        ] {
            assert_eq!(of(text), Some(found), "{text}");
        }
        // The mistake is another one.
        for text in [
            "x = [1, 2]]\n",
            "x = [1 2]\n",
            "x = [\n [1, 2]\n [3, 4]\n]\n",
            "x = \"[1\ny = 2\n",
        ] {
            assert_eq!(of(text), None, "{text}");
        }
    }
}
