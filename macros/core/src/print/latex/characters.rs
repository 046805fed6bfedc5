//! LaTeX for single characters, names and words: commands for Greek letters and signs, and escapes for LaTeX's
//! special characters.

use crate::expr::spelling::twin;
use crate::expr::symbol::{GREEK, greek_command};

/// The accent at the end of a name, as commands for one letter and for several letters, and the name without it.
fn accent(s: &str) -> Option<((&'static str, &'static str), &str)> {
    const ACCENTS: [(char, &str, &str); 2] = [
        ('\u{304}', "bar", "overline"),
        ('\u{20d7}', "vec", "overrightarrow"),
    ];
    let found = |(mark, narrow, wide): &(char, &'static str, &'static str)| {
        Some(((*narrow, *wide), s.strip_suffix(*mark)?))
    };
    ACCENTS
        .iter()
        .find_map(found)
        .filter(|(_, rest)| !rest.is_empty())
}

/// A letter, or several letters set as one name.
pub(super) fn identifier(s: &str) -> String {
    let mut chars = s.chars();
    match (chars.next(), chars.next()) {
        (Some(only), None) => symbol_of(only, false),
        _ => {
            if let Some(((narrow, wide), rest)) = accent(s) {
                let command = match rest.chars().count() {
                    1 => narrow,
                    _ => wide,
                };
                return format!("\\{command}{{{}}}", identifier(rest));
            }
            let letters = s.chars().map(|c| symbol_of(c, false));
            format!("\\mathit{{{}}}", joined(letters))
        }
    }
}

/// A character in math mode (`words` is false) or within a sentence.
pub(super) fn symbol_of(c: char, words: bool) -> String {
    let math = |m: &str| {
        if words {
            format!("${m}$")
        } else {
            m.to_owned()
        }
    };
    if let Some((_, greek)) = GREEK.iter().find(|(g, _)| *g == c) {
        return math(&greek_command(greek));
    }
    if let Some((_, command)) = SYMBOLS.iter().find(|(s, _)| *s == c) {
        return math(command);
    }
    // Subscript and superscript digits, and subscript letters, become scripts on an empty base.
    if let Some(digit) = (u32::from(c)).checked_sub(0x2080).filter(|d| *d < 10) {
        return math(&format!("{{}}_{{{digit}}}"));
    }
    if let Some(digit) = (u32::from(c)).checked_sub(0x2070).filter(|d| *d < 10) {
        return math(&format!("{{}}^{{{digit}}}"));
    }
    if let Some((_, index)) = INDICES.iter().find(|(i, _)| *i == c) {
        return math(&format!("{{}}_{{{index}}}"));
    }
    match c {
        '#' | '$' | '%' | '&' | '_' | '{' | '}' => format!("\\{c}"),
        '\\' if words => "\\textbackslash{}".to_owned(),
        '~' if words => "\\textasciitilde{}".to_owned(),
        '^' if words => "\\textasciicircum{}".to_owned(),
        '\\' => "\\backslash ".to_owned(),
        '~' => "\\sim ".to_owned(),
        '^' => "\\wedge ".to_owned(),
        '<' | '>' | '|' if words => format!("${c}$"),
        _ if c.is_ascii() => c.to_string(),
        // The micro sign is the letter mu, and the ohm sign the letter omega.
        _ if twin(c).is_some_and(|t| t.is_ascii() || GREEK.iter().any(|(g, _)| *g == t)) => {
            symbol_of(twin(c).unwrap_or(c), words)
        }
        _ if words => c.to_string(),
        _ => format!("\\text{{{c}}}"),
    }
}

/// Subscript letters.
const INDICES: [(char, char); 4] = [('ᵢ', 'i'), ('ⱼ', 'j'), ('ₖ', 'k'), ('ₙ', 'n')];

/// Characters that plain LaTeX can only set with a command.
const SYMBOLS: [(char, &str); 36] = [
    ('ℓ', "\\ell"),
    ('∂', "\\partial"),
    ('∇', "\\nabla"),
    ('∑', "\\sum"),
    ('√', "\\surd"),
    ('∞', "\\infty"),
    ('·', "\\cdot"),
    ('×', "\\times"),
    ('◇', "\\diamond"),
    ('⋄', "\\diamond"),
    ('∘', "\\circ"),
    ('⊗', "\\otimes"),
    ('∈', "\\in"),
    ('→', "\\to"),
    ('↦', "\\mapsto"),
    ('⟹', "\\implies"),
    ('≤', "\\le"),
    ('≥', "\\ge"),
    ('≠', "\\ne"),
    ('≈', "\\approx"),
    ('≡', "\\equiv"),
    ('±', "\\pm"),
    ('−', "-"),
    ('⟨', "\\langle"),
    ('⟩', "\\rangle"),
    ('ᵀ', "{}^{\\mathsf{T}}"),
    ('⁻', "{}^{-}"),
    ('¹', "{}^{1}"),
    ('²', "{}^{2}"),
    ('³', "{}^{3}"),
    ('½', "\\tfrac{1}{2}"),
    ('⅓', "\\tfrac{1}{3}"),
    ('¼', "\\tfrac{1}{4}"),
    ('°', "{}^{\\circ}"),
    ('ℝ', "\\mathbf{R}"),
    ('⋉', "\\rtimes"),
];

/// Words of a sentence.
pub(super) fn text(s: &str) -> String {
    let signs: String = s.chars().map(|c| symbol_of(c, true)).collect();
    one_formula(&signs)
}

/// Merges adjacent inline formulas into one; an escaped dollar sign does not end a formula.
fn one_formula(signs: &str) -> String {
    let mut parts = signs.split("$$");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        if out.ends_with('\\') {
            out.push_str("$$");
        } else if out.ends_with(|c: char| c.is_ascii_alphabetic())
            && part.starts_with(|c: char| c.is_ascii_alphabetic())
        {
            out.push(' ');
        }
        out.push_str(part);
    }
    out
}

/// Inline mathematics as it is written in plain words: `2/h² skew`, `Ad*`, `Ωᵀ P`.
pub(super) fn spelt(s: &str) -> String {
    let mut out: Vec<String> = Vec::new();
    let mut rest = s.chars().peekable();
    while let Some(c) = rest.next() {
        let mut word = c.to_string();
        if c.is_ascii_alphabetic() {
            while let Some(more) = rest.next_if(char::is_ascii_alphabetic) {
                word.push(more);
            }
        }
        out.push(match (word.as_str(), word.len()) {
            (" ", _) => "\\,".to_owned(),
            ("*", _) => "^{*}".to_owned(),
            (several, 2..) if c.is_ascii_alphabetic() => format!("\\operatorname{{{several}}}"),
            _ => symbol_of(c, false),
        });
    }
    joined(out.into_iter())
}

/// Words of a sentence, with arrows and names of groups set as mathematics.
pub(super) fn prose(s: &str) -> String {
    let mut out = String::new();
    let mut rest = s;
    while let Some(c) = rest.chars().next() {
        if let Some(after) = rest.strip_prefix("->") {
            out.push_str("$\\to$");
            rest = after;
            continue;
        }
        // `SO(3)`, `GL(n)`: but not directly after a letter.
        let begins = !out.ends_with(|c: char| c.is_ascii_alphanumeric());
        let group = GROUPS.iter().filter(|_| begins).find_map(|g| {
            let size = rest.strip_prefix(g)?.strip_prefix('(')?.split_once(')')?.0;
            let plain = size.chars().all(|c| c.is_ascii_alphanumeric());
            (plain && !size.is_empty()).then_some((*g, size))
        });
        match group {
            Some((g, size)) => {
                out.push_str(&format!("$\\mathrm{{{g}}}({size})$"));
                rest = rest.get(g.len() + size.len() + 2..).unwrap_or_default();
            }
            None => {
                out.push_str(&symbol_of(c, true));
                rest = rest.get(c.len_utf8()..).unwrap_or_default();
            }
        }
    }
    one_formula(&out)
}

/// Groups that sentences write with a size.
const GROUPS: [&str; 4] = ["SO", "SU", "SE", "GL"];

/// Concatenates, and inserts a space where a command would run into a letter.
pub(super) fn joined(parts: impl Iterator<Item = String>) -> String {
    let mut out = String::new();
    for part in parts {
        let letter = |c: char| c.is_ascii_alphabetic();
        let tail = out.trim_end_matches(letter);
        if tail.len() < out.len() && tail.ends_with('\\') && part.starts_with(letter) {
            out.push(' ');
        }
        out.push_str(&part);
    }
    out
}
