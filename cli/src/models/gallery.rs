//! Every model that the commands offer: compiled models, each a card with named cases, and shipped model files. Takes
//! both lists; gives look-up by name, and a suggestion if no model has the name.

use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use crate::words::suggestion::nearest;
use clebsch::card::{Card, Kind};
use clebsch_core::pipeline;
use clebsch_interpret::Cache;
pub use clebsch_models::{Case, CaseFile, Citations, Entry, Family, ModelFile};

/// All models, in the order in which they are listed.
#[derive(Clone, Debug, Default)]
pub struct Gallery {
    /// Compiled models.
    pub entries: Vec<Entry>,
    /// Models as text, which run without a build.
    pub files: Vec<ModelFile>,
    /// Keeps what is derived from texts. By default there is none, so that tests do not use the cache of the user.
    pub cache: Cache,
}

/// A model of the gallery.
#[derive(Clone, Copy, Debug)]
pub(crate) enum GalleryModel<'a> {
    Compiled(&'a Entry),
    File(&'a ModelFile),
}

impl Gallery {
    /// The models this program ships.
    #[must_use]
    pub fn shipped() -> Self {
        Self {
            entries: clebsch_models::gallery(),
            files: clebsch_models::FILES.to_vec(),
            cache: Cache::none(),
        }
    }

    /// These models with another cache.
    #[must_use]
    pub fn with_cache(self, cache: Cache) -> Self {
        Self { cache, ..self }
    }

    /// The compiled model called `name`: `heavy-top`, or `HeavyTop` as in the model's text.
    ///
    /// # Errors
    /// Usage: the model is unknown; the message suggests the nearest name.
    pub fn find(&self, name: &str) -> Result<&Entry, Failure> {
        match self.get(name) {
            Some(GalleryModel::Compiled(entry)) => Ok(entry),
            _ => Err(self.unknown(name)),
        }
    }

    /// The model called `name`, by its file's name or as its text declares it.
    pub(crate) fn get(&self, name: &str) -> Option<GalleryModel<'_>> {
        let mut entries = self.entries.iter();
        let compiled = entries.find(|entry| entry.card.kebab == name || entry.card.name == name);
        let file = || {
            let named = self.files.iter().find(|file| file.name == name);
            named.or_else(|| self.files.iter().find(|file| declares(file.text, name)))
        };
        compiled
            .map(GalleryModel::Compiled)
            .or_else(|| file().map(GalleryModel::File))
    }

    /// The names of all models, compiled ones first.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        let compiled = self.entries.iter().map(|entry| entry.card.kebab);
        compiled.chain(self.files.iter().map(|file| file.name))
    }

    /// The message for a name that no model has.
    pub(crate) fn unknown(&self, name: &str) -> Failure {
        let near = match nearest(name, self.names()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "`clebsch list` shows all models".to_owned(),
        };
        Failure::Usage(format!("no model `{}`; {near}", shown(name)))
    }
}

/// Whether a model's text declares a name. A text without the name is not parsed.
fn declares(text: &str, name: &str) -> bool {
    text.contains(name) && declared(text).is_some_and(|own| own == name)
}

/// The name that a model's text declares; `None` if the text does not parse.
pub(crate) fn declared(text: &str) -> Option<String> {
    let model = pipeline::parse_source(text).ok()?;
    Some(model.name.text)
}

/// The family of a compiled model, from the kinds of its initial values.
pub(crate) fn family(card: &Card) -> Family {
    let has = |kinds: &[Kind]| card.initial.iter().any(|field| kinds.contains(&field.kind));
    if has(&[Kind::Rotation, Kind::UnitQuaternion, Kind::RigidMotion]) {
        Family::Rigid
    } else if has(&[Kind::Matrix]) {
        Family::Elastic
    } else {
        Family::Particle
    }
}

/// The case called `name`, or the model's first one.
///
/// # Errors
/// Usage: the case is unknown, or the model has none.
pub fn case<'a>(entry: &'a Entry, name: Option<&str>) -> Result<&'a Case, Failure> {
    let found = match name {
        None => entry.cases.first(),
        Some(name) => entry.cases.iter().find(|case| case.name == name),
    };
    found.ok_or_else(|| {
        let names = entry.cases.iter().map(|case| case.name.as_str());
        no_case(entry.card.kebab, name, names)
    })
}

/// The message for a case that a model does not have.
pub(crate) fn no_case<'a>(
    model: &str,
    name: Option<&str>,
    known: impl Iterator<Item = &'a str>,
) -> Failure {
    let model = shown(model);
    Failure::Usage(match name {
        None => format!("model `{model}` has no cases; give one with --case FILE.toml"),
        Some(name) => format!(
            "model `{model}` has no case `{}`{} (a case file ends in .toml)",
            shown(name),
            crate::words::suggestion::did_you_mean(name, known)
        ),
    })
}
