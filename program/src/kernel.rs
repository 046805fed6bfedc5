//! Kernels: straight-line code in which every value is computed once, from earlier ones.

use crate::operation::Operation;
use crate::shape::Kind;
use crate::verify::{Misfit, kind_of};

/// A value of a kernel: the index of the line that computes it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Value(pub(crate) usize);

impl Value {
    /// The index of its line.
    #[must_use]
    pub fn line(self) -> usize {
        self.0
    }
}

/// An input of a kernel.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Input {
    /// Its name: a local variable in printed code.
    pub name: String,
    /// Its kind.
    pub kind: Kind,
}

/// A line: one operation and its result.
#[derive(Clone, PartialEq, Debug)]
pub struct Line {
    /// The operation.
    pub operation: Operation,
    /// The kind of the result.
    pub kind: Kind,
    /// The name of the variable in printed code. A value without a name is written at its point of use.
    pub name: Option<String>,
}

/// Straight-line code without side effects.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Kernel {
    inputs: Vec<Input>,
    lines: Vec<Line>,
    /// The results.
    pub outputs: Vec<Value>,
}

impl Kernel {
    /// A kernel without lines.
    #[must_use]
    pub fn new() -> Self {
        Kernel::default()
    }

    /// Its inputs, in order.
    #[must_use]
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// The lines, each after the lines that it uses.
    #[must_use]
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// The values and their lines, each after the lines that it uses.
    pub fn values(&self) -> impl Iterator<Item = (Value, &Line)> {
        self.lines
            .iter()
            .enumerate()
            .map(|(at, line)| (Value(at), line))
    }

    /// The line that computes a value of this kernel.
    ///
    /// # Panics
    /// If the value belongs to a longer kernel.
    #[must_use]
    pub fn line(&self, value: Value) -> &Line {
        &self.lines[value.0]
    }

    /// The input with this name; added if it is new.
    ///
    /// # Errors
    /// If an input of another kind has this name.
    pub fn input(&mut self, name: &str, kind: Kind) -> Result<Value, Misfit> {
        if let Some(at) = self.inputs.iter().position(|i| i.name == name) {
            if self.inputs[at].kind != kind {
                return Err(Misfit::Renamed(name.to_owned()));
            }
            let is_it = |line: &Line| line.operation == Operation::Input(at);
            if let Some(line) = self.lines.iter().position(is_it) {
                return Ok(Value(line));
            }
        }
        self.inputs.push(Input {
            name: name.to_owned(),
            kind,
        });
        self.push(Operation::Input(self.inputs.len() - 1))
    }

    /// Adds a line.
    ///
    /// # Errors
    /// If the operation does not take values of these kinds.
    pub fn push(&mut self, operation: Operation) -> Result<Value, Misfit> {
        let kind = kind_of(&operation, &self.inputs, &self.lines)?;
        self.lines.push(Line {
            operation,
            kind,
            name: None,
        });
        Ok(Value(self.lines.len() - 1))
    }

    /// Names the variable of a value in printed code.
    pub fn name(&mut self, value: Value, name: &str) {
        if let Some(line) = self.lines.get_mut(value.0) {
            line.name = Some(name.to_owned());
        }
    }

    /// Checks every line and the outputs.
    ///
    /// # Errors
    /// The first misfit.
    pub fn verify(&self) -> Result<(), Misfit> {
        for (at, line) in self.lines.iter().enumerate() {
            let kind = kind_of(&line.operation, &self.inputs, &self.lines[..at])?;
            if kind != line.kind {
                return Err(Misfit::Kinds(at));
            }
        }
        match self.outputs.iter().find(|v| v.0 >= self.lines.len()) {
            Some(v) => Err(Misfit::Later(v.0)),
            None => Ok(()),
        }
    }
}
