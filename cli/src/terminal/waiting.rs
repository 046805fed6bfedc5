//! Shows on a terminal what a run is computing before its first step, if this takes longer than a second. Takes the
//! text.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// The time before anything is shown.
const QUIET: Duration = Duration::from_secs(1);

/// An operation that the user waits for, until it is dropped.
#[derive(Debug)]
pub(crate) struct Waiting {
    end: Option<Sender<()>>,
    shown: Option<JoinHandle<()>>,
}

impl Waiting {
    /// Shows `what` on a terminal after a second, until the value is dropped. Without a terminal nothing is
    /// shown.
    pub(crate) fn showing(what: String, terminal: bool) -> Self {
        let (end, ended) = channel();
        let show = move || {
            if ended.recv_timeout(QUIET) != Err(RecvTimeoutError::Timeout) {
                return;
            }
            let line = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
            line.set_message(what);
            line.set_style(style());
            line.enable_steady_tick(Duration::from_millis(250));
            // Wait until the other end is dropped.
            let _ = ended.recv();
            line.finish_and_clear();
        };
        Self {
            end: Some(end),
            shown: terminal.then(|| std::thread::spawn(show)),
        }
    }
}

/// A progress bar on standard error with the time left, counting in units of `what`.
pub(crate) fn progress_bar(steps: u64, what: &str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr());
    let template = format!("{{wide_bar}} {{human_pos}}/{{human_len}} {what}, {{eta}} left");
    match ProgressStyle::with_template(&template) {
        Ok(style) => bar.with_style(style),
        // The template is constant; if it were invalid, the plain bar would be used.
        Err(_) => bar,
    }
}

fn style() -> ProgressStyle {
    let own = ProgressStyle::with_template("{msg}, {elapsed}");
    own.unwrap_or_else(|_| ProgressStyle::default_spinner())
}

impl Drop for Waiting {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(shown) = self.shown.take() {
            // A failure of the display thread is ignored.
            let _ = shown.join();
        }
    }
}
