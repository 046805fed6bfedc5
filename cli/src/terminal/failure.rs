//! Why a command stops, and with which exit code. Takes a message; gives the exit code of the process.

use std::fmt;
use std::io;

/// Everything was done and every bounded invariant stayed within its bound.
pub const DONE: u8 = 0;
/// The solver or the file system failed. If the run stopped after its first step, the results so far are
/// written.
pub const FAILED: u8 = 1;
/// The request cannot be understood: arguments, names, case files, values.
pub const USAGE: u8 = 2;
/// The run is complete and its results are written, but an invariant exceeded its bound, or a step contradicts
/// the action as stated.
pub const BOUND_LEFT: u8 = 3;
/// Smaller than the exit codes for signals, 130 for SIGINT and 143 for SIGTERM.
pub const BY_SIGNAL: u8 = 128;

/// The reason why a command was not completed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The request is wrong; the message names the argument, or file, line and field.
    Usage(String),
    /// The request was fine, but the work failed.
    Failed(String),
    /// The reader of the output has closed it, as `head` does. There is no message.
    ReaderGone,
}

impl Failure {
    /// The exit code of the process.
    #[must_use]
    pub const fn code(&self) -> u8 {
        match self {
            Self::Usage(_) => USAGE,
            Self::Failed(_) | Self::ReaderGone => FAILED,
        }
    }

    /// An input or output error with the action that failed: `cannot write x/run.json`.
    #[must_use]
    pub fn io(doing: &str, error: &io::Error) -> Self {
        Self::Failed(format!("{doing}: {error}"))
    }

    /// The JSON object that reports the failure.
    #[must_use]
    pub fn json(&self) -> serde_json::Value {
        serde_json::json!({"error": self.to_string(), "exit_code": self.code()})
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(message) | Self::Failed(message) => f.write_str(message),
            Self::ReaderGone => f.write_str("the program that reads the output has closed it"),
        }
    }
}

impl std::error::Error for Failure {}

/// For `?` on writes to standard output, the only unlabelled ones.
impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self::ReaderGone
        } else {
            Self::io("cannot write to standard output", &error)
        }
    }
}
