//! Assigns a register to each value of a tape.

use crate::compiled::Code;
use crate::instruction::{Called, Check, Instruction, Register};
use crate::machine::Machine;
use crate::tape::{Guard, Scalar, Step, Tape, Test};

/// The register assignment, found in a single pass through the tape.
pub(crate) struct Layout {
    inputs: usize,
    reads: Vec<bool>,
    constants: Vec<f64>,
    /// The register of each used step.
    of: Vec<Option<Register>>,
    registers: usize,
}

impl Layout {
    pub(crate) fn of(tape: &Tape, inputs: usize) -> Self {
        // The last step that uses each value; outputs of the tape stay in use until the end.
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
                        // A place may have several steps, of which some are not used.
                        *reads |= last[at].is_some();
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
            // A register that is read for the last time can take the result, except in a call, whose inputs are read once for all
            // outputs.
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

    pub(crate) fn machine(self, tape: &Tape) -> Machine {
        // Every used value has a register.
        let of = |x: Scalar| self.of[x.step()].unwrap_or(0);
        let mut calls: Vec<Called> = Vec::new();
        let mut place = vec![None; tape.calls.len()];
        let mut instruction = |(step, to): (&Step, &Option<Register>)| {
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
                    return is_first.then_some(Instruction::Call(at as u32));
                }
                Step::Add(a, b) => Instruction::Add(of(a), of(b), to),
                Step::Sub(a, b) => Instruction::Sub(of(a), of(b), to),
                Step::Mul(a, b) => Instruction::Mul(of(a), of(b), to),
                Step::Div(a, b) => Instruction::Div(of(a), of(b), to),
                Step::Neg(a) => Instruction::Neg(of(a), to),
                Step::Function(f, a) => Instruction::Function(f, of(a), to),
                Step::WherePositive(a, b) => Instruction::WherePositive(of(a), of(b), to),
            })
        };
        let check = |Guard { test, holds }: &Guard| match *test {
            Test::AtMost(a, b) => Check::AtMost(of(a), of(b), *holds),
            Test::Less(a, b) => Check::Less(of(a), of(b), *holds),
            Test::Finite(a) => Check::Finite(of(a), *holds),
            Test::Equal(a, b) => Check::Equal(of(a), of(b), *holds),
        };
        let instructions = tape
            .steps
            .iter()
            .zip(&self.of)
            .filter_map(&mut instruction)
            .collect();
        let checks = tape.guards.iter().map(check).collect();
        let outputs = tape.outputs.iter().map(|x| of(*x)).collect();
        Machine {
            inputs: self.inputs,
            reads: self.reads,
            instructions,
            calls,
            checks,
            outputs,
            constants: self.constants,
            registers: self.registers,
            code: Code::default(),
        }
    }
}
