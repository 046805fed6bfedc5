//! Named cases of a model in a file: `NAME.toml` in the folder beside it that is called as the model's file, without its
//! ending. Takes the model as it was named and the case; gives the file of the case, or which cases there are.

use crate::failure::Failure;
use crate::gallery::Gallery;
use crate::model_file;
use crate::plain::shown;
use crate::plan::is_file;
use crate::suggestion::did_you_mean;
use std::fs;
use std::path::{Path, PathBuf};
use toml::de::DeTable;

/// The case that is meant: a file, if it has its own.
///
/// # Errors
/// Usage: the model is in a file that has cases beside it, and none of this name.
pub(crate) fn case(
    gallery: &Gallery,
    model: &str,
    case: Option<&str>,
) -> Result<Option<String>, Failure> {
    let Some(name) = case else { return Ok(None) };
    let own = Some(name.to_owned());
    if is_file(name) || gallery.find(model).is_ok() || !model_file::is_meant(model) {
        return Ok(own);
    }
    let all = all(Path::new(model));
    let found = all.iter().find(|(known, _)| known == name);
    if let Some((_, path)) = found {
        return Ok(Some(path.to_string_lossy().into_owned()));
    }
    match all.is_empty() {
        // It may be that of sample values.
        true => Ok(own),
        false => {
            let names = all.iter().map(|(known, _)| known.as_str());
            Err(Failure::Usage(format!(
                "no case `{}` beside `{}`{} (a case file ends in .toml)",
                shown(name),
                shown(model),
                did_you_mean(name, names)
            )))
        }
    }
}

/// The cases of a model's file with their names, in order: the one that is called as the model, by the name that it bears
/// itself, then those of the folder.
fn all(model: &Path) -> Vec<(String, PathBuf)> {
    let mut out = Vec::new();
    let alone = model.with_extension("toml");
    if let Some(name) = fs::read_to_string(&alone).ok().as_deref().and_then(named) {
        out.push((name, alone));
    }
    let entries = fs::read_dir(model.with_extension(""));
    let mut own: Vec<(String, PathBuf)> = entries
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .filter_map(|path| Some((path.file_stem()?.to_str()?.to_owned(), path)))
        .collect();
    own.sort();
    out.extend(own);
    out
}

/// The name that a case bears.
fn named(text: &str) -> Option<String> {
    let table = DeTable::parse(text).ok()?;
    let name = table.get_ref().get("name")?.get_ref().as_str()?.to_owned();
    Some(name)
}
