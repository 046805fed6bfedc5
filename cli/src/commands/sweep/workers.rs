//! Computes the points of a sweep on all cores. Takes the missing rows; distributes them to free cores.

use super::Sweep;
use super::points::Points;
use crate::output::SignalListener;
use crate::terminal::failure::Failure;
use crate::terminal::waiting::progress_bar;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// After this time a checkpoint is written, so that a killed sweep can be resumed. The rows themselves need no
/// checkpoint.
const WORTH_KEEPING: Duration = Duration::from_millis(200);

impl Sweep<'_> {
    /// Computes the missing rows on all cores. Gives the signal that ended the computation, if any.
    pub(super) fn compute(
        &self,
        first: u64,
        left: &[u64],
        rows: &Mutex<Points>,
        progress: bool,
        keep: &mut dyn FnMut(u64) -> Result<(), Failure>,
    ) -> Result<Option<u8>, Failure> {
        let listening = SignalListener::begin();
        let bar = progress.then(|| progress_bar(left.len() as u64, "points"));
        let (next, made) = (AtomicU64::new(0), AtomicU64::new(0));
        let refused = Mutex::new(None);
        let ended = AtomicBool::new(false);
        let work = || {
            let mut row = vec![0; self.columns.names.len()];
            while !ended.load(Ordering::Relaxed) {
                let turn = next.fetch_add(1, Ordering::Relaxed);
                let Some(number) = usize::try_from(turn).ok().and_then(|n| left.get(n)) else {
                    break;
                };
                let point = first + number;
                if !self.row(point, &mut row, &|| listening.stop_signal().is_some()) {
                    break;
                }
                let mut rows = rows
                    .lock()
                    .unwrap_or_else(std::sync::PoisonError::into_inner);
                if let Err(error) = rows.put(*number, &row) {
                    ended.store(true, Ordering::Relaxed);
                    let mut refused = refused
                        .lock()
                        .unwrap_or_else(std::sync::PoisonError::into_inner);
                    *refused = Some(error);
                    break;
                }
                made.fetch_add(1, Ordering::Relaxed);
            }
        };
        let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let kept = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..cores.min(left.len().max(1)))
                .map(|_| scope.spawn(work))
                .collect();
            let begun = Instant::now();
            let mut kept = false;
            loop {
                let over = workers
                    .iter()
                    .all(std::thread::ScopedJoinHandle::is_finished);
                let made = made.load(Ordering::Relaxed);
                if let Some(bar) = &bar {
                    bar.set_position(made);
                }
                if !kept && (begun.elapsed() > WORTH_KEEPING || listening.stop_signal().is_some()) {
                    kept = true;
                    if let Err(failure) = keep(made) {
                        ended.store(true, Ordering::Relaxed);
                        return Err(failure);
                    }
                }
                if over {
                    return Ok(());
                }
                std::thread::sleep(Duration::from_millis(5));
            }
        });
        if let Some(bar) = bar {
            bar.finish_and_clear();
        }
        kept?;
        if let Some(error) = refused
            .into_inner()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
        {
            return Err(Failure::io("cannot write the points", &error));
        }
        let all = made.load(Ordering::Relaxed) == left.len() as u64;
        Ok(listening.stop_signal().filter(|_| !all))
    }
}
