//! The model and the case that a command line names: a model of the gallery, or a model file. Takes MODEL or
//! MODEL:CASE and the option `--case`; gives the model, ready to run, and the selected case.

use crate::case_file;
use crate::models::gallery::{self, Entry, Gallery, GalleryModel};
use crate::named::cases::{self, CaseText, NamedCases, WhichCase, is_file};
use crate::named::model_file::{self, ModelText};
use crate::overrides;
use crate::terminal::Streams;
use crate::terminal::bounded;
use crate::terminal::failure::Failure;
use crate::terminal::waiting::Waiting;
use crate::words::plain::shown;
use clap::ArgMatches;
use std::borrow::Cow;
use std::path::Path;
use toml::de::DeTable;

/// The placeholder case of a model file.
const SAMPLE: &str = "sample";

/// The model that a name on the command line refers to.
pub(crate) enum NamedModel<'a> {
    Compiled(&'a Entry),
    Text(ModelText),
}

/// A model with the case that is to run.
pub(crate) struct Resolved<'a> {
    /// The model.
    pub entry: Cow<'a, Entry>,
    /// The case.
    pub case: WhichCase,
    /// Whether its stepper was compiled.
    pub compiled: bool,
}

/// The model and the case of a command's arguments `model` and `case`. Warnings on the model's text go to
/// `streams.err`.
///
/// # Errors
/// Usage: the model or the case is unknown, a text does not derive, or a file cannot be read.
pub(crate) fn resolved<'a>(
    gallery: &'a Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<Resolved<'a>, Failure> {
    let (named, case) = resolve_model(gallery, matches)?;
    let by_name = overrides::by_name(matches)?;
    match named {
        NamedModel::Compiled(entry) => Ok(Resolved {
            entry: Cow::Borrowed(entry),
            case: match case {
                Some(file) if is_file(file) => {
                    WhichCase::Text(cases::read(Path::new(file))?).with(&by_name)
                }
                name => match overrides::needs_a_text(matches, &entry.card) {
                    true => WhichCase::Text(written(entry, name)?).with(&by_name),
                    false => {
                        name.map_or(WhichCase::First, |name| WhichCase::Named(name.to_owned()))
                    }
                },
            },
            compiled: true,
        }),
        NamedModel::Text(text) => {
            let case = match case_of(&text, case) {
                Ok(case) => case,
                Err(no_case) => {
                    // An error in the model is reported first.
                    entry(&text, &WhichCase::First, streams)?;
                    return Err(no_case);
                }
            };
            let case = case.with(&by_name);
            let entry = entry(&text, &case, streams)?;
            Ok(Resolved {
                entry: Cow::Owned(entry),
                case,
                compiled: false,
            })
        }
    }
}

/// A case of a compiled model as the text of a case file.
///
/// # Errors
/// Usage: the case is unknown.
pub(crate) fn written(entry: &Entry, name: Option<&str>) -> Result<CaseText, Failure> {
    let case = gallery::case(entry, name)?;
    Ok(CaseText {
        file: format!("{}:{}", entry.card.kebab, case.name),
        text: case_file::write(&entry.card_of(case), case, entry.card.kebab),
    })
}

/// The model and case that the arguments `model` and `case` name: MODEL and `--case`, or MODEL:CASE.
///
/// # Errors
/// Usage: the model is unknown, a file cannot be read, or the arguments name two cases.
pub(crate) fn resolve_model<'a, 'm>(
    gallery: &'a Gallery,
    matches: &'m ArgMatches,
) -> Result<(NamedModel<'a>, Option<&'m str>), Failure> {
    let argument = |key: &str| matches.get_one::<String>(key).map(String::as_str);
    let (name, case) = parts(argument("model").unwrap_or_default(), argument("case"))?;
    Ok((named(gallery, name, "expected a model")?, case))
}

/// The model of a text, derived, with the placeholder case if that is the one to run.
///
/// # Errors
/// Usage: it does not derive, or needs a build.
pub(crate) fn entry(
    text: &ModelText,
    case: &WhichCase,
    streams: &mut Streams<'_>,
) -> Result<Entry, Failure> {
    let mut warnings = Vec::new();
    let read = {
        let _told = Waiting::showing("deriving the equations".to_owned(), streams.progress);
        model_file::read(text, case, &mut warnings)
    };
    // A warning that cannot be written is not lost: the derivation contains it.
    let _ = streams.err.write_all(&warnings);
    read
}

/// A name split at the colon of MODEL:CASE; a path that exists is not split.
///
/// # Errors
/// Usage: the case is given twice.
pub(crate) fn parts<'n>(
    name: &'n str,
    case: Option<&'n str>,
) -> Result<(&'n str, Option<&'n str>), Failure> {
    match name.rsplit_once(':') {
        Some((model, own)) if is_name(own) && !Path::new(name).exists() => match case {
            None => Ok((model, Some(own))),
            Some(_) => Err(Failure::Usage(format!(
                "`{}` names a case, and --case names another; give one of them",
                shown(name)
            ))),
        },
        _ => Ok((name, case)),
    }
}

/// Whether a text can be the name of a case.
fn is_name(text: &str) -> bool {
    !text.is_empty()
        && text
            .chars()
            .all(|c| c.is_alphanumeric() || "-_.".contains(c))
}

/// The model that a name refers to: a model of the gallery, else a file. `but` is the end of the message for a case
/// file.
///
/// # Errors
/// Usage: there is neither, or the file cannot be read.
pub(crate) fn named<'a>(
    gallery: &'a Gallery,
    name: &str,
    but: &str,
) -> Result<NamedModel<'a>, Failure> {
    let path = Path::new(name);
    match gallery.get(name) {
        Some(GalleryModel::Compiled(entry)) => return Ok(NamedModel::Compiled(entry)),
        Some(GalleryModel::File(file)) => {
            return Ok(NamedModel::Text(ModelText {
                name: file.name.to_owned(),
                text: file.text.to_owned(),
                cases: NamedCases::shipped(file),
                is_path: false,
                cache: gallery.cache.clone(),
            }));
        }
        None => {}
    }
    if is_file(name) {
        return Err(is_a_case(gallery, name, but));
    }
    let is_meant = path.exists() || path.extension().is_some_and(|end| end == "clebsch");
    if !is_meant {
        let beside = format!("{name}.clebsch");
        return Err(match Path::new(&beside).is_file() {
            true => Failure::Usage(format!(
                "no model `{}`; did you mean `{}`?",
                shown(name),
                shown(&beside)
            )),
            false => gallery.unknown(name),
        });
    }
    if !path.exists() {
        return Err(Failure::Usage(format!(
            "model file `{}` does not exist; `clebsch new NAME` creates a model to start from",
            shown(name)
        )));
    }
    Ok(NamedModel::Text(ModelText {
        name: name.to_owned(),
        text: bounded::text(path, "model file")?,
        cases: NamedCases::beside(path),
        is_path: true,
        cache: gallery.cache.clone(),
    }))
}

/// The case of a model's text that is to run.
///
/// # Errors
/// Usage: there is no case with this name, or no case at all.
pub(crate) fn case_of(text: &ModelText, case: Option<&str>) -> Result<WhichCase, Failure> {
    if let Some(file) = case.filter(|case| is_file(case)) {
        return cases::read(Path::new(file)).map(WhichCase::Text);
    }
    match (text.cases.get(case)?, case) {
        (Some(found), _) => Ok(WhichCase::Text(found)),
        (None, Some(SAMPLE)) => Ok(WhichCase::Named(SAMPLE.to_owned())),
        (None, None) if text.is_path => Err(cases::none_beside(&text.name)),
        (None, name) => Err(gallery::no_case(&text.name, name, text.cases.names())),
    }
}

/// The message if a case file is given instead of a model.
fn is_a_case(gallery: &Gallery, name: &str, but: &str) -> Failure {
    let case = cases::read(Path::new(name)).ok();
    let table = case
        .as_ref()
        .and_then(|case| DeTable::parse(&case.text).ok());
    let stated = table
        .as_ref()
        .and_then(|table| table.get_ref().get("model"));
    let stated = stated.and_then(|model| model.get_ref().as_str());
    let model = match stated.and_then(|stated| gallery.get(stated)) {
        Some(GalleryModel::Compiled(entry)) => entry.card.kebab,
        Some(GalleryModel::File(file)) => file.name,
        None => "MODEL",
    };
    let name = shown(name);
    Failure::Usage(format!(
        "`{name}` is a case file and contains only numbers, and {but}\n\x20 to run it:              clebsch run {model} --case \
         {name}\n\x20 the model's equations: clebsch derive {model}"
    ))
}
