//! Parses LaTeX names into layouts for formats other than LaTeX: letters, Greek and other signs, scripts, accents and
//! fonts. Unknown commands are shown by name.

use super::layout::{Layout, Sign};
use crate::expr::symbol::GREEK;

/// Signs besides the Greek letters.
const SIGNS: [(&str, &str); 14] = [
    ("varepsilon", "ε"),
    ("epsilon", "ϵ"),
    ("varphi", "φ"),
    ("phi", "ϕ"),
    ("ell", "ℓ"),
    ("hbar", "ħ"),
    ("partial", "∂"),
    ("nabla", "∇"),
    ("infty", "∞"),
    ("prime", "′"),
    ("dagger", "†"),
    ("circ", "∘"),
    ("parallel", "∥"),
    ("perp", "⊥"),
];

/// Accents and their combining characters.
const ACCENTS: [(&str, char); 6] = [
    ("bar", '\u{304}'),
    ("overline", '\u{304}'),
    ("tilde", '\u{303}'),
    ("vec", '\u{20d7}'),
    ("dot", '\u{307}'),
    ("ddot", '\u{308}'),
];

/// The layout of a name; several pieces become a row.
pub(super) fn layout(latex: &str) -> Layout {
    row(&mut Rest(latex.chars().peekable()), false)
}

struct Rest<'a>(std::iter::Peekable<std::str::Chars<'a>>);

/// Parses up to a closing brace, or to the end.
fn row(rest: &mut Rest, inside: bool) -> Layout {
    let mut parts: Vec<Layout> = Vec::new();
    while let Some(c) = rest.0.next() {
        match c {
            '}' if inside => break,
            '_' | '^' => {
                let script = argument(rest);
                let base = parts.pop().unwrap_or_else(|| Layout::Row(Vec::new()));
                parts.push(match c {
                    '_' => below(base, script),
                    _ => base.superscript(script),
                });
            }
            c if c.is_whitespace() => {}
            c => parts.push(piece(c, rest)),
        }
    }
    let mut spaced = Vec::new();
    for part in parts {
        if !spaced.is_empty() && !matches!(part, Layout::Sign(_)) {
            spaced.push(Layout::Sign(Sign::Thin));
        }
        spaced.push(part);
    }
    Layout::row(spaced)
}

/// Adds a subscript, also to a base that already has a superscript.
fn below(base: Layout, script: Layout) -> Layout {
    match base {
        Layout::Script {
            base,
            sub: None,
            sup,
        } => Layout::Script {
            base,
            sub: Some(Box::new(script)),
            sup,
        },
        plain => plain.subscript(script),
    }
}

/// The argument of a script or a command: a group in braces, or one piece.
fn argument(rest: &mut Rest) -> Layout {
    while rest.0.next_if(|c| c.is_whitespace()).is_some() {}
    match rest.0.next() {
        Some('{') => row(rest, true),
        Some(c) => piece(c, rest),
        None => Layout::Row(Vec::new()),
    }
}

fn piece(c: char, rest: &mut Rest) -> Layout {
    match c {
        '{' => row(rest, true),
        '\\' => command(rest),
        '\'' => Layout::Identifier("′".to_owned()),
        c if c.is_ascii_digit() => {
            let mut digits = c.to_string();
            while let Some(d) = rest.0.next_if(char::is_ascii_digit) {
                digits.push(d);
            }
            Layout::Number(digits)
        }
        c if c.is_alphabetic() => Layout::Identifier(c.to_string()),
        c => Layout::Sign(Sign::Tight(c)),
    }
}

fn command(rest: &mut Rest) -> Layout {
    let mut word = String::new();
    while let Some(c) = rest.0.next_if(char::is_ascii_alphabetic) {
        word.push(c);
    }
    if word.is_empty() {
        // `\,` and similar commands: a space.
        rest.0.next();
        return Layout::Sign(Sign::Thin);
    }
    // The engine's plain Greek letters correspond to LaTeX's `\var...` forms.
    let signs = SIGNS
        .map(|(name, sign)| (name, sign.to_owned()))
        .into_iter();
    let mut signs = signs.chain(GREEK.iter().map(|(c, name)| (*name, c.to_string())));
    if let Some((_, sign)) = signs.find(|(name, _)| *name == word) {
        return Layout::Identifier(sign);
    }
    match word.as_str() {
        "cdot" => Layout::Sign(Sign::Dot),
        "times" => Layout::Sign(Sign::Cross),
        "hat" | "widehat" => Layout::Hat(Box::new(argument(rest))),
        "mathrm" | "text" | "operatorname" | "mathsf" => {
            while rest.0.next_if(|c| c.is_whitespace()).is_some() {}
            let mut inside = String::new();
            if rest.0.next_if_eq(&'{').is_some() {
                inside.extend(rest.0.by_ref().take_while(|c| *c != '}'));
            } else {
                inside.extend(rest.0.next());
            }
            Layout::Word(inside)
        }
        "mathbf" | "boldsymbol" | "bm" | "mathit" | "mathcal" | "mathbb" => argument(rest),
        other => match ACCENTS.iter().find(|(name, _)| *name == other) {
            Some((_, accent)) => accented(argument(rest), *accent),
            None => Layout::Word(other.to_owned()),
        },
    }
}

/// Places an accent on a single letter; longer layouts omit it.
fn accented(layout: Layout, accent: char) -> Layout {
    match layout {
        Layout::Identifier(mut s) if s.chars().count() == 1 => {
            s.push(accent);
            Layout::Identifier(s)
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::layout;
    use crate::print::unicode::line;

    #[test]
    fn names_are_shown_without_latex() {
        for (latex, shown) in [
            ("m g \\chi", "m g χ"),
            ("J_1", "J₁"),
            ("J_{\\mathrm{eff}}^2", "J_{eff}²"),
            ("\\hat\\omega", "hat(ω)"),
            ("\\bar{x}", "x\u{304}"),
            ("\\mathcal{I}_{12}", "I₁₂"),
            ("\\unknown", "unknown"),
            ("a'", "a ′"),
            ("{", ""),
            ("_2", "₂"),
            ("\\", " "),
        ] {
            assert_eq!(line(&layout(latex)), shown, "{latex}");
        }
    }
}
