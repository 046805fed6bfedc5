//! Domains of functions, and residuals of the equations of a step.

use crate::code::Native;
use crate::value::{MatrixGroup, Value};
use clebsch::Real;
use clebsch::domain;
use clebsch::integrate::{filled, fills};
use clebsch::kinetic::KineticWarning;
use clebsch::linalg::Dense;

fn invertible<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    let [
        Value::Text(name),
        Value::Element(_, before),
        Value::Element(_, after),
        Value::Real(h),
    ] = a
    else {
        return None;
    };
    let met = domain::invertible_of(name, before, after, *h);
    Some(Value::result(met.map(|()| Value::Unit)))
}

/// An argument at the start and at the end of a step.
macro_rules! argument {
    ($method:ident) => {
        |a, _| match a {
            [
                Value::Domain(d),
                Value::Call(call),
                Value::Real(x),
                Value::Real(y),
                Value::Real(h),
            ] => Some(Value::result(
                d.$method(call, *x, *y, *h).map(|()| Value::Unit),
            )),
            _ => None,
        }
    };
}

pub(super) fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    Some(match (name, arguments) {
        ("domain::invertible", 4) => invertible,
        ("domain::field_invertible", 4) => invertible,
        ("at_nodes", 5) => argument!(at_nodes),
        ("on_edge", 5) => argument!(on_edge),
        ("admits", 2) => |a, _| match a {
            [Value::Domain(d), Value::Real(x)] => Some(Value::Bool(d.admits(*x))),
            _ => None,
        },
        // Rows of a momentum, with the impulse that they receive.
        ("not_less", 3) => |a, _| match a {
            [momentum, Value::List(rows), Value::Real(impulse)] => {
                let m = momentum.dense()?;
                let (from, count) = (rows.first()?.count()?, rows.get(1)?.count()?);
                let within = from..from + count;
                let entries = within
                    .clone()
                    .flat_map(|i| (0..m.cols).map(move |j| (i, j)));
                let entries = entries.map(|(i, j)| m.at(i, j));
                let fills = fills(entries, *impulse);
                Some(Value::of(Dense::from_fn(
                    m.rows,
                    m.cols,
                    |i, j| match within.contains(&i) {
                        true => filled(m.at(i, j), fills, *impulse),
                        false => m.at(i, j),
                    },
                )))
            }
            _ => None,
        },
        ("KineticWarning::of", 2) => |a, _| {
            let (form, count) = (a.first()?.dense()?, a.get(1)?.count()?);
            let entry = |i, j| form.at(i, j).value();
            let warning = KineticWarning::of_entries(count.min(form.rows), &entry);
            Some(warning.map_or(Value::None, Value::Warning))
        },
        ("is_invertible", 1) => |a, _| match a.first()? {
            Value::Element(MatrixGroup::Linear, _) => Some(Value::Bool(true)),
            _ => None,
        },
        _ => return None,
    })
}
