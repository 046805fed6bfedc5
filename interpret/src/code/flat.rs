//! The body of a loop over sites as operations on numbered registers, one after the other: numbers side by side,
//! counts, and values of any other kind. Takes the places around a loop; gives the registers of each site,
//! or leaves a site to the body itself where something unusual comes up.

mod trace;

pub use trace::traced;

use super::{Code, Native, Places};
use crate::sites::{Column, range};
use crate::value::Value;
use clebsch::Real;
use nalgebra::{Matrix3, Vector3};

/// Where a value stands.
#[derive(Clone, Debug)]
pub(super) enum At<T: Real> {
    /// Nowhere: it is the same always.
    Constant(Value<T>),
    /// A number in a register.
    Real(usize),
    /// An array in registers from here on, column after column.
    Array([usize; 2], usize),
    /// A count in a register of counts.
    Int(usize),
    /// Anything else, in a register of values.
    Object(usize),
}

/// An operation; its last register is where it puts what it makes.
#[derive(Clone, Debug)]
pub(super) enum Op<T: Real> {
    Add(usize, usize, usize),
    Sub(usize, usize, usize),
    Mul(usize, usize, usize),
    Div(usize, usize, usize),
    Neg(usize, usize),
    Function(fn(T) -> T, usize, usize),
    Powi(usize, i32, usize),
    /// Entry by entry: how many.
    AddEach(usize, usize, usize, usize),
    SubEach(usize, usize, usize, usize),
    MulBy(usize, usize, usize, usize),
    DivBy(usize, usize, usize, usize),
    NegEach(usize, usize, usize),
    Copy(usize, usize, usize),
    /// A 3 x 3 matrix times a vector, and so on.
    MatVec(usize, usize, usize),
    MatMat(usize, usize, usize),
    TrMatVec(usize, usize, usize),
    TrMatMat(usize, usize, usize),
    Dot(usize, usize, usize),
    Cross(usize, usize, usize),
    Trace(usize, usize),
    /// `known * (1 / number)`, as fields are divided; leaves what is no number to the body.
    Divided(usize, usize, usize, usize),
    /// Leaves a site with a number that is not finite to the body.
    Finite(usize, usize),
    /// Counts.
    AddInt(usize, usize, usize),
    SubInt(usize, usize, usize),
    /// A number or an array of a list at the site of a count.
    Number(usize, usize, usize),
    Array(usize, usize, [usize; 2], usize),
    /// The matrix of an attitude of a list.
    Attitude(usize, usize, usize),
    /// Any other value of a list.
    Value(usize, usize, usize),
    /// A function of the runtime.
    Native(Native<T>, Box<[At<T>]>, Box<[usize]>, At<T>),
}

/// Something that is read before the loop.
#[derive(Clone, Debug)]
pub(super) struct Captured<T: Real> {
    pub path: Code<T>,
    pub to: At<T>,
}

/// A list that is read: its place, and the field of a struct in it.
#[derive(Clone, Debug)]
pub(super) struct Read<T: Real> {
    pub path: Code<T>,
    pub field: Option<u32>,
}

/// A body as operations.
#[derive(Clone, Debug)]
pub struct Flat<T: Real> {
    captured: Vec<Captured<T>>,
    columns: Vec<Read<T>>,
    numbers: Vec<T>,
    ints: Vec<i64>,
    objects: Vec<Value<T>>,
    before: Vec<Op<T>>,
    body: Vec<Op<T>>,
    /// Where the value that is kept comes in.
    kept: Option<At<T>>,
    /// What comes out.
    out: Vec<Vec<At<T>>>,
}

/// What runs: the registers.
struct Registers<T: Real> {
    numbers: Vec<T>,
    ints: Vec<i64>,
    objects: Vec<Value<T>>,
}

/// Why a loop stops.
pub enum Stop {
    /// It is done.
    Done,
    /// This site is left to the body.
    Left(usize),
    /// Nothing fits: all is left to the body.
    Unfit,
}

impl<T: Real> Flat<T> {
    /// Runs the sites from `from` to the one before `to`. `kept` gives what comes in at a site, `put` takes
    /// what comes out.
    pub fn run(
        &self,
        places: &Places<T>,
        [from, to]: [usize; 2],
        lists: &mut Lists<'_, T>,
    ) -> Stop {
        let columns = self.columns.iter().map(|read| {
            let Value::Sites(column) = read.path.place(places)? else {
                return None;
            };
            match read.field {
                None => Some(column),
                Some(name) => column.field(name),
            }
        });
        let Some(columns) = columns.collect::<Option<Vec<&Column<T>>>>() else {
            return Stop::Unfit;
        };
        let mut r = Registers {
            numbers: self.numbers.clone(),
            ints: self.ints.clone(),
            objects: self.objects.clone(),
        };
        for captured in &self.captured {
            let done = captured
                .path
                .place(places)
                .and_then(|v| r.put(&captured.to, v));
            if done.is_none() {
                return Stop::Unfit;
            }
        }
        for op in &self.before {
            if r.run(op, &columns).is_none() {
                return Stop::Unfit;
            }
        }
        for i in from..to {
            if self.site(i, &mut r, &columns, lists).is_none() {
                return Stop::Left(i);
            }
        }
        Stop::Done
    }

    fn site(
        &self,
        i: usize,
        r: &mut Registers<T>,
        columns: &[&Column<T>],
        lists: &mut Lists<'_, T>,
    ) -> Option<()> {
        *r.ints.first_mut()? = i64::try_from(i).ok()?;
        if let Some(at) = &self.kept {
            let (column, from) = lists.kept.as_ref()?;
            r.load(column, *from + i, at)?;
        }
        for op in &self.body {
            r.run(op, columns)?;
        }
        lists.put(i, &self.out, r)
    }
}

/// The lists that a loop fills.
pub struct Lists<'a, T: Real> {
    /// What is filled, from a site on.
    pub out: Option<(&'a mut Column<T>, usize)>,
    /// What is kept, from a site on.
    pub kept: Option<(&'a mut Column<T>, usize)>,
    /// Values that are put one after the other.
    pub gathered: Option<&'a mut Column<T>>,
}

impl<T: Real> Lists<'_, T> {
    /// Nothing is filled.
    pub fn none() -> Self {
        Lists {
            out: None,
            kept: None,
            gathered: None,
        }
    }

    fn put(&mut self, i: usize, out: &[Vec<At<T>>], r: &Registers<T>) -> Option<()> {
        let mut values = out.iter();
        if let Some((column, from)) = &mut self.out {
            r.store(column, *from + i, values.next()?)?;
        }
        if let Some((column, from)) = &mut self.kept {
            r.store(column, *from + i, values.next()?)?;
        }
        if let Some(column) = &mut self.gathered {
            let [at] = values.next()?.as_slice() else {
                return None;
            };
            match (&mut **column, at) {
                (Column::Numbers(all), At::Real(x)) => all.push(*r.numbers.get(*x)?),
                (Column::Arrays(dims, all), At::Array(own, x)) if dims == own => {
                    all.extend(r.numbers.get(*x..*x + dims[0] * dims[1])?);
                }
                (Column::Values(all), At::Object(o)) => all.push(r.objects.get(*o)?.clone()),
                _ => return None,
            }
        }
        Some(())
    }
}

fn vector<T: Real>(all: &[T], at: usize) -> Option<Vector3<T>> {
    Some(Vector3::from_column_slice(all.get(at..at + 3)?))
}

fn matrix<T: Real>(all: &[T], at: usize) -> Option<Matrix3<T>> {
    Some(Matrix3::from_column_slice(all.get(at..at + 9)?))
}

impl<T: Real> Registers<T> {
    /// Puts a value where it belongs, if it is of the kind that belongs there.
    fn put(&mut self, at: &At<T>, value: &Value<T>) -> Option<()> {
        match (at, value) {
            (At::Real(to), Value::Real(x)) => *self.numbers.get_mut(*to)? = *x,
            (At::Array([3, 1], to), Value::Vector(v)) => self.copy(*to, v.as_slice())?,
            (At::Array([3, 3], to), Value::Matrix(m)) => self.copy(*to, m.as_slice())?,
            (At::Array([rows, cols], to), Value::Dense(a))
                if (a.rows, a.cols) == (*rows, *cols) =>
            {
                self.copy(*to, &a.data)?;
            }
            (At::Int(to), Value::Int(n)) => *self.ints.get_mut(*to)? = *n,
            // Of a list its length.
            (At::Int(to), Value::Sites(list)) => {
                *self.ints.get_mut(*to)? = i64::try_from(list.len()).ok()?;
            }
            (At::Constant(_), Value::Unit) => {}
            (At::Object(to), value) => {
                let place = self.objects.get_mut(*to)?;
                let same = std::mem::discriminant(place) == std::mem::discriminant(value);
                let unusual = matches!(value, Value::Failed(_) | Value::None);
                if !same || unusual {
                    return None;
                }
                *place = value.clone();
            }
            _ => return None,
        }
        Some(())
    }

    fn copy(&mut self, to: usize, from: &[T]) -> Option<()> {
        self.numbers
            .get_mut(to..to + from.len())?
            .copy_from_slice(from);
        Some(())
    }

    /// The value that stands somewhere.
    fn get<'a>(&'a self, at: &'a At<T>, made: &'a mut Value<T>) -> Option<&'a Value<T>> {
        *made = match at {
            At::Constant(value) => return Some(value),
            At::Object(o) => return self.objects.get(*o),
            At::Real(x) => Value::Real(*self.numbers.get(*x)?),
            At::Int(n) => Value::Int(*self.ints.get(*n)?),
            At::Array(dims, x) => {
                let data = self.numbers.get(*x..*x + dims[0] * dims[1])?;
                crate::sites::array(*dims, data)
            }
        };
        Some(made)
    }

    fn load(&mut self, column: &Column<T>, site: usize, at: &At<T>) -> Option<()> {
        match (column, at) {
            (Column::Numbers(all), At::Real(to)) => {
                *self.numbers.get_mut(*to)? = *all.get(site)?;
            }
            (Column::Arrays(dims, all), At::Array(own, to)) if dims == own => {
                let data = all.get(range(*dims, site))?;
                self.numbers
                    .get_mut(*to..*to + data.len())?
                    .copy_from_slice(data);
            }
            (column, at @ At::Object(_)) => self.put(at, &column.get(site)?)?,
            _ => return None,
        }
        Some(())
    }

    fn store(&self, column: &mut Column<T>, site: usize, from: &[At<T>]) -> Option<()> {
        match (column, from) {
            (Column::Numbers(all), [At::Real(x)]) => {
                *all.get_mut(site)? = *self.numbers.get(*x)?;
            }
            (Column::Arrays(dims, all), [At::Array(own, x)]) if dims == own => {
                let to = all.get_mut(range(*dims, site))?;
                to.copy_from_slice(self.numbers.get(*x..*x + to.len())?);
            }
            (Column::Structs(_, fields, count), from) => {
                if site >= *count || fields.len() != from.len() {
                    return None;
                }
                for (field, at) in fields.iter_mut().zip(from) {
                    self.store(field, site, std::slice::from_ref(at))?;
                }
            }
            (column, [At::Object(o)]) => column.set(site, self.objects.get(*o)?)?,
            _ => return None,
        }
        Some(())
    }

    fn at(&self, x: usize) -> Option<T> {
        self.numbers.get(x).copied()
    }

    fn set(&mut self, to: usize, x: T) -> Option<()> {
        *self.numbers.get_mut(to)? = x;
        Some(())
    }

    /// Entry by entry.
    #[inline]
    fn each(&mut self, count: usize, to: usize, f: impl Fn(&[T], usize) -> T) -> Option<()> {
        let (read, write) = self.numbers.split_at_mut_checked(to)?;
        for (k, slot) in write.get_mut(..count)?.iter_mut().enumerate() {
            *slot = f(read, k);
        }
        Some(())
    }

    #[inline]
    fn run(&mut self, op: &Op<T>, columns: &[&Column<T>]) -> Option<()> {
        match *op {
            Op::Add(a, b, to) => self.set(to, self.at(a)? + self.at(b)?),
            Op::Sub(a, b, to) => self.set(to, self.at(a)? - self.at(b)?),
            Op::Mul(a, b, to) => self.set(to, self.at(a)? * self.at(b)?),
            Op::Div(a, b, to) => self.set(to, self.at(a)? / self.at(b)?),
            Op::Neg(a, to) => self.set(to, -self.at(a)?),
            Op::Function(f, a, to) => self.set(to, f(self.at(a)?)),
            Op::Powi(a, n, to) => self.set(to, self.at(a)?.powi(n)),
            // What is read stands before what is written: registers are given out in order.
            Op::AddEach(a, b, n, to) => self.each(n, to, |r, k| r[a + k] + r[b + k]),
            Op::SubEach(a, b, n, to) => self.each(n, to, |r, k| r[a + k] - r[b + k]),
            Op::MulBy(a, x, n, to) => self.each(n, to, |r, k| r[a + k] * r[x]),
            Op::DivBy(a, x, n, to) => self.each(n, to, |r, k| r[a + k] / r[x]),
            Op::NegEach(a, n, to) => self.each(n, to, |r, k| -r[a + k]),
            Op::Copy(a, n, to) => {
                if a + n > self.numbers.len() || to + n > self.numbers.len() {
                    return None;
                }
                self.numbers.copy_within(a..a + n, to);
                Some(())
            }
            Op::MatVec(a, b, to) => {
                let x = matrix(&self.numbers, a)? * vector(&self.numbers, b)?;
                self.copy(to, x.as_slice())
            }
            Op::MatMat(a, b, to) => {
                let x = matrix(&self.numbers, a)? * matrix(&self.numbers, b)?;
                self.copy(to, x.as_slice())
            }
            Op::TrMatVec(a, b, to) => {
                let x = matrix(&self.numbers, a)?.tr_mul(&vector(&self.numbers, b)?);
                self.copy(to, x.as_slice())
            }
            Op::TrMatMat(a, b, to) => {
                let x = matrix(&self.numbers, a)?.tr_mul(&matrix(&self.numbers, b)?);
                self.copy(to, x.as_slice())
            }
            Op::Dot(a, b, to) => {
                let x = vector(&self.numbers, a)?.dot(&vector(&self.numbers, b)?);
                self.set(to, x)
            }
            Op::Cross(a, b, to) => {
                let x = vector(&self.numbers, a)?.cross(&vector(&self.numbers, b)?);
                self.copy(to, x.as_slice())
            }
            Op::Trace(a, to) => {
                let x = matrix(&self.numbers, a)?.trace();
                self.set(to, x)
            }
            Op::Divided(a, x, n, to) => {
                let number = self.at(x)?;
                let inverse = T::one() / number;
                if !(inverse.is_finite() && number.is_finite()) {
                    return None;
                }
                self.each(n, to, |r, k| r[a + k] * inverse)
            }
            Op::Finite(a, n) => {
                let all = self.numbers.get(a..a + n)?;
                all.iter().all(|x| x.is_finite()).then_some(())
            }
            Op::AddInt(a, b, to) => {
                let sum = self.ints.get(a)?.checked_add(*self.ints.get(b)?)?;
                *self.ints.get_mut(to)? = sum;
                Some(())
            }
            Op::SubInt(a, b, to) => {
                let difference = self.ints.get(a)?.checked_sub(*self.ints.get(b)?)?;
                *self.ints.get_mut(to)? = difference;
                Some(())
            }
            Op::Number(column, site, to) => {
                let site = usize::try_from(*self.ints.get(site)?).ok()?;
                self.load(columns.get(column)?, site, &At::Real(to))
            }
            Op::Array(column, site, dims, to) => {
                let site = usize::try_from(*self.ints.get(site)?).ok()?;
                self.load(columns.get(column)?, site, &At::Array(dims, to))
            }
            Op::Attitude(column, site, to) => {
                let site = usize::try_from(*self.ints.get(site)?).ok()?;
                let Column::Attitudes(all) = columns.get(column)? else {
                    return None;
                };
                let x = all.get(site)?.matrix();
                self.copy(to, x.as_slice())
            }
            Op::Value(column, site, to) => {
                let site = usize::try_from(*self.ints.get(site)?).ok()?;
                self.load(columns.get(column)?, site, &At::Object(to))
            }
            Op::Native(native, ref arguments, ref sizes, ref to) => {
                let mut made = [const { Value::Unit }; 5];
                let nothing = Value::Unit;
                let mut list = [&nothing; 5];
                if arguments.len() > list.len() {
                    return None;
                }
                let slots = list.iter_mut().zip(&mut made).zip(arguments);
                for ((slot, made), at) in slots {
                    *slot = self.get(at, made)?;
                }
                let value = native(list.get(..arguments.len())?, sizes)?;
                self.put(to, &value)
            }
        }
    }
}
