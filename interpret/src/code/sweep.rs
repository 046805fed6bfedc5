//! Loops over sites: a body that is executed at each of them. What it fills is not read by it, so that it
//! can be taken out for as long as the loop runs.

use super::flat::{Flat, Lists, Stop, traced};
use super::{Code, Evaluated, Exit, Places, WRONG, unfit};
use crate::failure::Failure;
use crate::sites::Column;
use crate::value::Value;
use clebsch::Real;
use clebsch::linalg::Dense;
use clebsch::line;
use std::sync::{Arc, OnceLock};

/// What is done with the values of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `fill`: they are put into a list.
    Fill,
    /// `try_fill`: the same, up to the first that is an error.
    TryFill,
    /// `update`: put into one list, with another value kept; up to the first that is none.
    Update,
    /// `try_each`: tests, up to the first error.
    TryEach,
    /// `sum` and `total`.
    Sum(Terms),
    /// The same of the sizes of their terms: a scale of what is summed.
    Sizes(Terms),
}

/// What is summed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Terms {
    /// Numbers: of no site 0.
    Numbers,
    /// Arrays: of no site zeros, whatever their shape.
    Arrays,
}

/// A list of sites or part of it.
#[derive(Clone, Debug)]
pub struct Slice<T: Real> {
    /// The place of the list.
    pub list: Code<T>,
    /// The first site.
    pub from: Option<Code<T>>,
    /// The one after the last.
    pub to: Option<Code<T>>,
}

/// A loop.
#[derive(Clone, Debug)]
pub struct Sweep<T: Real> {
    /// What is done with the values.
    pub kind: Kind,
    /// What is filled.
    pub out: Vec<Slice<T>>,
    /// From which site to which, where nothing is filled.
    pub range: Option<[Code<T>; 2]>,
    /// The places of the parameters of the body.
    pub parameters: Vec<usize>,
    /// The body.
    pub body: Code<T>,
    /// The same as operations, made when it is first run; none where it has some that are not known.
    pub flat: OnceLock<Option<Arc<Flat<T>>>>,
}

/// A list that is taken out of its place, and its sites.
struct Taken<T: Real> {
    column: Column<T>,
    from: usize,
    to: usize,
}

impl<T: Real> Slice<T> {
    /// The first site, and the one after the last.
    pub fn range(&self, places: &mut Places<T>) -> Result<[usize; 2], Exit<T>> {
        let from = match &self.from {
            Some(from) => from.count(places)?,
            None => 0,
        };
        let to = match &self.to {
            Some(to) => to.count(places)?,
            None => match unfit(self.list.place(places))? {
                Value::Sites(column) => column.len(),
                _ => return Err(Exit::Unfit(WRONG)),
            },
        };
        Ok([from, to])
    }

    fn taken(&self, places: &mut Places<T>) -> Result<Taken<T>, Exit<T>> {
        let [from, to] = self.range(places)?;
        let place = unfit(self.list.place_mut(places))?;
        match std::mem::replace(place, Value::Unit) {
            Value::Sites(column) if from <= to && to <= column.len() => {
                Ok(Taken { column, from, to })
            }
            other => {
                *place = other;
                Err(Exit::Unfit(WRONG))
            }
        }
    }

    fn put_back(&self, taken: Taken<T>, places: &mut Places<T>) -> Result<(), Exit<T>> {
        *unfit(self.list.place_mut(places))? = Value::Sites(taken.column);
        Ok(())
    }
}

impl<T: Real> Sweep<T> {
    /// The value of the body at a site.
    fn at(
        &self,
        arguments: impl Iterator<Item = Value<T>>,
        places: &mut Places<T>,
    ) -> Evaluated<T> {
        for (at, value) in self.parameters.iter().zip(arguments) {
            *unfit(places.get_mut(*at))? = value;
        }
        match self.body.run(places) {
            Err(Exit::Return(value)) => Ok(*value),
            other => other,
        }
    }

    /// The loop.
    ///
    /// # Errors
    /// [`Exit`] for operations that do not fit; errors at sites are values.
    pub fn run(&self, places: &mut Places<T>) -> Evaluated<T> {
        match (self.kind, self.out.as_slice()) {
            (Kind::Fill | Kind::TryFill, [out]) => {
                let mut taken = out.taken(places)?;
                let done = self.filled(&mut taken, places);
                out.put_back(taken, places)?;
                done
            }
            (Kind::Update, [out, kept]) => {
                let (mut taken, mut keep) = (out.taken(places)?, kept.taken(places)?);
                let done = self.updated(&mut taken, &mut keep, places);
                out.put_back(taken, places)?;
                kept.put_back(keep, places)?;
                done
            }
            (Kind::TryEach, []) => {
                let [from, to] = self.whole(places)?;
                let mut i = from;
                while i < to {
                    i = self.quick(places, [i, to], Lists::none());
                    if i == to {
                        break;
                    }
                    if let Value::Failed(e) = self.at([site(i)].into_iter(), places)? {
                        return Ok(Value::failed(Failure::At(i, e)));
                    }
                    i += 1;
                }
                Ok(Value::Unit)
            }
            (Kind::Sum(terms) | Kind::Sizes(terms), []) => {
                let all = self.gathered(places)?;
                unfit(summed(&all, terms, matches!(self.kind, Kind::Sizes(_))))
            }
            _ => Err(Exit::Unfit(WRONG)),
        }
    }

    /// The values of the body at all sites.
    fn gathered(&self, places: &mut Places<T>) -> Result<Column<T>, Exit<T>> {
        let [from, to] = self.whole(places)?;
        let mut all = Column::Values(Vec::new());
        let mut i = from;
        while i < to {
            // The first says of what kind they are.
            if i > from {
                let lists = Lists {
                    gathered: Some(&mut all),
                    ..Lists::none()
                };
                i = self.quick(places, [i, to], lists);
                if i == to {
                    break;
                }
            }
            let value = self.at([site(i)].into_iter(), places)?;
            if i == from {
                all = Column::like(&value);
            }
            unfit(all.push(&value))?;
            i += 1;
        }
        Ok(all)
    }

    /// Runs sites by operations, as far as that goes: the next site that is left to the body.
    fn quick(&self, places: &Places<T>, [from, to]: [usize; 2], mut lists: Lists<'_, T>) -> usize {
        let flat = self.flat.get_or_init(|| {
            let kept = lists.kept.as_ref();
            let kept = kept.and_then(|(column, first)| column.get(*first + from));
            let shape = |column: &Column<T>| match column {
                Column::Arrays(dims, _) => Some(*dims),
                _ => None,
            };
            let out = lists.out.iter().map(|(column, _)| shape(column));
            let kept_shape = lists.kept.iter().map(|(column, _)| shape(column));
            let gathered = lists.gathered.iter().map(|column| shape(column));
            let shapes: Vec<Option<[usize; 2]>> = out.chain(kept_shape).chain(gathered).collect();
            let made = traced(places, &self.parameters, &self.body, from, kept, &shapes);
            made.map(Arc::new)
        });
        let Some(flat) = flat else { return from };
        match flat.run(places, [from, to], &mut lists) {
            Stop::Done => to,
            Stop::Left(site) => site,
            Stop::Unfit => from,
        }
    }

    fn whole(&self, places: &mut Places<T>) -> Result<[usize; 2], Exit<T>> {
        let [from, to] = unfit(self.range.as_ref())?;
        Ok([from.count(places)?, to.count(places)?])
    }

    fn filled(&self, taken: &mut Taken<T>, places: &mut Places<T>) -> Evaluated<T> {
        let (mut i, to) = (0, taken.to - taken.from);
        while i < to {
            let lists = Lists {
                out: Some((&mut taken.column, taken.from)),
                ..Lists::none()
            };
            i = self.quick(places, [i, to], lists);
            if i == to {
                break;
            }
            let value = self.at([site(i)].into_iter(), places)?;
            if let Value::Failed(e) = value {
                return Ok(Value::failed(Failure::At(i, e)));
            }
            unfit(taken.column.set(taken.from + i, &value))?;
            i += 1;
        }
        Ok(Value::Unit)
    }

    fn updated(
        &self,
        out: &mut Taken<T>,
        kept: &mut Taken<T>,
        places: &mut Places<T>,
    ) -> Evaluated<T> {
        let (mut i, to) = (0, (out.to - out.from).min(kept.to - kept.from));
        while i < to {
            let lists = Lists {
                out: Some((&mut out.column, out.from)),
                kept: Some((&mut kept.column, kept.from)),
                gathered: None,
            };
            i = self.quick(places, [i, to], lists);
            if i == to {
                break;
            }
            let keep = unfit(kept.column.get(kept.from + i))?;
            match self.at([site(i), keep].into_iter(), places)? {
                Value::None => return Ok(Value::failed(Failure::Site(i))),
                Value::List(both) => {
                    let [value, keep] = both.as_slice() else {
                        return Err(Exit::Unfit(WRONG));
                    };
                    unfit(out.column.set(out.from + i, value))?;
                    unfit(kept.column.set(kept.from + i, keep))?;
                }
                _ => return Err(Exit::Unfit(WRONG)),
            }
            i += 1;
        }
        Ok(Value::Unit)
    }
}

fn site<T: Real>(i: usize) -> Value<T> {
    Value::Int(i64::try_from(i).unwrap_or(i64::MAX))
}

/// The sum of numbers, or of arrays component by component.
fn summed<T: Real>(all: &Column<T>, terms: Terms, sizes: bool) -> Option<Value<T>> {
    let of = |x: T| if sizes { x.abs() } else { x };
    Some(match all {
        Column::Numbers(list) => Value::Real(line::sum(list.len(), |i| of(list[i]))),
        Column::Arrays([rows, cols], list) => {
            let size = rows * cols;
            let sum = |k: usize| line::sum(all.len(), |i| of(list[i * size + k]));
            Value::of(Dense {
                rows: *rows,
                cols: *cols,
                data: (0..size).map(sum).collect(),
            })
        }
        Column::Values(none) if none.is_empty() => match terms {
            Terms::Numbers => Value::Real(T::zero()),
            Terms::Arrays => Value::Zeros,
        },
        _ => return None,
    })
}
