//! Lists with a value for each site, stored as contiguous numbers. Loops over sites read and fill them. Takes values of
//! one kind; gives each value back, or a place for another value.

use crate::value::{Layout, Struct, Value};
use clebsch::Real;
use clebsch::linalg::Dense;
use clebsch::line::Attitude;
use std::ops::Range;
use std::sync::Arc;

/// One value for each site.
#[derive(Clone, Debug, PartialEq)]
pub enum Column<T: Real> {
    /// Numbers.
    Numbers(Vec<T>),
    /// Arrays of rows and columns, their numbers column after column.
    Arrays([usize; 2], Vec<T>),
    /// Attitudes.
    Attitudes(Vec<Attitude<T>>),
    /// Structs: a list for each field, and the number of structs.
    Structs(Arc<Layout>, Vec<Column<T>>, usize),
    /// Any others.
    Values(Vec<Value<T>>),
    /// A list stored elsewhere that notes which of its values are read.
    Tracked(Arc<dyn TrackedList<T>>),
}

/// A list that notes which of its sites are read.
pub trait TrackedList<T: Real>: std::fmt::Debug + Send + Sync {
    /// The number of sites.
    fn len(&self) -> usize;

    /// The value at a site.
    fn at(&self, site: usize) -> Option<Value<T>>;
}

impl<T: Real> PartialEq for dyn TrackedList<T> {
    /// Never called: the values are stored elsewhere.
    fn eq(&self, _: &Self) -> bool {
        false
    }
}

impl<T: Real> Column<T> {
    /// An empty column for values of the same type.
    pub fn like(value: &Value<T>) -> Self {
        match value {
            Value::Real(_) => Column::Numbers(Vec::new()),
            Value::Vector(_) => Column::Arrays([3, 1], Vec::new()),
            Value::Matrix(_) => Column::Arrays([3, 3], Vec::new()),
            Value::Dense(a) => Column::Arrays([a.rows, a.cols], Vec::new()),
            Value::Attitude(_) => Column::Attitudes(Vec::new()),
            Value::Struct(s) => {
                let fields = s.values.iter().map(Column::like).collect();
                Column::Structs(s.layout.clone(), fields, 0)
            }
            _ => Column::Values(Vec::new()),
        }
    }

    /// A column of values of one kind. Returns nothing if the kinds differ.
    pub fn of(values: Vec<Value<T>>) -> Option<Self> {
        let Some(first) = values.first() else {
            return Some(Column::Values(values));
        };
        let mut column = Column::like(first);
        if let Column::Values(_) = column {
            return Some(Column::Values(values));
        }
        for value in &values {
            column.push(value)?;
        }
        Some(column)
    }

    /// Numbers of arrays, row by row.
    pub fn of_rows([rows, cols]: [usize; 2], list: &[T]) -> Self {
        let size = (rows * cols).max(1);
        let mut all = Vec::with_capacity(list.len());
        for one in list.chunks_exact(size) {
            for j in 0..cols {
                all.extend((0..rows).filter_map(|i| one.get(i * cols + j)));
            }
        }
        Column::Arrays([rows, cols], all)
    }

    /// The number of sites.
    pub fn len(&self) -> usize {
        match self {
            Column::Numbers(all) => all.len(),
            Column::Arrays([rows, cols], all) => all.len() / (rows * cols).max(1),
            Column::Attitudes(all) => all.len(),
            Column::Structs(_, _, count) => *count,
            Column::Values(all) => all.len(),
            Column::Tracked(list) => list.len(),
        }
    }

    /// The value at a site.
    #[inline]
    pub fn get(&self, site: usize) -> Option<Value<T>> {
        Some(match self {
            Column::Numbers(all) => Value::Real(*all.get(site)?),
            Column::Arrays(dims, all) => array(*dims, part(*dims, all, site)?),
            Column::Attitudes(all) => Value::Attitude(Box::new(*all.get(site)?)),
            Column::Structs(layout, fields, _) => Value::Struct(Struct {
                layout: layout.clone(),
                values: fields.iter().map(|f| f.get(site)).collect::<Option<_>>()?,
            }),
            Column::Values(all) => all.get(site)?.clone(),
            Column::Tracked(list) => list.at(site)?,
        })
    }

    /// The list of one field, by mutable reference.
    pub fn field_mut(&mut self, name: u32) -> Option<&mut Column<T>> {
        match self {
            Column::Structs(layout, fields, _) => {
                fields.get_mut(layout.fields.iter().position(|f| *f == name)?)
            }
            _ => None,
        }
    }

    /// Replaces the value at a site.
    #[inline]
    pub fn set(&mut self, site: usize, value: &Value<T>) -> Option<()> {
        match (self, value) {
            (Column::Numbers(all), Value::Real(x)) => *all.get_mut(site)? = *x,
            (Column::Arrays(dims, all), value) => {
                let out = all.get_mut(range(*dims, site)).filter(|o| !o.is_empty())?;
                put(*dims, out, value)?;
            }
            (Column::Attitudes(all), Value::Attitude(x)) => *all.get_mut(site)? = **x,
            (Column::Structs(_, fields, count), Value::Struct(s)) => {
                if site >= *count {
                    return None;
                }
                for (field, value) in fields.iter_mut().zip(&s.values) {
                    field.set(site, value)?;
                }
            }
            (Column::Values(all), value) => *all.get_mut(site)? = value.clone(),
            _ => return None,
        }
        Some(())
    }

    /// Appends a site.
    pub fn push(&mut self, value: &Value<T>) -> Option<()> {
        match (self, value) {
            (Column::Numbers(all), Value::Real(x)) => all.push(*x),
            (Column::Arrays([rows, cols], all), value) => {
                let from = all.len();
                all.resize(from + *rows * *cols, T::zero());
                put([*rows, *cols], all.get_mut(from..)?, value)?;
            }
            (Column::Attitudes(all), Value::Attitude(x)) => all.push(**x),
            (Column::Structs(_, fields, count), Value::Struct(s)) => {
                for (field, value) in fields.iter_mut().zip(&s.values) {
                    field.push(value)?;
                }
                *count += 1;
            }
            (Column::Values(all), value) => all.push(value.clone()),
            _ => return None,
        }
        Some(())
    }

    /// Resizes to `count` sites: drops the last sites, or appends copies of a value.
    pub fn resize(&mut self, count: usize, value: &Value<T>) -> Option<()> {
        while self.len() < count {
            self.push(value)?;
        }
        self.truncate(count);
        Some(())
    }

    fn truncate(&mut self, to: usize) {
        match self {
            Column::Numbers(all) => all.truncate(to),
            Column::Arrays([rows, cols], all) => all.truncate(to * *rows * *cols),
            Column::Attitudes(all) => all.truncate(to),
            Column::Structs(_, fields, count) => {
                fields.iter_mut().for_each(|f| f.truncate(to));
                *count = (*count).min(to);
            }
            Column::Values(all) => all.truncate(to),
            Column::Tracked(_) => {}
        }
    }

    /// The sites of a range.
    pub fn part(&self, range: Range<usize>) -> Option<Self> {
        Some(match self {
            Column::Numbers(all) => Column::Numbers(all.get(range)?.to_vec()),
            Column::Arrays([rows, cols], all) => {
                let size = rows * cols;
                let all = all.get(range.start * size..range.end * size)?;
                Column::Arrays([*rows, *cols], all.to_vec())
            }
            Column::Attitudes(all) => Column::Attitudes(all.get(range)?.to_vec()),
            Column::Structs(layout, fields, _) => {
                let own = fields.iter().map(|f| f.part(range.clone()));
                Column::Structs(
                    layout.clone(),
                    own.collect::<Option<_>>()?,
                    range.end.checked_sub(range.start)?,
                )
            }
            Column::Values(all) => Column::Values(all.get(range)?.to_vec()),
            Column::Tracked(_) => return None,
        })
    }

    /// Writes the values of another list, starting at a site.
    pub fn put(&mut self, from: usize, other: &Column<T>) -> Option<()> {
        for site in 0..other.len() {
            self.set(from + site, &other.get(site)?)?;
        }
        Some(())
    }

    /// All values.
    pub fn values(&self) -> impl Iterator<Item = Value<T>> + '_ {
        (0..self.len()).filter_map(|site| self.get(site))
    }
}

/// The range of the numbers of the array of a site.
#[inline]
pub fn range([rows, cols]: [usize; 2], site: usize) -> Range<usize> {
    let size = rows * cols;
    let from = site.saturating_mul(size);
    from..from.saturating_add(size)
}

#[inline]
fn part<T>(dims: [usize; 2], all: &[T], site: usize) -> Option<&[T]> {
    all.get(range(dims, site)).filter(|a| !a.is_empty())
}

/// An array from its numbers, column after column.
#[inline]
pub fn array<T: Real>([rows, cols]: [usize; 2], data: &[T]) -> Value<T> {
    match (rows, cols) {
        (3, 1) => Value::Vector(nalgebra::Vector3::from_column_slice(data)),
        (3, 3) => Value::Matrix(nalgebra::Matrix3::from_column_slice(data)),
        _ => Value::Dense(Dense {
            rows,
            cols,
            data: data.to_vec(),
        }),
    }
}

/// Writes the numbers of an array.
fn put<T: Real>(dims: [usize; 2], out: &mut [T], value: &Value<T>) -> Option<()> {
    let (own, data): ([usize; 2], &[T]) = match value {
        Value::Vector(v) => ([3, 1], v.as_slice()),
        Value::Matrix(m) => ([3, 3], m.as_slice()),
        Value::Dense(a) => ([a.rows, a.cols], &a.data),
        Value::Zeros => {
            out.fill(T::zero());
            return Some(());
        }
        _ => return None,
    };
    (own == dims && out.len() == data.len()).then(|| out.copy_from_slice(data))
}
