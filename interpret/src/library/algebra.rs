//! Arithmetic, matrices and the functions of one number.

use crate::code::{Native, Operator};
use crate::value::{MatrixGroup, Value};
use clebsch::Real;
use clebsch::emitted as e;
use clebsch::linalg;
use clebsch::linalg::Dense;
use nalgebra::{Matrix3, Matrix4, SVector};

/// An operator on two values.
#[inline]
pub fn binary<T: Real>(operator: Operator, a: &Value<T>, b: &Value<T>) -> Option<Value<T>> {
    use Operator::{Add, Div, Mul, Sub};
    use Value as V;
    Some(match (operator, a, b) {
        (Operator::Equal, a, b) => V::Bool(a == b),
        (Operator::Differs, a, b) => V::Bool(a != b),
        (Add, V::Real(x), V::Real(y)) => V::Real(*x + *y),
        (Sub, V::Real(x), V::Real(y)) => V::Real(*x - *y),
        (Mul, V::Real(x), V::Real(y)) => V::Real(*x * *y),
        (Div, V::Real(x), V::Real(y)) => V::Real(*x / *y),
        (Add, V::Vector(x), V::Vector(y)) => V::Vector(x + y),
        (Sub, V::Vector(x), V::Vector(y)) => V::Vector(x - y),
        (Mul, V::Vector(x), V::Real(y)) => V::Vector(x * *y),
        (Div, V::Vector(x), V::Real(y)) => V::Vector(x / *y),
        (Add, V::Matrix(x), V::Matrix(y)) => V::Matrix(x + y),
        (Sub, V::Matrix(x), V::Matrix(y)) => V::Matrix(x - y),
        (Mul, V::Matrix(x), V::Matrix(y)) => V::Matrix(x * y),
        (Mul, V::Matrix(x), V::Vector(y)) => V::Vector(x * y),
        (Mul, V::Matrix(x), V::Real(y)) => V::Matrix(x * *y),
        (Div, V::Matrix(x), V::Real(y)) => V::Matrix(x / *y),
        (_, V::Double(x), V::Double(y)) => double(operator, *x, *y),
        (_, V::Int(x), V::Int(y)) => whole(operator, *x, *y)?,
        (Mul, V::Rotation(x), V::Rotation(y)) => V::Rotation(*x * *y),
        (Mul, V::Quaternion(x), V::Quaternion(y)) => V::Quaternion(*x * *y),
        (Mul, V::Motion(x), V::Motion(y)) => V::Motion(Box::new(**x * **y)),
        (Mul, V::Plane(x), V::Plane(y)) => V::Plane(Box::new(**x * **y)),
        (Add, V::Element(MatrixGroup::Field, x), V::Element(_, y)) => {
            V::Element(MatrixGroup::Field, x.zip(y, |x, y| x + y))
        }
        (Mul, V::Element(..), V::Element(..)) => super::groups::composed(a, b)?,
        (Mul, a, V::Real(y)) => V::Dense(a.dense()?.map(|x| x * *y)),
        (Div, a, V::Real(y)) => V::Dense(a.dense()?.map(|x| x / *y)),
        (Mul, a, b) => {
            let (x, y) = (a.dense()?, b.dense()?);
            (x.cols == y.rows).then(|| V::of(x.times(&y)))?
        }
        (Add, a, b) => sum(a, b, |x, y| x + y)?,
        (Sub, a, b) => sum(a, b, |x, y| x - y)?,
        _ => return None,
    })
}

fn sum<T: Real>(a: &Value<T>, b: &Value<T>, f: impl Fn(T, T) -> T) -> Option<Value<T>> {
    // `Zeros` takes the shape of the other operand.
    let like = |z: &Value<T>, of: &Value<T>| match z {
        Value::Zeros => Some(of.dense()?.map(|_| T::zero())),
        own => own.dense(),
    };
    let (x, y) = (like(a, b)?, like(b, a)?);
    x.fits(&y).then(|| Value::of(x.zip(&y, f)))
}

fn double<T: Real>(operator: Operator, x: f64, y: f64) -> Value<T> {
    match operator {
        Operator::Add => Value::Double(x + y),
        Operator::Sub => Value::Double(x - y),
        Operator::Mul => Value::Double(x * y),
        Operator::Div => Value::Double(x / y),
        Operator::Rem => Value::Double(x % y),
        Operator::Less => Value::Bool(x < y),
        Operator::AtMost => Value::Bool(x <= y),
        Operator::More => Value::Bool(x > y),
        Operator::AtLeast => Value::Bool(x >= y),
        Operator::Equal => Value::Bool(x == y),
        Operator::Differs => Value::Bool(x != y),
    }
}

fn whole<T: Real>(operator: Operator, x: i64, y: i64) -> Option<Value<T>> {
    Some(match operator {
        Operator::Add => Value::Int(x.checked_add(y)?),
        Operator::Sub => Value::Int(x.checked_sub(y)?),
        Operator::Mul => Value::Int(x.checked_mul(y)?),
        Operator::Div => Value::Int(x.checked_div(y)?),
        Operator::Rem => Value::Int(x.checked_rem(y)?),
        Operator::Less => Value::Bool(x < y),
        Operator::AtMost => Value::Bool(x <= y),
        Operator::More => Value::Bool(x > y),
        Operator::AtLeast => Value::Bool(x >= y),
        Operator::Equal => Value::Bool(x == y),
        Operator::Differs => Value::Bool(x != y),
    })
}

/// The negative.
#[inline]
pub fn negative<T: Real>(a: &Value<T>) -> Option<Value<T>> {
    Some(match a {
        Value::Real(x) => Value::Real(-*x),
        Value::Double(x) => Value::Double(-x),
        Value::Int(n) => Value::Int(n.checked_neg()?),
        Value::Vector(v) => Value::Vector(-v),
        Value::Matrix(m) => Value::Matrix(-m),
        other => Value::of(other.dense()?.map(|x| -x)),
    })
}

/// An entry of a list, a vector or a matrix.
pub fn entry<T: Real>(a: &Value<T>, at: [usize; 2], indices: usize) -> Option<Value<T>> {
    if let Value::List(list) = a {
        return list.get(at[0]).cloned();
    }
    if let Value::Sites(column) = a {
        return column.get(at[0]);
    }
    let a = a.dense()?;
    let (i, j) = match indices {
        1 => (at[0] % a.rows, at[0] / a.rows),
        _ => (at[0], at[1]),
    };
    (i < a.rows && j < a.cols).then(|| Value::Real(a.at(i, j)))
}

/// All numbers of a value, matrices column after column.
pub fn numbers<T: Real>(a: &Value<T>) -> Option<Vec<T>> {
    Some(match a {
        Value::Real(x) => vec![*x],
        Value::List(list) => {
            let mut all = Vec::new();
            for value in list {
                all.extend(numbers(value)?);
            }
            all
        }
        Value::Unit => Vec::new(),
        other => other.dense()?.data,
    })
}

fn three<T: Real>(a: &Value<T>) -> Option<&SVector<T, 3>> {
    match a {
        Value::Vector(v) => Some(v),
        _ => None,
    }
}

fn square<T: Real>(a: &Value<T>) -> Option<&Matrix3<T>> {
    match a {
        Value::Matrix(m) => Some(m),
        _ => None,
    }
}

fn four<T: Real>(a: &Value<T>) -> Option<Matrix4<T>> {
    match a {
        Value::Dense(d) if (d.rows, d.cols) == (4, 4) => Some(d.fixed()),
        _ => None,
    }
}

fn number<T: Real>(a: &Value<T>) -> Option<T> {
    match a {
        Value::Real(x) => Some(*x),
        _ => None,
    }
}

macro_rules! of_number {
    ($($name:ident),*) => {
        fn function<T: Real>(name: &str) -> Option<Native<T>> {
            match name {
                $(stringify!($name) => Some(|a, _| Some(Value::Real(number(a.first()?)?.$name()))),)*
                _ => None,
            }
        }
    };
}
of_number!(sqrt, exp, ln, sin, cos, sinh, cosh, tanh, sign, abs);

/// A function of square matrices that gives one.
macro_rules! square_to_square {
    ($f:expr) => {
        |a, _| {
            let a = a.first()?.dense()?;
            let f: fn(&Dense<T>) -> Dense<T> = $f;
            (a.rows == a.cols).then(|| Value::of(f(&a)))
        }
    };
}

pub(super) fn length<T: Real>(x: &Value<T>) -> Option<T> {
    let all = numbers(x)?;
    Some(all.iter().fold(T::zero(), |s, x| s + *x * *x).sqrt())
}

pub(super) fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    Some(match (name, arguments) {
        ("dot", 2) => |a, _| match (a.first()?, a.get(1)?) {
            (Value::Vector(x), Value::Vector(y)) => Some(Value::Real(x.dot(y))),
            (x, y) => Some(Value::Real(x.dense()?.dot(&y.dense()?))),
        },
        // Upper bounds of products, for any angle.
        ("dot_sizes", 2) => |a, _| Some(Value::Real(length(a.first()?)? * length(a.get(1)?)?)),
        ("cross_sizes", 2) => |a, _| {
            let size = length(a.first()?)? * length(a.get(1)?)?;
            Some(Value::Vector(SVector::repeat(size)))
        },
        ("cross", 2) => |a, _| Some(Value::Vector(three(a.first()?)?.cross(three(a.get(1)?)?))),
        ("tr_mul", 2) => |a, _| match (a.first()?, a.get(1)?) {
            (Value::Matrix(x), Value::Vector(y)) => Some(Value::Vector(x.tr_mul(y))),
            (Value::Matrix(x), Value::Matrix(y)) => Some(Value::Matrix(x.tr_mul(y))),
            (x, y) => {
                let (x, y) = (x.dense()?, y.dense()?);
                (x.rows == y.rows).then(|| Value::of(x.tr_mul(&y)))
            }
        },
        ("transpose", 1) => |a, _| match a.first()? {
            Value::Matrix(x) => Some(Value::Matrix(x.transpose())),
            x => Some(Value::of(x.dense()?.transpose())),
        },
        ("trace", 1) => |a, _| match a.first()? {
            Value::Matrix(x) => Some(Value::Real(x.trace())),
            x => Some(Value::Real(x.dense()?.trace())),
        },
        ("diagonal", 1) => |a, _| {
            let a = a.first()?.dense()?;
            let entry = |i, j| if i == j { a.at(i, 0) } else { T::zero() };
            Some(Value::of(Dense::from_fn(a.rows, a.rows, entry)))
        },
        ("diagonal_of", 1) => |a, _| {
            let a = a.first()?.dense()?;
            Some(Value::of(Dense::from_fn(a.rows, 1, |i, _| a.at(i, i))))
        },
        ("powi", 2) => |a, _| match a.get(1)? {
            Value::Int(n) => Some(Value::Real(
                number(a.first()?)?.powi(i32::try_from(*n).ok()?),
            )),
            _ => None,
        },
        ("powr", 3) => |a, _| match (a.get(1)?, a.get(2)?) {
            (Value::Int(p), Value::Int(q)) => Some(Value::Real(number(a.first()?)?.powr(*p, *q))),
            _ => None,
        },
        ("hat", 1) => |a, _| Some(Value::Matrix(linalg::hat(three(a.first()?)?))),
        ("vee", 1) => |a, _| Some(Value::Vector(linalg::vee(square(a.first()?)?))),
        ("axial_of_difference", 1) => |a, _| {
            Some(Value::Vector(linalg::axial_of_difference(square(
                a.first()?,
            )?)))
        },
        ("crossed", 2) => |a, _| {
            Some(Value::Matrix(linalg::crossed(
                three(a.first()?)?,
                square(a.get(1)?)?,
            )))
        },
        ("crossing", 2) => |a, _| {
            Some(Value::Matrix(linalg::crossing(
                square(a.first()?)?,
                three(a.get(1)?)?,
            )))
        },
        ("trace_complement", 1) => {
            |a, _| Some(Value::Matrix(linalg::trace_complement(square(a.first()?)?)))
        }
        ("symmetric_part", 1) => {
            square_to_square!(|a| a.plus(&a.transpose()).scaled(T::from_f64(0.5)))
        }
        ("skew_part", 1) => square_to_square!(|a| a.minus(&a.transpose()).scaled(T::from_f64(0.5))),
        ("diagonal_part", 1) => square_to_square!(|a| {
            Dense::from_fn(a.rows, a.cols, |i, j| match i == j {
                true => a.at(i, i),
                false => T::zero(),
            })
        }),
        ("adjugate", 1) => square_to_square!(Dense::adjugate),
        ("inverse_or_nan", 1) => square_to_square!(|a| a
            .small_inverse()
            .unwrap_or_else(|| Dense::unknown(a.rows, a.cols))),
        ("less_identity", 1) => square_to_square!(Dense::less_identity),
        ("determinant", 1) => |a, _| {
            let a = a.first()?.dense()?;
            (a.rows == a.cols).then(|| Value::Real(a.determinant()))
        },
        ("solve_or_nan", 2) => |a, _| {
            let (m, b) = (a.first()?.dense()?, a.get(1)?.dense()?);
            let x = (m.rows == m.cols && m.rows == b.rows).then(|| m.solved(&b))?;
            Some(Value::of(x.unwrap_or_else(|| Dense::unknown(b.rows, 1))))
        },
        ("solve_leading_or_nan", 3) => leading,
        ("motion_rotation", 1) => |a, _| match a.first()? {
            Value::Matrix(m) => Some(Value::of(Dense::of(&linalg::motion_rotation(m)))),
            m => Some(Value::Matrix(linalg::motion_rotation(&four(m)?))),
        },
        ("motion_translation", 1) => |a, _| match a.first()? {
            Value::Matrix(m) => Some(Value::of(Dense::of(&linalg::motion_translation(m)))),
            m => Some(Value::Vector(linalg::motion_translation(&four(m)?))),
        },
        ("twist", 1) => |a, _| match a.first()? {
            Value::Vector(v) => Some(Value::Matrix(linalg::twist(v))),
            Value::Dense(d) if d.rows == 6 => {
                Some(Value::of(Dense::of(&linalg::twist(&d.fixed::<6, 1>()))))
            }
            _ => None,
        },
        ("quaternion_real", 1) => {
            |a, _| Some(Value::Real(linalg::quaternion_real(&four(a.first()?)?)))
        }
        ("quaternion_imaginary", 1) => |a, _| {
            Some(Value::Vector(linalg::quaternion_imaginary(&four(
                a.first()?,
            )?)))
        },
        ("quaternion_rotation", 1) => |a, _| {
            Some(Value::Matrix(linalg::quaternion_rotation(&four(
                a.first()?,
            )?)))
        },
        ("pure_quaternion", 1) => |a, _| {
            Some(Value::of(Dense::of(&linalg::pure_quaternion(three(
                a.first()?,
            )?))))
        },
        ("length", 1) => |a, _| Some(Value::Real(length(a.first()?)?)),
        ("sum_of_sizes", 1) => |a, _| match a.first()? {
            Value::List(both) => {
                let (kinetic, potential) = (number(both.first()?)?, number(both.get(1)?)?);
                Some(Value::Real(e::sum_of_sizes((kinetic, potential))))
            }
            _ => None,
        },
        ("size_of_energy", 2) => |a, _| match (a.first()?, a.get(1)?) {
            (Value::List(plain), Value::List(enlarged)) => {
                let both = |list: &[Value<T>]| -> Option<(T, T)> {
                    Some((number(list.first()?)?, number(list.get(1)?)?))
                };
                Some(Value::Real(e::size_of_energy(
                    both(plain)?,
                    both(enlarged)?,
                )))
            }
            _ => None,
        },
        ("size_of", 1) => |a, _| {
            let all = numbers(a.first()?)?;
            Some(Value::Double(
                all.iter().fold(0.0, |s, x| s + x.magnitude()),
            ))
        },
        ("same", 2) => |a, _| Some(Value::Bool(numbers(a.first()?)? == numbers(a.get(1)?)?)),
        ("all_finite", 1) => |a, _| match a.first()? {
            Value::Vector(v) => Some(Value::Bool(e::all_finite(v))),
            x => Some(Value::Bool(numbers(x)?.iter().all(|x| x.is_finite()))),
        },
        ("magnitude", 1) => |a, _| Some(Value::Double(number(a.first()?)?.magnitude())),
        ("value", 1) => |a, _| Some(Value::Double(number(a.first()?)?.value())),
        ("from_ratio", 2) => |a, _| match (a.first()?, a.get(1)?) {
            (Value::Int(p), Value::Int(q)) => Some(Value::Real(T::from_ratio(*p, *q))),
            _ => None,
        },
        ("from_f64", 1) => |a, _| match a.first()? {
            Value::Double(x) => Some(Value::Real(T::from_f64(*x))),
            Value::Real(x) => Some(Value::Real(*x)),
            _ => None,
        },
        ("diagonal_times", 2) => |a, _| {
            let (d, m) = (a.first()?.dense()?, a.get(1)?.dense()?);
            let entry = |i, j| d.at(i, i) * m.at(i, j);
            Some(Value::of(Dense::from_fn(m.rows, m.cols, entry)))
        },
        ("times_diagonal", 2) => |a, _| {
            let (m, d) = (a.first()?.dense()?, a.get(1)?.dense()?);
            let entry = |i, j| m.at(i, j) * d.at(j, j);
            Some(Value::of(Dense::from_fn(m.rows, m.cols, entry)))
        },
        ("joined", 1) => |a, _| {
            let data = numbers(a.first()?)?;
            let (rows, cols) = (data.len(), 1);
            Some(Value::of(Dense { rows, cols, data }))
        },
        ("assembled", 1) => |a, _| {
            let Value::List(rows) = a.first()? else {
                return None;
            };
            let mut blocks = Vec::with_capacity(rows.len());
            for row in rows {
                let Value::List(row) = row else { return None };
                blocks.push(row.iter().map(square).collect::<Option<Vec<_>>>()?);
            }
            let size = 3 * rows.len();
            let entry = |i: usize, j: usize| {
                let block = blocks.get(i / 3).and_then(|row| row.get(j / 3));
                block.map_or_else(T::zero, |block| block[(i % 3, j % 3)])
            };
            Some(Value::of(Dense::from_fn(size, size, entry)))
        },
        ("repeat", 1) => |a, sizes| {
            let (x, [rows, cols]) = (number(a.first()?)?, sizes) else {
                return None;
            };
            Some(Value::of(Dense::from_fn(*rows, *cols, |_, _| x)))
        },
        ("from_diagonal_element", 1) => |a, sizes| {
            let (x, [rows, cols]) = (number(a.first()?)?, sizes) else {
                return None;
            };
            let entry = |i, j| if i == j { x } else { T::zero() };
            Some(Value::of(Dense::from_fn(*rows, *cols, entry)))
        },
        ("greatest", 1) => |a, _| Some(Value::Double(number(a.first()?)?.greatest())),
        ("least", 1) => |a, _| Some(Value::Double(number(a.first()?)?.least())),
        // Sizes: of the longer, of the shorter.
        ("rows_from", 2) => |a, sizes| {
            let (m, at) = (a.first()?.dense()?, a.get(1)?.count()?);
            let rows = *sizes.get(1)?;
            Some(Value::of(Dense::from_fn(rows, m.cols, |i, j| {
                m.at(at + i, j)
            })))
        },
        ("columns_from", 2) => |a, sizes| {
            let (m, at) = (a.first()?.dense()?, a.get(1)?.count()?);
            let cols = *sizes.get(1)?;
            Some(Value::of(Dense::from_fn(m.rows, cols, |i, j| {
                m.at(i, at + j)
            })))
        },
        ("into_rows", 2) => |a, sizes| {
            let (m, at) = (a.first()?.dense()?, a.get(1)?.count()?);
            let entry = |i: usize, j| i.checked_sub(at).map_or(T::zero(), |i| m.at(i, j));
            Some(Value::of(Dense::from_fn(*sizes.first()?, m.cols, entry)))
        },
        ("into_columns", 2) => |a, sizes| {
            let (m, at) = (a.first()?.dense()?, a.get(1)?.count()?);
            let entry = |i, j: usize| j.checked_sub(at).map_or(T::zero(), |j| m.at(i, j));
            Some(Value::of(Dense::from_fn(m.rows, *sizes.first()?, entry)))
        },
        ("inclusion", 1) => |a, sizes| {
            let (at, one) = (a.first()?.count()?, T::one());
            let entry = |i, j| if i == at + j { one } else { T::zero() };
            Some(Value::of(Dense::from_fn(
                *sizes.first()?,
                *sizes.get(1)?,
                entry,
            )))
        },
        ("unit", 1) => |a, sizes| {
            let (at, one) = (a.first()?.count()?, T::one());
            let entry = |i, _| if i == at { one } else { T::zero() };
            Some(Value::of(Dense::from_fn(*sizes.first()?, 1, entry)))
        },
        ("basis", 1) => |a, _| Some(Value::Matrix(e::basis(a.first()?.count()?))),
        ("skew_basis", 1) => |a, sizes| {
            let index = a.first()?.count()?;
            let n = *sizes.first()?;
            let mut basis = Dense::zeros(n, n);
            if let Some((i, j)) = e::skew_place(n, index) {
                basis.set(i, j, -T::one());
                basis.set(j, i, T::one());
            }
            Some(Value::of(basis))
        },
        ("matrix_basis", 1) => |a, sizes| {
            let (at, n, one) = (a.first()?.count()?, *sizes.first()?, T::one());
            let entry = |i, j| if n * i + j == at { one } else { T::zero() };
            Some(Value::of(Dense::from_fn(n, n, entry)))
        },
        ("array_basis", 1) => |a, sizes| {
            let (at, one) = (a.first()?.count()?, T::one());
            let (rows, cols) = (*sizes.first()?, *sizes.get(1)?);
            let entry = |i, j| if cols * i + j == at { one } else { T::zero() };
            Some(Value::of(Dense::from_fn(rows, cols, entry)))
        },
        ("zeros", 0) => |_, sizes| match sizes {
            [rows, cols] => Some(Value::of(Dense::zeros(*rows, *cols))),
            [rows] => Some(Value::of(Dense::zeros(*rows, 1))),
            _ => Some(Value::Zeros),
        },
        ("identity", 0) => |_, sizes| match sizes {
            [rows, cols] => Some(Value::of(Dense::identity(*rows, *cols))),
            _ => None,
        },
        ("single", 1) => |a, _| {
            Some(Value::of(Dense::from_fn(1, 1, {
                let x = number(a.first()?)?;
                move |_, _| x
            })))
        },
        ("rows", 1) => |a, _| {
            let t = a.first()?.dense()?.transpose();
            Some(Value::List(t.data.into_iter().map(Value::Real).collect()))
        },
        ("as_slice", 1) => |a, _| Some((*a.first()?).clone()),
        ("is_finite", 1) => |a, _| match a.first()? {
            Value::Real(x) => Some(Value::Bool(x.is_finite())),
            Value::Failed(f) => match &**f {
                crate::failure::Failure::Contact(c) => Some(Value::Bool(c.is_finite())),
                _ => None,
            },
            _ => None,
        },
        ("is_ok", 1) => |a, _| Some(Value::Bool(!matches!(a.first()?, Value::Failed(_)))),
        ("pencil_coefficients", 2) => |a, _| {
            let (m, s) = (a.first()?.dense()?, a.get(1)?.dense()?);
            m.fits(&s).then(|| Value::of(m.pencil_coefficients(&s)))
        },
        ("skew_coordinates", 1) => |a, _| {
            let m = a.first()?.dense()?;
            let all = m.skew_coordinates().into_iter();
            Some(Value::List(all.map(Value::Real).collect()))
        },
        ("spectrum", 1) => |a, _| {
            let all = a.first()?.dense()?;
            let all = all.spectrum().into_iter();
            Some(Value::List(all.map(Value::Real).collect()))
        },
        ("spectrum_scales", 2) => |a, sizes| {
            let (m, s) = (number(a.first()?)?.value(), number(a.get(1)?)?.value());
            let all = e::spectrum_scales_of(*sizes.first()?, m, s);
            Some(Value::List(
                all.map(|x| Value::Real(T::from_f64(x))).collect(),
            ))
        },
        ("even_count", 1) => |a, _| Some(Value::Int(e::even_count(a.first()?.count()?) as i64)),
        (name, 1) => return function(name),
        _ => return None,
    })
}

/// The solution of the leading equations; the others are zero.
fn leading<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    let [m, b, size] = a else { return None };
    let (m, b, size) = (m.dense()?, b.dense()?, size.count()?);
    let x = m.leading_solved(&b, size);
    Some(Value::of(x.unwrap_or_else(|| Dense::unknown(b.rows, 1))))
}
