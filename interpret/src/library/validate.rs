//! Checks of parameters and initial values.

use super::algebra::numbers;
use crate::code::Native;
use crate::value::Value;
use clebsch::{ParameterError, Real, validate};
use nalgebra::SMatrix;

fn check_result<T: Real>(r: Result<(), ParameterError>) -> Option<Value<T>> {
    Some(Value::result(r.map(|()| Value::Unit)))
}

/// Checks a square matrix.
macro_rules! square {
    ($f:path) => {
        |a, _| {
            let [Value::Text(name), m] = a else {
                return None;
            };
            let m = m.dense()?;
            (m.rows == m.cols).then(|| check_result($f(name, &m)))?
        }
    };
}

/// Checks an argument of a function.
macro_rules! argument {
    ($f:path) => {
        |a, _| match a {
            [
                Value::Domain(d),
                Value::Function(f),
                Value::Text(label),
                Value::Real(x),
            ] => check_result($f(*d, *f, label, *x)),
            _ => None,
        }
    };
}

pub(super) fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    Some(match (name, arguments) {
        ("validate::finite", 2) => |a, _| match a {
            [Value::Text(name), values] => {
                let values = match values {
                    Value::Momentum(..) | Value::Impulse(..) => numbers(&super::inner(values)?)?,
                    values => numbers(values)?,
                };
                check_result(validate::finite(name, &values))
            }
            _ => None,
        },
        ("validate::finite_entries", 2) => |a, _| {
            let [Value::Text(name), m] = a else {
                return None;
            };
            let m = m.dense()?;
            let entry = |row, column| Some(m.at(row, column));
            check_result(validate::finite_entries_of(name, [m.rows, m.cols], entry))
        },
        ("validate::symmetric", 2) => square!(validate::symmetric_of),
        ("validate::skew", 2) => square!(validate::skew_of),
        ("validate::diagonal", 2) => square!(validate::diagonal_of),
        ("validate::orthogonal", 2) => square!(validate::orthogonal_of),
        ("validate::invertible", 2) => square!(validate::invertible_of),
        ("validate::unit_quaternion", 2) => |a, _| {
            let [Value::Text(name), m] = a else {
                return None;
            };
            check_result(validate::unit_quaternion(name, &m.dense()?.fixed::<4, 4>()))
        },
        ("validate::rigid_motion", 2) => |a, _| {
            let [Value::Text(name), m] = a else {
                return None;
            };
            match m {
                Value::Matrix(m) => check_result(validate::rigid_motion::<T, 3, 2>(name, m)),
                m => {
                    let m: SMatrix<T, 4, 4> = m.dense()?.fixed();
                    check_result(validate::rigid_motion::<T, 4, 3>(name, &m))
                }
            }
        },
        ("validate::positive_step", 1) => |a, _| match a.first()? {
            Value::Real(h) => check_result(validate::positive_step(*h)),
            _ => None,
        },
        ("validate::directed_step", 1) => |a, _| match a.first()? {
            Value::Real(h) => check_result(validate::directed_step(*h)),
            _ => None,
        },
        ("validate::assumption", 2) => |a, _| match a {
            [Value::Bool(holds), Value::Text(label)] => {
                check_result(validate::assumption(*holds, label))
            }
            _ => None,
        },
        ("validate::has_inertia", 2) => |a, _| match a {
            [Value::Text(name), Value::Real(answer)] => {
                check_result(validate::has_inertia(name, *answer))
            }
            _ => None,
        },
        ("validate::on_constraint", 4) => |a, _| match a {
            [
                Value::Text(name),
                Value::Text(equation),
                Value::Real(value),
                Value::Real(scale),
            ] => check_result(validate::on_constraint(name, equation, *value, *scale)),
            _ => None,
        },
        ("validate::along_constraint", 5) => |a, _| match a {
            [
                Value::Text(name),
                Value::Text(equation),
                Value::Real(impulse),
                Value::Real(taken),
                Value::Real(whole),
            ] => check_result(validate::along_constraint(
                name, equation, *impulse, *taken, *whole,
            )),
            _ => None,
        },
        // Whether the impulse of the projection is determined.
        ("validate::is_determined", 5) => |a, _| match a {
            [
                Value::Text(name),
                Value::Text(equation),
                Value::Real(impulse),
                _,
                _,
            ] => check_result(validate::along_constraint(
                name,
                equation,
                *impulse,
                T::zero(),
                T::one(),
            )),
            _ => None,
        },
        ("validate::inside", 4) => argument!(validate::inside),
        ("validate::defined", 4) => argument!(validate::defined),
        _ => return None,
    })
}
