//! Matrices of any size of numbers with a derivative, for actions typed by hand.

use clebsch::Dual;
use std::ops::{Add, Mul, Sub};

pub type D = Dual<1>;

/// A number without derivative.
pub fn real(x: f64) -> D {
    D::constant(x)
}

/// A matrix, row after row.
#[derive(Clone, Debug)]
pub struct A {
    pub rows: usize,
    pub e: Vec<D>,
}

impl A {
    pub fn of(rows: usize, e: &[f64]) -> Self {
        let e = e.iter().map(|x| real(*x)).collect();
        Self { rows, e }
    }

    pub fn columns(&self) -> usize {
        self.e.len() / self.rows
    }

    pub fn at(&self, i: usize, j: usize) -> D {
        self.e[i * self.columns() + j]
    }

    fn by(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> D) -> Self {
        let all = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j)));
        let e = all.map(|(i, j)| entry(i, j)).collect();
        Self { rows, e }
    }

    pub fn identity(n: usize) -> Self {
        Self::by(n, n, |i, j| real(if i == j { 1.0 } else { 0.0 }))
    }

    pub fn t(&self) -> Self {
        Self::by(self.columns(), self.rows, |i, j| self.at(j, i))
    }

    pub fn tr(&self) -> D {
        (0..self.rows).fold(real(0.0), |sum, i| sum + self.at(i, i))
    }

    /// The block that begins at a corner.
    pub fn block(&self, (i, j): (usize, usize), (rows, columns): (usize, usize)) -> Self {
        Self::by(rows, columns, |a, b| self.at(i + a, j + b))
    }

    pub fn scaled(&self, by: f64) -> Self {
        Self::by(self.rows, self.columns(), |i, j| self.at(i, j) * real(by))
    }

    /// By the first row.
    pub fn det(&self) -> D {
        if self.rows == 1 {
            return self.e[0];
        }
        let n = self.rows;
        (0..n).fold(real(0.0), |sum, j| {
            let minor = Self::by(n - 1, n - 1, |a, b| {
                self.at(a + 1, if b < j { b } else { b + 1 })
            });
            let sign = real(if j % 2 == 0 { 1.0 } else { -1.0 });
            sum + sign * self.at(0, j) * minor.det()
        })
    }

    /// The inverse of a homogeneous matrix of a rotation and a position.
    pub fn motion_inverse(&self) -> Self {
        let n = self.rows - 1;
        let turn = self.block((0, 0), (n, n)).t();
        let place = &turn * &self.block((0, n), (n, 1));
        Self::by(n + 1, n + 1, |i, j| match (i < n, j < n) {
            (true, true) => turn.at(i, j),
            (true, false) => -place.at(i, 0),
            (false, true) => real(0.0),
            (false, false) => real(1.0),
        })
    }

    pub fn rot(&self) -> Self {
        let n = self.rows - 1;
        self.block((0, 0), (n, n))
    }

    pub fn pos(&self) -> Self {
        let n = self.rows - 1;
        self.block((0, n), (n, 1))
    }

    /// The sum of the products of all entries.
    pub fn dot(&self, other: &Self) -> D {
        let both = self.e.iter().zip(&other.e);
        both.fold(real(0.0), |sum, (a, b)| sum + *a * *b)
    }
}

impl Mul for &A {
    type Output = A;
    fn mul(self, other: &A) -> A {
        A::by(self.rows, other.columns(), |i, j| {
            (0..self.columns()).fold(real(0.0), |sum, k| sum + self.at(i, k) * other.at(k, j))
        })
    }
}

impl Add for &A {
    type Output = A;
    fn add(self, other: &A) -> A {
        A::by(self.rows, self.columns(), |i, j| {
            self.at(i, j) + other.at(i, j)
        })
    }
}

impl Sub for &A {
    type Output = A;
    fn sub(self, other: &A) -> A {
        A::by(self.rows, self.columns(), |i, j| {
            self.at(i, j) - other.at(i, j)
        })
    }
}
