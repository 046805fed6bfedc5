//! Functions that change their arguments or call back.

use super::algebra::numbers;
use crate::code::{Code, Exit, Places, Special, unfit};
use crate::failure::Failure;
use crate::sites::Column;
use crate::value::{Frame, Value};
use clebsch::linalg::Dense;
use clebsch::{Real, SpatialMomentum};
use nalgebra::Vector3;
use std::cell::RefCell;

type Done<T> = Result<Value<T>, Exit<T>>;

/// The values of all arguments.
fn values<T: Real>(places: &mut Places<T>, codes: &[Code<T>]) -> Result<Vec<Value<T>>, Exit<T>> {
    codes.iter().map(|c| c.run(places)).collect()
}

fn missing<T: Real>() -> Exit<T> {
    Exit::Unfit("a function called with other arguments")
}

/// `rest = all.as_mut_slice()`
fn as_mut_slice<T: Real>(_: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let at = unfit(a.first().and_then(Code::number))?;
    Ok(Value::Part(at, 0))
}

/// Writes numbers one after another into an array.
fn put_numbers<T: Real>(places: &mut Places<T>, rest: &Value<T>, list: Vec<T>) -> Done<T> {
    let Value::Part(at, from) = *rest else {
        return Err(missing());
    };
    let place = unfit(places.get_mut(at))?;
    let count = list.len();
    match place {
        Value::Vector(v) => fill(v.as_mut_slice(), from, list),
        Value::Dense(d) => fill(&mut d.data, from, list),
        Value::List(all) => all.extend(list.into_iter().map(Value::Real)),
        _ => return Err(missing()),
    }
    Ok(Value::Part(at, from + count))
}

fn fill<T: Real>(out: &mut [T], from: usize, list: Vec<T>) {
    for (slot, x) in out.iter_mut().skip(from).zip(list) {
        *slot = x;
    }
}

fn put_vector<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [rest, value] = &values(places, a)?[..] else {
        return Err(missing());
    };
    let list = unfit(numbers(value))?;
    put_numbers(places, rest, list)
}

fn put_matrix<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [rest, value] = &values(places, a)?[..] else {
        return Err(missing());
    };
    let list = unfit(value.dense())?.transpose().data;
    put_numbers(places, rest, list)
}

fn put_skew<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [rest, value] = &values(places, a)?[..] else {
        return Err(missing());
    };
    let m = unfit(value.dense())?;
    let list = m.skew_coordinates();
    put_numbers(places, rest, list)
}

/// `put(out, values)`: `out` is a list that grows.
fn put<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [out, value] = a else {
        return Err(missing());
    };
    let value = value.run(places)?;
    let list = unfit(numbers(&value))?;
    let at = match unfit(out.place(places))? {
        Value::Part(at, _) => *at,
        _ => unfit(out.number())?,
    };
    put_numbers(places, &Value::Part(at, 0), list)
}

fn set_column<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [matrix, index, column] = a else {
        return Err(missing());
    };
    let (index, column) = (index.run(places)?, column.run(places)?);
    let (index, column) = (unfit(index.count())?, unfit(column.dense())?);
    let place = unfit(matrix.place_mut(places))?;
    let old = unfit(place.dense())?;
    let entry = |i, j| {
        if j == index {
            column.at(i, 0)
        } else {
            old.at(i, j)
        }
    };
    *place = Value::of(Dense::from_fn(old.rows, old.cols, entry));
    Ok(Value::Unit)
}

/// `solver.follow(&mut attitude, &momentum)`
fn follow<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [solver, attitude, momentum] = a else {
        return Err(missing());
    };
    let Value::Momentum(Frame::Spatial, m) = *unfit(momentum.place(places))? else {
        return Err(missing());
    };
    let Value::Rotation(mut moving) = *unfit(attitude.place(places))? else {
        return Err(missing());
    };
    let Value::Free(free) = unfit(solver.place_mut(places))? else {
        return Err(missing());
    };
    let followed = free.follow(&mut moving, &SpatialMomentum(m));
    *unfit(attitude.place_mut(places))? = Value::Rotation(moving);
    Ok(Value::result(followed.map(|()| Value::Unit)))
}

/// `solver.restart_as(&factor, &attitude, &momentum)`
fn restart_as<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [solver, others @ ..] = a else {
        return Err(missing());
    };
    let [
        Value::Poinsot(body),
        Value::Rotation(attitude),
        Value::Momentum(Frame::Spatial, m),
    ] = &values(places, others)?[..]
    else {
        return Err(missing());
    };
    let Value::Free(free) = unfit(solver.place_mut(places))? else {
        return Err(missing());
    };
    let done = free.restart_as(body, attitude, &SpatialMomentum(*m));
    Ok(Value::result(done.map(|_| Value::Unit)))
}

/// `search.remember(node, &found)`
fn remember<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [search, node, found] = a else {
        return Err(missing());
    };
    let (node, found) = (node.run(places)?, found.run(places)?);
    let search = unfit(search.place_mut(places))?;
    unfit(crate::newton::remember(search, &node, &found))?;
    Ok(Value::Unit)
}

/// A closure that a search calls repeatedly. If a call fails, the search ends.
struct SearchClosure<'a, T: Real> {
    places: RefCell<&'a mut Places<T>>,
    closure: &'a Code<T>,
}

impl<T: Real> SearchClosure<'_, T> {
    fn answer(&self, x: Value<T>) -> Option<Value<T>> {
        let mut places = self.places.borrow_mut();
        self.closure.call(vec![x], &mut places).ok()
    }

    fn number(&self, x: f64) -> Option<f64> {
        match self.answer(Value::Double(x))? {
            Value::Double(x) => Some(x),
            Value::Real(x) => Some(x.value()),
            _ => None,
        }
    }
}

/// `error.with_searched_step(...)`
fn with_searched_step<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let Some((closure, others)) = a.split_last() else {
        return Err(missing());
    };
    let given = values(places, others)?;
    let asked = SearchClosure {
        places: RefCell::new(places),
        closure,
    };
    let nowhere = || Vector3::repeat(T::from_f64(f64::NAN));
    let edge = |trial: T| match asked.answer(Value::Real(trial)) {
        Some(Value::Vector(v)) => v,
        _ => nowhere(),
    };
    let Some(Value::Failed(e)) = given.first() else {
        return Err(missing());
    };
    let told: Failure = match ((**e).clone(), &given[1..]) {
        (Failure::MoserVeselov(e), [Value::Poinsot(body), Value::Real(h)]) => {
            e.with_searched_step(body, *h, edge).into()
        }
        (Failure::Quaternion(e), [Value::QuaternionBody(body), Value::Real(h)]) => {
            e.with_searched_step(body, *h, edge).into()
        }
        (Failure::Quaternion(e), [Value::Double(h)]) => {
            e.with_searched_steps(*h, |x| asked.number(x)).into()
        }
        (Failure::MoserVeselov(e), [Value::Double(h)]) => {
            let _ = h;
            e.into()
        }
        (Failure::Unsolved(e), [Value::Double(h)]) => {
            e.with_searched_step(*h, |x| asked.number(x)).into()
        }
        _ => return Err(missing()),
    };
    Ok(Value::failed(told))
}

/// `contact.with_trials(h, |h| ...)`
fn with_trials<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [contact, h, closure] = a else {
        return Err(missing());
    };
    let (contact, h) = (contact.run(places)?, h.run(places)?);
    let asked = SearchClosure {
        places: RefCell::new(places),
        closure,
    };
    match (contact, h) {
        (Value::Failed(e), Value::Real(h)) => match *e {
            Failure::Contact(contact) => {
                let made =
                    |trial: T| matches!(asked.answer(Value::Real(trial)), Some(Value::Bool(true)));
                Ok(Value::failed(contact.with_trials(h, made)))
            }
            _ => Err(missing()),
        },
        _ => Err(missing()),
    }
}

/// `result.map_err(|e| ...)`
fn map_err<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [value, closure] = a else {
        return Err(missing());
    };
    match value.run(places)? {
        Value::Failed(e) => {
            let told = closure.call(vec![Value::Failed(e)], places)?;
            // The name of a functional, together with its error.
            if let Value::List(both) = &told
                && let [Value::Text(name), Value::Failed(e)] = both.as_slice()
                && let Failure::Mesh(e) = **e
            {
                return Ok(Value::failed(Failure::Functional(name, e)));
            }
            Ok(told)
        }
        value => Ok(value),
    }
}

/// `option.map(|x| ...)`
fn map<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [value, closure] = a else {
        return Err(missing());
    };
    match value.run(places)? {
        Value::None => Ok(Value::None),
        Value::Failed(e) => Ok(Value::Failed(e)),
        Value::Sites(list) => {
            let mut made = Vec::with_capacity(list.len());
            for value in list.values() {
                let given = match (value, closure) {
                    (Value::List(all), Code::Closure(parameters, _))
                        if parameters.len() == all.len() =>
                    {
                        all
                    }
                    (value, _) => vec![value],
                };
                made.push(closure.call(given, places)?);
            }
            Ok(Value::Sites(unfit(Column::of(made))?))
        }
        value => closure.call(vec![value], places),
    }
}

/// `SMatrix::<T, R, C>::from_fn(|i, j| ...)`, the sizes first.
fn from_fn<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [rows, cols, closure] = a else {
        return Err(missing());
    };
    let (rows, cols) = (rows.run(places)?, cols.run(places)?);
    let (rows, cols) = (unfit(rows.count())?, unfit(cols.count())?);
    let mut data = Vec::with_capacity(rows * cols);
    for j in 0..cols {
        for i in 0..rows {
            let at = vec![Value::Int(i as i64), Value::Int(j as i64)];
            match closure.call(at, places)? {
                Value::Real(x) => data.push(x),
                _ => return Err(missing()),
            }
        }
    }
    Ok(Value::of(Dense { rows, cols, data }))
}

/// `columns(|axis| ...)`: a square matrix, whose first column determines its size.
fn columns<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [closure] = a else {
        return Err(missing());
    };
    let mut column = |axis: usize| {
        let column = closure.call(vec![Value::Int(axis as i64)], places)?;
        unfit(column.dense())
    };
    let first = column(0)?;
    let (rows, mut data) = (first.rows, first.data);
    for axis in 1..rows {
        data.extend(column(axis)?.data);
    }
    Ok(Value::of(Dense {
        rows,
        cols: rows,
        data,
    }))
}

/// The special functions that residuals and tangents call.
pub(super) fn kernel<T: Real>(name: &str) -> Option<Special<T>> {
    Some(match name {
        "as_mut_slice" => as_mut_slice,
        "put_vector" | "put_number" => put_vector,
        "put_matrix" => put_matrix,
        "put_skew" => put_skew,
        "put" => put,
        "set_column" => set_column,
        "map" => map,
        "from_fn" => from_fn,
        "columns" => columns,
        _ => return None,
    })
}

pub(super) fn special<T: Real>(name: &str) -> Option<Special<T>> {
    Some(match name {
        "follow" => follow,
        "restart_as" => restart_as,
        "remember" => remember,
        "with_searched_step" | "with_searched_steps" => with_searched_step,
        "with_trials" => with_trials,
        "map_err" => map_err,
        _ => return None,
    })
}
