//! A model in a file: read, derived and executed without a build. Takes a path; gives the model with a case of
//! placeholder values, as a template for your own.

use crate::case_file;
use crate::case_file::stated::Stated;
use crate::models::constraints::card_has_constraints;
use crate::models::fields::{is_momentum, sample_values, turns};
use crate::models::gallery::{Case, Citations, Entry};
use crate::named::cases::{NamedCases, WhichCase};
use crate::named::sample::onto_constraints;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use clebsch::card::{Card, Field};
use clebsch_core::lattice::ChainConfig;
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::{Model, Statement};
use clebsch_interpret::{Cache, Refused};
use std::io::Write;

/// The text of a model.
pub(crate) struct ModelText {
    /// The file or model, as messages name it.
    pub name: String,
    /// The statement.
    pub text: String,
    /// Its cases.
    pub cases: NamedCases,
    /// Whether it is a model file, named by its path.
    pub is_path: bool,
    /// Keeps what is derived from it.
    pub cache: Cache,
}

/// The model of a text, with the placeholder case if that is the one to run. Warnings go to `err`.
///
/// # Errors
/// Usage: the text does not derive, or the model needs a build.
pub(crate) fn read(
    model: &ModelText,
    case: &WhichCase,
    err: &mut dyn Write,
) -> Result<Entry, Failure> {
    let (name, text) = (shown(&model.name).to_string(), model.text.as_str());
    let of_case = case.text().map(|c| (c.file.as_str(), c.text.as_str()));
    let filled = case_file::functions::put_in(text, of_case)?;
    let text = filled.text.as_str();
    let stated = Stated::read(text);
    let choice = match &stated {
        None => None,
        Some(stated) => chosen(stated, of_case)?,
    };
    let read = match &choice {
        None => model.cache.card(text),
        Some(choice) => model.cache.card_on_lattice(text, choice),
    };
    let (card, warnings) = read.map_err(|refused| match refused {
        Refused::Model(errors) => filled
            .wrong_in(&errors, of_case)
            .unwrap_or_else(|| Failure::Usage(format!("\n{}", errors.render(text, &name)))),
        other => Failure::Usage(format!("{name}: {other}")),
    })?;
    for warning in warnings {
        // A warning that cannot be written is not lost: the derivation contains it.
        let _ = write!(err, "{}", warning.render("warning", text, &name));
    }
    let cases = match (case, stated.zip(choice)) {
        (WhichCase::Text(_) | WhichCase::First, _) => Vec::new(),
        (WhichCase::Named(_), None) => vec![sample(&card, &name)],
        (WhichCase::Named(_), Some((stated, choice))) => {
            let text = case_file::write_lattice(&card, &stated, &choice, &name);
            vec![case_file::read_of("sample", &text, &card, Some(&stated))?.case]
        }
    };
    Ok(Entry {
        card,
        citations: Citations::NONE,
        cases,
    })
}

/// The number of sites and the ends of the chain, from the case file if there is one.
fn chosen(stated: &Stated, case: Option<(&str, &str)>) -> Result<Option<ChainConfig>, Failure> {
    match case {
        None => Ok(case_file::default_choice(stated)),
        Some((file, text)) => case_file::choice(file, text, stated),
    }
}

/// Values that are admissible for most models, and of no further meaning.
fn sample(card: &Card, file: &str) -> Case {
    let turned = turns(card);
    let held = card_has_constraints(card);
    let values = |fields: &[Field]| {
        let sample = |f: &Field| match held && is_momentum(f) {
            true => vec![0.0; f.count()],
            false => sample_values(f, turned),
        };
        fields.iter().map(sample).collect()
    };
    let mut case = Case {
        name: "sample".to_owned(),
        doc: format!(
            "placeholder values; for a case of your own, run `clebsch case {file} > my.toml` and edit it"
        ),
        h: 0.01,
        steps: 1000,
        parameters: values(card.parameters),
        initial: values(card.initial),
        bounds: Vec::new(),
    };
    if let Ok(model) = pipeline::parse_source(card.source) {
        apart(&model, card, &mut case);
        if held {
            onto_constraints(&model, card, &mut case);
        }
    }
    case
}

/// Separates fields of one shape, since many Lagrangians are singular if two positions coincide.
fn apart(model: &Model, card: &Card, case: &mut Case) {
    let is_field = |name: &str| {
        model.statements.iter().any(|s| match s {
            Statement::Field { names, .. } => names.iter().any(|own| own.text == name),
            _ => false,
        })
    };
    let mut before: Vec<[usize; 2]> = Vec::new();
    for (field, numbers) in card.initial.iter().zip(&mut case.initial) {
        if field.cols != 1 || !is_field(field.name) {
            continue;
        }
        let shape = [field.rows, field.cols];
        let distance = before.iter().filter(|own| **own == shape).count();
        if let Some(first) = numbers.first_mut() {
            *first += distance as f64;
        }
        before.push(shape);
    }
}
