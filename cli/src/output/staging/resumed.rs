//! Resumes interrupted or killed runs.
//! Takes the folder for the results; gives its hidden folder, locked, with its checkpoint, or the reason why
//! there is nothing to resume. A run that cannot be resumed is left unchanged.

use super::{PARTIAL, Staging, first_free, interrupted, output_target};
use crate::output::samples;
use crate::terminal::failure::Failure;
use crate::trajectory::checkpoint::{self, Checkpoint, Identity};
use crate::words::plain::shown;
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

/// The result of the search for a run to resume.
pub enum ResumableRun {
    /// Nothing to resume: the run starts.
    Nothing,
    /// A run in the middle.
    Middle(Box<(Staging, Checkpoint)>),
    /// The results of a run are there already.
    Results,
}

/// Whether a folder contains a checkpoint.
fn has_checkpoint(folder: &Path) -> bool {
    folder.join(checkpoint::NAME).is_file()
}

impl Staging {
    /// Hidden folders of other runs into the same target.
    fn partial_folders(target: &Path) -> Vec<PathBuf> {
        let parent = target.parent().filter(|p| !p.as_os_str().is_empty());
        let Ok(siblings) = fs::read_dir(parent.unwrap_or(Path::new("."))) else {
            return Vec::new();
        };
        let name = target.file_name().unwrap_or_default().to_string_lossy();
        let start = format!(".{name}.{PARTIAL}-");
        let own = std::process::id();
        let mut found: Vec<PathBuf> = Vec::new();
        for entry in siblings.flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            let numbers = name.strip_prefix(&start).and_then(|n| n.split_once('-'));
            let Some((Ok(id), Ok(_))) = numbers.map(|(id, n)| (id.parse(), n.parse::<u32>()))
            else {
                continue;
            };
            // A name with the number of this process may belong to another run in this process that is not yet
            // locked.
            let another: u32 = id;
            if another != own {
                let parent = target.parent().unwrap_or(Path::new(""));
                found.push(parent.join(&name));
            }
        }
        found.sort();
        found
    }

    /// The hidden folders that no running process has locked.
    pub(super) fn abandoned(target: &Path) -> Vec<PathBuf> {
        let mut all = Self::partial_folders(target);
        all.retain(|folder| File::open(folder).is_ok_and(|file| file.try_lock().is_ok()));
        all
    }

    /// Fails if a killed run into this target can be resumed.
    pub(super) fn nothing_to_resume(target: &Path) -> Result<(), Failure> {
        let mut left = Self::abandoned(target).into_iter();
        match left.find(|folder| has_checkpoint(folder)) {
            None => Ok(()),
            Some(_) => Err(Failure::Usage(format!(
                "--out {}: a killed run into this folder left a checkpoint; resume it with --resume, or start over with --force",
                shown(target)
            ))),
        }
    }

    /// Looks for the run to resume.
    ///
    /// # Errors
    /// Usage: a checkpoint is damaged or belongs to another run, with the reason; or the target exists and is
    /// not a run.
    /// Failed: another process is writing a run into the same folder, or a file operation fails.
    pub(crate) fn resume(
        target: &Path,
        known: &[&'static str],
        identity: &Identity,
    ) -> Result<ResumableRun, Failure> {
        // A run that was killed while it took its name leaves it empty.
        let _ = fs::remove_dir(target);
        let standing = target.exists();
        let mut candidates = Self::partial_folders(target);
        if standing && has_checkpoint(target) {
            candidates.insert(0, target.to_owned());
        }
        let mut refused = None;
        for folder in candidates {
            let Ok(held) = File::open(&folder) else {
                continue;
            };
            if let Err(TryLockError::WouldBlock) = held.try_lock() {
                return Err(Failure::Failed(format!(
                    "--out {}: another run is writing into this folder",
                    shown(target)
                )));
            }
            if !has_checkpoint(&folder) {
                continue;
            }
            match Checkpoint::read(&folder, identity) {
                Ok(checkpoint) => {
                    // If the results already exist, remains of other runs do not matter.
                    if standing && folder != target {
                        break;
                    }
                    let staging = Self::take_up(target, known, &folder, held)?;
                    return Ok(ResumableRun::Middle(Box::new((staging, checkpoint))));
                }
                Err(why) => refused = refused.or(Some((folder, why))),
            }
        }
        if let Some((folder, why)) = refused {
            return Err(Failure::Usage(format!(
                "--resume: {}: {why}; nothing was changed. Start over with --force instead",
                shown(&folder.join(checkpoint::NAME))
            )));
        }
        Ok(match standing {
            true => ResumableRun::Results,
            false => ResumableRun::Nothing,
        })
    }

    /// Renames the folder of a run to a hidden name with the number of this process, and removes the remains of
    /// other runs that cannot be resumed.
    fn take_up(
        target: &Path,
        known: &[&'static str],
        folder: &Path,
        held: File,
    ) -> Result<Self, Failure> {
        let mut staging = Self {
            target: target.to_owned(),
            hidden: PathBuf::new(),
            held: Some(held),
            standing: None,
            known: known.to_vec(),
            created: Vec::new(),
            kept: true,
            taken_from: Some(folder.to_owned()),
            committed: false,
        };
        let id = std::process::id();
        let hidden = first_free(|count| {
            let hidden = staging.sibling(".", &format!(".{PARTIAL}-{id}-{count}"));
            super::place(folder, &hidden).map(|()| hidden)
        });
        let cannot = |error| Failure::io(&format!("cannot continue in {}", shown(folder)), &error);
        match hidden {
            Ok(hidden) => staging.hidden = hidden,
            Err(error) => {
                staging.taken_from = None;
                return Err(cannot(error));
            }
        }
        interrupted::begin(&staging.hidden, &[]);
        interrupted::keep(&staging.hidden);
        // The remains of other runs, which cannot be resumed.
        let mut others = Self::abandoned(target);
        others.retain(|folder| !has_checkpoint(folder));
        for folder in others {
            let _ = staging.remove_if_abandoned(&folder);
        }
        Ok(staging)
    }

    /// Continues the run: removes the files that are written anew at its end. Before this call, the folder can
    /// return to its earlier path.
    pub(crate) fn go_on(&mut self) {
        self.taken_from = None;
        for name in &self.known {
            let path = self.hidden.join(name);
            if name.ends_with('/') {
                let _ = output_target::remove_folder(&path);
            } else if ![checkpoint::NAME, samples::NAME].contains(name) {
                let _ = fs::remove_file(path);
            }
        }
    }
}
