//! The state of the output folder: absent, the folder of an earlier run, or something else.
//! Takes a path; gives the results that `--force` may replace, or the reason why nothing may be replaced.

use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use std::ffi::OsString;
use std::fs::{self, DirEntry};
use std::io;
use std::path::Path;
use std::time::SystemTime;

/// The text by which a picture of `clebsch plot` is recognised.
pub(crate) const MARK: &str = "clebsch plot: time ";

/// The endings of files for ParaView.
const ENDINGS: [&str; 3] = ["pvd", "vtp", "vti"];

/// One file: name, size, time of its last change.
type Entry = (OsString, u64, Option<SystemTime>);

/// The files of an earlier run, sorted by name. The name of a file in an inner folder starts with the name of
/// that folder. Comparing two such lists shows whether the results have changed, since a run never changes a
/// finished file.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct EarlierFiles(Vec<Entry>);

/// Whether results may be written to `target`: `None` if it does not exist, otherwise the results to replace.
///
/// # Errors
/// Usage: `target` exists and `force` is not given, or it is not a folder, or it contains a file that is not
/// `known`.
/// Failed: no permission to look.
pub(super) fn at(
    target: &Path,
    force: bool,
    known: &[&str],
) -> Result<Option<EarlierFiles>, Failure> {
    let wrong = |words: String| Failure::Usage(format!("--out {}: {words}", shown(target)));
    let found = match fs::symlink_metadata(target) {
        Ok(found) => found,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => {
            return Err(Failure::io(
                &format!("cannot look at {}", shown(target)),
                &error,
            ));
        }
    };
    if !found.is_dir() {
        return Err(wrong("this exists and is not a folder".to_owned()));
    }
    if !force {
        return Err(wrong("this exists; replace it with --force".to_owned()));
    }
    match look(target, known) {
        Ok(Ok(standing)) => Ok(Some(standing)),
        Ok(Err(foreign)) => Err(wrong(format!(
            "not replaced, because it contains `{}`, which no run wrote; remove it or choose another folder",
            shown(foreign)
        ))),
        Err(error) => Err(Failure::io(
            &format!("cannot look into {}", shown(target)),
            &error,
        )),
    }
}

/// The files in `folder`, or the name of a file that no run wrote. A name with a trailing slash denotes an inner
/// folder, whose files must have the extensions of files for ParaView.
pub(super) fn look(folder: &Path, known: &[&str]) -> io::Result<Result<EarlierFiles, OsString>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry: DirEntry = entry?;
        let (name, found) = (entry.file_name(), entry.metadata()?);
        let folder = name.to_str().map(|name| format!("{name}/"));
        if found.is_dir() && folder.is_some_and(|own| known.contains(&own.as_str())) {
            match within(&entry.path(), &name)? {
                Ok(own) => files.extend(own),
                Err(foreign) => return Ok(Err(foreign)),
            }
            continue;
        }
        let is_known = known.iter().any(|file| name == **file) || is_drawn(&entry.path());
        if !found.is_file() || !is_known {
            return Ok(Err(name));
        }
        files.push((name, found.len(), found.modified().ok()));
    }
    files.sort();
    Ok(Ok(EarlierFiles(files)))
}

/// The files of an inner folder. Their names start with the name of that folder.
fn within(path: &Path, name: &OsString) -> io::Result<Result<Vec<Entry>, OsString>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(path)? {
        let entry: DirEntry = entry?;
        let found = entry.metadata()?;
        let own = Path::new(name).join(entry.file_name());
        let ending = own.extension().and_then(|e| e.to_str());
        if !found.is_file() || !ending.is_some_and(|e| ENDINGS.contains(&e)) {
            return Ok(Err(own.into_os_string()));
        }
        files.push((own.into_os_string(), found.len(), found.modified().ok()));
    }
    Ok(Ok(files))
}

/// Whether a file is a picture of `clebsch plot`, which may be replaced.
pub(crate) fn is_drawn(file: &Path) -> bool {
    let is_svg = file.extension().is_some_and(|ending| ending == "svg");
    is_svg && fs::read_to_string(file).is_ok_and(|text| text.contains(MARK))
}

/// Removes an inner folder and the files that a run wrote into it.
pub(super) fn remove_folder(path: &Path) -> io::Result<()> {
    let name = path.file_name().unwrap_or_default().to_owned();
    if let Ok(files) = within(path, &name)? {
        let parent = path.parent().unwrap_or(Path::new(""));
        for (file, ..) in files {
            fs::remove_file(parent.join(file))?;
        }
    }
    fs::remove_dir(path)
}

impl EarlierFiles {
    /// Removes these files from `folder`, and then the folder if it is empty.
    pub(super) fn remove(&self, folder: &Path) -> io::Result<()> {
        for (name, ..) in &self.0 {
            fs::remove_file(folder.join(name))?;
        }
        // The inner folders are empty now.
        let own = fs::read_dir(folder)?.collect::<io::Result<Vec<DirEntry>>>()?;
        for entry in own {
            fs::remove_dir(entry.path())?;
        }
        fs::remove_dir(folder)
    }
}
