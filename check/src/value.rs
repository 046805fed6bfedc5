//! Values of expressions: matrices of numbers, and values such as `Id` and `E1` that take their size from other
//! operands.

use crate::matrix::Matrix;
use crate::number::Number;

/// The form of a value of unknown size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Open {
    /// A vector.
    Column,
    /// The transpose of a vector.
    Row,
    /// A square matrix.
    Square,
}

/// A value of unknown size: a multiple of the identity and single entries.
#[derive(Clone, Debug, PartialEq)]
pub struct Sparse {
    /// Its form.
    pub form: Open,
    /// The number that a square value adds to each entry of its diagonal.
    pub diagonal: Number,
    /// Entries by row and column, counted from 0.
    pub entries: Vec<(usize, usize, Number)>,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A value of known size.
    Known(Matrix),
    /// A value that takes its size from other operands.
    Open(Sparse),
}

use Value::{Known, Open as Unsized};

impl Value {
    /// A number.
    #[must_use]
    pub fn number(n: Number) -> Self {
        Known(Matrix::number(n))
    }

    /// The unit vector of this direction, counted from 0.
    #[must_use]
    pub fn unit(i: usize) -> Self {
        Unsized(Sparse {
            form: Open::Column,
            diagonal: Number::default(),
            entries: vec![(i, 0, Number::exact(1.0))],
        })
    }

    /// The identity.
    #[must_use]
    pub fn identity() -> Self {
        Unsized(Sparse {
            form: Open::Square,
            diagonal: Number::exact(1.0),
            entries: Vec::new(),
        })
    }

    /// Its value, if it is a number.
    #[must_use]
    pub fn as_number(&self) -> Option<&Number> {
        match self {
            Known(m) => m.as_number(),
            Unsized(_) => None,
        }
    }

    /// As a matrix of this size, if it fits.
    #[must_use]
    pub fn sized(&self, rows: usize, cols: usize) -> Option<Matrix> {
        match self {
            Known(m) if (m.rows, m.cols) == (rows, cols) => Some(m.clone()),
            Known(m) if m.as_number().is_some_and(Number::is_zero) => {
                Some(Matrix::from_entries(rows, cols, |_, _| Number::default()))
            }
            Known(_) => None,
            Unsized(s) => s.sized(rows, cols),
        }
    }

    /// Applies a function to each entry; zeros stay zeros.
    #[must_use]
    pub fn map(&self, of: impl Fn(&Number) -> Number) -> Self {
        match self {
            Known(m) => Known(m.map(of)),
            Unsized(s) => Unsized(Sparse {
                form: s.form,
                diagonal: of(&s.diagonal),
                entries: s.entries.iter().map(|(i, j, x)| (*i, *j, of(x))).collect(),
            }),
        }
    }

    /// The opposite.
    #[must_use]
    pub fn negated(&self) -> Self {
        self.map(|x| x.clone().negated())
    }

    /// The sum, if sizes fit.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Option<Self> {
        match (self, other) {
            (Known(a), Known(b)) if a.as_number().is_some_and(Number::is_zero) => {
                Some(Known(b.clone()))
            }
            (Known(a), Known(b)) if b.as_number().is_some_and(Number::is_zero) => {
                Some(Known(a.clone()))
            }
            (Known(a), Known(b)) => a.plus(b).map(Known),
            (Known(a), Unsized(_)) if a.as_number().is_some_and(Number::is_zero) => {
                Some(other.clone())
            }
            (Known(a), Unsized(s)) | (Unsized(s), Known(a)) => {
                a.plus(&s.sized(a.rows, a.cols)?).map(Known)
            }
            (Unsized(a), Unsized(b)) => a.plus(b).map(Unsized),
        }
    }

    /// The transpose.
    #[must_use]
    pub fn transposed(&self) -> Self {
        match self {
            Known(m) => Known(m.transposed()),
            Unsized(s) => Unsized(Sparse {
                form: match s.form {
                    Open::Column => Open::Row,
                    Open::Row => Open::Column,
                    Open::Square => Open::Square,
                },
                diagonal: s.diagonal.clone(),
                entries: s
                    .entries
                    .iter()
                    .map(|(i, j, x)| (*j, *i, x.clone()))
                    .collect(),
            }),
        }
    }

    /// The product, if sizes fit.
    #[must_use]
    pub fn times(&self, other: &Self) -> Option<Self> {
        match (self, other) {
            (Known(a), Known(b)) => a.times(b).map(Known),
            (Known(a), Unsized(s)) => match a.as_number() {
                Some(c) => Some(other.map(|x| c.times(x))),
                None => match s.form {
                    Open::Square => a.times(&s.sized(a.cols, a.cols)?).map(Known),
                    Open::Column => a.times(&s.sized(a.cols, 1)?).map(Known),
                    Open::Row if a.cols == 1 => None,
                    Open::Row => None,
                },
            },
            (Unsized(s), Known(b)) => match b.as_number() {
                Some(c) => Some(self.map(|x| x.times(c))),
                None => match s.form {
                    Open::Square => s.sized(b.rows, b.rows)?.times(b).map(Known),
                    Open::Row => s.sized(1, b.rows)?.times(b).map(Known),
                    Open::Column => None,
                },
            },
            (Unsized(a), Unsized(b)) => a.times(b),
        }
    }
}

impl Sparse {
    fn sized(&self, rows: usize, cols: usize) -> Option<Matrix> {
        let fits = match self.form {
            Open::Column => cols == 1,
            Open::Row => rows == 1,
            Open::Square => rows == cols,
        };
        let inside = self.entries.iter().all(|(i, j, _)| *i < rows && *j < cols);
        (fits && inside).then(|| {
            Matrix::from_entries(rows, cols, |i, j| {
                let start = match self.form == Open::Square && i == j {
                    true => self.diagonal.clone(),
                    false => Number::default(),
                };
                let own = self.entries.iter().filter(|(k, l, _)| (*k, *l) == (i, j));
                own.fold(start, |sum, (_, _, x)| sum.plus(x))
            })
        })
    }

    fn plus(&self, other: &Self) -> Option<Self> {
        (self.form == other.form).then(|| Self {
            form: self.form,
            diagonal: self.diagonal.plus(&other.diagonal),
            entries: self.entries.iter().chain(&other.entries).cloned().collect(),
        })
    }

    fn times(&self, other: &Self) -> Option<Value> {
        let mut entries = Vec::new();
        for (i, j, x) in &self.entries {
            for (k, l, y) in &other.entries {
                if j == k {
                    entries.push((*i, *l, x.times(y)));
                }
            }
            // The entries times the identity of the other operand.
            if other.form == Open::Square && !other.diagonal.is_zero() {
                entries.push((*i, *j, x.times(&other.diagonal)));
            }
        }
        if self.form == Open::Square && !self.diagonal.is_zero() {
            let each = other.entries.iter();
            entries.extend(each.map(|(k, l, y)| (*k, *l, self.diagonal.times(y))));
        }
        let form = match (self.form, other.form) {
            (Open::Row, Open::Column) => {
                let sum = entries
                    .iter()
                    .fold(Number::default(), |s, (_, _, x)| s.plus(x));
                return Some(Value::number(sum));
            }
            (Open::Column, Open::Row) | (Open::Square, Open::Square) => Open::Square,
            (Open::Square, Open::Column) => Open::Column,
            (Open::Row, Open::Square) => Open::Row,
            _ => return None,
        };
        let diagonal = match (self.form, other.form) {
            (Open::Square, Open::Square) => self.diagonal.times(&other.diagonal),
            _ => Number::default(),
        };
        Some(Value::Open(Self {
            form,
            diagonal,
            entries,
        }))
    }

    /// The trace, if it needs no size.
    #[must_use]
    pub fn trace(&self) -> Option<Number> {
        let own = self.entries.iter().filter(|(i, j, _)| i == j);
        let sum = own.fold(Number::default(), |sum, (_, _, x)| sum.plus(x));
        (self.form == Open::Square && self.diagonal.is_zero()).then_some(sum)
    }
}
