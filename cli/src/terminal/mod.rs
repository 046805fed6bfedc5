//! The interface of a command to the outside: its streams, its failures, the progress of long computations, and
//! bounded input, and the folder of the cache.

pub(crate) mod bounded;
pub(crate) mod cache_folder;
pub mod failure;
pub(crate) mod waiting;

use std::io::{Read, Write};

/// The streams that a command reads and writes.
pub struct Streams<'a> {
    /// The input that the file name `-` refers to.
    pub input: &'a mut dyn Read,
    /// Results.
    pub out: &'a mut dyn Write,
    /// Messages.
    pub err: &'a mut dyn Write,
    /// Whether to draw progress on the process's standard error.
    pub progress: bool,
    /// The largest number of characters in a line of help or of a table; `None` if it is unlimited, as in a file.
    pub width: Option<usize>,
}
