//! A kernel as text, with one line per value.

use crate::kernel::{Kernel, Value};
use crate::operation::{Number, Operation, Pair};
use core::fmt;

impl Kernel {
    /// The name of a value in the listing: its own name, or `%` and its index.
    fn listed(&self, v: Value) -> String {
        let line = self.line(v);
        match (&line.name, &line.operation) {
            (Some(name), _) => name.clone(),
            (None, Operation::Input(at)) => self.inputs()[*at].name.clone(),
            (None, Operation::Number(number)) => number.to_string(),
            _ => format!("%{}", v.line()),
        }
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Number::Double(x) => write!(f, "{x}"),
            Number::Ratio(num, den) => write!(f, "{num}/{den}"),
            Number::Pi => f.write_str("π"),
        }
    }
}

impl fmt::Display for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for input in self.inputs() {
            writeln!(f, "given {}: {}", input.name, input.kind)?;
        }
        for (at, line) in self.lines().iter().enumerate() {
            let of = |v: &Value| self.listed(*v);
            let text = match &line.operation {
                Operation::Input(_) | Operation::Number(_) => continue,
                Operation::Identity(shape) => format!("identity {shape}"),
                Operation::Zero(shape) => format!("zero {shape}"),
                Operation::Unit(dim, axis) => format!("unit {dim} {axis}"),
                Operation::Inclusion(shape, row) => format!("inclusion {shape} at {row}"),
                Operation::One(single, a) => format!("{} {}", single.word(), of(a)),
                Operation::Two(pair, a, b) => match pair {
                    Pair::Add | Pair::Sub | Pair::Mul | Pair::Div => {
                        format!("{} {} {}", of(a), pair.word(), of(b))
                    }
                    _ => format!("{} {} {}", pair.word(), of(a), of(b)),
                },
                Operation::Power(a, n) => format!("{} ^ {n}", of(a)),
                Operation::Root(a, num, den) => format!("{} ^ {num}/{den}", of(a)),
                Operation::Entry(a, row) => format!("{}[{row}]", of(a)),
                Operation::EntryAt(a, row, col) => format!("{}[{row}, {col}]", of(a)),
                Operation::RowsFrom(a, _, row) => format!("rows of {} from {row}", of(a)),
                Operation::IntoRows(a, _, row) => format!("{} in rows from {row}", of(a)),
                Operation::ColumnsFrom(a, _, col) => format!("columns of {} from {col}", of(a)),
                Operation::IntoColumns(a, _, col) => format!("{} in columns from {col}", of(a)),
                Operation::Functional(call) => {
                    let values: Vec<String> = call.values.iter().map(of).collect();
                    format!("functional {} of {}", call.functional, values.join(", "))
                }
            };
            writeln!(f, "{} = {text}: {}", self.listed(Value(at)), line.kind)?;
        }
        let outputs: Vec<String> = self.outputs.iter().map(|v| self.listed(*v)).collect();
        writeln!(f, "gives {}", outputs.join(", "))
    }
}
