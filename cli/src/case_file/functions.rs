//! Functions that a case gives: `[functions]` with `b = "0.1*cos(2*pi*x/Lx)"` for `given b(Vec<2>): Real = case;`.
//! Takes the text of a model and a case; gives the text with these expressions, which are differentiated like all
//! others.

use super::location::File;
use super::space::Space;
use super::stated::Stated;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use crate::words::suggestion::did_you_mean;
use clebsch_core::diagnostic::Errors;
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::{Model, Name, Statement};
use clebsch_core::syntax::formula::{self, Open};
use std::fmt::Write as _;
use std::ops::Range;
use toml::Spanned;
use toml::de::DeValue;

/// The table of a case.
pub(super) const TABLE: &str = "functions";

/// The text of a model with its functions filled in, and the position of each of them.
pub(crate) struct Filled {
    /// The text.
    pub text: String,
    /// Byte ranges of the text, each with the key of the case that provided it.
    put: Vec<(Range<usize>, String)>,
}

impl Filled {
    fn unchanged(text: &str) -> Self {
        Filled {
            text: text.to_owned(),
            put: Vec::new(),
        }
    }

    /// The first error inside a function of the case, reported at the key of that function.
    pub(crate) fn wrong_in(&self, errors: &Errors, case: Option<(&str, &str)>) -> Option<Failure> {
        let (name, text) = case?;
        let (diagnostic, key) = errors.iter().find_map(|d| {
            let at = offset(&self.text, d.place.line_and_column())?;
            let mut put = self.put.iter();
            let (_, key) = put.find(|(range, _)| range.contains(&at))?;
            Some((d, key))
        })?;
        let file = File::new(name, text);
        let document = file.document().ok()?;
        let given = file.table(document.get_ref(), TABLE).ok()??;
        let span = given.get(key.as_str())?.span();
        let message = format!("{TABLE}.{key}: {}", diagnostic.text());
        Some(file.wrong(Some(&span), &message))
    }
}

/// The text of a model with its functions filled in, from the case in the file `case` or from samples. The text
/// is unchanged if the case gives no functions, or if the text does not parse; its errors are reported later.
///
/// # Errors
/// Usage: a function is missing, unknown, or not an expression in its argument.
pub(crate) fn put_in(text: &str, case: Option<(&str, &str)>) -> Result<Filled, Failure> {
    let Ok(model) = pipeline::parse_source(text) else {
        return Ok(Filled::unchanged(text));
    };
    let mut open = formula::open(&model).unwrap_or_default();
    open.retain(|f| !f.is_filled);
    if open.is_empty() {
        return Ok(Filled::unchanged(text));
    }
    let stated = Stated::read(text);
    let sides = stated.as_ref().and_then(Space::sample).is_some();
    let written: Vec<Vec<String>> = match case {
        None => open
            .iter()
            .map(|f| {
                let sample = sample(f.components, f.argument.components().unwrap_or(1), sides);
                let lengths = sides.then_some(vec![1.0; 3]);
                let each = sample.iter().map(|e| with_lengths(e, lengths.as_deref()));
                each.collect()
            })
            .collect(),
        Some((name, case)) => of_case(name, case, &model, &open, stated.as_ref())?,
    };
    Ok(replaced(text, &open, &written))
}

/// The expressions of a case, in the order of the functions.
fn of_case(
    name: &str,
    case: &str,
    model: &Model,
    open: &[Open],
    stated: Option<&Stated>,
) -> Result<Vec<Vec<String>>, Failure> {
    let file = File::new(name, case);
    let document = file.document()?;
    let top = document.get_ref();
    let example = |f: &Open| {
        let argument = f.argument.components().unwrap_or(1);
        formula::in_quotes(&sample(f.components, argument, false))
    };
    let Some(given) = file.table(top, TABLE)? else {
        let each = open
            .iter()
            .map(|f| format!("{} = {}", f.name.text, example(f)));
        let message = format!(
            "missing table [{TABLE}] with the functions of the model: for example {}",
            each.collect::<Vec<_>>().join(", ")
        );
        return Err(file.wrong(None, &message));
    };
    for key in given.keys() {
        let asked = key.get_ref().as_ref();
        if !open.iter().any(|f| f.name.text == asked) {
            let hint = did_you_mean(asked, open.iter().map(|f| f.name.text.as_str()));
            let message = format!("unknown key `{TABLE}.{}`{hint}", shown(asked));
            return Err(file.wrong(Some(&key.span()), &message));
        }
    }
    let lengths = match stated {
        Some(stated) => Space::read(&file, top, stated)?.map(|space| space.lengths),
        None => None,
    };
    let parameters = parameters(model);
    open.iter()
        .map(|f| {
            let key = format!("{TABLE}.{}", f.name.text);
            let Some(value) = given.get(f.name.text.as_str()) else {
                let message = format!("missing key `{key}`: for example {}", example(f));
                return Err(file.wrong(None, &message));
            };
            let wrong =
                |message: &str| file.wrong(Some(&value.span()), &format!("{key}: {message}"));
            let texts = texts(value).filter(|t| t.len() == f.components);
            let texts = texts.ok_or_else(|| {
                wrong(&format!(
                    "expected {}: for example {}",
                    match f.components {
                        1 => "an expression in quotes".to_owned(),
                        n => format!("a list of {n} expressions in quotes"),
                    },
                    example(f)
                ))
            })?;
            let known = |n: &str| parameters.iter().any(|p| p == n);
            texts
                .iter()
                .map(|text| {
                    let text = with_lengths(text, lengths.as_deref());
                    match formula::check(&text, &f.argument, &known) {
                        Ok(()) => Ok(text),
                        Err(said) => Err(wrong(&said)),
                    }
                })
                .collect()
        })
        .collect()
}

/// One expression, or a list of them.
fn texts(value: &Spanned<DeValue<'_>>) -> Option<Vec<String>> {
    let one = |value: &DeValue<'_>| match value {
        DeValue::String(text) => Some(text.to_string()),
        DeValue::Float(number) => Some(number.to_string()),
        DeValue::Integer(number) => Some(number.to_string()),
        _ => None,
    };
    match value.get_ref() {
        DeValue::Array(list) => list.iter().map(|v| one(v.get_ref())).collect(),
        other => Some(vec![one(other)?]),
    }
}

/// The parameters of a model that are one number.
fn parameters(model: &Model) -> Vec<String> {
    let of = |s: &Statement| match s {
        Statement::Param { names, shape, .. } if shape.components() == Some(1) => {
            names.iter().map(|n: &Name| n.text.clone()).collect()
        }
        _ => Vec::new(),
    };
    model.statements.iter().flat_map(of).collect()
}

/// A text with the lengths of the domain for `Lx`, `Ly`, `Lz`.
fn with_lengths(text: &str, lengths: Option<&[f64]>) -> String {
    let Some(lengths) = lengths else {
        return text.to_owned();
    };
    let mut out = String::with_capacity(text.len());
    let mut word = String::new();
    let put = |word: &mut String, out: &mut String| {
        let which = ["Lx", "Ly", "Lz"].iter().position(|l| *l == word.as_str());
        match which.and_then(|d| lengths.get(d)) {
            Some(length) => {
                let _ = write!(out, "{length:?}");
            }
            None => out.push_str(word),
        }
        word.clear();
    };
    for c in text.chars() {
        if c.is_alphanumeric() || c == '_' {
            word.push(c);
            continue;
        }
        put(&mut word, &mut out);
        out.push(c);
    }
    put(&mut word, &mut out);
    out
}

/// The text of the model with the expressions inserted after the word `case`. It works backwards, so that
/// earlier positions remain valid.
fn replaced(text: &str, open: &[Open], written: &[Vec<String>]) -> Filled {
    let mut out = text.to_owned();
    let mut all: Vec<(usize, &str, String)> = open
        .iter()
        .zip(written)
        .filter_map(|(f, each)| {
            let list = format!(" {}", formula::in_quotes(each));
            Some((after_word(text, f.at)?, f.name.text.as_str(), list))
        })
        .collect();
    all.sort_by_key(|(at, ..)| *at);
    for (at, _, list) in all.iter().rev() {
        out.insert_str(*at, list);
    }
    let mut before = 0;
    let put = all.iter().map(|(at, name, list)| {
        let start = at + before;
        before += list.len();
        (start..start + list.len(), (*name).to_owned())
    });
    Filled {
        put: put.collect(),
        text: out,
    }
}

/// The byte after the keyword `case` that starts at this line and column.
fn after_word(text: &str, place: (usize, usize)) -> Option<usize> {
    let at = offset(text, place)?;
    text.get(at..)?.starts_with("case").then_some(at + 4)
}

/// A line and a column, counted from 1, in bytes.
fn offset(text: &str, (line, column): (usize, usize)) -> Option<usize> {
    let mut start = 0;
    for (index, own) in text.split_inclusive('\n').enumerate() {
        if index + 1 == line {
            return Some(start + own.char_indices().nth(column.checked_sub(1)?)?.0);
        }
        start += own.len();
    }
    None
}

/// A function to start from: waves.
fn sample(components: usize, argument: usize, domain: bool) -> Vec<String> {
    let place = ["x", "y", "z"];
    let wave = |i: usize| {
        let along = place.get(i % argument.max(1)).copied().unwrap_or("x1");
        match domain {
            true => format!("0.1*cos(2*pi*{along}/L{along})"),
            false => format!("0.1*cos({along})"),
        }
    };
    (0..components).map(wave).collect()
}

/// Whether a model has functions that its case gives.
pub(crate) fn are_given(model: &Model) -> bool {
    formula::open(model).is_ok_and(|open| !open.is_empty())
}

/// The table with samples, for the case of a model that needs one.
pub(super) fn sample_table(text: &mut String, model: &Model, domain: bool) {
    let open = formula::open(model).unwrap_or_default();
    if open.is_empty() {
        return;
    }
    let _ = writeln!(
        text,
        "\n[{TABLE}]\n# expressions in the components x, y, z of the argument, the parameters of the model and pi"
    );
    for f in &open {
        let argument = f.argument.components().unwrap_or(1);
        let _ = writeln!(
            text,
            "{} = {}",
            f.name.text,
            formula::in_quotes(&sample(f.components, argument, domain))
        );
    }
}
