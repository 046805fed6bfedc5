//! A state as plain numbers, for compositions, which copy states.

use crate::map_scalar::{fill, numbers};
use crate::value::Value;

/// How many numbers a state may have.
pub const MOST: usize = 512;

/// A state at one node.
#[derive(Clone, Copy, Debug)]
pub struct Packed {
    numbers: [f64; MOST],
    count: usize,
    /// The node.
    pub node: u64,
}

impl Packed {
    /// The numbers of a state. Returns nothing if there are too many.
    pub fn of(state: &Value<f64>) -> Option<Self> {
        let mut all = Vec::new();
        numbers(state, &mut all)?;
        Packed::of_numbers(&all, node(state))
    }

    /// These numbers at a node. Returns nothing if there are too many.
    pub fn of_numbers(all: &[f64], node: u64) -> Option<Self> {
        let mut packed = Packed {
            numbers: [0.0; MOST],
            count: all.len(),
            node,
        };
        packed.numbers.get_mut(..all.len())?.copy_from_slice(all);
        Some(packed)
    }

    /// Sets the numbers and the node; returns false if the count of numbers differs.
    pub fn set(&mut self, all: &[f64], node: u64) -> bool {
        let own = self.numbers.get_mut(..self.count);
        let Some(own) = own.filter(|own| own.len() == all.len()) else {
            return false;
        };
        own.copy_from_slice(all);
        self.node = node;
        true
    }

    /// This state, with its node number set to `node`.
    pub fn counted(self, node: u64) -> Self {
        Packed { node, ..self }
    }

    /// Its numbers.
    pub fn numbers(&self) -> &[f64] {
        self.numbers.get(..self.count).unwrap_or_default()
    }

    /// Writes the numbers into a state of the same model.
    pub fn put(&self, state: &mut Value<f64>) {
        fill(state, &mut self.numbers().iter().copied());
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
