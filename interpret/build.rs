//! Hashes the sources of the engine and of the interpreter. The cache keeps derivations under this hash, so a changed engine
//! never reads derivations of the engine before the change.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

#[path = "src/cache/hash.rs"]
mod hash;

/// Everything that determines a derivation and its form in the cache. The lock file has the versions of libraries.
const SOURCES: [&str; 5] = [
    "../macros/core/src",
    "../program/src",
    "src",
    "Cargo.toml",
    "../Cargo.lock",
];

fn main() -> io::Result<()> {
    let mut hash = hash::Hash::new();
    let mut is_complete = true;
    for source in SOURCES {
        println!("cargo:rerun-if-changed={source}");
        let mut files = Vec::new();
        collect(Path::new(source), &mut files)?;
        is_complete &= !files.is_empty();
        files.sort();
        for file in files {
            hash.add(file.to_string_lossy().as_bytes());
            hash.add(&fs::read(&file)?);
        }
    }
    // A package without the sources of the engine cannot tell two engines apart; it does not use a cache.
    let digits = match is_complete {
        true => hash.digits(),
        false => String::new(),
    };
    println!("cargo:rustc-env=CLEBSCH_SOURCES={digits}");
    Ok(())
}

/// Adds a file, or all files below a folder; nothing if the path does not exist.
fn collect(path: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if path.is_dir() {
        for entry in fs::read_dir(path)? {
            collect(&entry?.path(), files)?;
        }
    } else if path.is_file() {
        files.push(path.to_owned());
    }
    Ok(())
}
