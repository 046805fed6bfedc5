//! Evaluates patterns on matrices of doubles, with formulas independent of the rules. The result is a matrix, or
//! `None` if the pattern is undefined for these values.

use crate::language::{Leaf, Term};
use clebsch_core::expr::shape::{Dim, Shape};
use egg::{ENodeOrVar, Id, PatternAst, Var};
use std::collections::BTreeMap;

/// A matrix, stored by rows.
#[derive(Clone, Debug)]
pub struct Matrix {
    pub rows: usize,
    pub cols: usize,
    pub data: Vec<f64>,
}

/// A sequence of pseudo-random numbers between -1 and 1, the same in every run (linear congruential generator).
pub struct Sequence(pub u64);

impl Sequence {
    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn matrix(&mut self, rows: usize, cols: usize) -> Matrix {
        Matrix::from(rows, cols, |_, _| self.next())
    }

    /// A rotation: the Cayley transform of a random skew matrix.
    pub fn rotation(&mut self) -> Matrix {
        let a = self.matrix(3, 3);
        let skew = a.plus(&a.transposed().scaled(-1.0));
        let one = Matrix::identity(3);
        one.plus(&skew)
            .times(&one.plus(&skew.scaled(-1.0)).inverse())
    }
}

impl Matrix {
    pub fn from(rows: usize, cols: usize, mut f: impl FnMut(usize, usize) -> f64) -> Self {
        let data = (0..rows * cols).map(|k| f(k / cols, k % cols)).collect();
        Matrix { rows, cols, data }
    }

    pub fn identity(n: usize) -> Self {
        Matrix::from(n, n, |i, j| f64::from(i == j))
    }

    pub fn scalar(x: f64) -> Self {
        Matrix::from(1, 1, |_, _| x)
    }

    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.data[i * self.cols + j]
    }

    pub fn shape(&self) -> Shape {
        Shape {
            rows: Dim::Fixed(self.rows as u32),
            cols: Dim::Fixed(self.cols as u32),
        }
    }

    pub fn plus(&self, b: &Matrix) -> Matrix {
        assert_eq!((self.rows, self.cols), (b.rows, b.cols));
        Matrix::from(self.rows, self.cols, |i, j| self.at(i, j) + b.at(i, j))
    }

    pub fn scaled(&self, s: f64) -> Matrix {
        Matrix::from(self.rows, self.cols, |i, j| s * self.at(i, j))
    }

    pub fn times(&self, b: &Matrix) -> Matrix {
        assert_eq!(self.cols, b.rows);
        Matrix::from(self.rows, b.cols, |i, j| {
            (0..self.cols).map(|k| self.at(i, k) * b.at(k, j)).sum()
        })
    }

    pub fn transposed(&self) -> Matrix {
        Matrix::from(self.cols, self.rows, |i, j| self.at(j, i))
    }

    pub fn trace(&self) -> f64 {
        (0..self.rows).map(|i| self.at(i, i)).sum()
    }

    /// The matrix without row i and column j.
    fn minor(&self, i: usize, j: usize) -> Matrix {
        let n = self.rows - 1;
        Matrix::from(n, n, |r, c| {
            self.at(r + usize::from(r >= i), c + usize::from(c >= j))
        })
    }

    /// The determinant, by expansion along the first row.
    pub fn det(&self) -> f64 {
        if self.rows == 0 {
            return 1.0;
        }
        let sign = |j: usize| if j.is_multiple_of(2) { 1.0 } else { -1.0 };
        (0..self.rows)
            .map(|j| sign(j) * self.at(0, j) * self.minor(0, j).det())
            .sum()
    }

    /// The inverse, by Cramer's rule.
    pub fn inverse(&self) -> Matrix {
        let det = self.det();
        Matrix::from(self.rows, self.rows, |i, j| {
            let sign = if (i + j).is_multiple_of(2) { 1.0 } else { -1.0 };
            sign * self.minor(j, i).det() / det
        })
    }

    /// The vector product of two columns, by components.
    pub fn cross(&self, b: &Matrix) -> Matrix {
        let c = |i: usize, j: usize| self.at(i, 0) * b.at(j, 0) - self.at(j, 0) * b.at(i, 0);
        Matrix {
            rows: 3,
            cols: 1,
            data: vec![c(1, 2), c(2, 0), c(0, 1)],
        }
    }

    /// The skew matrix; its columns are the products with the unit vectors.
    pub fn hat(&self) -> Matrix {
        let e = Matrix::identity(3);
        let column = |j: usize| self.cross(&Matrix::from(3, 1, |i, _| e.at(i, j)));
        Matrix::from(3, 3, |i, j| column(j).at(i, 0))
    }

    pub fn vee(&self) -> Matrix {
        let c = |i: usize, j: usize| (self.at(j, i) - self.at(i, j)) / 2.0;
        Matrix {
            rows: 3,
            cols: 1,
            data: vec![c(1, 2), c(2, 0), c(0, 1)],
        }
    }
}

/// The value of the sub-pattern at `id`; `None` if shapes do not match.
pub fn value(pattern: &PatternAst<Term>, id: Id, known: &BTreeMap<Var, Matrix>) -> Option<Matrix> {
    let v = |id: &Id| value(pattern, *id, known);
    let node = match &pattern[id] {
        ENodeOrVar::Var(var) => return known.get(var).cloned(),
        ENodeOrVar::ENode(node) => node,
    };
    let shapes: Option<Vec<Shape>> = egg::Language::children(node)
        .iter()
        .map(|c| Some(v(c)?.shape()))
        .collect();
    crate::language::shape(node, &shapes?)?;
    Some(match node {
        Term::Number(q) => Matrix::scalar(q.0.value()),
        Term::Leaf(Leaf::Size(Dim::Fixed(n))) => Matrix::identity(*n as usize),
        Term::Leaf(Leaf::Unit(Dim::Fixed(n), axis)) => {
            Matrix::from(*n as usize, 1, |i, _| f64::from(i == usize::from(*axis)))
        }
        Term::Leaf(_) => return None,
        Term::Sum([a, b]) => v(a)?.plus(&v(b)?),
        Term::Scale([s, a]) => v(a)?.scaled(v(s)?.at(0, 0)),
        Term::Product([a, b]) => v(a)?.times(&v(b)?),
        Term::Power([a, q]) => Matrix::scalar(v(a)?.at(0, 0).powf(v(q)?.at(0, 0))),
        Term::Transpose(a) => v(a)?.transposed(),
        Term::Inverse(a) => v(a)?.inverse(),
        Term::Trace(a) => Matrix::scalar(v(a)?.trace()),
        Term::Det(a) => Matrix::scalar(v(a)?.det()),
        Term::Dot([a, b]) => {
            let (a, b) = (v(a)?, v(b)?);
            Matrix::scalar(a.data.iter().zip(&b.data).map(|(x, y)| x * y).sum())
        }
        Term::Cross([a, b]) => v(a)?.cross(&v(b)?),
        Term::Hat(a) => v(a)?.hat(),
        Term::Vee(a) => v(a)?.vee(),
        Term::Symmetric(a) => v(a)?.plus(&v(a)?.transposed()).scaled(0.5),
        Term::Skew(a) => v(a)?.plus(&v(a)?.transposed().scaled(-1.0)).scaled(0.5),
        Term::Diagonal(a) => {
            let a = v(a)?;
            Matrix::from(a.rows, a.rows, |i, j| if i == j { a.at(i, j) } else { 0.0 })
        }
        Term::Exp(a) => Matrix::scalar(v(a)?.at(0, 0).exp()),
        Term::Log(a) => Matrix::scalar(v(a)?.at(0, 0).ln()),
        Term::Identity(n) => Matrix::identity(v(n)?.rows),
        Term::Zero([n, m]) => Matrix::from(v(n)?.rows, v(m)?.rows, |_, _| 0.0),
    })
}
