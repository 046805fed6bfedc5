//! Runs that are interrupted: what they have begun to write is removed before the process ends.
//! Takes the folders in the making; on SIGINT and SIGTERM removes them, then lets the signal do what it does.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// A hidden folder, and the parents that were made for it, innermost first.
struct Begun {
    hidden: PathBuf,
    created: Vec<PathBuf>,
}

/// What this process is writing.
static BEGUN: Mutex<Vec<Begun>> = Mutex::new(Vec::new());

fn with_begun<R>(then: impl FnOnce(&mut Vec<Begun>) -> R) -> R {
    then(&mut BEGUN.lock().unwrap_or_else(PoisonError::into_inner))
}

/// From here on the folder is removed when the process is interrupted.
pub(super) fn begin(hidden: &Path, created: &[PathBuf]) {
    watch();
    with_begun(|all| {
        all.push(Begun {
            hidden: hidden.to_owned(),
            created: created.to_vec(),
        });
    });
}

/// From here on it is not: it is complete, or removed already.
pub(super) fn end(hidden: &Path) {
    with_begun(|all| all.retain(|begun| begun.hidden != hidden));
}

/// Removes a hidden folder and the parents that were made for it.
pub(super) fn remove(hidden: &Path, created: &[PathBuf]) {
    // Nothing can be done about errors here.
    if !hidden.as_os_str().is_empty() {
        let _ = fs::remove_dir_all(hidden);
    }
    for parent in created {
        let _ = fs::remove_dir(parent);
    }
}

/// Starts the thread that waits for signals, once.
#[cfg(unix)]
fn watch() {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;
    use std::sync::Once;

    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // Without it a run leaves its hidden folder, which the next one removes.
        let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else {
            return;
        };
        std::thread::spawn(move || {
            for signal in signals.forever() {
                // Held to the end: no other folder is begun, and none is completed while it is removed.
                with_begun(|all| {
                    for begun in all.iter() {
                        remove(&begun.hidden, &begun.created);
                    }
                    let _ = emulate_default_handler(signal);
                });
            }
        });
    });
}

#[cfg(not(unix))]
fn watch() {}
