//! Code of the processor for a machine, made by a crate of its own once a machine has run often.

use crate::machine::Machine;
use std::fmt::Debug;
use std::sync::{Arc, OnceLock};

/// Code of the processor for a machine: it computes the same numbers, to the last bit.
pub trait Compiled: Debug + Send + Sync {
    /// Computes in the registers of a frame of the machine. False if a decision comes out otherwise than recorded: the
    /// outputs then mean nothing.
    fn run(&self, registers: &mut [[f64; 1]]) -> bool;
}

/// Makes code, if it can.
#[derive(Clone, Copy, Debug)]
pub struct Compiler {
    /// Nothing if a machine is too large, or the processor is not known.
    pub compile: fn(&Machine) -> Option<Arc<dyn Compiled>>,
    /// After how many runs in one frame: compiling takes as long as some thousand runs.
    pub after: u32,
}

static COMPILER: OnceLock<Compiler> = OnceLock::new();

/// Machines of this process are compiled by `compiler` from now on. False if another one was set before.
pub fn compile_by(compiler: Compiler) -> bool {
    COMPILER.set(compiler).is_ok()
}

/// The code of one machine.
#[derive(Clone, Debug, Default)]
pub(crate) struct Code {
    made: OnceLock<Option<Arc<dyn Compiled>>>,
}

impl Code {
    /// The code, made at the run of this number in a frame.
    #[inline]
    pub(crate) fn at(&self, runs: &mut u32, machine: &Machine) -> Option<&dyn Compiled> {
        if let Some(made) = self.made.get() {
            return made.as_deref();
        }
        *runs = runs.saturating_add(1);
        let compiler = COMPILER.get()?;
        if *runs <= compiler.after {
            return None;
        }
        let made = self.made.get_or_init(|| (compiler.compile)(machine));
        made.as_deref()
    }
}
