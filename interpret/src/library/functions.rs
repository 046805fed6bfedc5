//! Functions that models call by path. The interpreter knows the runtime's functions. If a model calls another
//! function, it needs a build.

use crate::code::Native;
use crate::value::Value;
use clebsch::Real;
use clebsch::functions::{carlson_rf, carlson_rf_of_invariants as by_invariants};

/// The function with this path and method, for this number of arguments.
pub fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    let found: Native<T> = match (name, arguments) {
        ("clebsch::functions::carlson_rf::value", 1) => |a, _| {
            let shape = a.first()?.dense()?;
            Some(Value::Real(carlson_rf.value(&shape.fixed::<3, 3>())))
        },
        ("clebsch::functions::carlson_rf::pull_back_1", 2) => |a, _| match a {
            [shape, Value::Real(seed)] => {
                let shape = shape.dense()?.fixed::<3, 3>();
                Some(Value::Matrix(carlson_rf.pull_back_1(&shape, seed)))
            }
            _ => None,
        },
        ("clebsch::functions::carlson_rf_of_invariants::value", 3) => |a, _| match a {
            [Value::Real(x), Value::Real(y), Value::Real(z)] => {
                Some(Value::Real(by_invariants.value(x, y, z)))
            }
            _ => None,
        },
        ("clebsch::functions::carlson_rf_of_invariants::pull_back_1", 4) => |a, _| match a {
            [
                Value::Real(x),
                Value::Real(y),
                Value::Real(z),
                Value::Real(seed),
            ] => Some(Value::Real(by_invariants.pull_back_1(x, y, z, seed))),
            _ => None,
        },
        ("clebsch::functions::carlson_rf_of_invariants::pull_back_2", 4) => |a, _| match a {
            [
                Value::Real(x),
                Value::Real(y),
                Value::Real(z),
                Value::Real(seed),
            ] => Some(Value::Real(by_invariants.pull_back_2(x, y, z, seed))),
            _ => None,
        },
        ("clebsch::functions::carlson_rf_of_invariants::pull_back_3", 4) => |a, _| match a {
            [
                Value::Real(x),
                Value::Real(y),
                Value::Real(z),
                Value::Real(seed),
            ] => Some(Value::Real(by_invariants.pull_back_3(x, y, z, seed))),
            _ => None,
        },
        _ => return None,
    };
    Some(found)
}
