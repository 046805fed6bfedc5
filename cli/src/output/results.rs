//! The folder of a command with a few small results. Takes the option `--out`; gives complete files, or none.

use super::Staging;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use clap::ArgMatches;
use std::io::Write;
use std::path::PathBuf;

/// A folder for results, if one is requested.
pub(crate) struct Results {
    folder: Option<(Staging, PathBuf)>,
}

impl Results {
    /// Checks that the folder of `--out` can be written, before anything is computed.
    ///
    /// # Errors
    /// Usage: it exists, and contains other files or `--force` is not given.
    pub fn begin(matches: &ArgMatches, known: &[&'static str]) -> Result<Self, Failure> {
        let target = matches.get_one::<PathBuf>("out");
        let folder = target.map(|target| {
            let staging = Staging::new(target, matches.get_flag("force"), known)?;
            Ok::<_, Failure>((staging, target.clone()))
        });
        Ok(Self {
            folder: folder.transpose()?,
        })
    }

    /// Whether files are written.
    pub fn is_wanted(&self) -> bool {
        self.folder.is_some()
    }

    /// Writes all files; gives the line about them.
    ///
    /// # Errors
    /// Failed: a file cannot be written.
    pub fn end(self, files: &[(&str, String)]) -> Result<Option<String>, Failure> {
        let Some((staging, target)) = self.folder else {
            return Ok(None);
        };
        for (name, text) in files {
            staging.write(name, |file| file.write_all(text.as_bytes()))?;
        }
        staging.commit()?;
        let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
        Ok(Some(format!(
            "written to {}: {}",
            shown(&target),
            names.join(", ")
        )))
    }
}

/// A table as CSV: names, then rows of numbers.
pub(crate) fn csv(names: &[String], rows: impl Iterator<Item = Vec<f64>>) -> String {
    let mut text = format!("{}\n", names.join(","));
    for row in rows {
        let cells: Vec<String> = row.iter().map(|x| format!("{x:?}")).collect();
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

/// The message of a picture that cannot be drawn.
pub(crate) fn drawn(svg: Result<String, String>, name: &str) -> Result<String, Failure> {
    svg.map_err(|error| Failure::Failed(format!("cannot draw {name}: {error}")))
}
