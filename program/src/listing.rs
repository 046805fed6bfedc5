//! The operations of a machine as text, one operation per line, with a new name for each result.

use crate::instruction::{Check, Instruction, Register};
use crate::machine::Machine;
use crate::tape::Function;

impl Function {
    /// Its name in listings.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Function::Sqrt => "sqrt",
            Function::Exp => "exp",
            Function::Log => "log",
            Function::Sin => "sin",
            Function::Cos => "cos",
            Function::Sinh => "sinh",
            Function::Cosh => "cosh",
            Function::Tanh => "tanh",
            Function::Balance => "balance",
        }
    }
}

/// The names of the values in the registers while a listing is written.
struct Names {
    of: Vec<String>,
    results: usize,
}

impl Names {
    fn at(&self, register: Register) -> &str {
        self.of.get(register as usize).map_or("?", String::as_str)
    }

    /// A new name for the result in a register.
    fn result(&mut self, register: Register) -> String {
        self.results += 1;
        let name = format!("t{}", self.results);
        if let Some(of) = self.of.get_mut(register as usize) {
            of.clone_from(&name);
        }
        name
    }
}

impl Machine {
    /// The inputs that it reads, its operations, its decisions and its outputs. `inputs` and `outputs` are their names; an
    /// output that is an input of the same name is left out. `_` marks an unused result of a call.
    #[must_use]
    pub fn listing(&self, inputs: &[String], outputs: &[String]) -> String {
        let mut lines = Vec::new();
        let input = |at: usize| inputs.get(at).cloned().unwrap_or_else(|| format!("x{at}"));
        let read: Vec<String> = (0..self.inputs)
            .filter(|at| self.reads(*at))
            .map(input)
            .collect();
        if !read.is_empty() {
            lines.push(format!("given {}", read.join(", ")));
        }
        let mut of: Vec<String> = (0..self.inputs).map(input).collect();
        of.extend(self.constants.iter().map(f64::to_string));
        of.resize(self.registers, String::new());
        let mut names = Names { of, results: 0 };
        for instruction in &self.instructions {
            lines.push(self.line(instruction, &mut names));
        }
        for check in &self.checks {
            lines.push(decision(check, &names));
        }
        for (at, register) in self.outputs.iter().enumerate() {
            let name = outputs.get(at).cloned();
            let name = name.unwrap_or_else(|| format!("y{at}"));
            let value = names.at(*register);
            if name != value {
                lines.push(format!("{name} := {value}"));
            }
        }
        lines.join("\n")
    }

    fn line(&self, instruction: &Instruction, names: &mut Names) -> String {
        let two = |a: Register, word: &str, b: Register, names: &Names| {
            format!("{} {word} {}", names.at(a), names.at(b))
        };
        let (value, to) = match *instruction {
            Instruction::Add(a, b, to) => (two(a, "+", b, names), to),
            Instruction::Sub(a, b, to) => (two(a, "-", b, names), to),
            Instruction::Mul(a, b, to) => (two(a, "*", b, names), to),
            Instruction::Div(a, b, to) => (two(a, "/", b, names), to),
            Instruction::Neg(a, to) => (format!("-{}", names.at(a)), to),
            Instruction::Function(f, a, to) => (format!("{}({})", f.word(), names.at(a)), to),
            Instruction::WherePositive(a, b, to) => {
                let (a, b) = (names.at(a), names.at(b));
                (format!("{b} if {a} > 0, otherwise 0"), to)
            }
            Instruction::Call(which) => {
                let Some(call) = self.calls.get(which as usize) else {
                    return String::new();
                };
                let inputs: Vec<&str> = call.inputs.iter().map(|r| names.at(*r)).collect();
                let value = format!("call of {}", inputs.join(", "));
                let results = call.outputs.iter();
                let name = |r: &Option<Register>| r.map_or("_".to_owned(), |r| names.result(r));
                let results: Vec<String> = results.map(name).collect();
                return format!("{} = {value}", results.join(", "));
            }
        };
        format!("{} = {value}", names.result(to))
    }
}

fn decision(check: &Check, names: &Names) -> String {
    let test = |a: Register, words: [&str; 2], b: Register, holds: bool| {
        let word = words[usize::from(!holds)];
        format!("only if {} {word} {}", names.at(a), names.at(b))
    };
    match *check {
        Check::AtMost(a, b, holds) => test(a, ["<=", "is not <="], b, holds),
        Check::Less(a, b, holds) => test(a, ["<", "is not <"], b, holds),
        Check::Equal(a, b, holds) => test(a, ["=", "differs from"], b, holds),
        Check::Finite(a, true) => format!("only if {} is finite", names.at(a)),
        Check::Finite(a, false) => format!("only if {} is not finite", names.at(a)),
    }
}
