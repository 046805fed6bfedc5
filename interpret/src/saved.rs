//! Saves and restores the values that a trajectory keeps between its steps.

use crate::library::Factor;
use crate::sites::Column;
use crate::value::Value;
use clebsch::saved::{Saved, Words, sites};
use std::sync::Arc;

/// Saves the changing parts of a value. The kind of a value does not change, except that an optional value may appear
/// or disappear.
impl Saved for Value<f64> {
    fn words(&mut self, words: &mut Words) {
        words.same(kind(self));
        match self {
            Value::Int(n) => {
                let mut bits = n.cast_unsigned();
                words.word(&mut bits);
                *n = bits.cast_signed();
            }
            Value::Bool(b) => b.words(words),
            Value::Real(x) | Value::Double(x) => x.words(words),
            Value::Vector(v) | Value::Momentum(_, v) => v.words(words),
            Value::Matrix(m) => m.words(words),
            Value::Dense(a) | Value::Element(_, a) | Value::Impulse(_, a) => a.words(words),
            Value::Rotation(r) => r.words(words),
            Value::Quaternion(q) => q.words(words),
            Value::Motion(g) => g.words(words),
            Value::Plane(g) => g.words(words),
            Value::Edge(edge) => edge.words(words),
            Value::Poinsot(body) => Arc::make_mut(body).words(words),
            Value::QuaternionBody(body) => Arc::make_mut(body).words(words),
            Value::LeftFactor(factor) => factor.words(words),
            Value::Free(free) => free.words(words),
            Value::Struct(s) => sites(&mut s.values, words),
            Value::List(list) => sites(list, words),
            Value::Sites(column) => column.words(words),
            Value::Attitude(x) => x.words(words),
            Value::Search(held) => held.words(words),
            // Constant along a trajectory, or empty.
            Value::Unit
            | Value::None
            | Value::Zeros
            | Value::Text(_)
            | Value::Method(_)
            | Value::Order(_)
            | Value::Domain(_)
            | Value::Function(_)
            | Value::Call(_) => {}
            // The state that a stamp refers to is restored completely.
            Value::Stamp(_) => {}
            // Restarted in every step.
            Value::Multipliers(_) | Value::Band(_) => {}
            // Computed from the parameters.
            Value::Extent(_) | Value::FunctionalSetting(_) => {}
            Value::Functional(held) => held.words(words),
            // These never occur in a state or a workspace.
            Value::Turned(_)
            | Value::Warning(_)
            | Value::Part(..)
            | Value::At(_)
            | Value::Failed(_) => words.refuse(),
        }
    }
}

/// A number for each kind of value that is saved in its own format.
fn kind(value: &Value<f64>) -> u64 {
    match value {
        Value::Unit | Value::None => 0,
        Value::Bool(_) => 1,
        Value::Int(_) => 2,
        Value::Real(_) | Value::Double(_) => 3,
        Value::Vector(_) | Value::Momentum(..) => 4,
        Value::Matrix(_) => 5,
        Value::Dense(_) | Value::Element(..) | Value::Impulse(..) => 6,
        Value::Zeros => 7,
        Value::Rotation(_) => 8,
        Value::Quaternion(_) => 9,
        Value::Motion(_) => 10,
        Value::Plane(_) => 11,
        Value::Edge(_) => 12,
        Value::Poinsot(_) => 13,
        Value::QuaternionBody(_) => 14,
        Value::LeftFactor(_) => 15,
        Value::Free(_) => 16,
        Value::Struct(_) => 17,
        Value::List(_) => 18,
        Value::Search(_) => 19,
        Value::Sites(_) => 21,
        Value::Attitude(_) => 22,
        _ => 20,
    }
}

impl Saved for Column<f64> {
    fn words(&mut self, words: &mut Words) {
        words.same(self.len() as u64);
        match self {
            Column::Numbers(list) | Column::Arrays(_, list) => {
                list.iter_mut().for_each(|x| x.words(words));
            }
            Column::Attitudes(list) => list.iter_mut().for_each(|x| x.words(words)),
            Column::Structs(_, fields, _) => fields.iter_mut().for_each(|f| f.words(words)),
            Column::Values(list) => list.iter_mut().for_each(|x| x.words(words)),
            Column::Tracked(_) => words.refuse(),
        }
    }
}

impl Saved for Factor<f64> {
    fn words(&mut self, words: &mut Words) {
        match self {
            Factor::Two(f) => Arc::make_mut(f).words(words),
            Factor::Three(f) => Arc::make_mut(f).words(words),
            Factor::Four(f) => Arc::make_mut(f).words(words),
            Factor::Five(f) => Arc::make_mut(f).words(words),
            Factor::Six(f) => Arc::make_mut(f).words(words),
            Factor::Seven(f) => Arc::make_mut(f).words(words),
            Factor::Eight(f) => Arc::make_mut(f).words(words),
        }
    }
}
