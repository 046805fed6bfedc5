//! Where in a case file a key stands, so that every message can name file, line and field.
//! Takes the file's name and text; gives lines and placed messages.

use crate::failure::Failure;
use crate::gallery::Case;
use crate::plain::shown;
use std::collections::BTreeMap;
use std::ops::Range;

/// A case and the lines its values came from.
#[derive(Clone, Debug)]
pub struct Located {
    /// The case.
    pub case: Case,
    /// File name as the user gave it.
    pub file: String,
    /// Line, from 1, of each key such as `parameters.J`.
    pub lines: BTreeMap<String, usize>,
}

/// A file being read.
pub(super) struct File<'a> {
    pub name: &'a str,
    pub text: &'a str,
    /// Of a text that was written out: the line of the file that each of its lines came from.
    origin: Option<&'a [usize]>,
}

impl<'a> File<'a> {
    /// A file as it is.
    pub fn new(name: &'a str, text: &'a str) -> File<'a> {
        File {
            name,
            text,
            origin: None,
        }
    }

    /// A text that was written out from a file.
    pub fn written_out(name: &'a str, text: &'a str, origin: &'a [usize]) -> File<'a> {
        File {
            name,
            text,
            origin: Some(origin),
        }
    }

    /// Line, from 1, where `span` begins.
    pub fn line(&self, span: &Range<usize>) -> usize {
        let before = self.text.as_bytes().iter().take(span.start);
        let line = before.filter(|&&byte| byte == b'\n').count();
        match self.origin.and_then(|lines| lines.get(line)) {
            Some(own) => (*own).max(1),
            None => 1 + line,
        }
    }

    /// A usage failure at `span` (or for the file as a whole).
    pub fn wrong(&self, span: Option<&Range<usize>>, message: &str) -> Failure {
        Failure::Usage(match span {
            Some(span) => format!("{}:{}: {message}", shown(self.name), self.line(span)),
            None => format!("{}: {message}", shown(self.name)),
        })
    }
}
