//! Functions of the runtime that compiled code calls.

use clebsch_program::{Called, Function};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The address of a function of one number.
pub fn address(function: Function) -> Option<usize> {
    macro_rules! of {
        ($name:ident) => {{
            extern "C" fn of(x: f64) -> f64 {
                Function::$name.of(x)
            }
            of as extern "C" fn(f64) -> f64 as usize
        }};
    }
    Some(match function {
        // Every processor has an instruction for it.
        Function::Sqrt => return None,
        Function::Exp => of!(Exp),
        Function::Log => of!(Log),
        Function::Sin => of!(Sin),
        Function::Cos => of!(Cos),
        Function::Sinh => of!(Sinh),
        Function::Cosh => of!(Cosh),
        Function::Tanh => of!(Tanh),
        Function::Balance => of!(Balance),
    })
}

/// Calls a whole function. If it panics, its outputs are NaN, because a panic must not unwind into compiled code.
///
/// # Safety
/// `call` is valid, and `inputs` and `outputs` hold as many numbers as the call has.
pub unsafe extern "C" fn whole(call: *const Called, inputs: *const f64, outputs: *mut f64) {
    // SAFETY: the caller guarantees it.
    let (call, inputs, outputs) = unsafe {
        let call = &*call;
        (
            call,
            std::slice::from_raw_parts(inputs, call.inputs.len()),
            std::slice::from_raw_parts_mut(outputs, call.outputs.len()),
        )
    };
    outputs.fill(f64::NAN);
    let done = catch_unwind(AssertUnwindSafe(|| {
        (call.function)(&call.sizes, inputs, outputs);
    }));
    if done.is_err() {
        outputs.fill(f64::NAN);
    }
}
