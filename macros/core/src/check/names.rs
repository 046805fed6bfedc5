//! Names that a model cannot use: reserved in the language, in derivations or in Rust, or with letters that look like
//! other letters.

use super::messages;
use crate::diagnostic::{Diagnostic, Errors};
use crate::expr::spelling::{seen, twin};
use crate::syntax::ast::Name;
use crate::syntax::{FUNCTIONS, HIDEABLE};

/// Names with a fixed meaning.
const RESERVED: [&str; 5] = ["Id", "T", "E1", "E2", "E3"];

/// The signs that derivations print for the action, the identity and unit vectors.
pub(super) const PRINTED: [&str; 10] = ["ℓ", "Id", "E1", "E2", "E3", "E4", "E5", "E6", "E7", "E8"];

/// Words that cannot name a field, method or local of the emitted Rust.
const RUST: [&str; 53] = [
    "_", "Self", "abstract", "as", "async", "await", "become", "box", "break", "const", "continue",
    "crate", "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if",
    "impl", "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub",
    "ref", "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// Whether the word is a reserved word of Rust.
pub fn is_rust_word(name: &str) -> bool {
    RUST.contains(&name)
}

/// The error for a name that is invalid regardless of the other declarations.
pub(super) fn unusable(name: &Name) -> Option<Diagnostic> {
    let text = name.text.as_str();
    let function = FUNCTIONS.contains(&text) && !HIDEABLE.contains(&text);
    let shown = seen(text, "");
    // A copy with such a name prints its site in brackets instead.
    let printed = PRINTED
        .into_iter()
        .find(|sign| !name.is_copy && seen(sign, "") == shown);
    if RESERVED.contains(&text) || function {
        return Some(messages::reserved(name));
    }
    let message = if let Some(sign) = printed {
        format!("`{text}` prints like `{sign}`, which has a fixed meaning in derivations")
    } else if RUST.contains(&text) {
        format!("`{text}` is a Rust keyword and cannot be used as a name")
    } else {
        return None;
    };
    Some(Diagnostic::new(name.place, message).help("choose another name"))
}

/// Describes characters of two names that look the same but differ, with their code points.
pub(super) fn foreign(a: &str, b: &str) -> Option<String> {
    let strange = |text: &str| text.chars().find(|c| twin(*c).is_some());
    let c = strange(a).or_else(|| strange(b))?;
    let plain = twin(c)?;
    Some(format!(
        "`{c}` is U+{:04X}; it looks like `{plain}`, U+{:04X}, but is another character: write `{plain}` everywhere",
        u32::from(c),
        u32::from(plain)
    ))
}

/// Checks the model's name, which becomes the name of a type.
pub(super) fn model_name(name: &Name, errors: &mut Errors) {
    if RUST.contains(&name.text.as_str()) {
        errors.extend(unusable(name));
    } else if !name.text.starts_with(char::is_uppercase) {
        let mut letters = name.text.chars();
        let first = letters.next().into_iter().flat_map(char::to_uppercase);
        let capital: String = first.chain(letters).collect();
        let d = Diagnostic::new(
            name.place,
            format!(
                "`{}` is the name of a model: it must start with a capital letter",
                name.text
            ),
        );
        errors.push(d.help(match capital.starts_with(char::is_uppercase) {
            true => format!("write `model {capital}`"),
            false => "write for example `model HeavyTop`".to_owned(),
        }));
    }
}
