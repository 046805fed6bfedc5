//! Native code for a machine. A separate crate compiles it once the machine has run often.

use crate::machine::Machine;
use std::fmt::Debug;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, OnceLock};

/// Native code for a machine, with bitwise identical results.
pub trait Compiled: Debug + Send + Sync {
    /// Computes in the registers of a frame of the machine. Returns false if a decision differs from the recorded one; the outputs
    /// are then meaningless.
    fn run(&self, registers: &mut [[f64; 1]]) -> bool;
}

/// A compiler for machines.
#[derive(Clone, Copy, Debug)]
pub struct Compiler {
    /// Compiles a machine; returns `None` if the machine is too large, or the processor is not supported.
    pub compile: fn(&Machine) -> Option<Arc<dyn Compiled>>,
    /// The number of runs of a machine before compilation, which takes as long as several thousand runs.
    pub after: u32,
}

static COMPILER: OnceLock<Compiler> = OnceLock::new();

/// Compiles the machines of this process with `compiler` from now on. Returns false if another compiler was set before.
pub fn compile_by(compiler: Compiler) -> bool {
    COMPILER.set(compiler).is_ok()
}

/// The code of one machine.
#[derive(Debug, Default)]
pub(crate) struct Code {
    made: OnceLock<Option<Arc<dyn Compiled>>>,
    /// The number of runs in all frames.
    runs: AtomicU32,
}

impl Code {
    /// The code, compiled at the configured number of runs.
    #[inline]
    pub(crate) fn of(&self, machine: &Machine) -> Option<&dyn Compiled> {
        if let Some(made) = self.made.get() {
            return made.as_deref();
        }
        let compiler = COMPILER.get()?;
        if self.runs.fetch_add(1, Ordering::Relaxed) < compiler.after {
            return None;
        }
        let made = self.made.get_or_init(|| (compiler.compile)(machine));
        made.as_deref()
    }
}
