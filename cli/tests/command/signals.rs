//! The program as a process that receives signals at work. The hidden folder next to its results shows its progress.
#![cfg(unix)]
#![allow(missing_docs)]

use crate::common::{Words, wait_until};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// The program with these arguments, ready to run.
pub fn command(words: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_clebsch"));
    command.args(words.words()).env("CLEBSCH_CACHE", "off");
    command
}

/// The program at work.
pub fn begun(words: &str) -> Child {
    let mut command = command(words);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().expect("starts")
}

/// Whether the program succeeds.
pub fn succeeds(words: &str) -> bool {
    let status = command(words)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    status.expect("runs").success()
}

/// Sends a signal, which has no effect if the program has already ended; returns how the program ended.
pub fn ended_by(signal: &str, mut child: Child) -> Option<i32> {
    let id = child.id().to_string();
    let mut kill = Command::new("kill");
    let _ = kill.args([signal, &id]).stderr(Stdio::null()).status();
    child.wait().expect("ends").code()
}

/// The hidden folders of runs into `out`.
fn hidden(out: &str) -> Vec<PathBuf> {
    let out = Path::new(out);
    let own = format!(".{}.partial", out.file_name().expect("a name").display());
    let beside = fs::read_dir(out.parent().expect("a parent"))
        .into_iter()
        .flatten();
    let all = beside.flatten().map(|entry| entry.path());
    let is_own = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default();
        name.to_string_lossy().starts_with(&own)
    };
    all.filter(is_own).collect()
}

/// The number of bytes that a run into `out` has written into a file so far.
pub fn written(out: &str, file: &str) -> Vec<u8> {
    let read = |folder: PathBuf| fs::read(folder.join(file)).ok();
    hidden(out).into_iter().find_map(read).unwrap_or_default()
}

/// Waits until the file that a run into `out` writes satisfies a condition, or the run has ended.
pub fn wait_for(child: &mut Child, out: &str, file: &str, wanted: impl Fn(&[u8]) -> bool) {
    wait_until(file, || {
        wanted(&written(out, file)) || child.try_wait().expect("is asked").is_some()
    });
}
