//! Compiles the tapes of model files to machine code.
//!
//! A tape is straight-line code: first operations on numbers, then tests. Cranelift compiles it to one function. The
//! function computes the same numbers as [`Machine::run`](clebsch_program::Machine::run), bit for bit. Operations are
//! neither contracted nor reordered. The code calls the runtime for the sine, the exponential and similar functions.
//! All `unsafe` code of the project is here.

#![allow(unsafe_code)]

mod calls;
mod code;
mod generate;

pub use code::{Native, Refusal};

use clebsch_program::{Compiled, Compiler, Machine, compile_by};
use std::sync::{Arc, Once};

/// Compilation costs as much time as several thousand compiled runs save.
const AFTER: u32 = 4000;

/// Compiles the frequently run tapes of this process from now on. Returns false if another compiler was set before.
///
/// If this computer cannot compile, [`Machine::run`](clebsch_program::Machine::run) evaluates the tapes, with the same
/// numbers. A warning on the standard error says so once.
pub fn install() -> bool {
    install_after(AFTER)
}

/// Like [`install`], with the number of runs after which a tape is compiled.
pub fn install_after(after: u32) -> bool {
    compile_by(Compiler { compile, after })
}

/// Warns once in a process.
static WARNED: Once = Once::new();

fn compile(machine: &Machine) -> Option<Arc<dyn Compiled>> {
    match Native::of(machine) {
        Ok(native) => Some(Arc::new(native)),
        Err(refusal @ Refusal::Unsupported(_)) => {
            WARNED.call_once(|| {
                eprintln!("clebsch: warning: {refusal}; it evaluates them, which is slower");
            });
            None
        }
        Err(Refusal::TooLarge { .. }) => None,
    }
}
