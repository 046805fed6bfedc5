//! The models that the commands offer: each a card and its named cases.
//! Takes a list of entries; gives look-up by name, with a suggestion when there is none.

use crate::failure::Failure;
use crate::plain::shown;
use crate::suggestion::did_you_mean;
pub use clebsch_models::{Case, Entry};
use std::path::{Path, PathBuf};

/// All models, in the order in which they are listed.
#[derive(Clone, Debug)]
pub struct Gallery {
    /// One entry per model.
    pub entries: Vec<Entry>,
}

impl Gallery {
    /// The models this program ships.
    #[must_use]
    pub fn shipped() -> Self {
        Self {
            entries: clebsch_models::gallery(),
        }
    }

    /// The model called `name`: `heavy-top`, or `HeavyTop` as in the model's text.
    ///
    /// # Errors
    /// Usage: no such model; the message suggests the nearest.
    pub fn find(&self, name: &str) -> Result<&Entry, Failure> {
        self.entries
            .iter()
            .find(|entry| entry.card.kebab == name || entry.card.name == name)
            .ok_or_else(|| {
                let known = self.entries.iter().map(|entry| entry.card.kebab);
                let beside = file_called(name).map_or_else(String::new, |path| {
                    format!("; the model file {} is named by its path", path.display())
                });
                Failure::Usage(format!(
                    "no model `{}`{}{beside}",
                    shown(name),
                    did_you_mean(name, known)
                ))
            })
    }
}

/// The model file of this name in `models/` or a folder in it, below the folder at hand.
fn file_called(name: &str) -> Option<PathBuf> {
    let file = format!("{name}.clebsch");
    let root = Path::new("models");
    let folders = std::fs::read_dir(root).ok()?.flatten().map(|e| e.path());
    let mut all: Vec<PathBuf> = folders.map(|folder| folder.join(&file)).collect();
    all.push(root.join(&file));
    all.sort();
    // A name with parts of a path is none.
    let plain = Path::new(name).components().count() == 1;
    all.into_iter().find(|path| plain && path.is_file())
}

/// The case called `name`, or the model's first one.
///
/// # Errors
/// Usage: no such case, or no case at all.
pub fn case<'a>(entry: &'a Entry, name: Option<&str>) -> Result<&'a Case, Failure> {
    let found = match name {
        None => entry.cases.first(),
        Some(name) => entry.cases.iter().find(|case| case.name == name),
    };
    found.ok_or_else(|| {
        let model = entry.card.kebab;
        let names = entry.cases.iter().map(|case| case.name.as_str());
        Failure::Usage(match name {
            None => format!("model `{model}` has no case of its own; give one: --case FILE.toml"),
            Some(name) => format!(
                "model `{model}` has no case `{}`{} (a case file ends in .toml)",
                shown(name),
                did_you_mean(name, names)
            ),
        })
    })
}
