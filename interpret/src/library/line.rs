//! Functions that the steppers of models with labels call, except loops over sites.

use crate::code::{Code, Exit, Native, Places, Special, unfit};
use crate::failure::Failure;
use crate::sites::Column;
use crate::value::Value;
use clebsch::linalg::Dense;
use clebsch::line::{self, Attitude, LineError, Place, Stamp, Unknown};
use clebsch::{Real, StepCause};
use nalgebra::Matrix4;
use std::cell::RefCell;

type Done<T> = Result<Value<T>, Exit<T>>;

/// The number of values in a list.
fn length<T: Real>(list: &Value<T>) -> Option<usize> {
    match list {
        Value::Sites(column) => Some(column.len()),
        Value::List(list) => Some(list.len()),
        _ => None,
    }
}

fn line_result<T: Real>(r: Result<(), LineError>) -> Option<Value<T>> {
    Some(Value::result(r.map(|()| Value::Unit)))
}

/// A function of two counts.
macro_rules! counts {
    ($f:expr) => {
        |a, _| {
            let f: fn(usize, usize) -> usize = $f;
            let n = f(a.first()?.count()?, a.get(1)?.count()?);
            Some(Value::Int(i64::try_from(n).ok()?))
        }
    };
}

pub(super) fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    Some(match (name, arguments) {
        ("line::field", 1) => |a, _| unknown(line::field(a.first()?.count()?), false),
        ("line::rotation", 0) => |_, _| unknown(line::rotation(), true),
        ("line::count_of", 3) => |a, _| match a {
            [Value::Text(name), found, least] => {
                line_result(line::count_of(name, found.count()?, least.count()?))
            }
            _ => None,
        },
        ("line::length_of", 4) => |a, _| match a {
            [Value::Text(name), list, expected, Value::Text(sites)] => {
                let list = vec![(); length(list)?];
                line_result(line::length_of(name, &list, expected.count()?, sites))
            }
            _ => None,
        },
        ("line::repeated", 3) => |a, _| match a {
            [Value::Sites(list), beyond, Value::Bool(ring)] => {
                let mut out = list.clone();
                for i in 0..beyond.count()? {
                    let next = match ring {
                        true => i,
                        false => out.len().checked_sub(1)?,
                    };
                    let next = out.get(next)?;
                    out.push(&next)?;
                }
                Some(Value::Sites(out))
            }
            _ => None,
        },
        ("Stamp::fresh", 0) => |_, _| Some(Value::Stamp(Stamp::fresh())),
        ("Stamp::none", 0) => |_, _| Some(Value::Stamp(Stamp::none())),
        ("after", 3) => |a, _| match a {
            [Value::Stamp(state), Value::Stamp(model), Value::Double(h)] => {
                Some(Value::Stamp(state.after(*model, *h)))
            }
            _ => None,
        },
        ("Attitude::new", 1) => |a, _| match a.first()? {
            Value::Rotation(r) => Some(Value::Attitude(Box::new(Attitude::new(*r)))),
            _ => None,
        },
        ("line::between", 2) => |a, _| match (a.first()?, a.get(1)?) {
            (Value::Quaternion(p), Value::Quaternion(q)) => {
                Some(Value::Quaternion(line::between(p, q)))
            }
            _ => None,
        },
        ("Attitude::of_quaternion", 1) => |a, _| match a.first()? {
            Value::Quaternion(q) => Some(Value::Attitude(Box::new(Attitude::of_quaternion(*q)))),
            _ => None,
        },
        ("Attitude::turned", 1) => |a, _| match a.first()? {
            Value::Turned(r) => Some(Value::Attitude(Box::new(Attitude::turned(r)))),
            _ => None,
        },
        ("LineError::Parameter", 1) => |a, _| match a.first()? {
            Value::Failed(e) => Some(Value::failed((**e).clone().line())),
            _ => None,
        },
        ("StepCause::Contact", 1) => |a, _| match a.first()? {
            Value::Failed(e) => match &**e {
                Failure::Contact(contact) => Some(Value::failed(StepCause::Contact(*contact))),
                _ => None,
            },
            _ => None,
        },
        ("Vec::new", 0) => |_, _| Some(Value::Sites(Column::Values(Vec::new()))),
        ("filled" | "Columns::filled", 2) => |a, _| {
            let (value, count) = (a.first()?, a.get(1)?.count()?);
            let mut column = Column::like(value);
            column.resize(count, value)?;
            Some(Value::Sites(column))
        },
        ("iter" | "collect" | "clone", 1) => |a, _| Some((*a.first()?).clone()),
        ("zip", 2) => |a, _| match a {
            [Value::Sites(x), Value::Sites(y)] => {
                let both = x.values().zip(y.values());
                let both = both.map(|(x, y)| Value::List(vec![x, y]));
                Some(Value::Sites(Column::Values(both.collect())))
            }
            _ => None,
        },
        ("len", 1) => |a, _| Some(Value::Int(i64::try_from(length(a.first()?)?).ok()?)),
        ("max", 2) => counts!(usize::max),
        ("min", 2) => counts!(usize::min),
        ("saturating_sub", 2) => counts!(usize::saturating_sub),
        ("usize::from", 1) => |a, _| match a.first()? {
            Value::Bool(b) => Some(Value::Int(i64::from(*b))),
            _ => None,
        },
        ("is_some", 1) => |a, _| {
            let none = matches!(a.first()?, Value::None | Value::Failed(_));
            Some(Value::Bool(!none))
        },
        ("then_some", 2) => |a, _| match a {
            [Value::Bool(true), value] => Some((*value).clone()),
            [Value::Bool(false), _] => Some(Value::None),
            _ => None,
        },
        ("fixed_rows", 2) => |a, sizes| {
            let (m, at, rows) = (a.first()?.dense()?, a.get(1)?.count()?, *sizes.first()?);
            (at + rows <= m.rows)
                .then(|| Value::of(Dense::from_fn(rows, m.cols, |i, j| m.at(at + i, j))))
        },
        ("Place", 2) => |a, _| match a {
            [Value::Text(quantity), site] => Some(Value::At(Place {
                quantity,
                site: site.count()?,
            })),
            _ => None,
        },
        ("LineError::Site", 2) => |a, _| match a {
            [Value::At(at), Value::Failed(e)] => match &**e {
                Failure::Parameter(error) => Some(Value::failed(LineError::Site {
                    at: *at,
                    error: *error,
                })),
                _ => None,
            },
            _ => None,
        },
        ("LineError::Functional", 4) => |a, _| match a {
            [
                Value::Int(node),
                Value::Text(quantity),
                Value::Failed(cause),
                works,
            ] => {
                let Failure::Mesh(cause) = **cause else {
                    return None;
                };
                Some(Value::failed(LineError::Functional {
                    node: u64::try_from(*node).ok()?,
                    quantity,
                    cause,
                    works: shorter_step(works)?,
                }))
            }
            _ => None,
        },
        ("LineError::Step", 4) => |a, _| match a {
            [Value::Int(node), Value::At(at), Value::Failed(cause), works] => {
                let works = shorter_step(works)?;
                Some(Value::failed(LineError::Step {
                    node: u64::try_from(*node).ok()?,
                    at: *at,
                    cause: (**cause).clone().cause(),
                    works,
                }))
            }
            _ => None,
        },
        _ => return None,
    })
}

/// A smaller step size that succeeds, if there is one.
#[allow(clippy::option_option)] // `None` marks a value of another kind.
fn shorter_step<T: Real>(works: &Value<T>) -> Option<Option<f64>> {
    match works {
        Value::Double(h) => Some(Some(*h)),
        Value::None => Some(None),
        _ => None,
    }
}

fn missing<T: Real>() -> Exit<T> {
    Exit::Unfit("a function called with other arguments")
}

/// `line::each("q", &list, |value| ...)`
fn each<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [quantity, list, closure] = a else {
        return Err(missing());
    };
    let (Value::Text(quantity), Value::Sites(list)) = (quantity.run(places)?, list.run(places)?)
    else {
        return Err(missing());
    };
    let mut made = Vec::new();
    for (site, value) in list.values().enumerate() {
        match closure.call(vec![value], places)? {
            Value::Failed(e) => {
                let Failure::Parameter(error) = *e else {
                    return Err(missing());
                };
                let at = Place { quantity, site };
                return Ok(Value::failed(LineError::Site { at, error }));
            }
            Value::Unit => {}
            value => made.push(value),
        }
    }
    Ok(Value::Sites(unfit(Column::of(made))?))
}

/// `line::agree(&mut list)`
fn agree<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [list] = a else {
        return Err(missing());
    };
    match list.place_mut(places) {
        Some(Value::Sites(Column::Attitudes(all))) => changed(all, line::agree),
        _ => return Err(missing()),
    }
    Ok(Value::Unit)
}

/// Operations of the runtime that change attitudes.
fn changed<T: Real>(
    list: &mut Vec<line::Attitude<T>>,
    change: impl FnOnce(&mut line::Attitudes<T>),
) {
    let mut all: line::Attitudes<T> = list.iter().copied().collect();
    change(&mut all);
    *list = all.iter().collect();
}

/// `line::turn_towards(&mut list, site, &wall)`
fn turn_towards<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [list, site, wall] = a else {
        return Err(missing());
    };
    let (site, wall) = (unfit(site.run(places)?.count())?, wall.run(places)?);
    let wall = unfit(wall.dense())?;
    let wall = Matrix4::from_fn(|i, j| wall.at(i, j));
    match list.place_mut(places) {
        Some(Value::Sites(Column::Attitudes(all))) => {
            changed(all, |all| line::turn_towards(all, site, &wall));
        }
        _ => return Err(missing()),
    }
    Ok(Value::Unit)
}

/// `line::closes("q", &list)`
fn closes<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [quantity, list] = a else {
        return Err(missing());
    };
    let Value::Text(quantity) = quantity.run(places)? else {
        return Err(missing());
    };
    match list.place(places) {
        Some(Value::Sites(Column::Attitudes(all))) => Ok(Value::result(
            line::closes(quantity, &all.iter().copied().collect()).map(|()| Value::Unit),
        )),
        _ => Err(missing()),
    }
}

/// `line::shorter(h, |h| ...)`
fn shorter<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [h, closure] = a else {
        return Err(missing());
    };
    let Value::Real(h) = h.run(places)? else {
        return Err(missing());
    };
    let places = RefCell::new(places);
    let made = |h: T| {
        let answer = closure.call(vec![Value::Real(h)], &mut places.borrow_mut());
        matches!(answer, Ok(Value::Bool(true)))
    };
    Ok(match line::shorter(h, made) {
        Some(h) => Value::Double(h),
        None => Value::None,
    })
}

/// A part of a site's velocity, as its number of components and whether it is a rotation.
fn unknown<T: Real>(unknown: Unknown, turns: bool) -> Option<Value<T>> {
    let count = i64::try_from(unknown.components()).ok()?;
    Some(Value::List(vec![Value::Int(count), Value::Bool(turns)]))
}

/// The parts of a site's velocity.
pub(super) fn unknowns<T: Real>(list: &Value<T>) -> Option<Vec<Unknown>> {
    let Value::List(all) = list else {
        return None;
    };
    let each = all.iter().map(|value| match value {
        Value::List(both) => match both.as_slice() {
            [_, Value::Bool(true)] => Some(line::rotation()),
            [count, Value::Bool(false)] => Some(line::field(count.count()?)),
            _ => None,
        },
        _ => None,
    });
    each.collect()
}

/// `line::root(&known, [line::field(1), ...], |velocity| ..., |velocity| (..., ...))`, of which the first gives part of the second.
fn root<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [known, parts, _, closure] = a else {
        return Err(missing());
    };
    let known = unfit(known.run(places)?.dense())?;
    let parts = unfit(unknowns(&parts.run(places)?))?;
    let mut stopped = None;
    let found = line::root_of(&known.data, &parts, |velocity, momenta, derivative| {
        let velocity = Value::of(Dense::column_of(velocity.to_vec()));
        let both = closure.call(vec![velocity], places);
        let told = match &both {
            Ok(Value::List(both)) => match both.as_slice() {
                [p, a] => p.dense().zip(a.dense()),
                _ => None,
            },
            _ => None,
        };
        let n = momenta.len();
        let fits = |(p, a): &(Dense<T>, Dense<T>)| (p.data.len(), a.data.len()) == (n, n * n);
        match told.filter(fits) {
            Some((p, a)) => {
                momenta.copy_from_slice(&p.data);
                if let Some(derivative) = derivative {
                    derivative.copy_from_slice(&a.data);
                }
            }
            None => {
                // Fill the momenta with NaN, so that the search ends.
                momenta.fill(T::from_f64(f64::NAN));
                stopped.get_or_insert(both.err().unwrap_or_else(missing));
            }
        }
    });
    match stopped {
        Some(exit) => Err(exit),
        None => Ok(Value::result(found.map(|v| Value::of(Dense::column_of(v))))),
    }
}

/// The two ends of a range. A missing end is the start or the end of the list.
fn range<T: Real>(
    places: &mut Places<T>,
    from: &Code<T>,
    to: &Code<T>,
    list: &Code<T>,
) -> Result<[usize; 2], Exit<T>> {
    let from = match from.run(places)? {
        Value::None => 0,
        from => unfit(from.count())?,
    };
    let to = match to.run(places)? {
        Value::None => match list.place(places) {
            Some(list) => unfit(length(list))?,
            None => return Err(missing()),
        },
        to => unfit(to.count())?,
    };
    match from <= to {
        true => Ok([from, to]),
        false => Err(missing()),
    }
}

/// `list[from..to]`
fn slice<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [list, from, to] = a else {
        return Err(missing());
    };
    let [from, to] = range(places, from, to, list)?;
    match unfit(list.place(places))? {
        Value::Sites(column) => Ok(Value::Sites(unfit(column.part(from..to))?)),
        _ => Err(missing()),
    }
}

/// `list[from..to].copy_from_slice(&other[..])`
fn copy_slice<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [list, from, to, other] = a else {
        return Err(missing());
    };
    let [from, to] = range(places, from, to, list)?;
    let Value::Sites(other) = other.run(places)? else {
        return Err(missing());
    };
    match list.place_mut(places) {
        Some(Value::Sites(column)) if other.len() == to - from => {
            unfit(column.put(from, &other))?;
            Ok(Value::Unit)
        }
        _ => Err(missing()),
    }
}

/// `list[from..to].fill(value)`
fn fill_slice<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [list, from, to, value] = a else {
        return Err(missing());
    };
    let [from, to] = range(places, from, to, list)?;
    let value = value.run(places)?;
    let Some(Value::Sites(column)) = list.place_mut(places) else {
        return Err(missing());
    };
    for site in from..to {
        unfit(column.set(site, &value))?;
    }
    Ok(Value::Unit)
}

/// `list.resize(count, value)`
fn resize<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [list, count, value] = a else {
        return Err(missing());
    };
    let (count, value) = (unfit(count.run(places)?.count())?, value.run(places)?);
    match list.place_mut(places) {
        Some(Value::Sites(column)) => unfit(column.resize(count, &value))?,
        _ => return Err(missing()),
    }
    Ok(Value::Unit)
}

/// `list.push(value)`
fn push<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [list, value] = a else {
        return Err(missing());
    };
    let value = value.run(places)?;
    match list.place_mut(places) {
        Some(Value::Sites(column)) => unfit(column.push(&value))?,
        _ => return Err(missing()),
    }
    Ok(Value::Unit)
}

/// `mem::swap(&mut a, &mut b)`
fn swap<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [a, b] = a else {
        return Err(missing());
    };
    let one = std::mem::replace(unfit(a.place_mut(places))?, Value::Unit);
    let other = std::mem::replace(unfit(b.place_mut(places))?, one);
    *unfit(a.place_mut(places))? = other;
    Ok(Value::Unit)
}

/// `matrix.fixed_view_mut::<R, C>(i, j).copy_from(&block)`
fn put_block<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [matrix, row, column, block] = a else {
        return Err(missing());
    };
    let (row, column) = (row.run(places)?, column.run(places)?);
    let (row, column) = (unfit(row.count())?, unfit(column.count())?);
    let block = unfit(block.run(places)?.dense())?;
    let place = unfit(matrix.place_mut(places))?;
    let mut all = unfit(place.dense())?;
    if row + block.rows > all.rows || column + block.cols > all.cols {
        return Err(missing());
    }
    for i in 0..block.rows {
        for j in 0..block.cols {
            all.set(row + i, column + j, block.at(i, j));
        }
    }
    *place = Value::of(all);
    Ok(Value::Unit)
}

pub(super) fn special<T: Real>(name: &str) -> Option<Special<T>> {
    Some(match name {
        "line::each" => each,
        "line::agree" => agree,
        "line::turn_towards" => turn_towards,
        "line::closes" => closes,
        "line::shorter" => shorter,
        "line::root" => root,
        "slice" => slice,
        "copy_slice" => copy_slice,
        "fill_slice" => fill_slice,
        "resize" => resize,
        "push" => push,
        "mem::swap" => swap,
        "put_block" => put_block,
        _ => return None,
    })
}
