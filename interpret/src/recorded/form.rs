//! Operations over the recording scalar, in places that the caller fills.

use super::Traced;
use super::loop_inputs::SiteReader;
use crate::code::{Code, Places};
use crate::map_scalar::alike;
use crate::value::Value;
use std::collections::BTreeSet;

/// Operations over the recording scalar, and the paths that they read from the surrounding places.
#[derive(Debug)]
pub struct Form {
    body: Code<Traced>,
    paths: Vec<Code<f64>>,
}

impl Form {
    /// The form of a body with these parameters. Returns nothing if an operation supports only plain numbers.
    pub fn of(parameters: &[usize], body: &Code<f64>) -> Option<Self> {
        let mut filled: BTreeSet<usize> = parameters.iter().copied().collect();
        body.fills(&mut filled);
        let mut paths = Vec::new();
        body.reads(&filled, &mut paths);
        let mut distinct: Vec<Code<f64>> = Vec::new();
        for path in paths {
            if distinct.iter().all(|other| !is_same(other, path)) {
                distinct.push(path.clone());
            }
        }
        Some(Form {
            body: body.map_scalar(Traced::constant)?,
            paths: distinct,
        })
    }

    /// The places that the body reads, filled with inputs.
    pub fn places(&self, asker: &mut SiteReader, places: &Places<f64>) -> Option<Places<Traced>> {
        let mut own = vec![Value::Unit; places.len()];
        for path in &self.paths {
            asker.provide(path, places, &mut own)?;
        }
        Some(own)
    }

    /// The value, if there is one.
    pub fn run(&self, own: &mut Places<Traced>) -> Option<Value<Traced>> {
        value_of(&self.body, own)
    }
}

/// The value of operations. Returns nothing for an error; clebsch then computes with plain numbers.
pub fn value_of(body: &Code<Traced>, places: &mut Places<Traced>) -> Option<Value<Traced>> {
    let value = body.returned(places).ok();
    value.filter(|value| !matches!(value, Value::Failed(_)))
}

/// Whether two paths are equal.
pub fn is_same(a: &Code<f64>, b: &Code<f64>) -> bool {
    match (a, b) {
        (Code::Place(a), Code::Place(b)) => a == b,
        (Code::Field(a, name), Code::Field(b, other)) => name == other && is_same(a, b),
        _ => false,
    }
}

/// Whether the values at these paths agree with the fixed values, except for numbers. Lists are compared by length.
pub fn stands(fixed: &[(Code<f64>, Value<f64>)], places: &Places<f64>) -> bool {
    let same = |(path, value): &(Code<f64>, Value<f64>)| match (path.place(places), value) {
        (Some(Value::Sites(column)), Value::Int(n)) => i64::try_from(column.len()) == Ok(*n),
        (Some(own), value) => alike(own, value),
        (None, _) => false,
    };
    fixed.iter().all(same)
}
