//! Rounding of momenta of GL(n), which are products with the element in one of the frames of body and space. Takes an
//! element and matrices in one frame; gives the rounding that products with the element and its inverse cause.

use crate::matrix::Matrix;
use crate::number::{Number, UNIT};
use crate::stated::Side;

/// The matrices that transform a momentum from the other frame: `left M right`. The momentum in the body is
/// `Q^T m Q^-T`, and the momentum in space is `Q^-T M Q^T`.
pub struct TwoFrames {
    left: Matrix,
    right: Matrix,
}

impl TwoFrames {
    /// At an element of n rows, for momenta in the frame of this side.
    #[must_use]
    pub fn at(n: usize, numbers: &[f64], side: Side) -> Option<Self> {
        let transposed = square(n, numbers)?.transposed();
        let inverse = transposed.inverse()?;
        Some(match side {
            Side::Body => Self {
                left: transposed,
                right: inverse,
            },
            Side::Space => Self {
                left: inverse,
                right: transposed,
            },
        })
    }

    /// The rounding of the entries of a momentum that is stored in the other frame.
    #[must_use]
    pub fn rounding(&self, momentum: &[f64]) -> Option<Rounding> {
        let own = square(self.left.rows, momentum)?;
        let other = self.right.times(&own)?.times(&self.left)?;
        let stored = other.map(|x| Number::within(x.value, UNIT * x.value.abs()));
        let brought = self.left.times(&stored)?.times(&self.right)?;
        let size = |m: &Matrix| m.map(|x| Number::exact(x.value.abs()));
        let mixed = size(&self.left)
            .times(&size(&stored))?
            .times(&size(&self.right))?;
        Some(Rounding {
            errors: brought.entries.iter().map(|x| x.error).collect(),
            sizes: mixed.entries.iter().map(|x| x.value).collect(),
        })
    }
}

/// The rounding of the entries of a momentum. An entry mixes all entries of the stored momentum, so a small entry may
/// have a large error.
pub struct Rounding {
    /// Bounds on the errors of the entries.
    pub errors: Vec<f64>,
    /// The sizes of the terms of each entry: all products, summed.
    pub sizes: Vec<f64>,
}

fn square(n: usize, numbers: &[f64]) -> Option<Matrix> {
    let entries = || numbers.iter().map(|x| Number::exact(*x)).collect();
    (numbers.len() == n * n).then(|| Matrix::of_rows(n, n, entries()))
}
