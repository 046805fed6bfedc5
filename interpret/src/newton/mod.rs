//! Newton's method for equations that were read: the solver of the runtime on groups of any kind and size,
//! with residual and tangent run as operations.

mod search;
mod shape;
mod solve;

pub use search::{Held, Sought, remember};
pub use shape::{Kind, Shape};
pub use solve::{Rest, Settled, Solve};

use crate::value::{Struct, Value};
use clebsch::{OfScalars, Real};

/// A value over another scalar: every number replaced by its image.
pub fn over<T: Real, U: Real>(
    value: &Value<T>,
    change: &mut impl FnMut(T) -> U,
) -> Option<Value<U>> {
    use clebsch::linalg::Dense;
    let dense = |a: &Dense<T>, change: &mut dyn FnMut(T) -> U| Dense {
        rows: a.rows,
        cols: a.cols,
        data: a.data.iter().map(|x| change(*x)).collect(),
    };
    Some(match value {
        Value::Unit => Value::Unit,
        Value::None => Value::None,
        Value::Zeros => Value::Zeros,
        Value::Int(n) => Value::Int(*n),
        Value::Bool(b) => Value::Bool(*b),
        Value::Double(x) => Value::Double(*x),
        Value::Real(x) => Value::Real(change(*x)),
        Value::Vector(v) => Value::Vector(v.map(change)),
        Value::Matrix(m) => Value::Matrix(m.map(change)),
        Value::Dense(a) => Value::Dense(dense(a, change)),
        Value::Element(kept, a) => Value::Element(*kept, dense(a, change)),
        Value::Momentum(frame, v) => Value::Momentum(*frame, v.map(change)),
        Value::Impulse(frame, a) => Value::Impulse(*frame, dense(a, change)),
        Value::Rotation(r) => Value::Rotation(r.over(change)),
        Value::Quaternion(q) => Value::Quaternion(q.over(change)),
        Value::Motion(g) => Value::Motion(Box::new(g.over(change))),
        Value::Plane(g) => Value::Plane(Box::new(g.over(change))),
        Value::Struct(s) => Value::Struct(Struct {
            layout: s.layout.clone(),
            values: all(&s.values, change)?,
        }),
        Value::List(list) => Value::List(all(list, change)?),
        _ => return None,
    })
}

fn all<T: Real, U: Real>(
    list: &[Value<T>],
    change: &mut impl FnMut(T) -> U,
) -> Option<Vec<Value<U>>> {
    let mut out = Vec::with_capacity(list.len());
    for value in list {
        out.push(over(value, change)?);
    }
    Some(out)
}
