//! A folder that appears complete or not at all, and never replaces other contents. Takes the folder's final name;
//! gives a hidden sibling to write into. At the end the sibling gets the final name if this name is free, otherwise
//! another name next to it.
//!
//! The final name is checked twice. The check at the start rejects a run that could not be written before it
//! computes. At the end only atomic operations of the file system decide: a folder is created only if it does not
//! exist ([`fs::create_dir`]), and renamed only over an empty folder. If several runs write into one folder, one run
//! gets the name, and each of the others keeps its results under another name.
//!
//! A run locks its hidden folder, and the system releases the lock however the run ends. The next run into the
//! same folder removes the remains of killed runs, unless they can be resumed: see [`resumed`].

mod resumed;

pub use resumed::ResumableRun;

use super::interrupted;
use super::output_target::{self, EarlierFiles};
use crate::terminal::failure::Failure;
use crate::words::plain::{PrintableName, shown};
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

/// The number of names tried. The next name is tried only if a name is taken.
const ATTEMPTS: u32 = 10_000;

/// The middle part of the name of a hidden folder, between the name of the target and numbers.
const PARTIAL: &str = "partial";

/// The folder in the making. Dropping it uncommitted removes all traces.
#[derive(Debug)]
pub struct Staging {
    target: PathBuf,
    hidden: PathBuf,
    /// The hidden folder, locked; `None` if the file system does not lock folders.
    held: Option<File>,
    /// The results that `--force` is to replace, as they were at the start.
    standing: Option<EarlierFiles>,
    known: Vec<&'static str>,
    /// Parents of the target that did not exist, innermost first.
    created: Vec<PathBuf>,
    /// Whether the folder stays if the run ends before its results are complete, since it can be resumed.
    kept: bool,
    /// The path of the folder before it was resumed; cleared when the run continues.
    taken_from: Option<PathBuf>,
    committed: bool,
}

impl Staging {
    /// Checks that `target` may be written and creates the hidden sibling.
    ///
    /// # Errors
    /// Usage: `target` exists and `force` is not given, or it is not the folder of an earlier run. Such a
    /// folder is empty or contains only `known` files; other folders are never replaced. Failed: no permission.
    pub fn new(target: &Path, force: bool, known: &[&'static str]) -> Result<Self, Failure> {
        if target.file_name().is_none() {
            return Err(Failure::Usage(format!(
                "--out {}: this does not name a folder",
                shown(target)
            )));
        }
        let standing = output_target::at(target, force, known)?;
        if !force {
            Self::nothing_to_resume(target)?;
        }
        let mut staging = Self {
            target: target.to_owned(),
            hidden: PathBuf::new(),
            held: None,
            standing,
            known: known.to_vec(),
            created: Vec::new(),
            kept: false,
            taken_from: None,
            committed: false,
        };
        staging.make().map_err(|error| {
            Failure::io(&format!("cannot make the folder {}", shown(target)), &error)
        })?;
        interrupted::begin(&staging.hidden, &staging.created);
        Ok(staging)
    }

    fn make(&mut self) -> io::Result<()> {
        let missing = self.target.ancestors().skip(1);
        let missing = missing.take_while(|path| !path.as_os_str().is_empty() && !path.exists());
        let missing: Vec<PathBuf> = missing.map(Path::to_owned).collect();
        for parent in missing.iter().rev() {
            match fs::create_dir(parent) {
                Ok(()) => self.created.insert(0, parent.clone()),
                // Another run has just created it.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        self.remove_abandoned();
        let mut left = ATTEMPTS;
        loop {
            let hidden = self.fresh(PARTIAL)?;
            self.held = File::open(&hidden).and_then(|f| f.lock().map(|()| f)).ok();
            // Before the folder was locked, another run may have removed it as abandoned.
            left -= 1;
            if hidden.exists() || left == 0 {
                self.hidden = hidden;
                return Ok(());
            }
        }
    }

    /// Removes the hidden folders of killed runs: folders that are not locked and contain only files of a run.
    /// Errors are ignored, since these folders do not affect this run.
    fn remove_abandoned(&self) {
        for folder in Self::abandoned(&self.target) {
            let _ = self.remove_if_abandoned(&folder);
        }
    }

    fn remove_if_abandoned(&self, folder: &Path) -> io::Result<()> {
        let lock = File::open(folder)?;
        if lock.try_lock().is_err() {
            return Ok(());
        }
        match output_target::look(folder, &self.known)? {
            Ok(files) => files.remove(folder),
            Err(_) => Ok(()),
        }
    }

    /// Creates a hidden sibling with a new name. The process id only shortens the search.
    fn fresh(&self, role: &str) -> io::Result<PathBuf> {
        let id = std::process::id();
        first_free(|count| {
            let path = self.sibling(".", &format!(".{role}-{id}-{count}"));
            fs::create_dir(&path).map(|()| path)
        })
    }

    /// `target` with a prefix and a suffix around its name.
    fn sibling(&self, before: &str, behind: &str) -> PathBuf {
        let mut name = OsString::from(before);
        name.push(self.target.file_name().unwrap_or_default());
        name.push(behind);
        self.target.with_file_name(name)
    }

    /// The folder in the making.
    pub(crate) fn folder(&self) -> &Path {
        &self.hidden
    }

    /// From here on the folder is not removed before its results are complete.
    pub(crate) fn keep(&mut self) {
        self.kept = true;
        interrupted::keep(&self.hidden);
    }

    /// Creates an inner folder. The names of its files start with its name.
    ///
    /// # Errors
    /// Failed: the folder cannot be made.
    pub(crate) fn make_folder(&self, name: &str) -> Result<(), Failure> {
        fs::create_dir(self.hidden.join(name)).map_err(|error| {
            let path = self.target.join(name);
            Failure::io(&format!("cannot make the folder {}", shown(&path)), &error)
        })
    }

    /// Writes one file and flushes it to disk.
    ///
    /// # Errors
    /// Failed: the file cannot be written.
    pub fn write(
        &self,
        name: &str,
        contents: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let put = || {
            let mut file = BufWriter::new(File::create_new(self.hidden.join(name))?);
            contents(&mut file)?;
            file.into_inner()?.sync_all()
        };
        put().map_err(|error| {
            let path = self.target.join(name);
            Failure::io(&format!("cannot write {}", shown(&path)), &error)
        })
    }

    /// Gives the folder its final name. The results that were there at the start are removed afterwards.
    ///
    /// # Errors
    /// Failed: the name was taken meanwhile, the earlier results have changed, or a file operation fails. The
    /// existing folder is then left unchanged, and the results are kept next to it. The message gives their
    /// path.
    pub fn commit(mut self) -> Result<(), Failure> {
        // From here on the results are complete and are never removed.
        self.complete();
        let target = shown(&self.target);
        let earlier = match self.set_aside() {
            Ok(earlier) => earlier,
            Err(why) => return Err(self.keep_beside(&why)),
        };
        if let Err(error) = place(&self.hidden, &self.target) {
            let mut why = match taken(&error) {
                true => {
                    "another program created it during the run, so it is left unchanged".to_owned()
                }
                false => format!("cannot put the results there: {error}"),
            };
            if let Some(aside) = earlier {
                why.push_str(&self.give_back(&aside));
            }
            return Err(self.keep_beside(&why));
        }
        let (Some(aside), Some(standing)) = (earlier, &self.standing) else {
            return Ok(());
        };
        standing.remove(&aside).map_err(|error| {
            Failure::Failed(format!(
                "--out {target}: the results are written; the earlier contents cannot be removed completely ({error}), the \
                 rest is in {}",
                shown(&aside)
            ))
        })
    }

    /// As [`Staging::commit`], for results of a run that the user interrupted. The results that `--force` was to replace
    /// stay. Gives the path of the new results.
    ///
    /// # Errors
    /// As [`Staging::commit`].
    pub fn commit_interrupted(mut self) -> Result<PrintableName, Failure> {
        if self.standing.is_none() {
            let target = shown(&self.target);
            return self.commit().map(|()| target);
        }
        self.complete();
        Ok(self.beside(&self.hidden))
    }

    /// From here on the results are not removed.
    fn complete(&mut self) {
        self.committed = true;
        interrupted::end(&self.hidden);
    }

    /// Moves the results to be replaced aside, if they are unchanged since the start. Returns their new path, or
    /// `None` if there is nothing to replace.
    fn set_aside(&self) -> Result<Option<PathBuf>, String> {
        let Some(standing) = &self.standing else {
            return Ok(None);
        };
        let why = |error: io::Error| format!("cannot move the earlier contents: {error}");
        let aside = self.fresh("replaced").map_err(why)?;
        if let Err(error) = rename(&self.target, &aside) {
            // The folder is empty and was created here, so it does not matter if it cannot be removed.
            let _ = fs::remove_dir(&aside);
            return match error.kind() {
                io::ErrorKind::NotFound => Ok(None),
                _ => Err(why(error)),
            };
        }
        // Checked after the move, so that no run can exchange it between the check and the move.
        match output_target::look(&aside, &self.known) {
            Ok(Ok(now)) if now == *standing => Ok(Some(aside)),
            // An empty folder contains no results: another run has just created it to reserve the name.
            _ if fs::remove_dir(&aside).is_ok() => Ok(None),
            _ => Err(format!(
                "its contents changed during the run, so it is not replaced{}",
                self.give_back(&aside)
            )),
        }
    }

    /// Moves the earlier results back, or next to their path if it is taken. Gives the sentence for the
    /// message.
    fn give_back(&self, aside: &Path) -> String {
        // An empty folder moved back could occupy the path of results that another run has just set aside.
        if fs::remove_dir(aside).is_ok() {
            return String::new();
        }
        match place(aside, &self.target) {
            Ok(()) => String::new(),
            Err(_) => format!("; the earlier contents are in {}", self.beside(aside)),
        }
    }

    /// Gives the results a free name next to the target, and reports it.
    fn keep_beside(&self, why: &str) -> Failure {
        let target = shown(&self.target);
        let place = self.beside(&self.hidden);
        Failure::Failed(format!("--out {target}: {why}; the results are in {place}"))
    }

    /// Renames a folder to the first free name of `target-2`, `target-3` and so on, and returns its path.
    fn beside(&self, folder: &Path) -> PrintableName {
        let kept = first_free(|count| {
            let path = self.sibling("", &format!("-{}", count + 2));
            place(folder, &path).map(|()| path)
        });
        shown(&kept.unwrap_or_else(|_| folder.to_owned()))
    }
}

/// The first of many names that is not taken.
fn first_free(mut attempt: impl FnMut(u32) -> io::Result<PathBuf>) -> io::Result<PathBuf> {
    let mut count = 0;
    loop {
        match attempt(count) {
            Err(error) if taken(&error) && count < ATTEMPTS => count += 1,
            other => return other,
        }
    }
}

/// Whether the name was there already.
fn taken(error: &io::Error) -> bool {
    use io::ErrorKind::{AlreadyExists, DirectoryNotEmpty};
    matches!(error.kind(), AlreadyExists | DirectoryNotEmpty)
}

/// Renames the folder `from` to `to`, if `to` does not exist.
fn place(from: &Path, to: &Path) -> io::Result<()> {
    // Only one process succeeds in making the empty folder, and a rename replaces only an empty folder. If
    // another process puts a file into it first, the rename fails.
    fs::create_dir(to)?;
    rename(from, to).inspect_err(|_| {
        let _ = fs::remove_dir(to);
    })
}

/// Renames the folder `from` over the empty folder `to`.
fn rename(from: &Path, to: &Path) -> io::Result<()> {
    if cfg!(windows) {
        // Here a rename cannot replace a folder; this removes the folder only while it is empty.
        fs::remove_dir(to)?;
    }
    fs::rename(from, to)
}

impl Drop for Staging {
    fn drop(&mut self) {
        if self.committed {
            return;
        }
        interrupted::end(&self.hidden);
        if let Some(before) = &self.taken_from {
            let _ = place(&self.hidden, before);
        }
        if !self.kept {
            interrupted::remove(&self.hidden, &self.created);
        }
    }
}
