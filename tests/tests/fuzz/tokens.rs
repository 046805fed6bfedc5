//! Random token streams and mutations of valid models, from a seeded source. Texts have at most 10 kB and consist of tokens of the
//! model language, of Rust, and of valid models.

use clebsch_oracle::oracle::action::bodies::{
    FourDimensional, FreeBody, HeavyTop, QuadraticField, Stated, TwoVectors,
};
use clebsch_oracle::oracle::action::coupled::CoupledBodies;
use clebsch_oracle::oracle::action::elastic::{EllipsoidConvective, EllipsoidSpatial};
use clebsch_oracle::oracle::action::spatial::{FreeBodySpatial, HeavyTopSpatial};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::wide::Model;

/// Maximum length of a text.
const LONGEST: usize = 10_000;

/// Words of the model language and similar words.
const WORDS: [&str; 118] = [
    "model",
    "pub",
    "dim",
    "in",
    "time",
    "step",
    "label",
    "periodic",
    "offset",
    "grid",
    "param",
    "at",
    "assume",
    "group",
    "velocity",
    "strain",
    "field",
    "on",
    "torus",
    "box",
    "advected",
    "constraint",
    "next",
    "prev",
    "let",
    "hold",
    "given",
    "mesh",
    "linear",
    "selfadjoint",
    "scale",
    "node",
    "symmetric",
    "incoming",
    "outgoing",
    "integrate",
    "slaved",
    "lagrangian",
    "end",
    "nodes",
    "segments",
    "Real",
    "Vec",
    "Sym",
    "Skew",
    "Diag",
    "Mat",
    "SO",
    "SU",
    "GL",
    "SE",
    "tr",
    "det",
    "log",
    "exp",
    "sqrt",
    "inv",
    "sym",
    "skew",
    "diag",
    "hat",
    "vee",
    "dot",
    "cross",
    "perp",
    "re",
    "im",
    "I1",
    "I2",
    "rate",
    "sum",
    "Id",
    "E1",
    "E2",
    "E3",
    "E4",
    "T",
    "h",
    "k",
    "n",
    "N",
    "J",
    "z",
    "gU",
    "Λ",
    "Ω",
    "ω",
    "Γ",
    "χ",
    "a",
    "b",
    "HeavyTop",
    "FreeBody",
    "fn",
    "struct",
    "match",
    "self",
    "Self",
    "crate",
    "unsafe",
    "r#type",
    "'a",
    "\"text\"",
    "'x'",
    "b\"bytes\"",
    "macro_rules",
    "_",
    "__",
    "Ωᵀ",
    "Λ1",
    "R",
    "K",
    "S",
    "M",
    "w",
    "q",
    "ξ",
    "D",
];

/// Punctuation and number literals.
const SIGNS: [&str; 62] = [
    ";",
    ";",
    ";",
    ":",
    ":",
    "=",
    "=",
    ",",
    ",",
    "+",
    "-",
    "*",
    "*",
    "/",
    "^",
    "^",
    "^T",
    "^-1",
    "^2",
    "..",
    "..=",
    "->",
    "=>",
    "::",
    "!",
    "#",
    "?",
    "&",
    "&&",
    "|",
    "~",
    "@",
    "$",
    "%",
    ".",
    "<",
    ">",
    "<<",
    ">>",
    "<3>",
    "<2>",
    "<n>",
    "0",
    "1",
    "2",
    "3",
    "4",
    "0.5",
    "1e3",
    "1e400",
    "2e3x",
    "0x10",
    "1_000",
    "3.0f64",
    "7u8",
    "18446744073709551616",
    "99999999999999999999999999999999999999999",
    "//",
    "/*",
    "*/",
    "\\",
    "`",
];

/// One random word or sign.
fn token(source: &mut Source) -> &'static str {
    let signs = source.chance(45);
    let choices: &[&'static str] = if signs { &SIGNS } else { &WORDS };
    source.choose(choices).copied().unwrap_or(";")
}

/// Random tokens, nested in delimiters that mostly match.
fn nest(source: &mut Source, depth: usize, text: &mut String) {
    let count = source.below(14);
    for _ in 0..count {
        if text.len() > LONGEST - 200 {
            return;
        }
        if depth < 12 && source.chance(22) {
            let pair = source.choose(&[("(", ")"), ("{", "}"), ("[", "]"), ("<", ">")]);
            let (open, close) = pair.copied().unwrap_or(("(", ")"));
            text.push_str(open);
            nest(source, depth + 1, text);
            text.push_str(if source.chance(97) { close } else { "]" });
        } else {
            text.push_str(token(source));
        }
        text.push_str(if source.chance(95) { " " } else { "" });
    }
}

/// A random token stream: bare, or as the body or the Lagrangian of a model.
pub fn stream(source: &mut Source) -> String {
    let mut inner = String::new();
    let blocks = 1 + source.below(6);
    for _ in 0..blocks {
        nest(source, 0, &mut inner);
    }
    match source.below(4) {
        0 => inner,
        1 => format!("model Noise {{ {inner} }}"),
        2 => {
            let end = if source.chance(50) { ";" } else { "" };
            format!(
                "model Noise {{ param J: Sym<3>; group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω; {inner} {end} lagrangian = -tr(J*Ω)/h; }}"
            )
        }
        _ => format!(
            "model Noise {{ param J, K: Sym<3>; param z: Vec<3>; group Λ: SO<3> velocity Ω; advected Γ: Vec<3> = Λ^T*z; constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ; lagrangian = {inner}; }}"
        ),
    }
}

/// Valid models: the hand-written systems of the oracle, and random models.
pub fn models() -> Vec<String> {
    let mut models = vec![
        FreeBody::text(),
        <HeavyTop<0>>::text(),
        <HeavyTop<1>>::text(),
        <HeavyTop<2, true>>::text(),
        QuadraticField::text(),
        TwoVectors::text(),
        FourDimensional::text(),
        <CoupledBodies<true>>::text(),
        <CoupledBodies<false>>::text(),
        FreeBodySpatial::text(),
        HeavyTopSpatial::text(),
        <EllipsoidConvective<3>>::text(),
        EllipsoidSpatial::text(),
    ];
    models.extend((0..40).map(|seed| Model::of_seed(seed).text()));
    models
}

/// Splits a model into words, numbers and single punctuation characters.
pub fn lex(text: &str) -> Vec<String> {
    let mut tokens: Vec<String> = Vec::new();
    let mut word = false;
    for letter in text.chars() {
        let part = letter.is_alphanumeric() || letter == '_' || letter == '.';
        if letter.is_whitespace() {
            word = false;
        } else if part && word {
            if let Some(last) = tokens.last_mut() {
                last.push(letter);
            }
        } else {
            tokens.push(letter.to_string());
            word = part;
        }
    }
    tokens
}

/// The class of tokens that a token may be replaced with.
fn kind_of(token: &str) -> u8 {
    match token.chars().next() {
        Some(first) if first.is_ascii_digit() => 0,
        Some(first) if first.is_alphabetic() => 1,
        Some('+' | '-' | '*' | '/') => 2,
        _ => 3,
    }
}

/// A model with a few token mutations.
pub fn mutate(source: &mut Source, models: &[Vec<String>]) -> String {
    let mut tokens = source.choose(models).cloned().unwrap_or_default();
    let mutations = if source.chance(60) {
        1
    } else {
        1 + source.below(6)
    };
    for _ in 0..mutations {
        let (here, there) = (source.below(tokens.len()), source.below(tokens.len()));
        if tokens.is_empty() {
            break;
        }
        let donor = source
            .choose(models)
            .and_then(|model| source.choose(model))
            .cloned();
        match source.below(18) {
            13..=17 => {
                // Replaces the token with another of the same kind from the same model; many results are still valid
                // models.
                let kind = kind_of(&tokens[here]);
                let alike: Vec<String> = tokens
                    .iter()
                    .filter(|other| kind_of(other) == kind)
                    .cloned()
                    .collect();
                tokens[here] = source.choose(&alike).cloned().unwrap_or_default();
            }
            0 | 1 => drop(tokens.remove(here)),
            2 => tokens.insert(here, tokens[here].clone()),
            3 => tokens.swap(here, there),
            4 => tokens[here] = token(source).to_owned(),
            5 | 6 => tokens[here] = donor.unwrap_or_default(),
            7 => tokens[here] = tokens[there].clone(),
            8 => tokens.truncate(here),
            9 => {
                // Repeats a run of tokens several times.
                let length = 1 + source.below(12);
                let run: Vec<String> = tokens.iter().skip(here).take(length).cloned().collect();
                let times = 1 + source.below(8);
                for _ in 0..times {
                    tokens.splice(here..here, run.iter().cloned());
                }
            }
            10 => {
                let depth = 1 + source.below(120);
                let (open, close) = if source.chance(80) {
                    ("(", ")")
                } else {
                    ("{", "}")
                };
                tokens.splice(here..here, std::iter::repeat_n(open.to_owned(), depth));
                let after = (here + depth + 1).min(tokens.len());
                tokens.splice(after..after, std::iter::repeat_n(close.to_owned(), depth));
            }
            11 => tokens.insert(here, token(source).to_owned()),
            _ => drop(tokens.drain(here.min(there)..here.max(there))),
        }
    }
    let mut text = tokens.join(" ");
    while text.len() > LONGEST {
        text.pop();
    }
    text
}
