//! A folder that appears complete or not at all.
//! Takes the folder's final name; gives a hidden sibling to write into, renamed at the end and
//! removed when anything fails before.

use crate::failure::Failure;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The folder in the making. Dropping it uncommitted removes all traces.
#[derive(Debug)]
pub struct Staging {
    target: PathBuf,
    hidden: PathBuf,
    aside: PathBuf,
    /// Parents of the target that did not exist, innermost first.
    created: Vec<PathBuf>,
    committed: bool,
}

impl Staging {
    /// Checks that `target` may be written and makes the hidden sibling.
    ///
    /// # Errors
    /// Usage: it exists and `force` is not given, or it is not the folder of an earlier run (empty, or
    /// nothing but the files `known` of a run): such a folder is never replaced. Failed: no permission.
    pub fn new(target: &Path, force: bool, known: &[&str]) -> Result<Self, Failure> {
        let shown = target.display();
        let Some(name) = target.file_name() else {
            return Err(Failure::Usage(format!(
                "--out {shown}: this names no new folder"
            )));
        };
        if let Some(obstacle) = obstacle(target, force, known)? {
            return Err(Failure::Usage(format!("--out {shown}: {obstacle}")));
        }
        // The process id keeps simultaneous runs apart; it appears in no file.
        let sibling = |role: &str| {
            let mut hidden = OsString::from(".");
            hidden.push(name);
            hidden.push(format!(".{role}-{}", std::process::id()));
            target.with_file_name(hidden)
        };
        let mut staging = Self {
            target: target.to_owned(),
            hidden: sibling("partial"),
            aside: sibling("replaced"),
            created: Vec::new(),
            committed: false,
        };
        staging
            .make()
            .map_err(|error| Failure::io(&format!("cannot make the folder {shown}"), &error))?;
        Ok(staging)
    }

    fn make(&mut self) -> io::Result<()> {
        let missing = self.target.ancestors().skip(1);
        let missing = missing.take_while(|path| !path.as_os_str().is_empty() && !path.exists());
        let missing: Vec<PathBuf> = missing.map(Path::to_owned).collect();
        for parent in missing.iter().rev() {
            fs::create_dir(parent)?;
            self.created.insert(0, parent.clone());
        }
        // One of this name was left by an interrupted run whose process id has come round again.
        match fs::remove_dir_all(&self.hidden) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => fs::create_dir(&self.hidden),
        }
    }

    /// Writes one file and sees it to the disk.
    ///
    /// # Errors
    /// Failed: the file system refuses.
    pub fn write(
        &self,
        name: &str,
        contents: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let put = || {
            let mut file = BufWriter::new(File::create_new(self.hidden.join(name))?);
            contents(&mut file)?;
            file.into_inner()?.sync_all()
        };
        put().map_err(|error| {
            let path = self.target.join(name);
            Failure::io(&format!("cannot write {}", path.display()), &error)
        })
    }

    /// Gives the folder its name. An earlier one is moved aside, and removed once that is done.
    ///
    /// # Errors
    /// Failed: the file system refuses; the earlier folder is then where it was.
    pub fn commit(mut self) -> Result<(), Failure> {
        let replaces = self.target.exists();
        let rename = || {
            if replaces {
                fs::rename(&self.target, &self.aside)?;
            }
            fs::rename(&self.hidden, &self.target).inspect_err(|_| {
                if replaces {
                    // The first error is the one to report.
                    let _ = fs::rename(&self.aside, &self.target);
                }
            })
        };
        rename().map_err(|error| {
            Failure::io(
                &format!("cannot put {} in place", self.target.display()),
                &error,
            )
        })?;
        self.committed = true;
        if replaces {
            fs::remove_dir_all(&self.aside).map_err(|error| {
                let aside = self.aside.display();
                Failure::io(
                    &format!("cannot remove the earlier results, now in {aside}"),
                    &error,
                )
            })?;
        }
        Ok(())
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        if self.committed {
            return;
        }
        // Nothing can be done about errors here; the failure that led here is the one reported.
        let _ = fs::remove_dir_all(&self.hidden);
        for parent in &self.created {
            let _ = fs::remove_dir(parent);
        }
    }
}

/// Why `target` may not be written, if so.
fn obstacle(target: &Path, force: bool, known: &[&str]) -> Result<Option<String>, Failure> {
    let found = match fs::symlink_metadata(target) {
        Ok(found) => found,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => {
            return Err(Failure::io(
                &format!("cannot look at {}", target.display()),
                &error,
            ));
        }
    };
    if !found.is_dir() {
        return Ok(Some("this exists and is no folder".to_owned()));
    }
    if !force {
        return Ok(Some("this exists; give --force to replace it".to_owned()));
    }
    let looking =
        |error: io::Error| Failure::io(&format!("cannot look into {}", target.display()), &error);
    for entry in fs::read_dir(target).map_err(looking)? {
        let name = entry.map_err(looking)?.file_name();
        if !known.iter().any(|file| name == **file) {
            return Ok(Some(format!(
                "not replaced, as it holds `{}`, which no run wrote; remove it or name another folder",
                name.display()
            )));
        }
    }
    Ok(None)
}
