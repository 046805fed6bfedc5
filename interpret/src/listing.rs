//! Recorded functions as text: one section for each function, with the names of the numbers that it reads and computes.

use crate::code::Code;
use crate::map_scalar;
use crate::opened::at;
use crate::recorded::List;
use crate::value::Value;
use clebsch_program::{Counts, Machine};
use std::fmt::{self, Write};

/// A recorded function: a title, its operations by kind, and one line for each operation.
#[derive(Debug)]
pub struct Section {
    title: String,
    counts: Counts,
    lines: String,
}

impl Section {
    /// The operations of a machine, with names for its inputs and outputs.
    pub fn of(title: &str, machine: &Machine, inputs: &[String], outputs: &[String]) -> Self {
        Section {
            title: title.to_owned(),
            counts: machine.counts(),
            lines: machine.listing(inputs, outputs),
        }
    }
}

impl fmt::Display for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} ({})", self.title, self.counts)?;
        for line in self.lines.lines() {
            writeln!(f, "    {line}")?;
        }
        Ok(())
    }
}

/// All sections, with an empty line between two sections; nothing if there are none.
pub fn text(sections: &[Section]) -> Option<String> {
    let told: Vec<String> = sections.iter().map(Section::to_string).collect();
    (!told.is_empty()).then(|| told.join("\n"))
}

/// The names of fields by their numbers.
#[derive(Clone, Debug, Default)]
pub struct FieldNames(pub Vec<String>);

impl FieldNames {
    fn field(&self, number: u32) -> &str {
        self.0.get(number as usize).map_or("?", String::as_str)
    }

    /// Appends the names of the numbers of a value, in the order in which tapes read them. Vectors have names such as
    /// `x.1`, matrices `J.12` for row 1 and column 2. A rotation is its unit quaternion, real part first.
    pub fn numbers(&self, name: &str, value: &Value<f64>, out: &mut Vec<String>) {
        match value {
            Value::Real(_) => out.push(name.to_owned()),
            Value::Vector(_) | Value::Momentum(..) => entries(name, [3, 1], out),
            Value::Matrix(_) => entries(name, [3, 3], out),
            Value::Dense(a) | Value::Element(_, a) | Value::Impulse(_, a) => {
                entries(name, [a.rows, a.cols], out);
            }
            Value::Struct(s) => {
                for (field, value) in s.layout.fields.iter().zip(&s.values) {
                    self.numbers(&joined(name, self.field(*field)), value, out);
                }
            }
            Value::List(list) => {
                for (k, value) in list.iter().enumerate() {
                    self.numbers(&format!("{name}[{k}]"), value, out);
                }
            }
            other => {
                let mut own = Vec::new();
                if map_scalar::numbers(other, &mut own).is_some() {
                    entries(name, [own.len(), 1], out);
                }
            }
        }
    }

    /// A list or a field of its entries, such as `state.q`; the list that a loop changes is called `own`.
    pub fn list(&self, list: &List) -> String {
        let own = list.path.as_ref().map(|path| self.path(path));
        let mut name = own.unwrap_or_else(|| "own".to_owned());
        for at in &list.fields {
            name.push_str(&format!(".{at}"));
        }
        name
    }

    /// A path such as `state.q`; a local of the function is called `local` with its number.
    pub fn path(&self, path: &Code<f64>) -> String {
        match path {
            Code::Place(at::MODEL) => String::new(),
            Code::Place(at::STATE) => "state".to_owned(),
            Code::Place(at::WORK) => "workspace".to_owned(),
            Code::Place(at) => format!("local{at}"),
            Code::Field(base, number) => joined(&self.path(base), self.field(*number)),
            _ => "?".to_owned(),
        }
    }
}

fn joined(name: &str, field: &str) -> String {
    match name {
        "" => field.to_owned(),
        name => format!("{name}.{field}"),
    }
}

/// The names of the entries of an array, column by column.
fn entries(name: &str, [rows, cols]: [usize; 2], out: &mut Vec<String>) {
    let comma = if rows.max(cols) > 9 { "," } else { "" };
    for (col, row) in (1..=cols).flat_map(|col| (1..=rows).map(move |row| (col, row))) {
        let mut entry = format!("{name}.{row}");
        if cols > 1 {
            // Writing to a string does not fail.
            let _ = write!(entry, "{comma}{col}");
        }
        out.push(entry);
    }
}

/// Names such as `x.1` for `count` numbers.
pub fn numbered(name: &str, count: usize) -> Vec<String> {
    let mut out = Vec::new();
    entries(name, [count, 1], &mut out);
    out
}
