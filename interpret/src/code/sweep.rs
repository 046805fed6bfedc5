//! Loops over sites. The body does not read the list that it fills, so the list is taken out of its place while the
//! loop runs.

use super::{Code, Evaluated, Exit, Iterate, Places, WRONG, unfit};
use crate::failure::Failure;
use crate::listing::{FieldNames, Section};
use crate::recorded::{Lists, SiteBody, SiteFunction, Traced, TracedSite, has_derivatives};
use crate::sites::Column;
use crate::value::Value;
use clebsch::Real;
use clebsch::linalg::Dense;
use clebsch::line;
use std::sync::Arc;

/// How a loop uses the values of its body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `fill`: writes the values to a list.
    Fill,
    /// `try_fill`: writes the values to a list, up to the first error.
    TryFill,
    /// `update`: writes one part of each value to a list and keeps the other part, up to the first `None`.
    Update,
    /// `try_each`: tests, up to the first error.
    TryEach,
    /// `sum` and `total`.
    Sum(Terms),
    /// The sum of the sizes of the terms, which is a scale for the sum.
    Sizes(Terms),
}

/// The type of the terms of a sum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Terms {
    /// Numbers. An empty sum is 0.
    Numbers,
    /// Arrays. An empty sum is zero in any shape.
    Arrays,
}

/// A list of sites or part of it.
#[derive(Clone, Debug)]
pub struct Slice<T: Real> {
    /// The place of the list.
    pub list: Code<T>,
    /// The first site.
    pub from: Option<Code<T>>,
    /// The site after the last.
    pub to: Option<Code<T>>,
}

/// A loop.
#[derive(Debug)]
pub struct Sweep<T: Real, S> {
    /// How the loop uses the values.
    pub kind: Kind,
    /// The lists that the loop fills.
    pub out: Vec<Slice<T>>,
    /// The range of sites, if the loop fills no list.
    pub range: Option<[Code<T>; 2]>,
    /// The body.
    pub sites: S,
}

/// A list that is taken out of its place, and its sites.
struct TakenList<T: Real> {
    column: Column<T>,
    from: usize,
    to: usize,
}

impl Slice<f64> {
    /// This list over the recording scalar.
    fn recorded(&self) -> Option<Slice<Traced>> {
        let over = |code: &Code<f64>| code.map_scalar(Traced::constant);
        let perhaps = |code: &Option<Code<f64>>| match code {
            Some(code) => over(code).map(Some),
            None => Some(None),
        };
        Some(Slice {
            list: over(&self.list)?,
            from: perhaps(&self.from)?,
            to: perhaps(&self.to)?,
        })
    }
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

    fn taken(&self, places: &mut Places<T>) -> Result<TakenList<T>, Exit<T>> {
        let [from, to] = self.range(places)?;
        let place = unfit(self.list.place_mut(places))?;
        match std::mem::replace(place, Value::Unit) {
            Value::Sites(column) if from <= to && to <= column.len() => {
                Ok(TakenList { column, from, to })
            }
            other => {
                *place = other;
                Err(Exit::Unfit(WRONG))
            }
        }
    }

    fn put_back(&self, taken: TakenList<T>, places: &mut Places<T>) -> Result<(), Exit<T>> {
        *unfit(self.list.place_mut(places))? = Value::Sites(taken.column);
        Ok(())
    }
}

impl<T: Real, S: SiteBody<T>> Sweep<T, S> {
    /// Runs the loop.
    fn swept(&self, places: &mut Places<T>) -> Evaluated<T> {
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
                    i = self.sites.advance(places, [i, to], &mut Lists::default());
                    if i == to {
                        break;
                    }
                    if let Value::Failed(e) = self.sites.at(&[site(i)], places)? {
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
}

impl Iterate<f64> for Sweep<f64, SiteFunction> {
    fn run(&self, places: &mut Places<f64>) -> Evaluated<f64> {
        self.swept(places)
    }

    fn section(&self, names: &FieldNames) -> Option<Section> {
        let filled: Vec<String> = self.out.iter().map(|out| names.path(&out.list)).collect();
        let title = match (self.kind, filled.is_empty()) {
            (Kind::Sum(_), _) => "sum over sites k".to_owned(),
            (Kind::Sizes(_), _) => "sum of sizes over sites k".to_owned(),
            (_, true) => "test at sites k".to_owned(),
            (_, false) => format!("loop over sites k that fills {}", filled.join(", ")),
        };
        self.sites.section(&title, names)
    }

    fn recorded(self: Arc<Self>) -> Option<Arc<dyn Iterate<Traced>>> {
        let over = |code: &Code<f64>| code.map_scalar(Traced::constant);
        let range = match &self.range {
            Some([from, to]) => Some([over(from)?, over(to)?]),
            None => None,
        };
        Some(Arc::new(Sweep {
            kind: self.kind,
            out: self
                .out
                .iter()
                .map(Slice::recorded)
                .collect::<Option<_>>()?,
            range,
            sites: self.sites.recorded_at_each()?,
        }))
    }
}

/// A loop within a recording with derivatives: its body is recorded at every site. Other recordings stop here, because loops
/// record their bodies themselves.
impl Iterate<Traced> for Sweep<Traced, TracedSite> {
    fn run(&self, places: &mut Places<Traced>) -> Evaluated<Traced> {
        match has_derivatives() {
            true => self.swept(places),
            false => unfit(None),
        }
    }
}

impl<T: Real, S: SiteBody<T>> Sweep<T, S> {
    /// The values of the body at all sites.
    fn gathered(&self, places: &mut Places<T>) -> Result<Column<T>, Exit<T>> {
        let [from, to] = self.whole(places)?;
        let mut all = Column::Values(Vec::new());
        let mut i = from;
        while i < to {
            // The first value determines their kind.
            if i > from {
                let mut lists = Lists {
                    gathered: Some(&mut all),
                    ..Lists::default()
                };
                i = self.sites.advance(places, [i, to], &mut lists);
                if i == to {
                    break;
                }
            }
            let value = self.sites.at(&[site(i)], places)?;
            if i == from {
                all = Column::like(&value);
            }
            unfit(all.push(&value))?;
            i += 1;
        }
        Ok(all)
    }

    fn whole(&self, places: &mut Places<T>) -> Result<[usize; 2], Exit<T>> {
        let [from, to] = unfit(self.range.as_ref())?;
        Ok([from.count(places)?, to.count(places)?])
    }

    fn filled(&self, taken: &mut TakenList<T>, places: &mut Places<T>) -> Evaluated<T> {
        let (mut i, to) = (0, taken.to - taken.from);
        while i < to {
            let mut lists = Lists {
                out: Some((&mut taken.column, taken.from)),
                ..Lists::default()
            };
            i = self.sites.advance(places, [i, to], &mut lists);
            if i == to {
                break;
            }
            let value = self.sites.at(&[site(i)], places)?;
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
        out: &mut TakenList<T>,
        kept: &mut TakenList<T>,
        places: &mut Places<T>,
    ) -> Evaluated<T> {
        let (mut i, to) = (0, (out.to - out.from).min(kept.to - kept.from));
        while i < to {
            let mut lists = Lists {
                out: Some((&mut out.column, out.from)),
                kept: Some((&mut kept.column, kept.from)),
                gathered: None,
            };
            i = self.sites.advance(places, [i, to], &mut lists);
            if i == to {
                break;
            }
            let keep = unfit(kept.column.get(kept.from + i))?;
            match self.sites.at(&[site(i), keep], places)? {
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
    let of = |x: T| match sizes {
        true => T::from_f64(x.magnitude()),
        false => x,
    };
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
