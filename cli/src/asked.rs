//! What was given where a model's name is asked for: a model, or a file that belongs elsewhere.
//! Takes the argument; gives the model, or a message with the command that was meant.

use crate::failure::Failure;
use crate::gallery::{Entry, Gallery};
use crate::plain::shown;
use std::path::Path;
use toml::de::DeTable;

/// The model that `run`, `compare` or `case` is to work on.
///
/// # Errors
/// Usage: no model of the gallery. A case file and a file with a model's text are told apart, and the
/// message says what they are for.
pub(crate) fn model<'a>(gallery: &'a Gallery, name: &str) -> Result<&'a Entry, Failure> {
    let unknown = match gallery.find(name) {
        Ok(entry) => return Ok(entry),
        Err(unknown) => unknown,
    };
    if let Some(failure) = case_file(gallery, name, "here a model is named") {
        return Err(failure);
    }
    let path = Path::new(name);
    if path.is_file() || path.extension().is_some_and(|end| end == "clebsch") {
        let name = shown(name);
        let what = match path.is_file() {
            true => format!("`{name}` is a file"),
            false => format!("there is no file `{name}`"),
        };
        return Err(Failure::Usage(format!(
            "{what}, and only models that were compiled are run: `clebsch list` shows them\n\
             \x20 its equations:  clebsch derive {name}\n\
             \x20 to run it:      state it in `clebsch::model! {{ ... }}` in a crate of your own, and give it\n\
             \x20                 to `clebsch_cli::run_process_on`: README, \"A command line of your own\""
        )));
    }
    Err(unknown)
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
