//! A folder that keeps derivations of texts, so that clebsch derives an unchanged model once. Takes the key of a
//! derivation; gives its data if an earlier process has stored it.
//!
//! A cache never fails: if a file cannot be read or written, clebsch derives the model. Nothing in it depends on the
//! processor, because machine code is compiled from the data in each process.

mod bound;
mod file;
mod hash;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The sources of this build: the version, and a hash of the engine and of the interpreter.
const BUILD: &str = concat!(
    "clebsch ",
    env!("CARGO_PKG_VERSION"),
    " ",
    env!("CLEBSCH_SOURCES")
);

/// The largest text and data of one file in bytes. Longer data is not stored.
const LARGEST: usize = 8 << 20;

/// How much a folder keeps. The files that were used least recently are removed first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The largest number of files.
    pub files: usize,
    /// The largest number of bytes of all files together.
    pub bytes: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            files: 500,
            bytes: 64 << 20,
        }
    }
}

/// A folder of derivations, or none.
#[derive(Clone, Debug, Default)]
pub struct Cache {
    folder: Option<Arc<Path>>,
    limits: Limits,
}

/// Identifies a derivation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key<'a> {
    /// The kind of the data.
    pub kind: &'a str,
    /// The chosen numbers of sites and end conditions, if the data depends on them.
    pub choice: &'a str,
    /// The text of the model.
    pub text: &'a str,
}

impl Cache {
    /// No cache: each process derives its models.
    #[must_use]
    pub fn none() -> Self {
        Self::default()
    }

    /// A cache in a folder, which the first derivation creates.
    #[must_use]
    pub fn in_folder(folder: impl Into<PathBuf>) -> Self {
        // Without the sources of the engine, a stale derivation cannot be recognised.
        let is_known = !env!("CLEBSCH_SOURCES").is_empty();
        Cache {
            folder: is_known.then(|| Arc::from(folder.into())),
            limits: Limits::default(),
        }
    }

    /// This cache with other limits.
    #[must_use]
    pub fn with_limits(self, limits: Limits) -> Self {
        Cache { limits, ..self }
    }

    /// Whether there is a folder.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.folder.is_some()
    }

    /// The file of a key. Its name is a hash of the build and of the key.
    #[must_use]
    pub fn file(&self, key: &Key<'_>) -> Option<PathBuf> {
        let mut hash = hash::Hash::new();
        for part in [BUILD, key.kind, key.choice, key.text] {
            hash.add(part.as_bytes());
        }
        let name = format!("{}.{}", hash.digits(), file::EXTENSION);
        Some(self.folder.as_ref()?.join(name))
    }

    /// The data of a key, if a whole file of this build has it. The file contains the key, so two keys with one hash do
    /// not share data.
    #[must_use]
    pub fn get(&self, key: &Key<'_>) -> Option<String> {
        let path = self.file(key)?;
        let bytes = file::read(&path, (LARGEST as u64).saturating_mul(2))?;
        let parts = file::unpacked(&bytes)?;
        let [build, kind, choice, text, data] = parts.as_slice() else {
            return None;
        };
        let is_own = [*build, *kind, *choice, *text] == [BUILD, key.kind, key.choice, key.text];
        is_own.then(|| (*data).to_owned())
    }

    /// Stores the data of a key, and removes old files beyond the limits.
    pub fn put(&self, key: &Key<'_>, data: &str) {
        let (Some(folder), Some(path)) = (&self.folder, self.file(key)) else {
            return;
        };
        let length = key.text.len().saturating_add(data.len());
        if length > LARGEST || fs::create_dir_all(folder).is_err() {
            return;
        }
        let bytes = file::packed(&[BUILD, key.kind, key.choice, key.text, data]);
        if file::write(&path, &bytes).is_some() {
            bound::enforce(folder, self.limits);
        }
    }
}
