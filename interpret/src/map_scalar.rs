//! Maps a value to another scalar: replaces every number by its image, always in the same order.

use crate::value::{Struct, Value};
use clebsch::emitted::Edge;
use clebsch::linalg::Dense;
use clebsch::line::Attitude;
use clebsch::{OfScalars, Real};
use std::sync::Arc;

/// The value with every number replaced. Returns nothing for the memory of a solver.
pub fn map_scalar<T: Real, U: Real>(
    value: &Value<T>,
    change: &mut impl FnMut(T) -> U,
) -> Option<Value<U>> {
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
        Value::Text(text) => Value::Text(text),
        Value::Method(method) => Value::Method(*method),
        Value::Order(order) => Value::Order(*order),
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
        Value::Edge(edge) => {
            let body = edge.body().map(&mut *change);
            Value::Edge(Edge::new(body, edge.space().map(change)))
        }
        Value::Attitude(x) => {
            let rotation = x.rotation().over(change);
            Value::Attitude(Box::new(Attitude::new(rotation)))
        }
        Value::Poinsot(body) => Value::Poinsot(Arc::new(body.over(change))),
        Value::QuaternionBody(body) => Value::QuaternionBody(Arc::new(body.over(change))),
        Value::LeftFactor(factor) => Value::LeftFactor(factor.over(change)),
        Value::Domain(domain) => Value::Domain(*domain),
        Value::Function(function) => Value::Function(*function),
        Value::Call(call) => Value::Call(call),
        // A search uses plain numbers, whatever the scalar.
        Value::Search(search) => Value::Search(search.clone()),
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
        out.push(map_scalar(value, change)?);
    }
    Some(out)
}

/// The numbers of a value, in the order of [`map_scalar`]. Also appends nothing for data that [`map_scalar`] does not
/// change.
pub fn numbers<T: Real>(value: &Value<T>, out: &mut Vec<T>) -> Option<()> {
    match value {
        Value::Real(x) => out.push(*x),
        Value::Vector(v) | Value::Momentum(_, v) => out.extend_from_slice(v.as_slice()),
        Value::Matrix(m) => out.extend_from_slice(m.as_slice()),
        Value::Dense(a) | Value::Element(_, a) | Value::Impulse(_, a) => {
            out.extend_from_slice(&a.data);
        }
        Value::Struct(s) => {
            for value in &s.values {
                numbers(value, out)?;
            }
        }
        Value::List(list) => {
            for value in list {
                numbers(value, out)?;
            }
        }
        Value::Search(_) => {}
        other => {
            map_scalar(other, &mut |x| {
                out.push(x);
                x
            })?;
        }
    }
    Some(())
}

/// Puts numbers into a value, in the order of [`map_scalar`].
pub fn fill(value: &mut Value<f64>, from: &mut impl Iterator<Item = f64>) {
    let mut next = |x: &mut f64| *x = from.next().unwrap_or(*x);
    match value {
        Value::Real(x) => next(x),
        Value::Vector(v) | Value::Momentum(_, v) => v.iter_mut().for_each(next),
        Value::Matrix(m) => m.iter_mut().for_each(next),
        Value::Dense(a) | Value::Element(_, a) | Value::Impulse(_, a) => {
            a.data.iter_mut().for_each(next);
        }
        Value::Struct(s) => s.values.iter_mut().for_each(|value| fill(value, from)),
        Value::List(list) => list.iter_mut().for_each(|value| fill(value, from)),
        Value::Search(_) => {}
        other => {
            if let Some(made) = map_scalar(other, &mut |x: f64| from.next().unwrap_or(x)) {
                *other = made;
            }
        }
    }
}

/// Whether two values agree except for their numbers: in kinds, sizes, counts and names.
pub fn alike<T: Real>(a: &Value<T>, b: &Value<T>) -> bool {
    let lists = |a: &[Value<T>], b: &[Value<T>]| {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| alike(a, b))
    };
    match (a, b) {
        (Value::Struct(a), Value::Struct(b)) => lists(&a.values, &b.values),
        (Value::List(a), Value::List(b)) => lists(a, b),
        (Value::Dense(a), Value::Dense(b)) => (a.rows, a.cols) == (b.rows, b.cols),
        (Value::Element(k, a), Value::Element(l, b)) => (k, a.rows, a.cols) == (l, b.rows, b.cols),
        (Value::Impulse(f, a), Value::Impulse(g, b)) => (f, a.rows, a.cols) == (g, b.rows, b.cols),
        (Value::Momentum(f, _), Value::Momentum(g, _)) => f == g,
        (Value::Poinsot(a), Value::Poinsot(b)) => a.is_diagonal() == b.is_diagonal(),
        (Value::QuaternionBody(a), Value::QuaternionBody(b)) => a.is_diagonal() == b.is_diagonal(),
        (Value::LeftFactor(a), Value::LeftFactor(b)) => a.is_alike(b),
        (Value::Bool(a), Value::Bool(b)) => a == b,
        (Value::Int(a), Value::Int(b)) => a == b,
        (Value::Double(a), Value::Double(b)) => a.to_bits() == b.to_bits(),
        (Value::Text(a), Value::Text(b)) => a == b,
        (Value::Method(a), Value::Method(b)) => a == b,
        (Value::Domain(a), Value::Domain(b)) => a == b,
        (Value::Function(a), Value::Function(b)) => a == b,
        (Value::Call(a), Value::Call(b)) => std::ptr::eq(*a, *b),
        (Value::Order(_), Value::Order(_)) => false,
        _ => std::mem::discriminant(a) == std::mem::discriminant(b),
    }
}
