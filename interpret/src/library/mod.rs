//! Functions that emitted code calls, by name: the runtime's functions, applied to [`Value`]s. One file for each kind.

mod algebra;
mod band;
mod domain;
pub mod functions;
pub(crate) mod groups;
mod line;
mod mesh;
mod momenta;
mod reactions;
mod solvers;
mod special;
mod validate;

pub use algebra::{binary, entry, negative};
pub use solvers::Factor;

use crate::code::{Native, Special};
use crate::value::Value;
use clebsch::Real;
use clebsch::linalg::Dense;

/// The numbers of field names that the runtime's own types use.
pub const NAMES: [&str; 12] = [
    "rotation",
    "translation",
    "cause",
    "attitude",
    "momentum",
    "edge",
    "matrix",
    "real",
    "imaginary",
    "element",
    "iterations",
    "residual",
];

/// A field of a type of the runtime.
pub fn field<T: Real>(value: &Value<T>, name: u32) -> Option<Value<T>> {
    if let Value::Struct(s) = value {
        return s.field(name).cloned();
    }
    match (NAMES.get(name as usize).copied()?, value) {
        ("rotation", Value::Motion(g)) => Some(Value::Rotation(g.rotation)),
        ("translation", Value::Motion(g)) => Some(Value::Vector(g.translation)),
        ("translation", Value::Plane(g)) => Some(Value::of(Dense {
            rows: 2,
            cols: 1,
            data: g.translation.as_slice().to_vec(),
        })),
        ("cause", Value::Failed(e)) => Some(Value::failed((**e).clone().cause())),
        _ => None,
    }
}

/// A part of a region, by name.
fn part<T: Real>(value: &Value<T>, name: &str) -> Option<Value<T>> {
    match value {
        Value::Struct(s) => {
            let number = NAMES.iter().position(|n| *n == name)?;
            s.field(u32::try_from(number).ok()?).cloned()
        }
        _ => None,
    }
}

/// The content of a newtype: the components of a momentum.
pub fn inner<T: Real>(value: &Value<T>) -> Option<Value<T>> {
    match value {
        Value::Momentum(_, v) => Some(Value::Vector(*v)),
        Value::Impulse(_, a) => Some(Value::of(a.clone())),
        Value::List(list) => list.first().cloned(),
        _ => None,
    }
}

/// The function of the runtime with this name and number of arguments; for a method, the receiver
/// counts as an argument.
pub fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    algebra::native(name, arguments)
        .or_else(|| functions::native(name, arguments))
        .or_else(|| groups::native(name, arguments))
        .or_else(|| momenta::native(name, arguments))
        .or_else(|| solvers::native(name, arguments))
        .or_else(|| domain::native(name, arguments))
        .or_else(|| validate::native(name, arguments))
        .or_else(|| line::native(name, arguments))
        .or_else(|| reactions::native(name, arguments))
        .or_else(|| mesh::native(name, arguments))
        .or_else(|| band::native(name, arguments))
}

/// A function that residuals and tangents may call. Solvers and moves of elements are excluded.
pub fn kernel<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    algebra::native(name, arguments)
        .or_else(|| functions::native(name, arguments))
        .or_else(|| groups::native(name, arguments))
}

/// Like `kernel`, for functions that change their first argument or call back.
pub fn special<T: Real>(name: &str) -> Option<Special<T>> {
    special::kernel(name)
        .or_else(|| special::special(name))
        .or_else(|| line::special(name))
        .or_else(|| reactions::special(name))
        .or_else(|| mesh::special(name))
        .or_else(|| band::special(name))
}

/// A special function that residuals and tangents may call.
pub fn kernel_special<T: Real>(name: &str) -> Option<Special<T>> {
    special::kernel(name)
}
