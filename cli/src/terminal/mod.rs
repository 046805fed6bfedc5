//! Where a command reads and writes: its streams, how it fails, what is waited for, and texts no larger than it accepts.

pub(crate) mod bounded;
pub mod failure;
pub(crate) mod waiting;

use std::io::{Read, Write};

/// Where a command reads and writes.
pub struct Streams<'a> {
    /// What `-` stands for where a file is asked for.
    pub input: &'a mut dyn Read,
    /// Results.
    pub out: &'a mut dyn Write,
    /// Messages.
    pub err: &'a mut dyn Write,
    /// Whether to draw progress on the process's standard error.
    pub progress: bool,
    /// How many letters a line of help or of a table may have; `None` where nothing limits them, as in
    /// a file.
    pub width: Option<usize>,
}
