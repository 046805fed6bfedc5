//! The limits of a cache. Takes its folder; removes the files that were used least recently, and the remains of killed
//! processes. Other files in the folder stay.

use super::Limits;
use super::file::{EXTENSION, PARTIAL};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The age of a half-written file whose process has certainly ended.
const ABANDONED: Duration = Duration::from_secs(3600);

/// A file of the cache.
struct Stored {
    used: SystemTime,
    bytes: u64,
    path: PathBuf,
}

/// Removes files until the folder is within the limits.
pub fn enforce(folder: &Path, limits: Limits) {
    let mut files = stored(folder, EXTENSION);
    // The newest files first.
    files.sort_by(|a, b| (b.used, &b.path).cmp(&(a.used, &a.path)));
    let mut bytes = 0u64;
    for (i, file) in files.iter().enumerate() {
        bytes = bytes.saturating_add(file.bytes);
        if i >= limits.files || bytes > limits.bytes {
            // Another process may have removed it.
            let _ = fs::remove_file(&file.path);
        }
    }
    for file in stored(folder, PARTIAL) {
        if file.used.elapsed().is_ok_and(|age| age > ABANDONED) {
            let _ = fs::remove_file(&file.path);
        }
    }
}

/// The files of a folder with this extension.
fn stored(folder: &Path, extension: &str) -> Vec<Stored> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let own = entries.filter(|entry| entry.path().extension().is_some_and(|e| e == extension));
    let each = own.filter_map(|entry| {
        let data = entry.metadata().ok().filter(fs::Metadata::is_file)?;
        Some(Stored {
            used: data.modified().ok()?,
            bytes: data.len(),
            path: entry.path(),
        })
    });
    each.collect()
}
