//! The counts of a value, such as the node of a state. A tape computes numbers; counts grow beside it.

use super::Traced;
use crate::value::Value;
use clebsch::Real;

/// Puts each count of a value farther by its own distance: the first by 1000, the next by 2000 and so on.
pub fn shift(value: &mut Value<Traced>, next: &mut i64) {
    each_count(value, &mut |n| {
        *next += 1000;
        *n += *next;
    });
}

/// Meets every count of a value.
pub fn each_count<T: Real>(value: &mut Value<T>, met: &mut dyn FnMut(&mut i64)) {
    match value {
        Value::Int(n) => met(n),
        Value::Struct(s) => s.values.iter_mut().for_each(|v| each_count(v, met)),
        Value::List(list) => list.iter_mut().for_each(|v| each_count(v, met)),
        _ => {}
    }
}

/// The value with every count zero.
pub fn uncounted(value: &Value<Traced>) -> Value<Traced> {
    let mut value = value.clone();
    each_count(&mut value, &mut |n| *n = 0);
    value
}

/// Notes every count of a value.
pub fn counts<T: Real>(value: &Value<T>, out: &mut Vec<i64>) {
    match value {
        Value::Int(n) => out.push(*n),
        Value::Struct(s) => s.values.iter().for_each(|v| counts(v, out)),
        Value::List(list) => list.iter().for_each(|v| counts(v, out)),
        _ => {}
    }
}
