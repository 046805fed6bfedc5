//! The search for the impulses of constraints along a chain: the runtime's search, over lists of numbers.

use crate::code::{Code, Exit, Native, Places, Special, unfit};
use crate::failure::Failure;
use crate::sites::Column;
use crate::value::Value;
use clebsch::Real;
use clebsch::line::{self, Multipliers, NoReaction};

type Done<T> = Result<Value<T>, Exit<T>>;

fn search<'a, T: Real>(a: &[&'a Value<T>]) -> Option<&'a Multipliers<T>> {
    match a.first()? {
        Value::Multipliers(own) => Some(own),
        _ => None,
    }
}

fn reaction_result<T: Real>(made: Result<(), (usize, NoReaction)>) -> Value<T> {
    match made {
        Ok(()) => Value::Unit,
        Err((site, cause)) => Value::failed(Failure::At(site, Box::new(cause.into()))),
    }
}

pub(super) fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    Some(match (name, arguments) {
        ("Multipliers::new", 2) => |a, _| match a {
            [Value::List(counts), Value::Bool(ring)] => {
                let counts = counts.iter().map(Value::count);
                let counts = counts.collect::<Option<Vec<usize>>>()?;
                Some(Value::Multipliers(Box::new(Multipliers::new(
                    &counts, *ring,
                ))))
            }
            _ => None,
        },
        ("Multipliers::of_sums", 1) => |a, _| {
            let search = Multipliers::of_sums(a.first()?.count()?);
            Some(Value::Multipliers(Box::new(search)))
        },
        ("line::turned_by", 4) => |a, _| match a {
            [
                Value::Poinsot(body),
                Value::Real(h),
                Value::Attitude(from),
                Value::Attitude(to),
            ] => Some(Value::Matrix(line::turned_by(body, *h, from, to))),
            _ => None,
        },
        ("goes_on", 1) => |a, _| Some(Value::Bool(search(a)?.goes_on())),
        ("sites", 1) => |a, _| Some(Value::Int(i64::try_from(search(a)?.sites()).ok()?)),
        ("largest_impulse", 1) => |a, _| {
            Some(Value::Int(
                i64::try_from(search(a)?.largest_impulse()).ok()?,
            ))
        },
        ("root_found", 1) => |a, _| Some(reaction_result(search(a)?.root_found())),
        ("fixed_view", 3) => |a, sizes| {
            let (m, row, column) = (a.first()?.dense()?, a.get(1)?.count()?, a.get(2)?.count()?);
            let [rows, cols] = sizes else { return None };
            let fits = row + rows <= m.rows && column + cols <= m.cols;
            let part =
                || clebsch::linalg::Dense::from_fn(*rows, *cols, |i, j| m.at(row + i, column + j));
            fits.then(|| Value::of(part()))
        },
        _ => return None,
    })
}

fn missing<T: Real>() -> Exit<T> {
    Exit::Unfit("a search for impulses over other lists")
}

/// The numbers of a site in a list of arrays.
fn numbers<T: Real>(list: &Value<T>) -> Option<(usize, &[T])> {
    match list {
        Value::Sites(Column::Arrays([rows, cols], all)) => Some((rows * cols, all)),
        _ => None,
    }
}

fn at<T>((size, all): (usize, &[T]), site: usize) -> &[T] {
    all.get(site * size..(site + 1) * size).unwrap_or_default()
}

/// Takes the search out of its place while it works on lists.
fn with<T: Real>(
    places: &mut Places<T>,
    own: &Code<T>,
    work: impl FnOnce(&mut Multipliers<T>, &mut Places<T>) -> Option<Value<T>>,
) -> Done<T> {
    let place = unfit(own.place_mut(places))?;
    let Value::Multipliers(mut search) = std::mem::replace(place, Value::Unit) else {
        return Err(missing());
    };
    let made = work(&mut search, places);
    *unfit(own.place_mut(places))? = Value::Multipliers(search);
    made.ok_or_else(missing)
}

/// How many components the list of impulses has at a site.
fn components<T: Real>(places: &Places<T>, list: &Code<T>) -> Option<usize> {
    numbers(list.place(places)?).map(|(n, _)| n)
}

/// Writes the impulses, on a ring with one more copy on either side.
fn put<T: Real>(search: &Multipliers<T>, places: &mut Places<T>, out: &Code<T>) -> Option<()> {
    let Value::Sites(Column::Arrays([rows, cols], all)) = out.place_mut(places)? else {
        return None;
    };
    let (n, list) = (*rows * *cols, search.impulses());
    all.get_mut(n..n + list.len())?.copy_from_slice(list);
    if search.is_ring() {
        let end = list.len();
        all.copy_within(end..end + n, 0);
        all.copy_within(n..2 * n, end + n);
    }
    Some(())
}

/// `search.begin_search(&mut out)`
fn begin<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [own, out] = a else { return Err(missing()) };
    with(places, own, |search, places| {
        search.begin();
        put(search, places, out).map(|()| Value::Unit)
    })
}

/// `search.wants_derivatives(&held, &mut out)`
fn wants<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [own, held, out] = a else {
        return Err(missing());
    };
    with(places, own, |search, places| {
        let held = numbers(held.place(places)?)?;
        let wants = search.wants(held.0 / 2, |site| at(held, site));
        if search.is_corrected() {
            put(search, places, out)?;
        }
        Some(Value::Bool(wants))
    })
}

/// `search.correct(&rows, &mut out)`
fn correct<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [own, rows, out] = a else {
        return Err(missing());
    };
    with(places, own, |search, places| {
        let n = components(places, out)?;
        let rows = numbers(rows.place(places)?)?;
        search.correct_by(n, |site| at(rows, site));
        put(search, places, out).map(|()| Value::Unit)
    })
}

/// `search.projected(&rows, &rates, &mut out)`
fn projected<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [own, rows, rates, out] = a else {
        return Err(missing());
    };
    with(places, own, |search, places| {
        let n = components(places, out)?;
        let (rows, rates) = (
            numbers(rows.place(places)?)?,
            numbers(rates.place(places)?)?,
        );
        let made = search.project(n, |site| at(rows, site), |site| at(rates, site));
        if made.is_ok() {
            put(search, places, out)?;
        }
        Some(reaction_result(made))
    })
}

pub(super) fn special<T: Real>(name: &str) -> Option<Special<T>> {
    Some(match name {
        "begin_search" => begin,
        "wants_derivatives" => wants,
        "correct" => correct,
        "projected" => projected,
        _ => return None,
    })
}
