//! Probes the engine with a sequence of inputs. Reports how many were valid, the inputs with the most work and memory, and every
//! failure: a panic, too many allocations, or more than 500 MB. Allocations measure work, because other load on the machine does
//! not change them.

use crate::memory;
use clebsch_core::print::Format;
use clebsch_core::{Assignment, document, emit};
use std::fmt;
use std::io::Write as _;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, Once, PoisonError};

/// Limit on allocations for an input of at most 10 kB: 1.5 times the busiest input, and within the guaranteed 2 s in an optimised
/// engine.
const WORK: u64 = 20_000_000;
/// Memory limit for an input of at most 10 kB, in bytes.
const MEMORY: isize = 500_000_000;
/// Probing stops after this number of failures.
const ENOUGH: usize = 20;

/// Probing threads; the usual machines have two cores.
const THREADS: usize = 2;

/// If this variable is set, the name of every input is printed before it is probed. A stack overflow aborts the process, and the
/// last name identifies the input.
const TRACE: &str = "CLEBSCH_FUZZ_TRACE";

/// An input with a name to reproduce it.
#[derive(Clone, Debug, Default)]
pub struct Input {
    /// Its kind and number.
    pub name: String,
    /// The text.
    pub text: String,
}

/// The results of many inputs.
#[derive(Debug, Default)]
pub struct Report {
    /// Number of inputs.
    pub probed: u64,
    /// Number of valid models.
    pub accepted: u64,
    /// The most allocations, and the input.
    pub busiest: (u64, String),
    /// The largest peak of memory, and the input.
    pub largest: (isize, String),
    /// All failures.
    pub failures: Vec<String>,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} probed, {} valid, most work {} allocations ({}), largest {:.1} MB ({}), {} failures",
            self.probed,
            self.accepted,
            self.busiest.0,
            self.busiest.1,
            self.largest.0 as f64 / 1e6,
            self.largest.1,
            self.failures.len()
        )
    }
}

/// The message of the last panic on a probing thread.
static PANIC: Mutex<Option<String>> = Mutex::new(None);

/// Silences panics of probing threads; all other panics are reported as usual.
fn silence_probes() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let report = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if std::thread::current().name() == Some("probe") {
                *lock(&PANIC) = Some(panic.to_string());
            } else {
                report(panic);
            }
        }));
    });
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The result of one input.
struct Outcome {
    panicked: bool,
    accepted: bool,
    work: u64,
    memory: isize,
}

fn probe(text: &str) -> Outcome {
    let begin = memory::begin();
    let result = catch_unwind(AssertUnwindSafe(|| {
        match clebsch_core::derive_source(text) {
            Ok(derivation) => {
                // Without values the evaluation fails, but it builds the program and returns a typed error.
                let _ = derivation.residual(&Assignment::new());
                // Printing and emission are probed, too.
                for format in [
                    Format::Text,
                    Format::Latex,
                    Format::Markdown,
                    Format::MathMl,
                    Format::Json,
                ] {
                    let _ = document::printed(&derivation, format);
                }
                if emit::refusal(&derivation).is_none() {
                    let _ = emit::emit(&derivation, true);
                }
                String::new()
            }
            // The error message is part of the probe.
            Err(errors) => errors.to_string(),
        }
    }));
    Outcome {
        panicked: result.is_err(),
        accepted: result.is_ok_and(|message| message.is_empty()),
        work: memory::calls(),
        memory: memory::peak_since(begin),
    }
}

/// The failure of an input, if any.
fn failure(input: &Input, outcome: &Outcome) -> Option<String> {
    let complaint = if outcome.panicked {
        let message = lock(&PANIC).take().unwrap_or_default();
        format!("panicked: {message}")
    } else if outcome.memory > MEMORY {
        format!("took {:.0} MB", outcome.memory as f64 / 1e6)
    } else if outcome.work > WORK {
        format!("took {} allocations", outcome.work)
    } else {
        return None;
    };
    let shown: String = input.text.chars().take(1500).collect();
    Some(format!("{} {complaint}\n{shown}", input.name))
}

/// Probes the inputs with these numbers on two threads, with half of the stack that rustc gives to macros, because the engine is as
/// unoptimised as in a user's build.
pub fn probe_all(numbers: Range<u64>, input: impl Fn(u64) -> Input + Sync) -> Report {
    silence_probes();
    let trace = std::env::var_os(TRACE).is_some();
    let report = Mutex::new(Report::default());
    let next = AtomicU64::new(numbers.start);
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= numbers.end || lock(&report).failures.len() >= ENOUGH {
                break;
            }
            let input = input(number);
            if trace {
                // Written directly to the stream, because output captured by the test harness is lost on abort.
                let _ = writeln!(std::io::stderr(), "{}", input.name);
            }
            let outcome = probe(&input.text);
            let failure = failure(&input, &outcome);
            let mut report = lock(&report);
            report.probed += 1;
            report.accepted += u64::from(outcome.accepted);
            if outcome.work > report.busiest.0 {
                report.busiest = (outcome.work, input.name.clone());
            }
            if outcome.memory > report.largest.0 {
                report.largest = (outcome.memory, input.name);
            }
            report.failures.extend(failure);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..THREADS {
            let probing = std::thread::Builder::new()
                .name("probe".to_owned())
                .stack_size(4 << 20)
                .spawn_scoped(scope, work);
            assert!(probing.is_ok(), "a thread");
        }
    });
    report.into_inner().unwrap_or_else(PoisonError::into_inner)
}
