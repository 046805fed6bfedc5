//! Handles the interruption of runs by SIGINT (Ctrl-C) or SIGTERM.
//! Takes the folders in the making. While a run computes, the first signal only requests a stop, and the run
//! writes its results so far. At any other time, and at the second signal, unfinished folders are removed,
//! except those with a checkpoint. The process then ends with the default action of the signal.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicI32, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// A hidden folder, and the parents that were made for it, innermost first.
struct HiddenFolder {
    hidden: PathBuf,
    created: Vec<PathBuf>,
    kept: bool,
}

/// The folders that this process is writing.
static BEGUN: Mutex<Vec<HiddenFolder>> = Mutex::new(Vec::new());

/// The number of runs that stop by themselves at a signal.
static LISTENING: AtomicUsize = AtomicUsize::new(0);

/// The signal that requested the stop; 0 for none.
static ASKED: AtomicI32 = AtomicI32::new(0);

fn with_begun<R>(then: impl FnOnce(&mut Vec<HiddenFolder>) -> R) -> R {
    then(&mut BEGUN.lock().unwrap_or_else(PoisonError::into_inner))
}

/// From here on the folder is removed when the process is interrupted.
pub(super) fn begin(hidden: &Path, created: &[PathBuf]) {
    watch();
    with_begun(|all| {
        all.push(HiddenFolder {
            hidden: hidden.to_owned(),
            created: created.to_vec(),
            kept: false,
        });
    });
}

/// Keeps the folder from now on, since a checkpoint in it can be resumed.
pub(super) fn keep(hidden: &Path) {
    with_begun(|all| {
        let own = all.iter_mut().filter(|begun| begun.hidden == hidden);
        own.for_each(|begun| begun.kept = true);
    });
}

/// From here on it is not removed: it is complete, or already removed.
pub(super) fn end(hidden: &Path) {
    with_begun(|all| all.retain(|begun| begun.hidden != hidden));
}

/// Removes a hidden folder and the parents that were made for it.
pub(super) fn remove(hidden: &Path, created: &[PathBuf]) {
    // Errors here cannot be handled.
    if !hidden.as_os_str().is_empty() {
        let _ = fs::remove_dir_all(hidden);
    }
    for parent in created {
        let _ = fs::remove_dir(parent);
    }
}

/// While this value exists, a signal stops the run at the next step.
pub(crate) struct SignalListener(());

impl SignalListener {
    /// From here on.
    pub(crate) fn begin() -> Self {
        watch();
        LISTENING.fetch_add(1, Ordering::SeqCst);
        Self(())
    }

    /// The signal that requested the stop, if any.
    pub(crate) fn stop_signal(&self) -> Option<u8> {
        u8::try_from(ASKED.load(Ordering::SeqCst))
            .ok()
            .filter(|signal| *signal != 0)
    }
}

impl Drop for SignalListener {
    fn drop(&mut self) {
        LISTENING.fetch_sub(1, Ordering::SeqCst);
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
                let first = ASKED.swap(signal, Ordering::SeqCst) == 0;
                if first && LISTENING.load(Ordering::SeqCst) > 0 {
                    continue;
                }
                // The lock is held until the end: no folder can be created or completed during the removal.
                with_begun(|all| {
                    for begun in all.iter().filter(|begun| !begun.kept) {
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
