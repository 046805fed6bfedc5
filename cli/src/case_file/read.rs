//! Reads a case from a TOML file, for the model whose card is given.
//! Takes the text; gives the case with the lines of its keys, or the first thing wrong with it.

use super::beside::Beside;
use super::from_npz::{self, Arrays};
use super::inertia::{self, Given, Taken};
use super::labels::WrittenOut;
use super::location::{File, Located};
use super::value::{expected, number, numbers};
use crate::arguments::whole;
use crate::failure::Failure;
use crate::gallery::Case;
use crate::plain::shown;
use crate::suggestion::did_you_mean;
use clebsch::card::{Card, Field};
use clebsch_core::pipeline;
use std::collections::{BTreeMap, HashSet};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

const KEYS: [&str; 8] = [
    "model",
    "name",
    "doc",
    "h",
    "steps",
    "parameters",
    "initial",
    "bounds",
];

type Lines = BTreeMap<String, usize>;

/// Reads the numbers of a field from a value.
type Numbers = fn(&Field, &DeValue<'_>) -> Result<Vec<f64>, String>;

/// Reads the case in `text`, which came from the file `name`, for the model of `card`.
///
/// # Errors
/// Usage: no TOML, another model, an unknown, missing, mistyped or misshapen value. The message
/// names file, line and key.
pub fn read(name: &str, text: &str, card: &Card) -> Result<Located, Failure> {
    located(&File::new(name, text), &Beside::default(), card)
}

/// The same of a case that was written out from a file, whose lines are told.
///
/// # Errors
/// As [`read`].
pub(crate) fn read_written_out(
    name: &str,
    out: &WrittenOut,
    card: &Card,
) -> Result<Located, Failure> {
    let file = File::written_out(name, &out.text, &out.lines);
    located(&file, &out.beside, card)
}

fn located(file: &File<'_>, beside: &Beside, card: &Card) -> Result<Located, Failure> {
    let name = file.name;
    let document = file.document()?;
    let top = document.get_ref();
    let mut known = KEYS.to_vec();
    let functions = super::functions::TABLE;
    // The model is read again for those cases alone.
    let model = top
        .contains_key(functions)
        .then(|| pipeline::parse_source(card.source));
    if matches!(&model, Some(Ok(model)) if super::functions::are_given(model)) {
        known.push(functions);
    }
    known_keys(file, top, &known, "at the top level", None)?;
    let model = required(
        file,
        top,
        "model",
        &format!("the model's name, \"{}\"", card.kebab),
    )?;
    let asked = string(file, "model", model)?;
    if asked != card.kebab && asked != card.name {
        return Err(file.wrong(
            Some(&model.span()),
            &format!(
                "model: this case is for `{}`, but `{}` is to run",
                shown(&asked),
                card.kebab
            ),
        ));
    }
    let mut lines = beside.lines();
    for (key, value) in top {
        lines.insert(key.get_ref().to_string(), file.line(&value.span()));
    }
    let case = Case {
        name: optional_string(file, top, "name")?.unwrap_or_else(|| stem(name)),
        doc: optional_string(file, top, "doc")?.unwrap_or_default(),
        h: step_size(file, required(file, top, "h", "the step size")?)?,
        steps: steps(file, required(file, top, "steps", "the number of steps")?)?,
        parameters: fields(
            file,
            top,
            beside,
            ("parameters", card.parameters),
            &mut lines,
        )?,
        initial: fields(file, top, beside, ("initial", card.initial), &mut lines)?,
        bounds: bounds(file, top, card)?,
    };
    Ok(Located {
        case,
        file: name.to_owned(),
        lines,
    })
}

/// Name of a case that states none: the file's, without folder and extension.
fn stem(name: &str) -> String {
    let stem = std::path::Path::new(name).file_stem();
    stem.map_or_else(
        || name.to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    )
}

fn known_keys(
    file: &File<'_>,
    table: &DeTable<'_>,
    known: &[&str],
    place: &str,
    written: Option<&[Field]>,
) -> Result<(), Failure> {
    let all: HashSet<&str> = known.iter().copied().collect();
    for key in table.keys() {
        let name = key.get_ref().as_ref();
        if all.contains(name) {
            continue;
        }
        // `"Λ"` is how the model writes it, but files use the ASCII name.
        let ascii = written
            .unwrap_or_default()
            .iter()
            .find(|field| field.name == name);
        let hint = match ascii {
            Some(field) => format!("; did you mean `{}`?", field.ascii),
            None => did_you_mean(name, known.iter().copied()),
        };
        return Err(file.wrong(
            Some(&key.span()),
            &format!("unknown key `{}` {place}{hint}", shown(name)),
        ));
    }
    Ok(())
}

fn required<'a, 'i>(
    file: &File<'_>,
    table: &'a DeTable<'i>,
    key: &str,
    what: &str,
) -> Result<&'a Spanned<DeValue<'i>>, Failure> {
    table
        .get(key)
        .ok_or_else(|| file.wrong(None, &format!("missing key `{key}`: {what}")))
}

fn string(file: &File<'_>, key: &str, value: &Spanned<DeValue<'_>>) -> Result<String, Failure> {
    value.get_ref().as_str().map(str::to_owned).ok_or_else(|| {
        let found = value.get_ref().type_str();
        file.wrong(
            Some(&value.span()),
            &format!("{key}: expected a string, found a value of type {found}"),
        )
    })
}

fn optional_string(
    file: &File<'_>,
    table: &DeTable<'_>,
    key: &str,
) -> Result<Option<String>, Failure> {
    table
        .get(key)
        .map(|value| string(file, key, value))
        .transpose()
}

fn step_size(file: &File<'_>, value: &Spanned<DeValue<'_>>) -> Result<f64, Failure> {
    let wrong = |message: &str| file.wrong(Some(&value.span()), &format!("h: {message}"));
    let h = number(value.get_ref()).map_err(|message| wrong(&message))?;
    if h > 0.0 {
        Ok(h)
    } else {
        Err(wrong(&format!("the step size must be positive, found {h}")))
    }
}

fn steps(file: &File<'_>, value: &Spanned<DeValue<'_>>) -> Result<u64, Failure> {
    let wrong = |message: &str| file.wrong(Some(&value.span()), &format!("steps: {message}"));
    let (text, steps) = match value.get_ref() {
        DeValue::Integer(text) => {
            let steps = u64::from_str_radix(text.as_str(), text.radix());
            (text.to_string(), steps.ok())
        }
        // `1e6` is a whole number, too.
        DeValue::Float(text) => (text.to_string(), whole(text.as_str())),
        other => {
            let found = other.type_str();
            return Err(wrong(&format!(
                "expected a whole number, found a value of type {found}"
            )));
        }
    };
    match steps {
        Some(steps) if steps > 0 => Ok(steps),
        _ => Err(wrong(&format!(
            "must be a whole number, at least 1, found {text}"
        ))),
    }
}

/// The table `name`, with the line it starts on; `None` when the file has none.
fn table<'a, 'i>(
    file: &File<'_>,
    top: &'a DeTable<'i>,
    name: &str,
) -> Result<Option<(&'a DeTable<'i>, Range<usize>)>, Failure> {
    let Some(value) = top.get(name) else {
        return Ok(None);
    };
    match value.get_ref().as_table() {
        Some(table) => Ok(Some((table, value.span()))),
        None => Err(file.wrong(
            Some(&value.span()),
            &format!(
                "{name}: expected a table [{name}], found a value of type {}",
                value.get_ref().type_str()
            ),
        )),
    }
}

fn fields(
    file: &File<'_>,
    top: &DeTable<'_>,
    beside: &Beside,
    (name, fields): (&'static str, &[Field]),
    lines: &mut Lines,
) -> Result<Vec<Vec<f64>>, Failure> {
    let Some((table, span)) = table(file, top, name)? else {
        return match fields.first() {
            None => Ok(Vec::new()),
            Some(_) => {
                let keys: Vec<&str> = fields.iter().map(|field| field.ascii).collect();
                let message = format!("missing table [{name}] with keys {}", keys.join(", "));
                Err(file.wrong(None, &message))
            }
        };
    };
    let taken = Taken::of(fields);
    let arrays = Arrays::of(file);
    let inertias: Vec<String> = fields
        .iter()
        .filter_map(|field| inertia::key(field, &taken))
        .collect();
    let in_text = fields.iter().enumerate();
    let in_text = in_text.filter(|(index, _)| beside.get(name, *index).is_none());
    let known = in_text.map(|(_, field)| field.ascii);
    let known: Vec<&str> = known.chain(inertias.iter().map(String::as_str)).collect();
    known_keys(file, table, &known, &format!("in [{name}]"), Some(fields))?;
    let mut values = Vec::with_capacity(fields.len());
    for (index, field) in fields.iter().enumerate() {
        if let Some(numbers) = beside.get(name, index) {
            values.push(numbers.to_vec());
            continue;
        }
        let stands = match beside.initial(field.ascii) {
            true => "initial",
            false => name,
        };
        let key = format!("{stands}.{}", field.ascii);
        let read = |own: &Field, value: &Spanned<DeValue<'_>>, of: Numbers| {
            if !from_npz::is_meant(value.get_ref()) {
                return Ok::<_, Failure>(of(field, value.get_ref()));
            }
            let shown = inertia::shown_key(table, field, &taken);
            let text = arrays.whole(own, value, shown.trim_end_matches(".I"));
            let text = text.map_err(|fault| {
                file.wrong(Some(&fault.at), &format!("{stands}.{shown}: {}", fault.why))
            })?;
            let one = DeValue::parse(&text);
            let one = one.map_err(|e| file.wrong(Some(&value.span()), e.message()))?;
            Ok(of(field, one.get_ref()))
        };
        let (value, found) = match inertia::given(table, field, &taken) {
            Given::Own(value) => (value, read(field, value, numbers)?),
            Given::Inertia(value) => {
                let inertia = inertia::field(field);
                (value, read(&inertia, value, inertia::second_moments)?)
            }
            Given::Twice(value) => (
                value,
                Err("is given twice, by itself and by its inertia".to_owned()),
            ),
            Given::Missing => {
                let message = format!("missing key `{key}`: {}", expected(field));
                return Err(file.wrong(Some(&span), &message));
            }
        };
        let found = found.map_err(|message| {
            let shown = inertia::shown_key(table, field, &taken);
            file.wrong(Some(&value.span()), &format!("{stands}.{shown}: {message}"))
        })?;
        lines.insert(key, file.line(&value.span()));
        values.push(found);
    }
    Ok(values)
}

fn bounds(file: &File<'_>, top: &DeTable<'_>, card: &Card) -> Result<Vec<(String, f64)>, Failure> {
    let Some((table, _)) = table(file, top, "bounds")? else {
        return Ok(Vec::new());
    };
    let known: Vec<&str> = card
        .invariants
        .iter()
        .map(|invariant| invariant.name)
        .collect();
    known_keys(file, table, &known, "in [bounds]", None)?;
    let mut bounds = Vec::new();
    // In the order of the card, so that the order in the file does not matter.
    for name in known {
        let Some(value) = table.get(name) else {
            continue;
        };
        let wrong =
            |message: &str| file.wrong(Some(&value.span()), &format!("bounds.{name}: {message}"));
        let bound = number(value.get_ref()).map_err(|message| wrong(&message))?;
        if bound < 0.0 {
            return Err(wrong(&format!("a bound is never negative, found {bound}")));
        }
        bounds.push((name.to_owned(), bound));
    }
    Ok(bounds)
}
