//! How many operations of each kind a machine computes in one run.

use crate::instruction::Instruction;
use crate::machine::Machine;
use crate::tape::Function;
use core::fmt;

/// Numbers of operations by kind.
#[derive(Clone, Copy, Default, PartialEq, Eq, Debug)]
pub struct Counts {
    /// Sums and differences.
    pub sums: usize,
    /// Products.
    pub products: usize,
    /// Quotients.
    pub quotients: usize,
    /// Changes of sign.
    pub signs: usize,
    /// Selections of a number or zero by the sign of another.
    pub selections: usize,
    /// Square roots.
    pub roots: usize,
    /// Other functions of one number, such as sines.
    pub functions: usize,
    /// Calls of functions of the runtime, such as an elimination with pivoting.
    pub calls: usize,
    /// Decisions that must come out as recorded.
    pub decisions: usize,
}

impl Counts {
    /// The number of all operations, without decisions.
    #[must_use]
    pub fn operations(&self) -> usize {
        let arithmetic = self.sums + self.products + self.quotients + self.signs;
        arithmetic + self.selections + self.roots + self.functions + self.calls
    }
}

impl Machine {
    /// How many operations a run computes.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let mut counts = Counts {
            decisions: self.checks.len(),
            ..Counts::default()
        };
        for instruction in &self.instructions {
            let count = match instruction {
                Instruction::Add(..) | Instruction::Sub(..) => &mut counts.sums,
                Instruction::Mul(..) => &mut counts.products,
                Instruction::Div(..) => &mut counts.quotients,
                Instruction::Neg(..) => &mut counts.signs,
                Instruction::WherePositive(..) => &mut counts.selections,
                Instruction::Function(Function::Sqrt, ..) => &mut counts.roots,
                Instruction::Function(..) => &mut counts.functions,
                Instruction::Call(_) => &mut counts.calls,
            };
            *count += 1;
        }
        counts
    }
}

/// The number of operations, then the number of each kind that occurs.
impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kinds = [
            (self.sums, "sum"),
            (self.products, "product"),
            (self.quotients, "quotient"),
            (self.signs, "change of sign"),
            (self.selections, "selection"),
            (self.roots, "square root"),
            (self.functions, "other function"),
            (self.calls, "call"),
            (self.decisions, "decision"),
        ];
        let told = kinds.iter().filter(|(n, _)| *n > 0);
        let told: Vec<String> = told.map(|(n, kind)| counted(*n, kind)).collect();
        f.write_str(&counted(self.operations(), "operation"))?;
        match told.is_empty() {
            true => Ok(()),
            false => write!(f, ": {}", told.join(", ")),
        }
    }
}

fn counted(n: usize, kind: &str) -> String {
    match (n, kind.split_once(' ')) {
        (1, _) => format!("1 {kind}"),
        (_, Some(("change", rest))) => format!("{n} changes {rest}"),
        _ => format!("{n} {kind}s"),
    }
}
