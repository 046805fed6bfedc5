//! What was given where a model's name is asked for: a model, or a file that belongs elsewhere.
//! Takes the argument; gives the model, or a message with the command that was meant.

use crate::Streams;
use crate::failure::Failure;
use crate::gallery::{Entry, Gallery};
use crate::model_file;
use crate::plain::shown;
use crate::waiting::Waiting;
use std::borrow::Cow;
use std::path::Path;
use toml::de::DeTable;

/// The model that `run`, `compare` or `case` is to work on: one of the gallery, else that of a file, whose
/// warnings are told. A `case` says how many sites a model with labels has.
///
/// # Errors
/// Usage: neither; a case file is told apart, and the message says what it is for.
pub(crate) fn model<'a>(
    gallery: &'a Gallery,
    name: &str,
    case: Option<&str>,
    streams: &mut Streams<'_>,
) -> Result<Cow<'a, Entry>, Failure> {
    let unknown = match gallery.find(name) {
        Ok(entry) => return Ok(Cow::Borrowed(entry)),
        Err(unknown) => unknown,
    };
    if let Some(failure) = case_file(gallery, name, "here a model is named") {
        return Err(failure);
    }
    if !model_file::is_meant(name) {
        return Err(unknown);
    }
    let mut warnings = Vec::new();
    let read = {
        let _told = Waiting::told("deriving the equations".to_owned(), streams.progress);
        model_file::read(gallery, name, case, &mut warnings)
    };
    // What cannot be written there stands in the derivation too.
    let _ = streams.err.write_all(&warnings);
    read.map(Cow::Owned)
}

/// The message for a case file in the place of a model, if `name` is one.
pub(crate) fn case_file(gallery: &Gallery, name: &str, but: &str) -> Option<Failure> {
    if Path::new(name).extension().is_none_or(|end| end != "toml") {
        return None;
    }
    let text = std::fs::read_to_string(name).unwrap_or_default();
    let table = DeTable::parse(&text).ok();
    let stated = table
        .as_ref()
        .and_then(|table| table.get_ref().get("model"));
    let stated = stated.and_then(|model| model.get_ref().as_str());
    let known = stated.and_then(|stated| gallery.find(stated).ok());
    let model = known.map_or("MODEL", |entry| entry.card.kebab);
    let name = shown(name);
    Some(Failure::Usage(format!(
        "`{name}` is a case file, with the numbers of a case, and {but}\n\
         \x20 to run it:              clebsch run {model} --case {name}\n\
         \x20 the model's equations: clebsch derive {model}"
    )))
}
