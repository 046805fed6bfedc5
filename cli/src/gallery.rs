//! The models that the commands offer: each a card and its named cases.
//! Takes a list of entries; gives look-up by name, with a suggestion when there is none.

use crate::failure::Failure;
use crate::plain::shown;
use crate::suggestion::did_you_mean;
pub use clebsch_models::{Case, Entry};

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
                Failure::Usage(format!(
                    "no model `{}`{}",
                    shown(name),
                    did_you_mean(name, known)
                ))
            })
    }
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
