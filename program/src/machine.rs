//! A tape prepared for execution: without dead steps, and with as few registers as possible. One run computes one set of inputs, or
//! several sets side by side in lanes.

use crate::compiled::Code;
use crate::instruction::{Called, Check, Instruction, Register};
use crate::layout::Layout;
use crate::tape::{Function, Tape};

/// An executable tape. The first registers hold inputs, the next constants, the rest results.
#[derive(Debug)]
pub struct Machine {
    pub(crate) inputs: usize,
    pub(crate) reads: Vec<bool>,
    pub(crate) constants: Vec<f64>,
    pub(crate) registers: usize,
    pub(crate) instructions: Vec<Instruction>,
    pub(crate) calls: Vec<Called>,
    pub(crate) checks: Vec<Check>,
    pub(crate) outputs: Vec<Register>,
    pub(crate) code: Code,
}

/// The registers of a machine for `L` runs side by side.
#[derive(Clone, Debug)]
pub struct Frame<const L: usize> {
    registers: Vec<[f64; L]>,
    /// Inputs and outputs of a call.
    called: [Vec<f64>; 2],
}

impl Machine {
    /// A machine for a tape with this number of inputs.
    #[must_use]
    pub fn new(tape: &Tape, inputs: usize) -> Self {
        Layout::of(tape, inputs).machine(tape)
    }

    /// The number of inputs.
    #[must_use]
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Whether an output or a decision depends on an input.
    #[must_use]
    pub fn reads(&self, input: usize) -> bool {
        self.reads.get(input).copied().unwrap_or(false)
    }

    /// The number of outputs.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// The number of operations per run.
    #[must_use]
    pub fn operations(&self) -> usize {
        self.instructions.len()
    }

    /// The number of registers.
    #[must_use]
    pub fn registers(&self) -> usize {
        self.registers
    }

    /// The constants, which are in the registers after the inputs.
    #[must_use]
    pub fn constants(&self) -> &[f64] {
        &self.constants
    }

    /// The operations, in order.
    #[must_use]
    pub fn instructions(&self) -> &[Instruction] {
        &self.instructions
    }

    /// The calls.
    #[must_use]
    pub fn calls(&self) -> &[Called] {
        &self.calls
    }

    /// The tests.
    #[must_use]
    pub fn checks(&self) -> &[Check] {
        &self.checks
    }

    /// The registers of the outputs.
    #[must_use]
    pub fn results(&self) -> &[Register] {
        &self.outputs
    }

    /// Registers initialised with the constants.
    #[must_use]
    pub fn frame<const L: usize>(&self) -> Frame<L> {
        let mut registers = vec![[0.0; L]; self.registers];
        let own = registers.iter_mut().skip(self.inputs);
        for (register, x) in own.zip(&self.constants) {
            *register = [*x; L];
        }
        Frame {
            registers,
            called: [Vec::new(), Vec::new()],
        }
    }

    /// Computes on the inputs in `frame`. Returns false if a decision differs from the recorded one; the outputs are then
    /// meaningless.
    pub fn run(&self, frame: &mut Frame<1>) -> bool {
        match self.code.of(self) {
            Some(code) => code.run(&mut frame.registers),
            None => self.computes(frame),
        }
    }

    /// Computes on `L` sets of inputs side by side. Returns false if a decision differs in any of them. The caller chooses the
    /// instruction set for which this function is compiled.
    #[inline(always)]
    pub fn computes<const L: usize>(&self, frame: &mut Frame<L>) -> bool {
        let r = frame.registers.as_mut_slice();
        for op in &self.instructions {
            match *op {
                Instruction::Add(a, b, to) => two(r, a, b, to, |x, y| x + y),
                Instruction::Sub(a, b, to) => two(r, a, b, to, |x, y| x - y),
                Instruction::Mul(a, b, to) => two(r, a, b, to, |x, y| x * y),
                Instruction::Div(a, b, to) => two(r, a, b, to, |x, y| x / y),
                Instruction::Neg(a, to) => one(r, a, to, |x| -x),
                Instruction::Function(Function::Sqrt, a, to) => one(r, a, to, f64::sqrt),
                Instruction::Function(function, a, to) => one(r, a, to, |x| function.of(x)),
                Instruction::WherePositive(a, b, to) => {
                    two(r, a, b, to, |x, y| if x > 0.0 { y } else { 0.0 });
                }
                Instruction::Call(which) => self.calls[which as usize].run(r, &mut frame.called),
            }
        }
        self.checks.iter().all(|check| match *check {
            Check::AtMost(a, b, holds) => all(r, a, b, |x, y| (x <= y) == holds),
            Check::Less(a, b, holds) => all(r, a, b, |x, y| (x < y) == holds),
            Check::Equal(a, b, holds) => all(r, a, b, |x, y| (x == y) == holds),
            Check::Finite(a, holds) => all(r, a, a, |x, _| x.is_finite() == holds),
        })
    }

    /// The output with this index.
    #[inline]
    #[must_use]
    pub fn output<'a, const L: usize>(&self, frame: &'a Frame<L>, which: usize) -> &'a [f64; L] {
        &frame.registers[self.outputs[which] as usize]
    }

    /// All outputs of one lane.
    pub fn gives<'a, const L: usize>(
        &'a self,
        frame: &'a Frame<L>,
        lane: usize,
    ) -> impl Iterator<Item = f64> + Clone + 'a {
        let of = move |register: &Register| frame.registers[*register as usize][lane];
        self.outputs.iter().map(of)
    }
}

impl<const L: usize> Frame<L> {
    /// The registers of the inputs in order, followed by the other registers.
    #[inline]
    pub fn inputs(&mut self) -> &mut [[f64; L]] {
        &mut self.registers
    }
}

/// Number of lanes that are read before any is written, so that the compiler vectorises the loops.
const CHUNK: usize = 16;

/// Number of input sets side by side: enough to share the cost of dispatch, and few enough to stay in the L1 cache.
pub const WIDTH: usize = 64;

#[inline(always)]
fn two<const L: usize>(
    r: &mut [[f64; L]],
    a: Register,
    b: Register,
    to: Register,
    f: impl Fn(f64, f64) -> f64,
) {
    let (a, b, to) = (a as usize, b as usize, to as usize);
    if L == 1 {
        r[to][0] = f(r[a][0], r[b][0]);
        return;
    }
    for k in 0..L / CHUNK {
        let part = k * CHUNK..(k + 1) * CHUNK;
        let (mut x, mut y) = ([0.0; CHUNK], [0.0; CHUNK]);
        x.copy_from_slice(&r[a][part.clone()]);
        y.copy_from_slice(&r[b][part.clone()]);
        for (x, y) in x.iter_mut().zip(y) {
            *x = f(*x, y);
        }
        r[to][part].copy_from_slice(&x);
    }
}

#[inline(always)]
fn one<const L: usize>(r: &mut [[f64; L]], a: Register, to: Register, f: impl Fn(f64) -> f64) {
    let mut x = r[a as usize];
    for x in &mut x {
        *x = f(*x);
    }
    r[to as usize] = x;
}

#[inline(always)]
fn all<const L: usize>(
    r: &[[f64; L]],
    a: Register,
    b: Register,
    test: impl Fn(f64, f64) -> bool,
) -> bool {
    let pairs = r[a as usize].iter().zip(&r[b as usize]);
    pairs.fold(true, |all, (x, y)| all & test(*x, *y))
}
