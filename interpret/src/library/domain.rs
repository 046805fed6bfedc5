//! Where functions are defined, and what a step leaves of its equations.

use super::groups::linear;
use super::of_size;
use crate::code::Native;
use crate::value::{Kept, Value};
use clebsch::Real;
use clebsch::domain;
use clebsch::emitted::Residual;
use clebsch::kinetic::KineticWarning;
use nalgebra::SMatrix;

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
    of_size!(before.rows, N, {
        let (from, to) = (linear::<T, N>(before), linear::<T, N>(after));
        let met = domain::invertible(name, &from, &to, *h);
        Some(Value::result(met.map(|()| Value::Unit)))
    })
}

/// An argument at two places of a step.
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
        ("Residual", 2) => |a, _| match a {
            [Value::Double(size), Value::Double(scale)] => Some(Value::Residual(Residual {
                size: *size,
                scale: *scale,
            })),
            _ => None,
        },
        ("KineticWarning::of", 2) => |a, _| {
            let (form, count) = (a.first()?.dense()?, a.get(1)?.count()?);
            fn of<const N: usize>(
                entry: impl Fn(usize, usize) -> f64,
                n: usize,
            ) -> Option<KineticWarning> {
                KineticWarning::of(&SMatrix::<f64, N, N>::from_fn(entry), n)
            }
            let entry = |i, j| form.at(i, j).value();
            let warning = match form.rows {
                0..=3 => of::<3>(entry, count),
                4..=6 => of::<6>(entry, count),
                7..=16 => of::<16>(entry, count),
                17..=64 => of::<64>(entry, count),
                _ => return None,
            };
            Some(warning.map_or(Value::None, Value::Warning))
        },
        ("is_invertible", 1) => |a, _| match a.first()? {
            Value::Element(Kept::Linear, _) => Some(Value::Bool(true)),
            _ => None,
        },
        _ => return None,
    })
}
