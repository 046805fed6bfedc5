//! Runs many cases of one model on all cores. Returns the runs in the order of the cases, for any number of threads.

use crate::errors::exception;
use crate::guarded::guarded;
use crate::model::Model;
use crate::options::request;
use crate::running::Running;
use clebsch_cli::session::{self, Request};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::num::NonZero;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// The end of a case.
enum Ended {
    /// All steps succeeded.
    Whole(Box<session::Running>),
    /// A step failed.
    Stopped(Box<session::Running>, String),
    /// The start failed.
    Refused(String),
    /// The call was interrupted before the case started.
    Left,
}

/// The reason for an interrupted run.
const INTERRUPTED: &str = "interrupted";

/// Stack size of a thread in bytes.
const STACK: usize = 8 << 20;

/// Time between two checks for an interrupt.
const AT_A_TIME: Duration = Duration::from_millis(50);

fn one(
    model: &session::Model,
    (file, text): &(String, String),
    request: &Request,
    stop: &AtomicBool,
) -> Ended {
    let planned = match model.planned(file, text, request) {
        Ok(planned) => planned,
        Err(failure) => return Ended::Refused(failure.to_string()),
    };
    let mut running = match session::Running::start(planned, request.judged, true) {
        Ok(running) => Box::new(running),
        Err(failure) => return Ended::Refused(failure.to_string()),
    };
    while !stop.load(Ordering::Relaxed) {
        match running.advance(AT_A_TIME) {
            Ok(true) => {
                return match running.full() {
                    Some(why) => Ended::Stopped(running, why),
                    None => Ended::Whole(running),
                };
            }
            Ok(false) => {}
            Err(error) if running.summary().steps == 0 => return Ended::Refused(error.to_string()),
            Err(error) => return Ended::Stopped(running, error.to_string()),
        }
    }
    // Keeps the samples so far.
    running.end_here();
    Ended::Stopped(running, INTERRUPTED.to_owned())
}

/// Runs cases, each given by its name in messages and its text, on `workers` threads, by default one per core. Returns for each
/// case its run or None, and the reason if it ended early; after Ctrl-C the reason is `interrupted`. Calls `tell` from time to time
/// with the number of finished cases.
#[pyfunction]
pub(crate) fn run_many<'py>(
    py: Python<'py>,
    model: &Bound<'py, Model>,
    cases: Vec<(String, String)>,
    options: &Bound<'py, PyDict>,
    workers: Option<usize>,
    tell: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyList>> {
    let request = request(options)?;
    let model = &model.get().inner;
    if workers == Some(0) {
        return Err(exception(
            py,
            "DataError",
            "workers: expected None or at least 1, found 0",
            &[],
        ));
    }
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    let workers = workers.unwrap_or(cores).min(cases.len().max(1));
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let stop = AtomicBool::new(false);
    let ended: Vec<Mutex<Ended>> = cases.iter().map(|_| Mutex::new(Ended::Left)).collect();
    let work = || {
        while !stop.load(Ordering::Relaxed) {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let (Some(case), Some(place)) = (cases.get(at), ended.get(at)) else {
                break;
            };
            // A panic in one case must not end the others.
            let own = catch_unwind(AssertUnwindSafe(|| one(model, case, &request, &stop)));
            let own =
                own.unwrap_or_else(|_| Ended::Refused("internal error in clebsch".to_owned()));
            *place.lock().unwrap_or_else(PoisonError::into_inner) = own;
            done.fetch_add(1, Ordering::Relaxed);
        }
    };
    let interrupted = std::thread::scope(|scope| {
        // The usual stack size of a main thread, because a case with other sites is derived here.
        let start = |_| {
            std::thread::Builder::new()
                .stack_size(STACK)
                .spawn_scoped(scope, work)
        };
        let threads: Vec<_> = (0..workers).map_while(|n| start(n).ok()).collect();
        loop {
            py.detach(|| wait(&threads));
            let told = tell.call1((done.load(Ordering::Relaxed),));
            let signalled = py.check_signals().and(told.map(drop));
            let over = threads
                .iter()
                .all(std::thread::ScopedJoinHandle::is_finished);
            if over || signalled.is_err() {
                stop.store(true, Ordering::Relaxed);
                // The threads are joined at the end of the scope, without the interpreter lock.
                py.detach(|| {
                    while !threads
                        .iter()
                        .all(std::thread::ScopedJoinHandle::is_finished)
                    {
                        std::thread::sleep(Duration::from_millis(1));
                    }
                });
                return signalled;
            }
        }
    });
    // Ctrl-C ends the cases but returns the results so far.
    interrupted.or_else(
        |error| match error.is_instance_of::<PyKeyboardInterrupt>(py) {
            true => Ok(()),
            false => Err(error),
        },
    )?;
    guarded(|| {
        let out = PyList::empty(py);
        for (place, (file, _)) in ended.into_iter().zip(&cases) {
            let own = place.into_inner().unwrap_or_else(PoisonError::into_inner);
            let (running, why) = match own {
                Ended::Whole(running) => (Some(running), None),
                Ended::Stopped(running, why) => (Some(running), Some(why)),
                Ended::Refused(why) => (None, Some(why)),
                Ended::Left => (None, Some(INTERRUPTED.to_owned())),
            };
            let running = running.map(|running| Py::new(py, Running::of(*running, file)));
            out.append((running.transpose()?, why))?;
        }
        Ok(out)
    })
}

/// Waits until the threads finish, at most a tenth of a second.
fn wait(threads: &[std::thread::ScopedJoinHandle<'_, ()>]) {
    for turn in 0..100 {
        if threads
            .iter()
            .all(std::thread::ScopedJoinHandle::is_finished)
        {
            return;
        }
        // Polls quickly at first, to return early from short cases.
        std::thread::sleep(Duration::from_micros(if turn < 10 { 100 } else { 1100 }));
    }
}
