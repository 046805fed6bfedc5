//! Solves for the velocities of all sites together: the search of the runtime, over lists of numbers, with the
//! contributions of sites and coupling terms from the interpreter.

use crate::code::{Code, Exit, Native, Places, Special, unfit};
use crate::failure::Failure;
use crate::sites::Column;
use crate::value::Value;
use clebsch::Real;
use clebsch::linalg::Dense;
use clebsch::line::{self, AnyBand, Attitude, Sums};
use clebsch::nalgebra::Vector3;

type Done<T> = Result<Value<T>, Exit<T>>;

pub(super) fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    Some(match (name, arguments) {
        ("Band::new", 3) => |a, sizes| match a {
            [sites, Value::Bool(ring), Value::Bool(constant)] => {
                let band = AnyBand::new(*sizes.first()?, sites.count()?, *ring, *constant);
                Some(Value::Band(Box::new(band)))
            }
            _ => None,
        },
        ("with_unknowns", 2) => |a, _| match a {
            [Value::Band(band), unknowns] => {
                let unknowns = super::line::unknowns(unknowns)?;
                let band = band.as_ref().clone();
                Some(Value::Band(Box::new(band.with_unknowns(&unknowns))))
            }
            _ => None,
        },
        ("line::turn_of", 1) => |a, _| match a.first()? {
            Value::Vector(v) => Some(Value::Matrix(line::turn_of(v))),
            _ => None,
        },
        ("turn", 2) => |a, _| match a {
            [velocity, row] => {
                let (all, row) = (velocity.dense()?.data, row.count()?);
                match all.get(row..row + 3)? {
                    &[x, y, z] => Some(Value::Matrix(line::turn_of(&Vector3::new(x, y, z)))),
                    _ => None,
                }
            }
            _ => None,
        },
        ("moved", 2) => |a, _| match a {
            [Value::Attitude(from), Value::Vector(v)] => {
                let moved: Attitude<T> = from.moved(v);
                Some(Value::Attitude(Box::new(moved)))
            }
            _ => None,
        },
        _ => return None,
    })
}

fn missing<T: Real>() -> Exit<T> {
    Exit::Unfit("velocities of all sites over other lists")
}

fn site<T: Real>(i: usize) -> Value<T> {
    Value::Int(i64::try_from(i).unwrap_or(i64::MAX))
}

/// Two counts.
fn range<T: Real>(places: &mut Places<T>, code: &Code<T>) -> Result<[usize; 2], Exit<T>> {
    match code.run(places)? {
        Value::List(both) => match both.as_slice() {
            [first, last] => Ok([unfit(first.count())?, unfit(last.count())?]),
            _ => Err(missing()),
        },
        _ => Err(missing()),
    }
}

/// The sites of a term.
fn touched<T: Real>(list: &Value<T>) -> Option<Vec<usize>> {
    match list {
        Value::List(all) => all.iter().map(Value::count).collect(),
        _ => None,
    }
}

/// An array of this many numbers.
fn numbers<T: Real>(value: &Value<T>, count: usize) -> Option<Vec<T>> {
    let all = value.dense()?.data;
    (all.len() == count).then_some(all)
}

/// `rows.tie([first, last], |site| [...], |site, velocities| ..., |site, velocities| (..., ...))`: the first element of
/// `rows` contains the velocities. For each term, its sites and its contribution are appended. The closure for momenta
/// alone is not called, since the last closure gives them too.
fn tie<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [rows, ends, sites, _, term] = a else {
        return Err(missing());
    };
    let [first, last] = range(places, ends)?;
    for index in first..last {
        let sites = sites.call(vec![site(index)], places)?;
        let own = unfit(touched(&sites))?;
        let velocities = match rows.place(places) {
            Some(Value::List(both)) => match both.first() {
                Some(Value::Sites(column)) => own.iter().map(|i| column.get(*i)).collect(),
                _ => None,
            },
            _ => None,
        };
        let velocities = Value::List(unfit(velocities)?);
        let made = term.call(vec![site(index), velocities], places)?;
        match rows.place_mut(places) {
            Some(Value::List(all)) => all.push(Value::List(vec![sites, made])),
            _ => return Err(missing()),
        }
    }
    Ok(Value::Unit)
}

/// The contributions of all sites and terms at given velocities.
struct Terms<'a, T: Real> {
    n: usize,
    sites: usize,
    own: &'a Code<T>,
    /// Whether the closure of a site takes a velocity.
    at_velocities: bool,
    between: &'a Code<T>,
}

impl<T: Real> Terms<'_, T> {
    fn add(&self, places: &mut Places<T>, sums: &mut Sums<'_, T>) -> Result<(), Exit<T>> {
        let n = self.n;
        let mut all = Vec::with_capacity(n * self.sites);
        for i in 0..self.sites {
            let velocity = sums.velocity(n, i).to_vec();
            all.extend_from_slice(&velocity);
            let mut given = vec![site(i)];
            if self.at_velocities {
                given.push(Value::of(Dense::column_of(velocity)));
            }
            let Value::List(both) = self.own.call(given, places)? else {
                return Err(missing());
            };
            let [p, derivative] = both.as_slice() else {
                return Err(missing());
            };
            sums.put(n, i, &unfit(numbers(p, n))?);
            sums.put_derivative(i, &unfit(numbers(derivative, n * n))?);
        }
        let Code::Closure(parameters, _) = self.between else {
            return Err(missing());
        };
        let velocities = Value::Sites(Column::Arrays([n, 1], all));
        self.between
            .call(vec![Value::List(vec![velocities])], places)?;
        let place = parameters.first().and_then(|at| places.get_mut(*at));
        let Value::List(made) = std::mem::replace(unfit(place)?, Value::Unit) else {
            return Err(missing());
        };
        for one in made.iter().skip(1) {
            unfit(self.put(one, sums))?;
        }
        Ok(())
    }

    /// Adds the contribution of one term to its sites.
    fn put(&self, one: &Value<T>, sums: &mut Sums<'_, T>) -> Option<()> {
        let n = self.n;
        let Value::List(both) = one else { return None };
        let [sites, Value::List(made)] = both.as_slice() else {
            return None;
        };
        let sites = touched(sites)?;
        let [Value::List(momenta), Value::List(derivatives)] = made.as_slice() else {
            return None;
        };
        for (row, momenta) in sites.iter().zip(momenta) {
            sums.add(n, *row, &numbers(momenta, n)?);
        }
        for one in derivatives {
            let Value::List(one) = one else { return None };
            let [of, by, block] = one.as_slice() else {
                return None;
            };
            let (row, column) = (sites.get(of.count()?)?, sites.get(by.count()?)?);
            sums.add_derivative(*row, *column, &numbers(block, n * n)?);
        }
        Some(())
    }

    /// Solves for the velocities of known momenta.
    fn solve(
        &self,
        places: &mut Places<T>,
        band: &mut AnyBand<T>,
        [first, last]: [usize; 2],
        known: &Code<T>,
    ) -> Result<Result<(), (usize, line::NoRoot)>, Exit<T>> {
        let n = self.n;
        for i in first..last {
            let value = known.call(vec![site(i)], places)?;
            let value = unfit(numbers(&value, n))?;
            let out = unfit(band.known_mut().get_mut(n * i..n * (i + 1)))?;
            out.copy_from_slice(&value);
        }
        let mut stopped = None;
        let solved = band.solve(n, [first, last], |sums| {
            if let Err(exit) = self.add(places, sums) {
                // NaN ends the search without a solution.
                sums.add(n, 0, &vec![T::from_f64(f64::NAN); n]);
                stopped.get_or_insert(exit);
            }
        });
        match stopped {
            Some(exit) => Err(exit),
            None => Ok(solved),
        }
    }
}

/// `band.solve_along([first, last], |site| known, |site, velocity| ..., |site, velocity| (..., ...), |rows| { ... }, &mut out)`
fn solve_along<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [band, moving, known, _, own, between, out] = a else {
        return Err(missing());
    };
    let moving = range(places, moving)?;
    let n = match out.place(places) {
        Some(Value::Sites(Column::Arrays([n, 1], _))) => *n,
        _ => return Err(missing()),
    };
    let place = unfit(band.place_mut(places))?;
    let Value::Band(mut search) = std::mem::replace(place, Value::Unit) else {
        return Err(missing());
    };
    let terms = Terms {
        n,
        sites: search.sites(),
        own,
        at_velocities: true,
        between,
    };
    let solved = terms.solve(places, &mut search, moving, known);
    if let (Ok(Ok(())), Some(Value::Sites(Column::Arrays(_, all)))) =
        (&solved, out.place_mut(places))
    {
        let found = search.velocities();
        if let Some(all) = all.get_mut(..found.len()) {
            all.copy_from_slice(found);
        }
    }
    *unfit(band.place_mut(places))? = Value::Band(search);
    Ok(match solved? {
        Ok(()) => Value::Unit,
        Err((site, cause)) => Value::failed(Failure::At(site, Box::new(cause.into()))),
    })
}

/// `Band::kinetic([sites, first, last], ring, |site| known, |site| (...), |rows| { ... })`
fn kinetic<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [counts, ring, known, own, between] = a else {
        return Err(missing());
    };
    let counts = counts.run(places)?;
    let counts = touched(&counts);
    let Some([sites, first, last]) = counts.as_deref() else {
        return Err(missing());
    };
    let Value::Bool(ring) = ring.run(places)? else {
        return Err(missing());
    };
    if first >= last {
        return Ok(Value::Real(T::zero()));
    }
    let one = known.call(vec![site(*first)], places)?;
    let n = unfit(one.dense())?.data.len();
    let terms = Terms {
        n,
        sites: *sites,
        own,
        at_velocities: false,
        between,
    };
    let mut band = AnyBand::new(n, *sites, ring, true);
    let solved = terms.solve(places, &mut band, [*first, *last], known)?;
    Ok(Value::Real(match solved {
        Ok(()) => band.half_product(),
        Err(_) => T::from_f64(f64::NAN),
    }))
}

/// `line::spread([first, last], |site| [...], &velocities, &mut out, |site, velocities| ...)`
fn spread<T: Real>(places: &mut Places<T>, a: &[Code<T>]) -> Done<T> {
    let [ends, sites, velocities, out, term] = a else {
        return Err(missing());
    };
    let [first, last] = range(places, ends)?;
    for index in first..last {
        let own = sites.call(vec![site(index)], places)?;
        let own = unfit(touched(&own))?;
        let known = match velocities.place(places) {
            Some(Value::Sites(column)) => own.iter().map(|i| column.get(*i)).collect(),
            _ => None,
        };
        let known = Value::List(unfit(known)?);
        let Value::List(made) = term.call(vec![site(index), known], places)? else {
            return Err(missing());
        };
        let Some(Value::Sites(Column::Arrays([rows, cols], all))) = out.place_mut(places) else {
            return Err(missing());
        };
        let n = *rows * *cols;
        for (i, value) in own.iter().zip(&made) {
            let value = unfit(numbers(value, n))?;
            let out = unfit(all.get_mut(n * i..n * (i + 1)))?;
            for (x, y) in out.iter_mut().zip(value) {
                *x += y;
            }
        }
    }
    Ok(Value::Unit)
}

pub(super) fn special<T: Real>(name: &str) -> Option<Special<T>> {
    Some(match name {
        "tie" => tie,
        "solve_along" => solve_along,
        "Band::kinetic" => kinetic,
        "line::spread" => spread,
        _ => return None,
    })
}
