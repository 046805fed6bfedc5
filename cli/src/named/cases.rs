//! The cases of a model given as text: `MODEL.toml` next to the file, then the cases in the folder `MODEL/`. Takes a
//! model file or a shipped model; gives its cases by name, with their texts.

use crate::models::gallery::ModelFile;
use crate::overrides::substitute::substituted;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use std::fs;
use std::path::{Path, PathBuf};
use toml::de::DeTable;

/// A case as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct CaseText {
    /// The file, as messages name it.
    pub file: String,
    /// Its TOML.
    pub text: String,
}

/// Which case a command runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum WhichCase {
    /// The first one of a compiled model.
    First,
    /// One of a compiled model, or `sample`: placeholder values of a model file.
    Named(String),
    /// The case of a file.
    Text(CaseText),
}

impl WhichCase {
    /// This case with values of the step size and of parameters inserted into its text, so that expressions use the
    /// new values.
    #[must_use]
    pub fn with(self, values: &[(String, String)]) -> Self {
        match self {
            Self::Text(case) => Self::Text(CaseText {
                text: substituted(&case.text, values),
                ..case
            }),
            other => other,
        }
    }

    /// The text of a case that has one.
    pub fn text(&self) -> Option<&CaseText> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }
}

/// A name that ends in .toml is a file; any other name is a case.
pub(crate) fn is_file(name: &str) -> bool {
    let extension = Path::new(name).extension();
    extension.is_some_and(|extension| extension == "toml")
}

/// Reads a case file.
///
/// # Errors
/// Usage: it cannot be read, or is larger than clebsch reads.
pub(crate) fn read(file: &Path) -> Result<CaseText, Failure> {
    let text = crate::terminal::bounded::text(file, "case file")?;
    Ok(CaseText {
        file: file.to_string_lossy().into_owned(),
        text,
    })
}

/// The location of a case.
#[derive(Clone, Debug)]
enum CaseLocation {
    At(PathBuf),
    Shipped(CaseText),
}

/// The cases of one model, the default one first.
#[derive(Clone, Debug, Default)]
pub(crate) struct NamedCases {
    cases: Vec<(String, CaseLocation)>,
}

impl NamedCases {
    /// The cases next to a model file. The name of the case that belongs to the model file is the name in its text.
    pub fn beside(model: &Path) -> Self {
        let own = model.with_extension("toml");
        let mut cases = Vec::new();
        if own.is_file() {
            // A case that cannot be read is listed here and fails when it is requested.
            let name = read(&own).ok().and_then(|case| stated(&case.text));
            cases.push((name.unwrap_or_else(|| stem(&own)), CaseLocation::At(own)));
        }
        let entries = fs::read_dir(model.with_extension(""));
        let mut others: Vec<PathBuf> = entries
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| entry.path())
            .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
            .collect();
        others.sort();
        cases.extend(
            others
                .into_iter()
                .map(|path| (stem(&path), CaseLocation::At(path))),
        );
        Self { cases }
    }

    /// The cases of a shipped model.
    pub fn shipped(model: &ModelFile) -> Self {
        let cases = model.cases.iter().map(|case| {
            let own = stated(case.text).filter(|_| case.stem == model.name);
            let name = own.unwrap_or_else(|| case.stem.to_owned());
            let file = match case.stem == model.name {
                true => format!("{}.toml", model.name),
                false => format!("{}/{}.toml", model.name, case.stem),
            };
            let text = case.text.to_owned();
            (name, CaseLocation::Shipped(CaseText { file, text }))
        });
        Self {
            cases: cases.collect(),
        }
    }

    /// The names of the cases.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.cases.iter().map(|(name, _)| name.as_str())
    }

    /// The case with this name, or the first case if no name is given. `None` if the model has no such case.
    ///
    /// # Errors
    /// Usage: the file of the case cannot be read.
    pub fn get(&self, name: Option<&str>) -> Result<Option<CaseText>, Failure> {
        let found = match name {
            None => self.cases.first(),
            Some(name) => self.cases.iter().find(|(known, _)| known == name),
        };
        match found {
            None => Ok(None),
            Some((_, CaseLocation::Shipped(text))) => Ok(Some(text.clone())),
            Some((_, CaseLocation::At(path))) => read(path).map(Some),
        }
    }

    /// The names of the cases, each with its description.
    pub fn described(&self) -> Vec<(String, String)> {
        let each = self.cases.iter().map(|(name, kept)| {
            let text = match kept {
                CaseLocation::Shipped(case) => Some(case.text.clone()),
                CaseLocation::At(path) => read(path).ok().map(|case| case.text),
            };
            let doc = text.and_then(|text| string(&text, "doc"));
            (name.clone(), doc.unwrap_or_default())
        });
        each.collect()
    }
}

/// The message for a model file without a case.
pub(crate) fn none_beside(model: &str) -> Failure {
    let own = Path::new(model).with_extension("toml");
    let (model, own) = (shown(model), own.to_string_lossy().into_owned());
    let own = shown(&own);
    Failure::Usage(format!(
        "`{model}` has no case file; create one with `clebsch case {model} > {own}` and edit its numbers. `--case sample` runs \
         placeholder values"
    ))
}

/// The name that a case states.
fn stated(text: &str) -> Option<String> {
    string(text, "name")
}

/// A string at the top level of a case.
fn string(text: &str, key: &str) -> Option<String> {
    let table = DeTable::parse(text).ok()?;
    Some(table.get_ref().get(key)?.get_ref().as_str()?.to_owned())
}

fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}
