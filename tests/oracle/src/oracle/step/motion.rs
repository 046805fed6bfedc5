//! The variables of a step: additive values, and group elements, varied in the frame of their momenta. Gives tangents, moved
//! values, and increments from one node to the next, from row-major numbers.

use super::group::{exponential, inverse, product};
use crate::oracle::dual::Number;
use crate::oracle::pair::Pair;
use crate::oracle::sides::Side;

/// How a configuration is varied.
#[derive(Clone, Debug)]
pub enum Motion {
    /// Entry by entry.
    Added,
    /// With a basis of a Lie algebra (row-major matrices), on one side.
    Turned(Vec<Vec<f64>>, Side),
    /// Not varied, because an end prescribes it.
    Fixed,
}

/// One configuration of one site.
#[derive(Clone, Debug)]
pub struct Block {
    /// Its site.
    pub site: usize,
    /// The index of its first number.
    pub at: usize,
    /// Rows.
    pub rows: usize,
    /// Columns.
    pub cols: usize,
    /// How it is varied.
    pub motion: Motion,
}

impl Block {
    /// The number of its entries.
    #[must_use]
    pub fn size(&self) -> usize {
        self.rows * self.cols
    }

    /// The number of its directions.
    #[must_use]
    pub fn directions(&self) -> usize {
        match &self.motion {
            Motion::Added => self.size(),
            Motion::Turned(basis, _) => basis.len(),
            Motion::Fixed => 0,
        }
    }

    /// The tangent of its value along a direction.
    pub fn tangent<T: Number>(&self, value: &[T], direction: usize) -> Vec<T> {
        match &self.motion {
            Motion::Added | Motion::Fixed => (0..self.size())
                .map(|k| T::constant(f64::from(u8::from(k == direction))))
                .collect(),
            Motion::Turned(basis, side) => {
                let along: Vec<T> = basis[direction].iter().map(|x| T::constant(*x)).collect();
                match side {
                    Side::Body => product(self.rows, value, &along),
                    Side::Space => product(self.rows, &along, value),
                }
            }
        }
    }

    /// Its value moved by `by` along the directions.
    #[must_use]
    pub fn moved(&self, value: &[Pair], by: &[Pair]) -> Vec<Pair> {
        match &self.motion {
            Motion::Fixed => value.to_vec(),
            Motion::Added => value.iter().zip(by).map(|(x, d)| *x + *d).collect(),
            Motion::Turned(basis, side) => {
                let mut along = vec![Pair::constant(0.0); self.size()];
                for (matrix, amount) in basis.iter().zip(by) {
                    for (sum, x) in along.iter_mut().zip(matrix) {
                        *sum = *sum + Pair::constant(*x) * *amount;
                    }
                }
                let turn = exponential(self.rows, &along);
                match side {
                    Side::Body => product(self.rows, value, &turn),
                    Side::Space => product(self.rows, &turn, value),
                }
            }
        }
    }

    /// A change of its value at the head as a change of the increment from the tail: `R^-1 δ` in the body, `δ R^-1` in space.
    #[must_use]
    pub fn as_increment(&self, tail: &[Pair], change: &[Pair]) -> Vec<Pair> {
        match &self.motion {
            Motion::Added | Motion::Fixed => change.to_vec(),
            Motion::Turned(_, side) => {
                let back = inverse(self.rows, tail);
                match side {
                    Side::Body => product(self.rows, &back, change),
                    Side::Space => product(self.rows, change, &back),
                }
            }
        }
    }

    /// The increment from the tail to the head.
    #[must_use]
    pub fn increment(&self, tail: &[Pair], head: &[Pair]) -> Vec<Pair> {
        let change: Vec<Pair> = head.iter().zip(tail).map(|(b, a)| *b - *a).collect();
        self.as_increment(tail, &change)
    }
}
