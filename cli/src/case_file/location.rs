//! Where in a case file a key stands, so that every message can name file, line and field.
//! Takes the file's name and text; gives lines and placed messages.

use super::motion::Motion;
use super::not_toml;
use crate::models::gallery::Case;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;
use toml::de::DeTable;

/// A case and the lines its values came from.
#[derive(Clone, Debug)]
pub struct Located {
    /// The case.
    pub case: Case,
    /// File name as the user gave it.
    pub file: String,
    /// Line, from 1, of each key such as `parameters.J`.
    pub lines: BTreeMap<String, usize>,
    /// How what is not given by momenta starts.
    pub(crate) motion: Motion,
}

/// A file being read.
pub(super) struct File<'a> {
    pub name: &'a str,
    pub text: &'a str,
    /// Where its lines end.
    ends: Vec<usize>,
    /// Of a text that was written out: the line of the file that each of its lines came from.
    origin: Option<&'a [usize]>,
}

impl<'a> File<'a> {
    /// A file as it is.
    pub fn new(name: &'a str, text: &'a str) -> File<'a> {
        File {
            name,
            text,
            ends: ends(text),
            origin: None,
        }
    }

    /// A text that was written out from a file.
    pub fn written_out(name: &'a str, text: &'a str, origin: &'a [usize]) -> File<'a> {
        File {
            name,
            text,
            ends: ends(text),
            origin: Some(origin),
        }
    }

    /// What it holds.
    ///
    /// # Errors
    /// Usage: it is no TOML, with the line.
    pub fn document(&self) -> Result<Spanned<DeTable<'a>>, Failure> {
        DeTable::parse(self.text).map_err(|error| {
            let span = error.span();
            let instead = span
                .as_ref()
                .and_then(|span| not_toml::instead(self.text, span));
            let message = instead.unwrap_or_else(|| format!("not TOML: {}", error.message()));
            self.wrong(span.as_ref(), &message)
        })
    }

    /// Line, from 1, where `span` begins.
    pub fn line(&self, span: &Range<usize>) -> usize {
        let line = self.ends.partition_point(|end| *end < span.start);
        match self.origin.and_then(|lines| lines.get(line)) {
            Some(own) => (*own).max(1),
            None => 1 + line,
        }
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
