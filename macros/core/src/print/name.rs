//! Names of letters: from `Lambda1`, `J^R_{k+1}` or `gU` to a base letter or word, subscripts and
//! a superscript. Greek words become Greek letters, trailing digits become subscripts.

use super::layout::{Layout, Sign};
use crate::expr::symbol::GREEK;

/// A name in its parts.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Parsed {
    /// A letter, or a word of several.
    pub base: String,
    /// Subscripts in order, as text.
    pub subs: Vec<String>,
    /// Superscript, as text.
    pub sup: Option<String>,
}

/// The Greek letter of a word such as `Lambda`, or the word itself.
pub(super) fn letter(word: &str) -> String {
    match GREEK.iter().find(|(_, name)| *name == word) {
        Some((greek, _)) => greek.to_string(),
        None => word.to_owned(),
    }
}

/// Takes a name apart.
pub(super) fn parse(text: &str) -> Parsed {
    let end = text
        .char_indices()
        .position(|(at, c)| at > 0 && matches!(c, '_' | '^'))
        .unwrap_or_else(|| text.chars().count());
    let stem: String = text.chars().take(end).collect();
    let base = stem.trim_end_matches(|c: char| c.is_ascii_digit());
    let (base, digits) = if base.is_empty() {
        (stem.as_str(), "")
    } else {
        stem.split_at(base.len())
    };
    let mut parsed = Parsed {
        base: letter(base),
        subs: Vec::new(),
        sup: None,
    };
    if !digits.is_empty() {
        parsed.subs.push(digits.to_owned());
    }
    let mut rest = text.chars().skip(end).peekable();
    while let Some(mark) = rest.next() {
        let mut script = String::new();
        if rest.next_if_eq(&'{').is_some() {
            script.extend(rest.by_ref().take_while(|c| *c != '}'));
        } else {
            while let Some(c) = rest.next_if(|c| !matches!(c, '_' | '^')) {
                script.push(c);
            }
        }
        match mark {
            _ if script.is_empty() => {}
            '^' => parsed.sup = Some(script),
            _ => parsed.subs.push(script),
        }
    }
    parsed
}

/// The text of a script, such as `k+1` or `ref`, in its tokens.
pub(super) fn script(text: &str) -> Layout {
    let mut row = Vec::new();
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        let same = |class: fn(char) -> bool, rest: &mut std::iter::Peekable<std::str::Chars>| {
            let mut run = c.to_string();
            while let Some(d) = rest.next_if(|d| class(*d)) {
                run.push(d);
            }
            run
        };
        if c.is_alphabetic() {
            let word = letter(&same(char::is_alphabetic, &mut rest));
            row.push(match word.chars().count() {
                1 => Layout::Identifier(word),
                _ => Layout::Word(word),
            });
        } else if c.is_ascii_digit() {
            row.push(Layout::Number(same(|d| d.is_ascii_digit(), &mut rest)));
        } else if !c.is_whitespace() {
            row.push(Layout::Sign(Sign::Tight(c)));
        }
    }
    Layout::row(row)
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn names_are_taken_apart() {
        let parts = |text: &str| {
            let p = parse(text);
            (p.base, p.subs.join(","), p.sup.unwrap_or_default())
        };
        let owned = |a: &str, b: &str, c: &str| (a.to_owned(), b.to_owned(), c.to_owned());
        assert_eq!(parts("Λ1"), owned("Λ", "1", ""));
        assert_eq!(parts("Lambda12"), owned("Λ", "12", ""));
        assert_eq!(parts("gU"), owned("gU", "", ""));
        assert_eq!(parts("J^R_{k+1}"), owned("J", "k+1", "R"));
        assert_eq!(parts("Γ_ref"), owned("Γ", "ref", ""));
        assert_eq!(parts("chi0_k"), owned("χ", "0,k", ""));
        assert_eq!(parts("3"), owned("3", "", ""));
        assert_eq!(parts("_"), owned("_", "", ""));
        assert_eq!(parts(""), owned("", "", ""));
    }
}
