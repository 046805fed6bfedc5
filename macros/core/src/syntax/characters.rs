//! Characters that papers use but the language does not: a typographic minus, subscripts, primes. In a file they must
//! be reported before the text is split into tokens, which fails on them.

use super::delimiters::place;
use super::text;
use super::unknown::RADIANS;
use crate::diagnostic::{Diagnostic, Place};

/// The advice for a prime used as in papers.
pub(super) const PRIME: &str = "write `(next(x) - x)/h` for a rate of change, `next(x)` for the value at the next node, `A^T` for a transpose";

/// The advice for single quotes around a text or a name.
pub(super) const QUOTES: &str =
    "write a text in double quotes, as in `\"x^2\"`, and a name without quotes";

/// The notation of the language for a character that papers use.
fn written(c: char) -> Option<&'static str> {
    Some(match c {
        '−' | '–' | '—' | '‐' => "write the ASCII minus sign, `-`",
        '\'' | '′' | '’' => PRIME,
        '·' | '⋅' | '×' | '∙' | '∗' | '∧' | '⊗' => {
            "write `a*b` for a product, `dot(a, b)` and `cross(a, b)` for products of vectors"
        }
        '⟨' | '⟩' | '〈' | '〉' => "write `dot(a, b)` for vectors, `tr(a^T*b)` for matrices",
        '₀'..='₉' => "write an index as `w_0` or `w0`",
        '²' | '³' | '¹' | '⁰' | '⁴'..='⁹' | '⁻' | 'ᵀ' => {
            "write `a^2` for a power, `A^T` for a transpose, `A^-1` for an inverse"
        }
        '°' => RADIANS,
        '÷' => "write `a/b`",
        '√' => "write `sqrt(a)`",
        '≤' | '≥' | '≠' => "write `<=` or `>=`, in an `assume` statement",
        '½' | '¼' | '¾' | '⅓' | '⅔' => "write `1/2`",
        '∇' | '∂' => "state the Lagrangian; clebsch takes the derivatives",
        '∫' | '∑' | '∏' => {
            "terms `at nodes` and `at segments` are summed over the label automatically"
        }
        '“' | '”' | '„' | '‘' => "write straight double quotes, `\"`",
        '\\' => {
            "write names in Unicode or spelt out, `Λ` or `Lambda`; put LaTeX in quotes after `as`"
        }
        _ => return None,
    })
}

/// A product or transpose sign within a name, where Rust accepts it as a letter.
pub(super) fn within(name: &str, place: Place) -> Option<Diagnostic> {
    let c = name.chars().find(|c| matches!(c, '·' | 'ᵀ'))?;
    let d = Diagnostic::new(place, format!("`{c}` is not a character of the language"));
    Some(d.help(written(c)?))
}

/// The first character outside comments and strings that cannot belong to a token.
pub(super) fn foreign(source: &str) -> Option<Diagnostic> {
    let mut found = None;
    let (text, _) = text::read(source, |at, c| {
        let known = c.is_ascii() || c.is_alphabetic() || c.is_whitespace();
        if found.is_none() && (written(c).is_some() || !known) {
            found = Some((at, c));
        }
    });
    let (at, c) = found?;
    if let Some(quoted) = in_single_quotes(&text, at) {
        let here = place(&text, at)?;
        let end = place(&text, at + quoted.len() - 1).unwrap_or(here);
        let message = format!("single quotes do not enclose a text in a model: `{quoted}`");
        return Some(Diagnostic::new(here.to(end), message).help(QUOTES));
    }
    let d = Diagnostic::new(
        place(&text, at)?,
        format!("`{c}` is not a character of the language"),
    );
    Some(match written(c) {
        Some(remedy) => d.help(remedy),
        None => d.help("names consist of letters, digits and `_`"),
    })
}

/// The text in single quotes that begins at this byte, with its quotes. A quote behind a name or a bracket is a prime.
fn in_single_quotes(text: &str, at: usize) -> Option<&str> {
    let before = text.get(..at)?.chars().next_back();
    let is_prime = |c: char| c.is_alphanumeric() || matches!(c, '_' | ')' | ']' | '\'');
    if before.is_some_and(is_prime) {
        return None;
    }
    let line = text.get(at..)?.lines().next()?;
    let inside = line.strip_prefix('\'')?;
    let length = inside.find('\'').filter(|length| *length > 0)?;
    line.get(..length + 2)
}

#[cfg(test)]
mod tests {
    use crate::syntax::tokens;

    #[test]
    fn a_character_of_a_paper_is_pointed_at() {
        for (source, column, said) in [
            ("model M { lagrangian = a − b; }", 26, "ASCII minus sign"),
            ("model M { param ω₀: Real; }", 18, "`w_0`"),
            ("model M { let a = q' - q; }", 20, "`next(x)`"),
            ("model M { let a = (q)' - q'; }", 22, "`next(x)`"),
            (
                "model M { given f(Real): Real = 'sin(x)'; }",
                33,
                "`'sin(x)'`",
            ),
            (
                "model M { param m: Real as 'm_0'; }",
                28,
                "in double quotes",
            ),
            ("model M { let a = x²; }", 20, "`a^2`"),
            ("model M { let a = cos(30°); }", 25, "30*pi/180"),
            ("model M { let a = ⟨x, x⟩; }", 19, "`dot(a, b)`"),
            ("model M { let a = \u{1f600}; }", 19, "letters, digits"),
        ] {
            let errors = tokens(source).map(|_| ()).unwrap_err();
            let first = errors.iter().next().unwrap();
            assert_eq!(first.place.line_and_column(), (1, column), "{source}");
            assert!(errors.to_string().contains(said), "{source}: {errors}");
        }
        // Comments and strings may contain any character.
        assert!(tokens("model M { // a − b\n let a = m as \"ω₀\"; }").is_ok());
    }
}
