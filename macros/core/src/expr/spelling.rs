//! How a name is interpreted for printing: `Lambda1`, `J^R_{k+1}` or `gU` is split into a base letter or word,
//! subscripts and a superscript. Greek words become Greek letters, trailing digits become subscripts. Two names that
//! print alike are the same name to a reader, however they are spelled.

mod confusable;
mod typeset;

use super::symbol::GREEK;
pub(crate) use confusable::{skeleton, twin};
pub(crate) use typeset::seen_typeset;

/// A name in its parts.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Parsed {
    /// A letter or a word.
    pub base: String,
    /// Subscripts in order, as text.
    pub subs: Vec<String>,
    /// Superscript, as text.
    pub sup: Option<String>,
}

/// The sign of an increment, before the name of the quantity.
pub(crate) const INCREMENT: char = 'Δ';

/// The Greek letter of a word such as `Lambda`, or the word itself; for an increment such as `Δphi`, `Δ` and the
/// Greek letter of its name.
pub(crate) fn letter(word: &str) -> String {
    let (increment, of) = match word.strip_prefix(INCREMENT) {
        Some(of) => (true, of),
        None => (false, word),
    };
    match GREEK.iter().find(|(_, name)| *name == of) {
        Some((greek, _)) if increment => format!("{INCREMENT}{greek}"),
        Some((greek, _)) => greek.to_string(),
        None => word.to_owned(),
    }
}

/// A name in a sentence, with Greek words as letters: `theta_dot` becomes `θ_dot`.
pub(crate) fn in_words(name: &str) -> String {
    let mut out = String::new();
    let mut word = String::new();
    for c in name.chars().map(Some).chain([None]) {
        match c {
            Some(c) if c.is_alphabetic() => word.push(c),
            other => {
                out.push_str(&letter(&std::mem::take(&mut word)));
                out.extend(other);
            }
        }
    }
    out
}

/// Splits a name into its parts.
pub(crate) fn parse(text: &str) -> Parsed {
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

/// Splits the name of a copy of a quantity at a site and puts the site in brackets, for use if another name prints
/// alike.
pub(crate) fn parse_apart(text: &str) -> Parsed {
    let mut parsed = parse(text);
    if let Some(site) = parsed.subs.last_mut() {
        *site = format!("({site})");
    }
    parsed
}

/// Greek letters that look Latin, which LaTeX prints as Latin letters.
const LATIN: [(char, char); 15] = [
    ('Α', 'A'),
    ('Β', 'B'),
    ('Ε', 'E'),
    ('Ζ', 'Z'),
    ('Η', 'H'),
    ('Ι', 'I'),
    ('Κ', 'K'),
    ('Μ', 'M'),
    ('Ν', 'N'),
    ('Ο', 'O'),
    ('Ρ', 'P'),
    ('Τ', 'T'),
    ('Υ', 'Y'),
    ('Χ', 'X'),
    ('ο', 'o'),
];

fn latin(text: &str) -> String {
    let twin = |c: char| LATIN.iter().find(|(greek, _)| *greek == c).map(|(_, l)| *l);
    text.chars().map(|c| twin(c).unwrap_or(c)).collect()
}

/// The text of a script with Greek words as letters.
fn script(text: &str) -> String {
    let mut out = String::new();
    let mut word = String::new();
    for c in text.chars().chain([' ']) {
        if c.is_alphabetic() {
            word.push(c);
            continue;
        }
        out.push_str(&letter(&std::mem::take(&mut word)));
        if !c.is_whitespace() {
            out.push(c);
        }
    }
    out
}

/// The appearance of a base with scripts. A trailing time index `k`, `k+1` or `k-1` is omitted, because a moving
/// quantity always gets one.
fn shown(base: &str, mut below: Vec<String>, above: &str, index: &str) -> String {
    let last = below.last().map(|l| {
        let stem = l.trim_end_matches("+1").trim_end_matches("-1");
        let rest = Some(index).filter(|i| !i.is_empty());
        let rest = rest
            .and_then(|i| stem.strip_suffix(i))
            .map(|r| r.trim_end_matches(','));
        rest.filter(|r| r.chars().all(|c| c.is_ascii_digit()))
            .map(str::to_owned)
    });
    if let Some(Some(rest)) = last {
        below.pop();
        below.extend(Some(rest).filter(|r| !r.is_empty()));
    }
    latin(&format!("{base}_{}^{above}", below.join(",")))
}

/// A name as a reader sees it: one text for all spellings that print alike. `index` is the time index.
pub(crate) fn seen(text: &str, index: &str) -> String {
    seen_as(&parse(&skeleton(text)), index)
}

/// The copy of a quantity at a site, with the site in brackets, as a reader sees it.
pub(crate) fn seen_apart(text: &str, index: &str) -> String {
    seen_as(&parse_apart(&skeleton(text)), index)
}

fn seen_as(parsed: &Parsed, index: &str) -> String {
    let below = parsed.subs.iter().map(|s| script(s)).collect();
    let above = parsed.sup.as_deref().map(script).unwrap_or_default();
    shown(&parsed.base, below, &above, index)
}

#[cfg(test)]
mod tests {
    use super::{parse, seen};

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

    #[test]
    fn spellings_that_print_alike_are_one_name() {
        for (a, b) in [
            ("mu", "μ"),
            ("mu1", "μ_1"),
            ("mu_1", "μ1"),
            ("x_mu", "x_{μ}"),
            ("chi_0k", "χ_{0 k}"),
            ("J^R_{k+1}", "J_{k+1}^R"),
            ("Mu", "M"),
            // A time index belongs to moving quantities.
            ("x_k", "x"),
            ("x_{k+1}", "x"),
            ("x1_k", "x_1"),
            // Other characters of the same shape.
            ("µ", "μ"),
            ("Ω", "\u{2126}"),
            ("K", "\u{212a}"),
            ("𝑥_1", "x1"),
            ("ｘ", "x"),
            ("а", "a"),
            ("Гx", "Γx"),
            ("é", "e\u{301}"),
            ("ı", "i"),
            ("ϐ", "β"),
        ] {
            assert_eq!(seen(a, "k"), seen(b, "k"), "{a} {b}");
        }
        for (a, b) in [
            ("mu", "nu"),
            ("mu", "mu1"),
            ("Mu", "mu"),
            ("x_1", "x^1"),
            ("x_k", "y"),
            ("x_ok", "x_o"),
            ("x_n", "x"),
            ("ϕ", "φ"),
            ("ϵ", "ε"),
            ("ϑ", "θ"),
            ("ϖ", "π"),
            ("ϱ", "ρ"),
            ("ς", "σ"),
            ("ℓ", "l"),
            ("I", "l"),
            ("ρ", "p"),
            ("é", "e"),
            ("ж", "x"),
        ] {
            assert_ne!(seen(a, "k"), seen(b, "k"), "{a} {b}");
        }
        assert_eq!(seen("x_n", "n"), seen("x", "n"));
    }
}
