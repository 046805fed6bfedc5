//! How a declared name is typeset: `as "m g \chi"` behind its shape. Takes tokens; gives LaTeX that
//! any formula can hold.

use super::ast::Name;
use super::token::{Cursor, Token};
use crate::diagnostic::Diagnostic;

/// `as "m g \chi"`, one for each of the names: how they are typeset.
pub(super) fn typeset(c: &mut Cursor, names: &mut [Name]) -> Result<(), Diagnostic> {
    if !c.take_word("as") {
        return Ok(());
    }
    for (i, name) in names.iter_mut().enumerate() {
        if i > 0 && !c.take_punct(',') {
            return Err(c
                .unexpected(&format!("`,` and how `{}` is typeset", name.text))
                .help("each of the names takes one text: `param a, b: Real as \"\\alpha\", \"\\beta\";`"));
        }
        let Some(Token::Literal(literal)) = c.peek() else {
            return Err(c
                .unexpected("a name in LaTeX between quotes")
                .help("write for example `param gU: Vec<3> as \"m g \\chi\";`, in Rust `as r\"m g \\chi\"`"));
        };
        match latex(literal) {
            Ok(text) => name.typeset = Some(text),
            Err(why) => {
                let d = Diagnostic::new(c.place(), format!("this is no name in LaTeX: {why}"));
                return Err(d.help("write what stands between two dollars, such as `m g \\chi` or `J_{\\mathrm{eff}}`"));
            }
        }
        c.advance();
    }
    Ok(())
}

/// Longest typeset name, in characters.
const LONGEST_NAME: usize = 120;

/// What a string literal says as LaTeX: a backslash is one, doubled or not, and raw strings are
/// taken as they are.
fn latex(literal: &str) -> Result<String, String> {
    let raw = literal.starts_with('r');
    let inside = literal
        .trim_start_matches('r')
        .trim_matches('#')
        .strip_prefix('"')
        .and_then(|s| s.strip_suffix('"'))
        .ok_or("it stands between quotes")?;
    let inside = inside.replace(super::text::BACKSLASH, "\\");
    let text = match raw {
        true => inside,
        false => inside.replace("\\\\", "\\").replace("\\\"", "\""),
    };
    let text = text.trim().to_owned();
    if text.is_empty() || text.chars().count() > LONGEST_NAME {
        return Err(format!("it has between 1 and {LONGEST_NAME} characters"));
    }
    if let Some(c) = text
        .chars()
        .find(|c| c.is_control() || "$%#&~\"".contains(*c))
    {
        return Err(format!("it holds `{}`", c.escape_default()));
    }
    let mut depth = 0i32;
    let mut closed = true;
    for c in text.chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        closed &= depth >= 0;
    }
    if depth != 0 || !closed || text.ends_with(['\\', '_', '^']) {
        return Err("its braces are not paired, or something is missing at its end".to_owned());
    }
    Ok(text)
}
