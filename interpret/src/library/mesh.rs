//! Functions that the steppers of fluids call: domains and settings, functionals of all sites, walls.

use crate::code::{Code, Exit, Native, Places, Special, unfit};
use crate::functional::{Extent, FunctionalSetting, made};
use crate::sites::Column;
use crate::value::Value;
use clebsch::Real;
use clebsch::linalg::Dense;
use clebsch::mesh::{Domain, MeshError};

type Done<T> = Result<Value<T>, Exit<T>>;

fn missing<T: Real>() -> Exit<T> {
    Exit::Unfit("a functional of all sites called with other arguments")
}

fn mesh_result<T: Real>(done: Result<Value<T>, MeshError>) -> Value<T> {
    Value::result(done)
}

/// The numbers of an array.
fn doubles<T: Real>(value: &Value<T>) -> Option<Vec<f64>> {
    let Value::List(list) = value else {
        return None;
    };
    let each = list.iter().map(|x| match x {
        Value::Double(x) => Some(*x),
        _ => None,
    });
    each.collect()
}

/// The components of a place.
fn reals<T: Real>(value: &Value<T>) -> Option<Vec<T>> {
    let Value::List(list) = value else {
        return None;
    };
    let each = list.iter().map(|x| match x {
        Value::Real(x) => Some(*x),
        _ => None,
    });
    each.collect()
}

fn listed<T: Real>(all: &[T]) -> Value<T> {
    Value::List(all.iter().map(|x| Value::Real(*x)).collect())
}

pub(super) fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    Some(match (name, arguments) {
        ("Domain::torus", 1) => |a, _| {
            Some(Value::Extent(match *doubles(a.first()?)?.as_slice() {
                [length] => Extent::Line(Domain::torus([length])),
                [width, height] => Extent::Plane(Domain::torus([width, height])),
                _ => return None,
            }))
        },
        ("Setting", 3) => |a, _| match a {
            [Value::Extent(extent), grid, particles] => {
                let cells = match grid {
                    Value::List(list) => {
                        let each = list.iter().map(Value::count);
                        Some(each.collect::<Option<Vec<usize>>>()?)
                    }
                    _ => None,
                };
                let around = FunctionalSetting::new(*extent, cells.as_deref(), particles.count()?)?;
                Some(Value::FunctionalSetting(Box::new(around)))
            }
            _ => None,
        },
        ("nodes", 1) => |a, _| match a.first()? {
            Value::FunctionalSetting(around) => {
                Some(Value::Int(i64::try_from(around.nodes()).ok()?))
            }
            _ => None,
        },
        ("cell", 1) => |a, _| match a.first()? {
            Value::FunctionalSetting(around) => {
                let lengths = around.cell().into_iter().map(Value::Double);
                Some(Value::List(lengths.collect()))
            }
            _ => None,
        },
        ("Functional::new", 3) => |a, _| match a {
            [Value::Text(name), Value::FunctionalSetting(around), data] => {
                let data = match data {
                    Value::List(list) => list.as_slice(),
                    _ => &[],
                };
                Some(Value::result(
                    made(name, around, data)?.map(Value::Functional),
                ))
            }
            _ => None,
        },
        // Results do not depend on the number of threads.
        ("share", 2) => |_, _| Some(Value::Unit),
        ("is_inside", 2) => |a, _| {
            let place = match a.get(1)? {
                Value::List(list) => list,
                _ => return None,
            };
            let inside = match (a.first()?, place.as_slice()) {
                (Value::Extent(Extent::Line(d)), [Value::Real(x)]) => d.is_inside(&[*x]),
                (Value::Extent(Extent::Plane(d)), [Value::Real(x), Value::Real(y)]) => {
                    d.is_inside(&[*x, *y])
                }
                _ => return None,
            };
            Some(Value::Bool(inside))
        },
        ("into", 1) => |a, _| match a.first()? {
            Value::List(_) => {
                let data = reals(a.first()?)?;
                let (rows, cols) = (data.len(), 1);
                Some(Value::of(Dense { rows, cols, data }))
            }
            other => Some(listed(&other.dense()?.data)),
        },
        ("to_vec" | "into_owned", 1) => |a, _| Some((*a.first()?).clone()),
        ("is_err", 1) => |a, _| Some(Value::Bool(matches!(a.first()?, Value::Failed(_)))),
        _ => return None,
    })
}

/// `functional.value(&at[..], values)`
fn value<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [functional, at, out] = a else {
        return Err(missing());
    };
    let Value::Sites(at) = at.run(places)? else {
        return Err(missing());
    };
    let mut values = match std::mem::replace(unfit(out.place_mut(places))?, Value::Unit) {
        Value::Sites(Column::Numbers(list)) => list,
        _ => return Err(missing()),
    };
    let done = match functional.place_mut(places) {
        Some(Value::Functional(f)) => f.value(&at, &mut values),
        _ => None,
    };
    *unfit(out.place_mut(places))? = Value::Sites(Column::Numbers(values));
    Ok(mesh_result(unfit(done)?.map(|()| Value::Unit)))
}

/// `functional.pull_back(&at[..], seed, back)`
fn pull_back<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [functional, at, seed, out] = a else {
        return Err(missing());
    };
    let (Value::Sites(at), Value::Sites(Column::Numbers(seed))) =
        (at.run(places)?, seed.run(places)?)
    else {
        return Err(missing());
    };
    let done = match functional.place_mut(places) {
        Some(Value::Functional(f)) => f.pull_back(&at, &seed),
        _ => None,
    };
    match unfit(done)? {
        Ok(column) => {
            *unfit(out.place_mut(places))? = Value::Sites(column);
            Ok(Value::Unit)
        }
        Err(e) => Ok(Value::failed(e)),
    }
}

/// `domain.reflect(site, &cell, &mut place, &mut velocity)`
fn reflect<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [domain, site, cell, place, velocity] = a else {
        return Err(missing());
    };
    let (extent, site) = (domain.run(places)?, site.count(places)?);
    let cell = unfit(doubles(&cell.run(places)?))?;
    let mut to = unfit(reals(&place.run(places)?))?;
    let mut turned = unfit(reals(&velocity.run(places)?))?;
    let done = match extent {
        Value::Extent(Extent::Line(d)) => along(&d, site, &cell, &mut to, &mut turned),
        Value::Extent(Extent::Plane(d)) => along(&d, site, &cell, &mut to, &mut turned),
        _ => None,
    };
    match unfit(done)? {
        Ok(crossed) => {
            *unfit(place.place_mut(places))? = listed(&to);
            *unfit(velocity.place_mut(places))? = listed(&turned);
            Ok(Value::Int(crossed as i64))
        }
        Err(e) => Ok(Value::failed(e)),
    }
}

fn along<T: Real, const D: usize>(
    domain: &Domain<D>,
    site: usize,
    cell: &[f64],
    to: &mut [T],
    turned: &mut [T],
) -> Option<Result<usize, MeshError>> {
    let cell = <[f64; D]>::try_from(cell).ok()?;
    let (to, turned) = (to.try_into().ok()?, turned.try_into().ok()?);
    Some(domain.reflect(site, &cell, to, turned))
}

pub(super) fn special<T: Real>(name: &str) -> Option<Special<T>> {
    Some(match name {
        "value" => value,
        "pull_back" => pull_back,
        "reflect" => reflect,
        _ => return None,
    })
}
