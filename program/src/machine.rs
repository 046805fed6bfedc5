//! A tape made ready to run: dead steps left out, values in as few registers as they need. One run computes one set of
//! inputs, or several side by side, one in each lane.

use crate::tape::{Function, Guard, Scalar, Step, Tape, Test, Whole};

/// A place of a value.
type Register = u32;

/// An operation; its last register takes the result.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Op {
    Add(Register, Register, Register),
    Sub(Register, Register, Register),
    Mul(Register, Register, Register),
    Div(Register, Register, Register),
    Neg(Register, Register),
    Function(Function, Register, Register),
    WherePositive(Register, Register, Register),
    Call(u32),
}

/// A call on registers.
#[derive(Clone, Debug)]
struct Called {
    function: Whole,
    sizes: Vec<usize>,
    inputs: Vec<Register>,
    /// Nothing for an output that is not used.
    outputs: Vec<Option<Register>>,
}

/// A test on registers.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Check {
    AtMost(Register, Register, bool),
    Less(Register, Register, bool),
    Equal(Register, Register, bool),
    Finite(Register, bool),
}

/// A tape that runs. The first registers hold inputs, the next constants, the others results.
#[derive(Clone, Debug)]
pub struct Machine {
    inputs: usize,
    reads: Vec<bool>,
    constants: Vec<f64>,
    registers: usize,
    ops: Vec<Op>,
    calls: Vec<Called>,
    checks: Vec<Check>,
    outputs: Vec<Register>,
}

/// Registers of a machine, `L` runs side by side.
#[derive(Clone, Debug)]
pub struct Frame<const L: usize> {
    registers: Vec<[f64; L]>,
    /// Numbers that enter a call, and that leave it.
    called: [Vec<f64>; 2],
}

impl Machine {
    /// A machine for a tape of so many inputs.
    #[must_use]
    pub fn new(tape: &Tape, inputs: usize) -> Self {
        Layout::of(tape, inputs).machine(tape)
    }

    /// How many numbers it takes.
    #[must_use]
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Whether an input enters what is computed or decided.
    #[must_use]
    pub fn reads(&self, input: usize) -> bool {
        self.reads.get(input).copied().unwrap_or(false)
    }

    /// How many numbers it gives.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// How many operations a run takes.
    #[must_use]
    pub fn operations(&self) -> usize {
        self.ops.len()
    }

    /// Registers with its constants.
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

    /// Computes on the inputs in `frame`. False if a decision comes out otherwise than recorded: the outputs then mean
    /// nothing.
    pub fn run(&self, frame: &mut Frame<1>) -> bool {
        self.computes(frame)
    }

    /// Computes on [`WIDTH`] sets of inputs side by side. False if a decision comes out otherwise in any of them.
    pub fn run_wide(&self, frame: &mut Frame<WIDTH>) -> bool {
        wide::run(self, frame)
    }

    #[inline(always)]
    fn computes<const L: usize>(&self, frame: &mut Frame<L>) -> bool {
        let r = frame.registers.as_mut_slice();
        for op in &self.ops {
            match *op {
                Op::Add(a, b, to) => two(r, a, b, to, |x, y| x + y),
                Op::Sub(a, b, to) => two(r, a, b, to, |x, y| x - y),
                Op::Mul(a, b, to) => two(r, a, b, to, |x, y| x * y),
                Op::Div(a, b, to) => two(r, a, b, to, |x, y| x / y),
                Op::Neg(a, to) => one(r, a, to, |x| -x),
                Op::Function(Function::Sqrt, a, to) => one(r, a, to, f64::sqrt),
                Op::Function(function, a, to) => one(r, a, to, |x| function.of(x)),
                Op::WherePositive(a, b, to) => {
                    two(r, a, b, to, |x, y| if x > 0.0 { y } else { 0.0 });
                }
                Op::Call(which) => self.calls[which as usize].run(r, &mut frame.called),
            }
        }
        self.checks.iter().all(|check| match *check {
            Check::AtMost(a, b, holds) => all(r, a, b, |x, y| (x <= y) == holds),
            Check::Less(a, b, holds) => all(r, a, b, |x, y| (x < y) == holds),
            Check::Equal(a, b, holds) => all(r, a, b, |x, y| (x == y) == holds),
            Check::Finite(a, holds) => all(r, a, a, |x, _| x.is_finite() == holds),
        })
    }

    /// The output of this number.
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
    ) -> impl Iterator<Item = f64> + 'a {
        let of = move |register: &Register| frame.registers[*register as usize][lane];
        self.outputs.iter().map(of)
    }
}

impl<const L: usize> Frame<L> {
    /// The places of the inputs, in their order, and others behind them.
    #[inline]
    pub fn inputs(&mut self) -> &mut [[f64; L]] {
        &mut self.registers
    }
}

impl Called {
    #[cold]
    fn run<const L: usize>(&self, r: &mut [[f64; L]], [inputs, outputs]: &mut [Vec<f64>; 2]) {
        // Registers are chosen by number, lanes by place.
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

/// Lanes that are read before any is written, so that loops over them are vectorised.
const CHUNK: usize = 16;

/// How many sets of inputs run side by side: enough to share the cost of finding out what to do, few enough to stay in
/// the nearest cache.
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

/// The widest registers of the processor, if they are asked for.
mod wide {
    use super::{Frame, Machine, WIDTH};

    #[cfg(feature = "simd")]
    pub(super) fn run(machine: &Machine, frame: &mut Frame<WIDTH>) -> bool {
        struct Run<'a>(&'a Machine, &'a mut Frame<WIDTH>);

        impl pulp::WithSimd for Run<'_> {
            type Output = bool;

            #[inline(always)]
            fn with_simd<S: pulp::Simd>(self, _: S) -> bool {
                self.0.computes(self.1)
            }
        }

        pulp::Arch::new().dispatch(Run(machine, frame))
    }

    #[cfg(not(feature = "simd"))]
    pub(super) fn run(machine: &Machine, frame: &mut Frame<WIDTH>) -> bool {
        machine.computes(frame)
    }
}

/// Where values stand, found by going through the tape once.
struct Layout {
    inputs: usize,
    reads: Vec<bool>,
    constants: Vec<f64>,
    /// The register of each step that is used.
    of: Vec<Option<Register>>,
    registers: usize,
}

impl Layout {
    fn of(tape: &Tape, inputs: usize) -> Self {
        // The last step that uses each value; what leaves the tape is used to the end.
        let mut last = vec![None; tape.steps.len()];
        let end = tape.steps.len();
        let guarded = tape.guards.iter().flat_map(|g| g.test.uses());
        for used in guarded.flatten().chain(tape.outputs.iter().copied()) {
            last[used.step()] = Some(end);
        }
        for (at, step) in tape.steps.iter().enumerate().rev() {
            if last[at].is_some() {
                for used in tape.uses(*step) {
                    last[used.step()] = last[used.step()].max(Some(at));
                }
            }
        }
        let mut layout = Layout {
            inputs,
            reads: vec![false; inputs],
            constants: Vec::new(),
            of: vec![None; end],
            registers: 0,
        };
        for (at, step) in tape.steps.iter().enumerate() {
            match step {
                Step::Input(place) => {
                    layout.of[at] = Some(*place);
                    if let Some(reads) = layout.reads.get_mut(*place as usize) {
                        *reads = last[at].is_some();
                    }
                }
                Step::Double(bits) if last[at].is_some() => {
                    layout.of[at] = Some((inputs + layout.constants.len()) as Register);
                    layout.constants.push(f64::from_bits(*bits));
                }
                _ => {}
            }
        }
        layout.registers = inputs + layout.constants.len();
        let mut free: Vec<Register> = Vec::new();
        for (at, step) in tape.steps.iter().enumerate() {
            let computes = !matches!(step, Step::Input(_) | Step::Double(_));
            if !computes || last[at].is_none() {
                continue;
            }
            // A register that is read for the last time may take the result, but not one of a call: its inputs are read
            // once for all its outputs.
            let fixed = inputs + layout.constants.len();
            let [a, b] = step.uses();
            let b = b.filter(|b| Some(*b) != a);
            for used in [a, b].into_iter().flatten() {
                let register = layout.of[used.step()].filter(|r| *r as usize >= fixed);
                if last[used.step()] == Some(at) {
                    free.extend(register);
                }
            }
            layout.of[at] = Some(free.pop().unwrap_or_else(|| {
                layout.registers += 1;
                (layout.registers - 1) as Register
            }));
        }
        layout
    }

    fn machine(self, tape: &Tape) -> Machine {
        // Every value that is used has a register.
        let of = |x: Scalar| self.of[x.step()].unwrap_or(0);
        let mut calls: Vec<Called> = Vec::new();
        let mut place = vec![None; tape.calls.len()];
        let mut op = |(step, to): (&Step, &Option<Register>)| {
            let to = (*to)?;
            Some(match *step {
                Step::Input(_) | Step::Double(_) => return None,
                Step::Output(which, output) => {
                    let (call, output) = (tape.calls.get(which as usize)?, output as usize);
                    let known = place.get_mut(which as usize)?;
                    let at = *known.get_or_insert(calls.len());
                    if at == calls.len() {
                        calls.push(Called {
                            function: *tape.functions.get(call.function)?,
                            sizes: call.sizes.clone(),
                            inputs: call.inputs.iter().map(|x| of(*x)).collect(),
                            outputs: vec![None; call.outputs],
                        });
                    }
                    let outputs = &mut calls.get_mut(at)?.outputs;
                    let is_first = outputs.iter().all(Option::is_none);
                    *outputs.get_mut(output)? = Some(to);
                    return is_first.then_some(Op::Call(at as u32));
                }
                Step::Add(a, b) => Op::Add(of(a), of(b), to),
                Step::Sub(a, b) => Op::Sub(of(a), of(b), to),
                Step::Mul(a, b) => Op::Mul(of(a), of(b), to),
                Step::Div(a, b) => Op::Div(of(a), of(b), to),
                Step::Neg(a) => Op::Neg(of(a), to),
                Step::Function(f, a) => Op::Function(f, of(a), to),
                Step::WherePositive(a, b) => Op::WherePositive(of(a), of(b), to),
            })
        };
        let check = |Guard { test, holds }: &Guard| match *test {
            Test::AtMost(a, b) => Check::AtMost(of(a), of(b), *holds),
            Test::Less(a, b) => Check::Less(of(a), of(b), *holds),
            Test::Finite(a) => Check::Finite(of(a), *holds),
            Test::Equal(a, b) => Check::Equal(of(a), of(b), *holds),
        };
        let ops = tape
            .steps
            .iter()
            .zip(&self.of)
            .filter_map(&mut op)
            .collect();
        let checks = tape.guards.iter().map(check).collect();
        let outputs = tape.outputs.iter().map(|x| of(*x)).collect();
        Machine {
            inputs: self.inputs,
            reads: self.reads,
            ops,
            calls,
            checks,
            outputs,
            constants: self.constants,
            registers: self.registers,
        }
    }
}
