//! Compiled code and its memory.

use crate::generate::generate;
use clebsch_program::{Called, Compiled, Machine};
use cranelift_codegen::settings::{self, Configurable};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{Linkage, Module, default_libcall_names};
use std::fmt;
use std::sync::Mutex;

/// Maximum number of instructions of a compiled machine; compiling this many takes 0.2 seconds.
const MOST: usize = 20_000;

/// Why a machine is not compiled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// It has too many instructions for compilation to pay off.
    TooLarge {
        /// The number of its instructions.
        instructions: usize,
        /// The maximum number of instructions.
        most: usize,
    },
    /// Cranelift does not support the processor, or the system provides no executable memory.
    Unsupported(String),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::TooLarge { instructions, most } => write!(
                f,
                "a step of {instructions} operations is not compiled; the limit is {most}"
            ),
            Refusal::Unsupported(why) => {
                write!(f, "clebsch cannot compile steps on this machine: {why}")
            }
        }
    }
}

impl std::error::Error for Refusal {}

fn unsupported(why: impl fmt::Display) -> Refusal {
    Refusal::Unsupported(why.to_string())
}

/// The code of one machine. Its memory is written before it is made executable, and never after.
pub struct Native {
    function: unsafe extern "C" fn(*mut f64) -> u8,
    registers: usize,
    size: usize,
    /// Kept alive because the code contains their addresses.
    _calls: Box<[Called]>,
    /// Owns the memory of the code.
    module: Mutex<Option<JITModule>>,
}

impl fmt::Debug for Native {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Native").field("size", &self.size).finish()
    }
}

impl Native {
    /// Compiles a machine.
    ///
    /// # Errors
    /// [`Refusal`] if the machine is too large, or if this computer cannot compile.
    pub fn of(machine: &Machine) -> Result<Self, Refusal> {
        let instructions = machine.operations();
        if instructions > MOST {
            return Err(Refusal::TooLarge {
                instructions,
                most: MOST,
            });
        }
        let mut module = JITModule::new(builder()?);
        let calls: Box<[Called]> = machine.calls().into();
        let mut context = module.make_context();
        generate(machine, &calls, &mut module, &mut context);
        let name = module.declare_function("tape", Linkage::Local, &context.func.signature);
        let name = name.map_err(unsupported)?;
        module
            .define_function(name, &mut context)
            .map_err(unsupported)?;
        let size = context.compiled_code().map_or(0, |c| c.code_buffer().len());
        module.finalize_definitions().map_err(unsupported)?;
        let code = module.get_finalized_function(name);
        // SAFETY: the function was declared with this signature, in memory that `module` owns.
        let function =
            unsafe { std::mem::transmute::<*const u8, unsafe extern "C" fn(*mut f64) -> u8>(code) };
        Ok(Native {
            function,
            registers: machine.registers(),
            size,
            _calls: calls,
            module: Mutex::new(Some(module)),
        })
    }

    /// The size of the code in bytes.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }
}

fn builder() -> Result<JITBuilder, Refusal> {
    let mut flags = settings::builder();
    let set = [
        ("opt_level", "speed"),
        ("is_pic", "false"),
        ("use_colocated_libcalls", "false"),
        ("enable_verifier", "false"),
    ];
    for (name, value) in set {
        flags.set(name, value).map_err(unsupported)?;
    }
    let isa = cranelift_native::builder().map_err(unsupported)?;
    let isa = isa.finish(settings::Flags::new(flags));
    let isa = isa.map_err(unsupported)?;
    Ok(JITBuilder::with_isa(isa, default_libcall_names()))
}

impl Compiled for Native {
    fn run(&self, registers: &mut [[f64; 1]]) -> bool {
        if registers.len() < self.registers {
            return false;
        }
        // SAFETY: the code accesses only the registers of its machine, whose number is correct, and the calls, which live as long
        // as the code.
        unsafe { (self.function)(registers.as_mut_ptr().cast()) != 0 }
    }
}

impl Drop for Native {
    fn drop(&mut self) {
        let module = self.module.get_mut();
        if let Some(module) = module.ok().and_then(Option::take) {
            // SAFETY: nothing runs the code after it is dropped.
            unsafe { module.free_memory() };
        }
    }
}
