//! `clebsch show` and `clebsch case`: the text of a model, and a case as TOML as a template for your own. Takes the
//! names on the command line; gives the texts in the form of files.

use crate::case_file::{self, stated::Stated};
use crate::models::gallery::{self, Gallery};
use crate::named::cases::WhichCase;
use crate::named::model_file::ModelText;
use crate::named::resolve::{NamedModel, case_of, entry, resolve_model};
use crate::terminal::Streams;
use crate::terminal::failure::Failure;
use clap::ArgMatches;

/// Prints a case.
///
/// # Errors
/// Usage: the model or the case is unknown.
pub(crate) fn case(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<(), Failure> {
    let (named, case) = resolve_model(gallery, matches)?;
    let toml = case_text(&named, case, streams)?;
    streams.out.write_all(toml.as_bytes())?;
    Ok(())
}

/// Prints the text of a model and a case.
///
/// # Errors
/// Usage: the model or the case is unknown.
pub(crate) fn show(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<(), Failure> {
    let (named, case) = resolve_model(gallery, matches)?;
    let toml = case_text(&named, case, streams)?;
    write!(streams.out, "{}\n\n{toml}", statement(&named).trim_end())?;
    Ok(())
}

/// The statement of a model.
pub(crate) fn statement<'n>(named: &'n NamedModel<'_>) -> &'n str {
    match named {
        NamedModel::Compiled(entry) => entry.card.source,
        NamedModel::Text(text) => &text.text,
    }
}

/// A case of a model as TOML. Without a name it is the first case of a shipped model, or placeholder values for a
/// file.
///
/// # Errors
/// Usage: the case is unknown, or the text does not derive.
pub(crate) fn case_text(
    named: &NamedModel<'_>,
    case: Option<&str>,
    streams: &mut Streams<'_>,
) -> Result<String, Failure> {
    match named {
        NamedModel::Compiled(entry) => {
            let case = gallery::case(entry, case)?;
            Ok(case_file::write(
                &entry.card_of(case),
                case,
                entry.card.kebab,
            ))
        }
        NamedModel::Text(text) if text.is_path && case.is_none() => placeholder(text, streams),
        NamedModel::Text(text) => match case_of(text, case)? {
            WhichCase::Text(case) => Ok(case.text),
            _ => placeholder(text, streams),
        },
    }
}

/// A case of placeholder values for a model's text.
pub(crate) fn placeholder(text: &ModelText, streams: &mut Streams<'_>) -> Result<String, Failure> {
    let sample = WhichCase::Named("sample".to_owned());
    if let Some(stated) = Stated::read(&text.text)
        && let Some(choice) = case_file::default_choice(&stated)
    {
        let entry = entry(text, &WhichCase::First, streams)?;
        return Ok(case_file::write_lattice(
            &entry.card,
            &stated,
            &choice,
            &text.name,
        ));
    }
    let entry = entry(text, &sample, streams)?;
    let case = gallery::case(&entry, None)?;
    Ok(case_file::write(&entry.card_of(case), case, &text.name))
}
