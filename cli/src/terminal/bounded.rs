//! Reads text files up to a maximal size, so that an endless device is rejected.
//! Takes a path or a stream; gives the text.

use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The largest size of a model or a case in bytes: 10 MB. The longest shipped file has 3 kB.
const MOST: u64 = 10_000_000;

/// The text of a file; `what` names it in messages: "model file".
///
/// # Errors
/// Usage: it cannot be read, is longer than 10 MB, or is not UTF-8.
pub(crate) fn text(path: &Path, what: &str) -> Result<String, Failure> {
    let name = format!("the {what} {}", shown(path));
    let file = File::open(path).map_err(|error| cannot(&name, &error))?;
    stream(file, &name)
}

/// The text of a stream, which `name` names in messages.
///
/// # Errors
/// As [`text`].
pub(crate) fn stream(input: impl Read, name: &str) -> Result<String, Failure> {
    let mut text = String::new();
    let read = input.take(MOST + 1).read_to_string(&mut text);
    // The first megabytes of a device may not be UTF-8, or may end within a character.
    let read = read.map_err(|error| cannot(name, &error))?;
    match u64::try_from(read) {
        Ok(read) if read <= MOST => Ok(text),
        _ => Err(Failure::Usage(format!(
            "{name} is larger than 10 MB, the limit of clebsch; models and cases take a few kilobytes, and arrays belong in a \
             .npz file that the case names"
        ))),
    }
}

fn cannot(name: &str, error: &std::io::Error) -> Failure {
    Failure::Usage(format!("cannot read {name}: {error}"))
}
