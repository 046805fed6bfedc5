//! A state as plain numbers, for compositions, which copy states.

use crate::over::{numbers, over};
use crate::value::Value;

/// How many numbers a state may have.
const MOST: usize = 512;

/// A state at one node.
#[derive(Clone, Copy, Debug)]
pub struct Packed {
    numbers: [f64; MOST],
    /// The node.
    pub node: u64,
}

impl Packed {
    /// The numbers of a state; nothing where there are too many.
    pub fn of(state: &Value<f64>) -> Option<Self> {
        let mut all = Vec::new();
        numbers(state, &mut all)?;
        let mut packed = Packed {
            numbers: [0.0; MOST],
            node: node(state),
        };
        packed.numbers.get_mut(..all.len())?.copy_from_slice(&all);
        Some(packed)
    }

    /// The same, counted as another node.
    pub fn counted(self, node: u64) -> Self {
        Packed { node, ..self }
    }

    /// Puts them into a state of the same model.
    pub fn put(&self, state: &mut Value<f64>) {
        let mut all = self.numbers.iter().copied();
        if let Some(own) = over(state, &mut |x| all.next().unwrap_or(x)) {
            *state = own;
        }
        if let Value::Struct(s) = state {
            for value in &mut s.values {
                if let Value::Int(n) = value {
                    *n = i64::try_from(self.node).unwrap_or(i64::MAX);
                }
            }
        }
    }
}

/// The count among the fields of a state.
fn node(state: &Value<f64>) -> u64 {
    let Value::Struct(s) = state else {
        return 0;
    };
    let count = s.values.iter().find_map(Value::count);
    count.map_or(0, |n| n as u64)
}
