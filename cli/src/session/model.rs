//! A model of the gallery, of a file or of a text in memory. Takes the case as text; gives the plan of its run.

use super::request::Request;
use crate::case_file;
use crate::case_file::stated::Stated;
use crate::commands::derive::{Proofs, derived};
use crate::commands::show;
use crate::models::gallery::{Citations, Entry, Gallery};
use crate::named::cases::{CaseText, NamedCases, WhichCase};
use crate::named::model_file::{self, ModelText};
use crate::named::resolve::{NamedModel, named};
use crate::plan::Plan;
use crate::terminal::Streams;
use crate::terminal::failure::Failure;
use clebsch::card::Card;
use clebsch_core::{Errors, lattice, pipeline};
use clebsch_interpret::{Cache, Refused};
use std::borrow::Cow;
use std::io;

/// A model that a program runs.
pub struct Model {
    text: ModelText,
    /// Its card and cases, if the stepper is compiled.
    compiled: Option<Entry>,
    /// Its card, if no case changes it: the model has no labels, and no functions that a case gives.
    fixed: Option<Entry>,
    has_sites: bool,
    warnings: String,
}

/// A case that is ready to start.
pub struct Planned {
    /// The card of the model, of the size or on the sites of the case.
    pub card: Card,
    /// The plan of the run.
    pub plan: Plan,
    /// Warnings on the text of the model, rendered with carets.
    pub warnings: String,
}

impl Model {
    /// The model of a text, which messages call `name`. A cache may have its derivation.
    ///
    /// # Errors
    /// Usage: the text does not derive, which the message shows with a caret; or the model needs a build.
    pub fn of_text(name: &str, text: &str, cache: &Cache) -> Result<Self, Failure> {
        Self::read(ModelText {
            name: name.to_owned(),
            text: text.to_owned(),
            cases: NamedCases::default(),
            is_path: false,
            cache: cache.clone(),
        })
    }

    /// The model of the gallery with this name, or of the file with this path.
    ///
    /// # Errors
    /// Usage: the model is unknown, a file cannot be read, or the text does not derive.
    pub fn named(gallery: &Gallery, name: &str) -> Result<Self, Failure> {
        match named(gallery, name, "expected a model")? {
            NamedModel::Text(text) if text.is_path => Self::read(text),
            // Shipped texts are derived here, and each run derives them again for its case.
            NamedModel::Text(text) => Ok(Self {
                has_sites: has_sites(&text.text),
                text,
                compiled: None,
                fixed: None,
                warnings: String::new(),
            }),
            NamedModel::Compiled(entry) => Ok(Self {
                text: ModelText {
                    name: entry.card.kebab.to_owned(),
                    text: entry.card.source.to_owned(),
                    cases: NamedCases::default(),
                    is_path: false,
                    cache: gallery.cache.clone(),
                },
                has_sites: has_sites(entry.card.source),
                compiled: Some(entry.clone()),
                fixed: None,
                warnings: String::new(),
            }),
        }
    }

    fn read(text: ModelText) -> Result<Self, Failure> {
        let mut warnings = Vec::new();
        let entry = model_file::read(&text, &WhichCase::First, &mut warnings)?;
        let has_sites = has_sites(&text.text);
        let is_fixed = !has_sites && !gives_functions(&text.text);
        Ok(Self {
            text,
            compiled: None,
            fixed: is_fixed.then_some(entry),
            has_sites,
            warnings: String::from_utf8_lossy(&warnings).into_owned(),
        })
    }

    /// Its name in messages: the name in the gallery, a path, or the name given with the text.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.text.name
    }

    /// The name that its text declares.
    #[must_use]
    pub fn declared(&self) -> Option<String> {
        crate::models::gallery::declared(&self.text.text)
    }

    /// Its text.
    #[must_use]
    pub fn source(&self) -> &str {
        &self.text.text
    }

    /// Warnings on its text, rendered with carets.
    #[must_use]
    pub fn warnings(&self) -> &str {
        &self.warnings
    }

    /// Whether the model has labels. Its card then depends on the number of sites.
    #[must_use]
    pub fn has_sites(&self) -> bool {
        self.has_sites
    }

    /// The names of its cases, the default case first, each with its description.
    #[must_use]
    pub fn cases(&self) -> Vec<(String, String)> {
        match &self.compiled {
            Some(entry) => {
                let cases = entry.cases.iter();
                cases.map(|c| (c.name.clone(), c.doc.clone())).collect()
            }
            None => self.text.cases.described(),
        }
    }

    /// The name of a case's file in messages, and its text. `sample` has placeholder values; a name that ends
    /// in .toml is a path.
    ///
    /// # Errors
    /// Usage: the case is unknown, or a file cannot be read.
    pub fn case(&self, name: Option<&str>) -> Result<(String, String), Failure> {
        if let Some(entry) = &self.compiled
            && !name.is_some_and(crate::named::cases::is_file)
        {
            let case = crate::models::gallery::case(entry, name)?;
            let text = case_file::write(&entry.card_of(case), case, entry.card.kebab);
            return Ok((format!("{}:{}", entry.card.kebab, case.name), text));
        }
        match crate::named::resolve::case_of(&self.text, name)? {
            WhichCase::Text(case) => Ok((case.file, case.text)),
            _ => {
                let streams = &mut Streams {
                    input: &mut io::empty(),
                    out: &mut io::sink(),
                    err: &mut io::sink(),
                    progress: false,
                    width: None,
                };
                let text = show::placeholder(&self.text, streams)?;
                Ok(("sample".to_owned(), text))
            }
        }
    }

    /// The card of the model; with labels that on the default number of sites.
    ///
    /// # Errors
    /// As [`Model::named`].
    pub fn card(&self) -> Result<Card, Failure> {
        let known = self.compiled.as_ref().or(self.fixed.as_ref());
        match known {
            Some(entry) => Ok(entry.card),
            None => {
                let text = &self.text;
                let read = model_file::read(text, &WhichCase::First, &mut io::sink());
                read.map(|entry| entry.card)
            }
        }
    }

    /// The plan of a case. `file` is the file name for messages, `text` the case.
    ///
    /// # Errors
    /// Usage: a mistake in the case or the request.
    pub fn planned(&self, file: &str, text: &str, request: &Request) -> Result<Planned, Failure> {
        let case = CaseText {
            file: file.to_owned(),
            text: text.to_owned(),
        };
        let mut warnings = Vec::new();
        let (entry, case) = match self.compiled.as_ref().or(self.fixed.as_ref()) {
            Some(entry) => (Cow::Borrowed(entry), case),
            None => {
                let which = WhichCase::Text(case.clone());
                (
                    Cow::Owned(model_file::read(&self.text, &which, &mut warnings)?),
                    case,
                )
            }
        };
        let mut plan = Plan::of_text(&entry, &case, self.has_sites)?;
        request.applied(&mut plan, entry.card.solvers)?;
        let card = entry.card_of(&plan.case);
        Ok(Planned {
            card,
            plan,
            warnings: String::from_utf8_lossy(&warnings).into_owned(),
        })
    }

    /// The derivation in a form: `text`, `latex`, `markdown`, `rust` or `json`. It can include the proof, or be
    /// a complete document.
    ///
    /// # Errors
    /// Usage: the text does not derive.
    pub fn derivation(
        &self,
        format: &str,
        explain: bool,
        standalone: bool,
    ) -> Result<String, Failure> {
        let citations = self
            .compiled
            .as_ref()
            .map_or(Citations::NONE, |e| e.citations);
        let proofs = Proofs {
            explain,
            standalone,
            ..Proofs::default()
        };
        let derived = derived(self.name(), self.source(), citations, format, proofs, None);
        derived.map(|(text, _)| text).map_err(Failure::Usage)
    }

    /// The mistakes of a text that is not a model.
    #[must_use]
    pub fn mistakes(text: &str) -> Option<Errors> {
        let model = match pipeline::parse_source(text) {
            Ok(model) => model,
            Err(errors) => return Some(errors),
        };
        let refused = match Stated::read(text)
            .as_ref()
            .and_then(case_file::default_choice)
        {
            Some(choice) => clebsch_interpret::card_on_lattice(text, &choice).err(),
            None if lattice::has_labels(&model) => {
                return pipeline::derive_model(&model).err();
            }
            None => clebsch_interpret::card_and_warnings(text).err(),
        };
        match refused {
            Some(Refused::Model(errors)) => Some(errors),
            _ => None,
        }
    }
}

fn has_sites(text: &str) -> bool {
    pipeline::parse_source(text).is_ok_and(|model| lattice::has_labels(&model))
}

fn gives_functions(text: &str) -> bool {
    pipeline::parse_source(text).is_ok_and(|model| case_file::functions::are_given(&model))
}
