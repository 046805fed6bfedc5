//! Finds unmatched parentheses, brackets and braces in a file, where they would prevent splitting the text into
//! tokens. In a macro, the compiler reports them before the call.

use super::text;
use crate::diagnostic::{Diagnostic, Place};
use proc_macro2::{Span, TokenStream};

/// The error for an opening delimiter that is not closed; it names the text before which it should be closed, if any.
pub(super) fn not_closed(opening: char, place: Place, before: Option<(&str, Place)>) -> Diagnostic {
    let closing = partner(opening);
    let message = match before {
        Some((found, _)) => format!("this `{opening}` is not closed before `{found}`"),
        None => format!("this `{opening}` is not closed"),
    };
    let mut d =
        Diagnostic::new(place, message).help(format!("add `{closing}` where the group ends"));
    if let Some((found, place)) = before {
        d = d.also(
            place,
            format!("`{closing}` is missing before this `{found}`"),
        );
    }
    d
}

/// The matching delimiter of an opening or closing one.
fn partner(c: char) -> char {
    match c {
        '(' => ')',
        '[' => ']',
        '{' => '}',
        ')' => '(',
        ']' => '[',
        _ => '{',
    }
}

/// An opening delimiter, its position, and the first end of a statement inside it.
struct Opening {
    at: usize,
    delimiter: char,
    ends: Option<(usize, char)>,
}

/// An unmatched delimiter.
enum Unmatched {
    Opening(Opening),
    Closing(usize, char),
}

/// The first unmatched delimiter of the text, if there is one.
pub(super) fn unmatched(source: &str) -> Option<Diagnostic> {
    let mut open: Vec<Opening> = Vec::new();
    let mut fault = None;
    let (text, whole) = text::read(source, |at, c| match c {
        _ if fault.is_some() => {}
        '(' | '[' | '{' => open.push(Opening {
            at,
            delimiter: c,
            ends: None,
        }),
        // A statement cannot end inside parentheses: the missing delimiter belongs before this.
        ';' => {
            if let Some(inner) = open.last_mut().filter(|o| o.delimiter != '{') {
                inner.ends.get_or_insert((at, c));
            }
        }
        ')' | ']' | '}' => match open.pop() {
            Some(o) if o.delimiter == partner(c) => {}
            Some(o) if o.delimiter != '{' => {
                let ends = o.ends.or(Some((at, c)));
                fault = Some(Unmatched::Opening(Opening { ends, ..o }));
            }
            _ => fault = Some(Unmatched::Closing(at, c)),
        },
        _ => {}
    });
    // An unterminated string hides the text after it.
    let left = open.pop().filter(|_| whole);
    match fault.or(left.map(Unmatched::Opening))? {
        Unmatched::Opening(o) => {
            let ends = match o.ends {
                Some((at, c)) => Some((c.to_string(), place(&text, at)?)),
                None => None,
            };
            let before = ends.as_ref().map(|(c, place)| (c.as_str(), *place));
            Some(not_closed(o.delimiter, place(&text, o.at)?, before))
        }
        Unmatched::Closing(at, c) => {
            let message = format!("this `{c}` has no matching `{}`", partner(c));
            Some(
                Diagnostic::new(place(&text, at)?, message)
                    .help("remove it, or add the missing one"),
            )
        }
    }
}

/// The position of one character, obtained from a text that is blank up to that character.
pub(super) fn place(text: &str, at: usize) -> Option<Place> {
    let before = text.get(..at)?.chars();
    let mut blank: String = before.map(|c| if c == '\n' { c } else { ' ' }).collect();
    blank.push(';');
    let tokens: TokenStream = blank.parse().ok()?;
    let span: Span = tokens.into_iter().next()?.span();
    Some(Place::token(span))
}

#[cfg(test)]
mod tests {
    use crate::syntax::{parse, tokens};

    /// Line and column of the first error, and its message.
    fn fault(source: &str) -> (usize, usize, String) {
        let errors = tokens(source).and_then(parse).map(|_| ()).unwrap_err();
        let first = errors.iter().next().unwrap();
        let (line, column) = first.place.line_and_column();
        (line, column, first.message.clone())
    }

    #[test]
    fn an_opening_delimiter_without_partner_is_pointed_at() {
        for (source, line, column, said) in [
            (
                "model M {\n  let Λ = (a;\n}",
                2,
                11,
                "this `(` is not closed before `;`",
            ),
            (
                "model M {\n  let a = v[2;\n}",
                2,
                12,
                "this `[` is not closed before `;`",
            ),
            (
                "model M {\n  let a = (v];\n}",
                2,
                11,
                "this `(` is not closed before `]`",
            ),
            (
                "model M {\n  let a = (v\n}",
                2,
                11,
                "this `(` is not closed before `}`",
            ),
            (
                "model M {\n  let a = (b + (c;\n}",
                2,
                16,
                "this `(` is not closed before `;`",
            ),
            ("model M {\n  let a = tr(b", 2, 13, "this `(` is not closed"),
            ("model M {\n  let a = b;\n", 1, 9, "this `{` is not closed"),
            (
                "model M {\n  let a = b);\n}",
                2,
                12,
                "this `)` has no matching `(`",
            ),
            (
                "model M {\n  let a = b;\n}\n}",
                4,
                1,
                "this `}` has no matching `{`",
            ),
            // Delimiters in comments and literals do not count, also where backslashes are replaced.
            (
                "// (\n/* [ */ model M {\n  param a as \"\\chi(\"; let b = (a;\n}",
                3,
                31,
                "this `(` is not closed before `;`",
            ),
            (
                "#[doc = \"(\"] #[x = '('] model M {\n  let b = (a;\n}",
                2,
                11,
                "this `(` is not closed before `;`",
            ),
        ] {
            assert_eq!(fault(source), (line, column, said.to_owned()), "{source}");
        }
    }

    #[test]
    fn a_string_without_end_is_told_before_what_it_hides() {
        for source in [
            "model M { param a as \"b; }",
            "model M { /* let a = (b; }",
            "model M { r#\"}\" }",
        ] {
            let (_, _, said) = fault(source);
            assert!(said.contains("unexpected character"), "{source}: {said}");
        }
        assert_eq!(fault("model M { let a = (b; } \"").1, 19);
    }

    #[test]
    fn one_that_is_closed_in_a_later_statement_is_pointed_at() {
        for (source, column) in [
            ("model M {\n  let a = (b; let c = (d));\n}", 11),
            ("model M {\n  let a = dot(b, c; let c = d);\n}", 14),
            ("model M {\n  let a = b[2; let c = d];\n}", 12),
            ("model M {\n  let a = b^(1/2; let c = d);\n}", 13),
            ("model M {\n  let a = (b let c = (d));\n}", 11),
            (
                "model M {\n  param a: Real; constraint next(a = b;);\n}",
                33,
            ),
        ] {
            let (line, found, said) = fault(source);
            assert_eq!((line, found), (2, column), "{source}: {said}");
            assert!(said.contains("is not closed before"), "{source}: {said}");
        }
    }
}
