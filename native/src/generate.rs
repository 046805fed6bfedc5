//! Translates a machine to Cranelift's intermediate representation. The function takes a pointer to the registers and returns 1 if
//! every decision comes out as recorded.

use crate::calls::{address, whole};
use clebsch_program::{Called, Check, Function, Instruction, Machine, Register};
use cranelift_codegen::Context;
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::types::{F64, I8};
use cranelift_codegen::ir::{
    AbiParam, InstBuilder, MemFlagsData, SigRef, Signature, StackSlotData, StackSlotKind, Type,
    Value,
};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::JITModule;
use cranelift_module::Module;

/// The function under construction, and the values of its registers.
struct Writer<'a, 'b> {
    machine: &'a Machine,
    builder: FunctionBuilder<'b>,
    /// The first register.
    registers: Value,
    pointer: Type,
    /// The current value of each register.
    values: Vec<Option<Value>>,
    /// The index of the last instruction that writes each register.
    last: Vec<usize>,
    /// The checks that become possible after the last write of a register.
    checks: Vec<Vec<usize>>,
    /// Whether the function must store the register as a result.
    is_result: Vec<bool>,
    /// Whether all decisions came out as recorded so far.
    holds: Option<Value>,
    of_number: SigRef,
    of_call: SigRef,
}

/// Writes the function into `context`.
pub fn generate(
    machine: &Machine,
    calls: &[Called],
    module: &mut JITModule,
    context: &mut Context,
) {
    let pointer = module.target_config().pointer_type();
    let signature = |module: &JITModule, takes: &[Type], gives: Option<Type>| {
        let mut signature = module.make_signature();
        signature
            .params
            .extend(takes.iter().map(|t| AbiParam::new(*t)));
        signature.returns.extend(gives.map(AbiParam::new));
        signature
    };
    context.func.signature = signature(module, &[pointer], Some(I8));
    let of_number: Signature = signature(module, &[F64], Some(F64));
    let of_call: Signature = signature(module, &[pointer, pointer, pointer], None);

    let mut own = FunctionBuilderContext::new();
    let mut builder = FunctionBuilder::new(&mut context.func, &mut own);
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    builder.seal_block(block);
    let registers = builder.block_params(block)[0];
    let (of_number, of_call) = (
        builder.import_signature(of_number),
        builder.import_signature(of_call),
    );
    let mut is_result = vec![false; machine.registers()];
    for result in machine.results() {
        is_result[*result as usize] = true;
    }
    let mut writer = Writer {
        machine,
        builder,
        registers,
        pointer,
        values: vec![None; machine.registers()],
        last: vec![0; machine.registers()],
        checks: vec![Vec::new(); machine.registers()],
        is_result,
        holds: None,
        of_number,
        of_call,
    };
    writer.place_checks();
    for (at, instruction) in machine.instructions().iter().enumerate() {
        writer.instruction(at, *instruction, calls);
    }
    let holds = match writer.holds {
        Some(holds) => holds,
        None => writer.builder.ins().iconst(I8, 1),
    };
    writer.builder.ins().return_(&[holds]);
    writer.builder.finalize(module.target_config());
}

fn looks_at(check: Check) -> [Register; 2] {
    match check {
        Check::AtMost(a, b, _) | Check::Less(a, b, _) | Check::Equal(a, b, _) => [a, b],
        Check::Finite(a, _) => [a, a],
    }
}

impl Writer<'_, '_> {
    /// Whether a register always holds an input or a constant.
    fn is_given(&self, register: Register) -> bool {
        (register as usize) < self.machine.inputs() + self.machine.constants().len()
    }

    /// Schedules each check as soon as its operands are known. No later instruction may overwrite a register that a check reads.
    fn place_checks(&mut self) {
        for (at, instruction) in self.machine.instructions().iter().enumerate() {
            match *instruction {
                Instruction::Call(call) => {
                    let outputs = &self.machine.calls()[call as usize].outputs;
                    for to in outputs.iter().flatten() {
                        self.last[*to as usize] = at;
                    }
                }
                Instruction::Add(.., to)
                | Instruction::Sub(.., to)
                | Instruction::Mul(.., to)
                | Instruction::Div(.., to)
                | Instruction::Neg(_, to)
                | Instruction::Function(.., to)
                | Instruction::WherePositive(.., to) => self.last[to as usize] = at,
            }
        }
        for (at, check) in self.machine.checks().iter().enumerate() {
            let [a, b] = looks_at(*check);
            let last = match (self.is_given(a), self.is_given(b)) {
                (true, true) => {
                    self.check(*check);
                    continue;
                }
                (true, false) => b,
                (false, true) => a,
                (false, false) if self.last[b as usize] > self.last[a as usize] => b,
                (false, false) => a,
            };
            self.checks[last as usize].push(at);
        }
    }

    fn at(&self, register: Register) -> i32 {
        // The index fits, because a machine has fewer registers than instructions, inputs and constants.
        i32::try_from(register as usize * size_of::<f64>()).unwrap_or(i32::MAX)
    }

    fn value(&mut self, register: Register) -> Value {
        if let Some(value) = self.values[register as usize] {
            return value;
        }
        let constant = (register as usize)
            .checked_sub(self.machine.inputs())
            .and_then(|at| self.machine.constants().get(at));
        let value = match constant {
            Some(x) => self.builder.ins().f64const(*x),
            None => {
                let offset = self.at(register);
                let flags = MemFlagsData::trusted();
                self.builder.ins().load(F64, flags, self.registers, offset)
            }
        };
        self.values[register as usize] = Some(value);
        value
    }

    fn put(&mut self, register: Register, value: Value) {
        self.values[register as usize] = Some(value);
    }

    /// Records that an instruction has written a register. After the last write, stores the register if it is a result, and emits
    /// the checks that are now possible.
    fn written(&mut self, register: Register, by: usize) {
        if self.last[register as usize] != by {
            return;
        }
        if self.is_result[register as usize] {
            let (value, offset) = (self.value(register), self.at(register));
            let flags = MemFlagsData::trusted();
            self.builder
                .ins()
                .store(flags, value, self.registers, offset);
        }
        for at in std::mem::take(&mut self.checks[register as usize]) {
            self.check(self.machine.checks()[at]);
        }
    }

    fn check(&mut self, check: Check) {
        let (found, holds) = match check {
            Check::AtMost(a, b, holds) => (self.compare(FloatCC::LessThanOrEqual, a, b), holds),
            Check::Less(a, b, holds) => (self.compare(FloatCC::LessThan, a, b), holds),
            Check::Equal(a, b, holds) => (self.compare(FloatCC::Equal, a, b), holds),
            Check::Finite(a, holds) => {
                let a = self.value(a);
                let size = self.builder.ins().fabs(a);
                let infinite = self.builder.ins().f64const(f64::INFINITY);
                let found = self.builder.ins().fcmp(FloatCC::LessThan, size, infinite);
                (found, holds)
            }
        };
        let as_recorded = match holds {
            true => found,
            false => self.builder.ins().bxor_imm_u(found, 1),
        };
        self.holds = Some(match self.holds {
            Some(before) => self.builder.ins().band(before, as_recorded),
            None => as_recorded,
        });
    }

    fn compare(&mut self, by: FloatCC, a: Register, b: Register) -> Value {
        let (a, b) = (self.value(a), self.value(b));
        self.builder.ins().fcmp(by, a, b)
    }

    fn instruction(&mut self, at: usize, instruction: Instruction, calls: &[Called]) {
        let (value, to) = match instruction {
            Instruction::Add(a, b, to) => {
                let (a, b) = (self.value(a), self.value(b));
                (self.builder.ins().fadd(a, b), to)
            }
            Instruction::Sub(a, b, to) => {
                let (a, b) = (self.value(a), self.value(b));
                (self.builder.ins().fsub(a, b), to)
            }
            Instruction::Mul(a, b, to) => {
                let (a, b) = (self.value(a), self.value(b));
                (self.builder.ins().fmul(a, b), to)
            }
            Instruction::Div(a, b, to) => {
                let (a, b) = (self.value(a), self.value(b));
                (self.builder.ins().fdiv(a, b), to)
            }
            Instruction::Neg(a, to) => {
                let a = self.value(a);
                (self.builder.ins().fneg(a), to)
            }
            Instruction::WherePositive(a, b, to) => {
                let (a, b) = (self.value(a), self.value(b));
                let zero = self.builder.ins().f64const(0.0);
                let positive = self.builder.ins().fcmp(FloatCC::GreaterThan, a, zero);
                (self.builder.ins().select(positive, b, zero), to)
            }
            Instruction::Function(function, a, to) => (self.function(function, a), to),
            Instruction::Call(which) => return self.call(at, &calls[which as usize]),
        };
        self.put(to, value);
        self.written(to, at);
    }

    fn function(&mut self, function: Function, a: Register) -> Value {
        let a = self.value(a);
        let Some(address) = address(function) else {
            return self.builder.ins().sqrt(a);
        };
        let address = self.builder.ins().iconst(self.pointer, address as i64);
        let call = self
            .builder
            .ins()
            .call_indirect(self.of_number, address, &[a]);
        self.builder.inst_results(call)[0]
    }

    /// Passes inputs and outputs through stack memory.
    fn call(&mut self, at: usize, call: &Called) {
        let bytes =
            |count: usize| u32::try_from(count.max(1) * size_of::<f64>()).unwrap_or(u32::MAX);
        let mut slot = |count: usize| {
            let data = StackSlotData::new(StackSlotKind::ExplicitSlot, bytes(count), 3);
            self.builder.create_sized_stack_slot(data)
        };
        let (takes, gives) = (slot(call.inputs.len()), slot(call.outputs.len()));
        let offset = |k: usize| i32::try_from(k * size_of::<f64>()).unwrap_or(i32::MAX);
        for (k, input) in call.inputs.iter().enumerate() {
            let value = self.value(*input);
            self.builder
                .ins()
                .stack_store(self.pointer, value, takes, offset(k));
        }
        let takes = self.builder.ins().stack_addr(self.pointer, takes, 0);
        let results = self.builder.ins().stack_addr(self.pointer, gives, 0);
        let this = std::ptr::from_ref(call) as i64;
        let this = self.builder.ins().iconst(self.pointer, this);
        let function = whole as unsafe extern "C" fn(*const Called, *const f64, *mut f64);
        let function = self
            .builder
            .ins()
            .iconst(self.pointer, function as usize as i64);
        self.builder
            .ins()
            .call_indirect(self.of_call, function, &[this, takes, results]);
        for (k, to) in call.outputs.iter().enumerate() {
            if let Some(to) = to {
                let value = self
                    .builder
                    .ins()
                    .stack_load(self.pointer, F64, gives, offset(k));
                self.put(*to, value);
            }
        }
        for to in call.outputs.iter().flatten() {
            self.written(*to, at);
        }
    }
}
