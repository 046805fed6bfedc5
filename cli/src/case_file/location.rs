//! The positions of keys in a case file, so that every message can name file, line and field.
//! Takes the file's name and text; gives lines and placed messages.

use super::motion::Motion;
use super::not_toml;
use crate::models::gallery::Case;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use crate::words::suggestion::did_you_mean;
use clebsch_core::lattice::ChainConfig;
use std::collections::{BTreeMap, HashSet};
use std::ops::Range;
use toml::Spanned;
use toml::de::DeTable;

/// A case and the lines of its values.
#[derive(Clone, Debug)]
pub struct Located {
    /// The case.
    pub case: Case,
    /// File name as the user gave it.
    pub file: String,
    /// Line, from 1, of each key such as `parameters.J`.
    pub lines: BTreeMap<String, usize>,
    /// The initial velocities, and the configurations at rest.
    pub(crate) motion: Motion,
    /// The number of sites of a model with labels, and its end conditions.
    pub(crate) choice: Option<ChainConfig>,
}

/// A file being read.
pub(super) struct File<'a> {
    pub name: &'a str,
    pub text: &'a str,
    /// The byte offsets of the line ends.
    ends: Vec<usize>,
}

impl<'a> File<'a> {
    /// A file with this name and text.
    pub fn new(name: &'a str, text: &'a str) -> File<'a> {
        File {
            name,
            text,
            ends: ends(text),
        }
    }

    /// The parsed document.
    ///
    /// # Errors
    /// Usage: the text is not TOML; the message has the line.
    pub fn document(&self) -> Result<Spanned<DeTable<'a>>, Failure> {
        DeTable::parse(self.text).map_err(|error| {
            let span = error.span();
            let stop = span.as_ref().map_or(self.text.len(), |span| span.start);
            let instead = span
                .as_ref()
                .and_then(|span| not_toml::instead(self.text, span));
            if let (None, Some(open)) = (&instead, not_toml::unclosed(self.text, stop)) {
                return self.wrong(Some(&(open.at..open.at)), &open.to_string());
            }
            let message = instead.unwrap_or_else(|| format!("not TOML: {}", error.message()));
            self.wrong(span.as_ref(), &message)
        })
    }

    /// Line, from 1, in which `span` starts.
    pub fn line(&self, span: &Range<usize>) -> usize {
        1 + self.ends.partition_point(|end| *end < span.start)
    }

    /// The table `name`; `None` if the file does not contain it.
    ///
    /// # Errors
    /// Usage: the value with this name is not a table.
    pub fn table<'t, 'i>(
        &self,
        top: &'t DeTable<'i>,
        name: &str,
    ) -> Result<Option<&'t DeTable<'i>>, Failure> {
        let Some(value) = top.get(name) else {
            return Ok(None);
        };
        match value.get_ref().as_table() {
            Some(table) => Ok(Some(table)),
            None => Err(self.wrong(
                Some(&value.span()),
                &format!(
                    "{name}: expected a table [{name}], found a value of type {}",
                    value.get_ref().type_str()
                ),
            )),
        }
    }

    /// Rejects a key of a table that is not in `known`. `otherwise` may suggest the intended key.
    ///
    /// # Errors
    /// Usage: the first unknown key.
    pub fn known_keys(
        &self,
        table: &DeTable<'_>,
        known: &[&str],
        place: &str,
        otherwise: &dyn Fn(&str) -> Option<String>,
    ) -> Result<(), Failure> {
        let all: HashSet<&str> = known.iter().copied().collect();
        for key in table.keys() {
            let name = key.get_ref().as_ref();
            if all.contains(name) {
                continue;
            }
            let hint = otherwise(name).unwrap_or_else(|| did_you_mean(name, known.iter().copied()));
            return Err(self.wrong(
                Some(&key.span()),
                &format!("unknown key `{}` {place}{hint}", shown(name)),
            ));
        }
        Ok(())
    }

    /// A usage failure at a line.
    pub fn wrong_at(&self, line: usize, message: &str) -> Failure {
        Failure::Usage(format!("{}:{line}: {message}", shown(self.name)))
    }

    /// A usage failure at `span` (or for the file as a whole).
    pub fn wrong(&self, span: Option<&Range<usize>>, message: &str) -> Failure {
        Failure::Usage(match span {
            Some(span) => format!("{}:{}: {message}", shown(self.name), self.line(span)),
            None => format!("{}: {message}", shown(self.name)),
        })
    }
}

fn ends(text: &str) -> Vec<usize> {
    let bytes = text.bytes().enumerate();
    bytes
        .filter(|(_, b)| *b == b'\n')
        .map(|(at, _)| at)
        .collect()
}
