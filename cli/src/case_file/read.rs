//! Reads a case from a TOML file, for the model of a card.
//! Takes the text; gives the case with the lines of its keys, or the first error.

use super::at_sites::AtSites;
use super::fields::Fields;
use super::from_npz::Arrays;
use super::location::{File, Located};
use super::motion::Motion;
use super::scope::{Scope, rounded};
use super::stated::Stated;
use crate::models::gallery::Case;
use crate::terminal::failure::Failure;
use crate::words::number::whole;
use crate::words::plain::shown;
use clebsch::card::Card;
use clebsch::validate::positive_step;
use clebsch_core::pipeline;
use std::collections::{BTreeMap, HashSet};
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

/// Reads the case in `text`, which came from the file `name`, for the model of `card`.
///
/// # Errors
/// Usage: the text is not TOML or names another model, or a value is unknown, missing, mistyped or misshapen.
/// The message has file, line and key.
pub fn read(name: &str, text: &str, card: &Card) -> Result<Located, Failure> {
    let located = read_of(name, text, card, None)?;
    match located.case.steps {
        0 => Err(no_steps(name)),
        _ => Ok(located),
    }
}

/// The message for a case without a number of steps.
pub(crate) fn no_steps(name: &str) -> Failure {
    let message = "missing key `steps`: give the number of steps, or --until T or --steps N";
    Failure::Usage(format!("{}: {message}", shown(name)))
}

/// Reads a case that may omit the number of steps, which is then 0. `stated` is the model, if it has labels.
///
/// # Errors
/// As [`read`].
pub(crate) fn read_of(
    name: &str,
    text: &str,
    card: &Card,
    stated: Option<&Stated>,
) -> Result<Located, Failure> {
    let file = &File::new(name, text);
    let document = file.document()?;
    let top = document.get_ref();
    let sites = stated.map(|stated| AtSites::read(file, top, stated));
    let sites = sites.transpose()?;
    let mut known = KEYS.to_vec();
    if sites.is_some() {
        known.extend(["labels", "domain", "ends"]);
    }
    let functions = super::functions::TABLE;
    // Only such cases need the model to be parsed again.
    let model = top
        .contains_key(functions)
        .then(|| pipeline::parse_source(card.source));
    if matches!(&model, Some(Ok(model)) if super::functions::are_given(model)) {
        known.push(functions);
    }
    let means_h = |key: &str| {
        let is_step = ["dt", "step_size", "timestep", "time_step"].contains(&key);
        is_step.then(|| "; the step size is `h`".to_owned())
    };
    file.known_keys(top, &known, "at the top level", &means_h)?;
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
                "model: this case is for `{}`, not for `{}`",
                shown(&asked),
                card.kebab
            ),
        ));
    }
    let scope = Scope::of(top);
    let h = step_size(file, &scope, required(file, top, "h", "the step size")?)?;
    let steps = match top.get("steps") {
        Some(count) => steps(file, &scope, count)?,
        None => 0,
    };
    let of_top = top.iter().map(|(key, value)| {
        let line = file.line(&value.span());
        (key.get_ref().to_string(), line)
    });
    let mut fields = Fields {
        file,
        scope: &scope,
        arrays: Arrays::of(file),
        sites: sites.as_ref(),
        lines: of_top.collect(),
        motion: Motion::default(),
        seen: BTreeMap::new(),
        quantities: HashSet::new(),
    };
    let [parameters, initial] = fields.read(top, card)?;
    let Fields {
        lines, mut motion, ..
    } = fields;
    let choice = sites.map(|sites| sites.choice);
    let mut case = Case {
        name: optional_string(file, top, "name")?.unwrap_or_else(|| stem(name)),
        doc: optional_string(file, top, "doc")?.unwrap_or_default(),
        h,
        steps,
        parameters,
        initial,
        bounds: bounds(file, &scope, top, card)?,
    };
    let put = motion.put(card, choice.as_ref(), &mut case);
    put.map_err(|wrong| {
        let message = format!("initial.{}: {}", wrong.key, wrong.why);
        file.wrong_at(wrong.line, &message)
    })?;
    Ok(Located {
        case,
        file: name.to_owned(),
        lines,
        motion,
        choice,
    })
}

/// The default name of a case: the name of its file, without folder and extension.
fn stem(name: &str) -> String {
    let stem = std::path::Path::new(name).file_stem();
    stem.map_or_else(
        || name.to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    )
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

fn step_size(file: &File<'_>, scope: &Scope, value: &Spanned<DeValue<'_>>) -> Result<f64, Failure> {
    let wrong = |message: &str| file.wrong(Some(&value.span()), &format!("h: {message}"));
    let h = scope
        .read(value.get_ref())
        .map_err(|message| wrong(&message))?;
    match positive_step(h) {
        Ok(()) => Ok(h),
        Err(error) => Err(wrong(&format!("{}; {}", error.problem, error.remedy))),
    }
}

/// The smallest number of steps that cannot be counted: 2^64.
const TOO_MANY: f64 = 18_446_744_073_709_551_616.0;

fn steps(file: &File<'_>, scope: &Scope, value: &Spanned<DeValue<'_>>) -> Result<u64, Failure> {
    let wrong = |message: &str| file.wrong(Some(&value.span()), &format!("steps: {message}"));
    let (text, steps) = match value.get_ref() {
        DeValue::Integer(text) => {
            let steps = u64::from_str_radix(text.as_str(), text.radix());
            (text.to_string(), steps.ok())
        }
        // `1e6` is an integer as well.
        DeValue::Float(text) => (text.to_string(), whole(text.as_str())),
        own @ DeValue::String(_) => {
            let found = scope.read(own).map_err(|message| wrong(&message))?;
            (found.to_string(), rounded(found))
        }
        other => {
            let found = other.type_str();
            return Err(wrong(&format!(
                "expected a whole number, found a value of type {found}"
            )));
        }
    };
    match steps {
        Some(steps) if steps > 0 => Ok(steps),
        None if text
            .parse()
            .is_ok_and(|x: f64| x.is_finite() && x >= TOO_MANY) =>
        {
            Err(wrong(&format!(
                "{text} is too large; give at most {}",
                u64::MAX
            )))
        }
        _ => Err(wrong(&format!(
            "must be a whole number, at least 1, found {text}"
        ))),
    }
}

fn bounds(
    file: &File<'_>,
    scope: &Scope,
    top: &DeTable<'_>,
    card: &Card,
) -> Result<Vec<(String, f64)>, Failure> {
    let Some(table) = file.table(top, "bounds")? else {
        return Ok(Vec::new());
    };
    let known: Vec<&str> = card
        .invariants
        .iter()
        .map(|invariant| invariant.name)
        .collect();
    file.known_keys(table, &known, "in [bounds]", &|_| None)?;
    let mut bounds = Vec::new();
    // In the order of the card, so that the order in the file does not matter.
    for name in known {
        let Some(value) = table.get(name) else {
            continue;
        };
        let wrong =
            |message: &str| file.wrong(Some(&value.span()), &format!("bounds.{name}: {message}"));
        let bound = scope
            .read(value.get_ref())
            .map_err(|message| wrong(&message))?;
        if bound < 0.0 {
            return Err(wrong(&format!(
                "a bound must not be negative, found {bound}"
            )));
        }
        bounds.push((name.to_owned(), bound));
    }
    Ok(bounds)
}
