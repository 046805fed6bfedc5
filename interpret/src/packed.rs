//! A state as plain numbers, for compositions, which copy states.

use crate::value::{Frame, Value};
use clebsch::OfScalars;

/// How many numbers a state may have.
const MOST: usize = 512;

/// A state at one node.
#[derive(Clone, Copy, Debug)]
pub struct Packed {
    numbers: [f64; MOST],
    /// The node.
    pub node: u64,
}

/// One number of a value, to be looked at or changed.
type Visit<'a> = dyn FnMut(&mut f64) + 'a;

impl Packed {
    /// The numbers of a state; nothing where there are too many.
    pub fn of(state: &Value<f64>) -> Option<Self> {
        let mut packed = Packed {
            numbers: [0.0; MOST],
            node: 0,
        };
        let mut at = 0;
        let mut looked = state.clone();
        let node = &mut packed.node;
        let numbers = &mut packed.numbers;
        visit(&mut looked, node, &mut |x| {
            if let Some(slot) = numbers.get_mut(at) {
                *slot = *x;
            }
            at += 1;
        });
        (at <= MOST).then_some(packed)
    }

    /// The same, counted as another node.
    pub fn counted(self, node: u64) -> Self {
        Packed { node, ..self }
    }

    /// Puts them into a state of the same model.
    pub fn put(&self, state: &mut Value<f64>) {
        let mut all = self.numbers.iter();
        let mut node = self.node;
        visit(state, &mut node, &mut |x| {
            if let Some(known) = all.next() {
                *x = *known;
            }
        });
        set_node(state, self.node);
    }
}

fn set_node(state: &mut Value<f64>, node: u64) {
    if let Value::Struct(s) = state {
        for value in &mut s.values {
            if let Value::Int(n) = value {
                *n = i64::try_from(node).unwrap_or(i64::MAX);
            }
        }
    }
}

/// Meets all numbers of a value in the order of its fields. The count among the fields is the node.
fn visit(value: &mut Value<f64>, node: &mut u64, met: &mut Visit) {
    let mut each = |x: f64| {
        let mut x = x;
        met(&mut x);
        x
    };
    match value {
        Value::Struct(s) => {
            for field in &mut s.values {
                visit(field, node, met);
            }
        }
        Value::List(list) => {
            for field in list {
                visit(field, node, met);
            }
        }
        Value::Int(n) => *node = u64::try_from(*n).unwrap_or(0),
        Value::Real(x) | Value::Double(x) => met(x),
        Value::Vector(v) | Value::Momentum(Frame::Body | Frame::Spatial | Frame::Carried, v) => {
            v.iter_mut().for_each(met);
        }
        Value::Matrix(m) => m.iter_mut().for_each(met),
        Value::Dense(a) | Value::Element(_, a) | Value::Impulse(_, a) => {
            a.data.iter_mut().for_each(met);
        }
        Value::Momentum(Frame::Field, v) => v.iter_mut().for_each(met),
        Value::Rotation(r) => *r = r.over(&mut each),
        Value::Quaternion(q) => *q = q.over(&mut each),
        Value::Motion(g) => **g = g.over(&mut each),
        Value::Plane(g) => **g = g.over(&mut each),
        _ => {}
    }
}
