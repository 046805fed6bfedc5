//! The instructions of a machine: operations, calls and tests on registers.

use crate::tape::{Function, Whole};

/// The number of a register.
pub type Register = u32;

/// An operation; its last register takes the result.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Instruction {
    /// The sum.
    Add(Register, Register, Register),
    /// The difference.
    Sub(Register, Register, Register),
    /// The product.
    Mul(Register, Register, Register),
    /// The quotient.
    Div(Register, Register, Register),
    /// The negative.
    Neg(Register, Register),
    /// A function of one number.
    Function(Function, Register, Register),
    /// The second operand if the first is positive, otherwise zero.
    WherePositive(Register, Register, Register),
    /// The call with this index.
    Call(u32),
}

/// A call on registers.
#[derive(Clone, Debug)]
pub struct Called {
    /// The function.
    pub function: Whole,
    /// The sizes that the function needs.
    pub sizes: Vec<usize>,
    /// The registers of its inputs.
    pub inputs: Vec<Register>,
    /// The registers of its outputs; `None` for an unused output.
    pub outputs: Vec<Option<Register>>,
}

/// A test on registers, and its outcome when the tape was recorded.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Check {
    /// Whether the first is at most the second.
    AtMost(Register, Register, bool),
    /// Whether the first is less than the second.
    Less(Register, Register, bool),
    /// Whether both are equal.
    Equal(Register, Register, bool),
    /// Whether a number is finite.
    Finite(Register, bool),
}

impl Called {
    #[cold]
    pub(crate) fn run<const L: usize>(
        &self,
        r: &mut [[f64; L]],
        [inputs, outputs]: &mut [Vec<f64>; 2],
    ) {
        // Inputs and outputs are indexed by register, then by lane.
        #[allow(clippy::needless_range_loop)]
        for lane in 0..L {
            inputs.clear();
            inputs.extend(self.inputs.iter().map(|x| r[*x as usize][lane]));
            outputs.clear();
            outputs.resize(self.outputs.len(), f64::NAN);
            (self.function)(&self.sizes, inputs, outputs);
            for (to, x) in self.outputs.iter().zip(outputs.iter()) {
                if let Some(to) = to {
                    r[*to as usize][lane] = *x;
                }
            }
        }
    }
}
