//! Group elements: products, velocities, matrices, places.

use crate::code::Native;
use crate::value::{MatrixGroup, Value};
use clebsch::Real;
use clebsch::emitted::{Additive, Group, Placed, added};
use clebsch::linalg::Dense;
use nalgebra::SMatrix;

/// The product of two rotations by their matrices, orthogonal to rounding.
pub(crate) fn turned<T: Real>(a: &Dense<T>, b: &Dense<T>) -> Dense<T> {
    a.product(b).orthonormalised()
}

/// The inverse of an invertible map; all NaN if a step has made the matrix singular.
pub(crate) fn linear_inverse<T: Real>(a: &Dense<T>) -> Dense<T> {
    a.small_inverse()
        .unwrap_or_else(|| Dense::unknown(a.rows, a.cols))
}

/// The inverse of an element stored as a matrix.
pub(crate) fn inverse_kept<T: Real>(kept: MatrixGroup, a: &Dense<T>) -> Dense<T> {
    match kept {
        MatrixGroup::Orthogonal => a.transpose(),
        MatrixGroup::Linear => linear_inverse(a),
        MatrixGroup::Field => a.map(|x| -x),
    }
}

/// The product of two elements stored as matrices.
pub(crate) fn composed_kept<T: Real>(kept: MatrixGroup, a: &Dense<T>, b: &Dense<T>) -> Dense<T> {
    match kept {
        MatrixGroup::Orthogonal => turned(a, b),
        MatrixGroup::Linear => a.times(b),
        MatrixGroup::Field => a.plus(b),
    }
}

/// Applies `f` to two rotations or two linear maps.
fn of_both<T: Real>(
    a: &Value<T>,
    b: &Value<T>,
    f: impl Fn(MatrixGroup, &Dense<T>, &Dense<T>) -> Dense<T>,
) -> Option<Value<T>> {
    match (a, b) {
        (Value::Element(kept, a), Value::Element(_, b))
            if *kept != MatrixGroup::Field && a.fits(b) =>
        {
            Some(Value::Element(*kept, f(*kept, a, b)))
        }
        _ => None,
    }
}

/// The product of two elements kept as matrices.
pub(super) fn composed<T: Real>(a: &Value<T>, b: &Value<T>) -> Option<Value<T>> {
    of_both(a, b, composed_kept)
}

fn velocity<T: Real>(a: &Value<T>, b: &Value<T>) -> Option<Value<T>> {
    Some(match (a, b) {
        (Value::Rotation(a), Value::Rotation(b)) => Value::Rotation(a.body_velocity(b)),
        (Value::Quaternion(a), Value::Quaternion(b)) => Value::Quaternion(a.body_velocity(b)),
        (Value::Motion(a), Value::Motion(b)) => Value::Motion(Box::new(a.body_velocity(b))),
        (Value::Plane(a), Value::Plane(b)) => Value::Plane(Box::new(a.body_velocity(b))),
        (Value::Element(MatrixGroup::Field, a), Value::Element(_, b)) => column_wise(a, b)?,
        _ => {
            return of_both(a, b, |kept, a, b| {
                composed_kept(kept, &inverse_kept(kept, a), b)
            });
        }
    })
}

fn spatial_velocity<T: Real>(a: &Value<T>, b: &Value<T>) -> Option<Value<T>> {
    Some(match (a, b) {
        (Value::Rotation(a), Value::Rotation(b)) => Value::Rotation(a.spatial_velocity(b)),
        (Value::Quaternion(a), Value::Quaternion(b)) => Value::Quaternion(a.spatial_velocity(b)),
        (Value::Motion(a), Value::Motion(b)) => Value::Motion(Box::new(a.spatial_velocity(b))),
        (Value::Plane(a), Value::Plane(b)) => Value::Plane(Box::new(a.spatial_velocity(b))),
        (Value::Element(MatrixGroup::Field, a), Value::Element(_, b)) => {
            let (one, two) = (single(a), single(b));
            let each = one.iter().zip(&two).map(|(a, b)| a.spatial_velocity(b));
            field(a, each.map(|v| v.matrix()[0]).collect())
        }
        _ => {
            return of_both(a, b, |kept, a, b| {
                composed_kept(kept, b, &inverse_kept(kept, a))
            });
        }
    })
}

/// The entries of a field one by one, as fields of numbers: their operations are entry by entry.
fn single<T: Real>(a: &Dense<T>) -> Vec<Additive<1, 1, T>> {
    let one = |x: &T| Additive::new(SMatrix::<T, 1, 1>::new(*x));
    a.data.iter().map(one).collect()
}

fn field<T: Real>(like: &Dense<T>, data: Vec<T>) -> Value<T> {
    let (rows, cols) = (like.rows, like.cols);
    Value::Element(MatrixGroup::Field, Dense { rows, cols, data })
}

fn column_wise<T: Real>(a: &Dense<T>, b: &Dense<T>) -> Option<Value<T>> {
    let (one, two) = (single(a), single(b));
    let each = one.iter().zip(&two).map(|(a, b)| a.body_velocity(b));
    Some(field(a, each.map(|v| v.matrix()[0]).collect()))
}

fn matrix<T: Real>(a: &Value<T>) -> Option<Value<T>> {
    Some(match a {
        Value::Rotation(r) => Value::Matrix(r.matrix()),
        Value::Turned(r) => Value::Matrix(r.matrix()),
        Value::Attitude(x) => Value::Matrix(x.matrix()),
        Value::Quaternion(q) => Value::of(Dense::of(&q.matrix())),
        Value::Motion(g) => Value::of(Dense::of(&g.matrix())),
        Value::Plane(g) => Value::of(Dense::of(&g.matrix())),
        Value::Element(_, a) => Value::of(a.clone()),
        other => super::part(other, "matrix")?,
    })
}

/// The numbers of an output, matrices in row-major order.
fn numbers<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    let shown = match a.first()? {
        Value::Real(x) => return Some(Value::List(vec![Value::Real(*x)])),
        Value::Quaternion(q) => return Some(list(q.components())),
        other => matrix(other)
            .or_else(|| super::inner(other))
            .unwrap_or_else(|| (*other).clone()),
    };
    let rows = shown.dense()?.transpose().data;
    Some(Value::List(rows.into_iter().map(Value::Real).collect()))
}

/// The displacement that is added to a position, with its static size.
fn way<T: Real, const R: usize>(a: &Value<T>) -> Option<SMatrix<T, R, 1>> {
    Some(a.dense()?.fixed())
}

fn moved<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    let [place, velocity, rest] = a else {
        return None;
    };
    let (end, left) = match (place, velocity) {
        (Value::Motion(g), Value::Motion(v)) => {
            let (end, left) = g.moved(v, &way(rest)?);
            (Value::Motion(Box::new(end)), Value::of(Dense::of(&left)))
        }
        (Value::Plane(g), Value::Plane(v)) => {
            let (end, left) = g.moved(v, &way(rest)?);
            (Value::Plane(Box::new(end)), Value::of(Dense::of(&left)))
        }
        (Value::Element(MatrixGroup::Field, x), Value::Element(_, v)) => {
            let rest = rest.dense()?;
            let parts = single(x).into_iter().zip(single(v)).zip(&rest.data);
            let parts = parts.map(|((x, v), r)| x.moved(&v, &SMatrix::<T, 1, 1>::new(*r)));
            let (ends, left): (Vec<T>, Vec<T>) =
                parts.map(|(end, left)| (end.matrix()[0], left[0])).unzip();
            let (rows, cols) = (x.rows, x.cols);
            let left = Dense {
                rows,
                cols,
                data: left,
            };
            (field(x, ends), Value::of(left))
        }
        _ => return None,
    };
    Some(Value::List(vec![end, left]))
}

fn between<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    let [from, rest, to, next] = a else {
        return None;
    };
    Some(match (from, to) {
        (Value::Motion(g), Value::Motion(f)) => {
            Value::Motion(Box::new(g.velocity_between(&way(rest)?, f, &way(next)?)))
        }
        (Value::Plane(g), Value::Plane(f)) => {
            Value::Plane(Box::new(g.velocity_between(&way(rest)?, f, &way(next)?)))
        }
        (Value::Element(MatrixGroup::Field, x), Value::Element(_, y)) => {
            let (rest, next) = (rest.dense()?, next.dense()?);
            let ends = single(x).into_iter().zip(single(y));
            let rests = rest.data.iter().zip(&next.data);
            let one = |x: &T| SMatrix::<T, 1, 1>::new(*x);
            let each = ends
                .zip(rests)
                .map(|((x, y), (r, s))| x.velocity_between(&one(r), &y, &one(s)).matrix()[0]);
            field(x, each.collect())
        }
        _ => return None,
    })
}

fn inverse<T: Real>(a: &Value<T>) -> Option<Value<T>> {
    Some(match a {
        Value::Rotation(r) => Value::Rotation(r.inverse()),
        Value::Quaternion(q) => Value::Quaternion(q.inverse()),
        Value::Motion(g) => Value::Motion(Box::new(g.inverse())),
        Value::Plane(g) => Value::Plane(Box::new(g.inverse())),
        Value::Element(..) => return of_both(a, a, |kept, a, _| inverse_kept(kept, a)),
        _ => return None,
    })
}

pub(super) fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    Some(match (name, arguments) {
        ("matrix", 1) => |a, _| matrix(a.first()?),
        ("numbers", 1) => numbers,
        ("body_velocity", 2) => |a, _| velocity(a.first()?, a.get(1)?),
        ("spatial_velocity", 2) => |a, _| spatial_velocity(a.first()?, a.get(1)?),
        ("inverse", 1) => |a, _| inverse(a.first()?),
        ("Additive::new", 1) => {
            |a, _| Some(Value::Element(MatrixGroup::Field, a.first()?.dense()?))
        }
        ("changed", 2) => |a, _| match a {
            [Value::Element(MatrixGroup::Linear, q), change] => {
                let change = change.dense()?;
                let fits = q.fits(&change);
                fits.then(|| Value::Element(MatrixGroup::Linear, q.plus(&change)))
            }
            _ => None,
        },
        ("moved", 3) => moved,
        ("velocity_between", 4) => between,
        ("added", 3) => |a, _| {
            let [value, rest, more] = a else { return None };
            let (value, rest, more) = (value.dense()?, rest.dense()?, more.dense()?);
            if !value.fits(&rest) || !value.fits(&more) {
                return None;
            }
            let one = |x: T| SMatrix::<T, 1, 1>::new(x);
            let parts = value.data.iter().zip(&rest.data).zip(&more.data);
            let parts = parts.map(|((v, r), m)| added(&one(*v), &one(*r), &one(*m)));
            let (sums, left): (Vec<T>, Vec<T>) = parts.map(|(s, l)| (s[0], l[0])).unzip();
            let of = |data| {
                let (rows, cols) = (value.rows, value.cols);
                Value::of(Dense { rows, cols, data })
            };
            Some(Value::List(vec![of(sums), of(left)]))
        },
        ("added_number", 3) => |a, _| match a {
            [Value::Real(value), Value::Real(rest), Value::Real(amount)] => {
                let (sum, lost) = clebsch::emitted::added_number(*value, *rest, *amount);
                Some(list([sum, lost]))
            }
            _ => None,
        },
        ("rodrigues", 1) => |a, _| match a.first()? {
            Value::Rotation(r) => Some(Value::Vector(r.rodrigues())),
            _ => None,
        },
        ("rigid_motion", 2) => |a, _| match a {
            [Value::Rotation(rotation), Value::Vector(translation)] => {
                let g = clebsch::emitted::rigid_motion(*rotation, *translation);
                Some(Value::Motion(Box::new(g)))
            }
            _ => None,
        },
        ("quaternion", 1) => |a, _| match a.first()? {
            Value::Rotation(r) => Some(list(r.quaternion())),
            _ => None,
        },
        ("components", 1) => |a, _| match a.first()? {
            Value::Quaternion(q) => Some(list(q.components())),
            _ => None,
        },
        ("rotation", 1) => |a, _| match a.first()? {
            Value::Quaternion(q) => Some(Value::Rotation(q.rotation())),
            Value::Turned(r) => Some(Value::Rotation(r.rotation())),
            Value::Attitude(x) => Some(Value::Rotation(x.rotation())),
            _ => None,
        },
        ("unit_quaternion", 1) => |a, _| match a.first()? {
            Value::Turned(r) => Some(Value::Quaternion(r.unit_quaternion())),
            Value::Attitude(x) => Some(Value::Quaternion(x.unit_quaternion())),
            _ => None,
        },
        ("real", 1) => |a, _| match a.first()? {
            Value::Quaternion(q) => Some(Value::Real(q.real())),
            other => super::part(other, "real"),
        },
        ("imaginary", 1) => |a, _| match a.first()? {
            Value::Quaternion(q) => Some(Value::Vector(q.imaginary())),
            other => super::part(other, "imaginary"),
        },
        ("inverse_rotate", 2) => |a, _| match (a.first()?, a.get(1)?) {
            (Value::Rotation(r), Value::Vector(v)) => Some(Value::Vector(r.inverse_rotate(v))),
            (Value::Turned(r), Value::Vector(v)) => Some(Value::Vector(r.inverse_rotate(v))),
            _ => None,
        },
        ("rotate", 2) => |a, _| match (a.first()?, a.get(1)?) {
            (Value::Rotation(r), Value::Vector(v)) => Some(Value::Vector(r.rotate(v))),
            _ => None,
        },
        _ => return None,
    })
}

fn list<T: Real, const N: usize>(all: [T; N]) -> Value<T> {
    Value::List(all.map(Value::Real).to_vec())
}
