//! The Helmholtz smoother between two walls: `S = (M + α²K)⁻¹ M` with the mass and stiffness matrices M, K of linear
//! finite elements and natural (Neumann) ends. With the lumped mass D of the trapezoid rule and the spacing s,
//! `M = D - (s²/6) K`. Hence S is a function of D⁻¹K, and self-adjoint in the weights of nodes. Takes rows of values,
//! the first and last on the walls; leaves constants unchanged, bit for bit.

use super::axis::Axis;
use crate::Real;

/// Rows or columns that are solved for side by side.
pub(super) const BLOCK: usize = 8;

/// Factors of the tridiagonal matrix, divided by the spacing.
#[derive(Clone, Debug)]
pub(super) struct Bounded<T> {
    /// `(α/s)²`.
    stiffness: T,
    /// The factors of the previous row in the forward sweep.
    forwards: Vec<T>,
    /// The factors of the next row in the backward sweep.
    backwards: Vec<T>,
    /// Reciprocal pivots.
    pivots: Vec<T>,
    rest: Vec<T>,
    block: Vec<T>,
}

impl<T: Real> Bounded<T> {
    /// For the smoothing length `alpha`.
    pub fn new(axis: &Axis, alpha: T) -> Self {
        let ratio = alpha * axis.density();
        let stiffness = ratio * ratio;
        let last = axis.intervals();
        let off = T::from_ratio(1, 6) - stiffness;
        let on = T::from_ratio(1, 3) + stiffness;
        let (mut forwards, mut backwards, mut pivots) = (vec![], vec![], vec![]);
        let mut before = T::zero();
        for i in 0..=last {
            let diagonal = match i == 0 || i == last {
                true => on,
                false => on + on,
            };
            let forward = off * before;
            let pivot = T::one() / (diagonal - off * forward);
            forwards.push(forward);
            pivots.push(pivot);
            backwards.push(off * pivot);
            before = pivot;
        }
        Self {
            stiffness,
            forwards,
            backwards,
            pivots,
            rest: vec![],
            block: vec![],
        }
    }

    /// Smooths across rows of this length: `values` has one row for each node. As `S = 1 - (M + α²K)⁻¹ α²K`.
    pub fn across(&mut self, values: &mut [T], width: usize) {
        let nodes = self.pivots.len();
        if width == 0 || values.len() != nodes * width {
            return;
        }
        self.rest.resize(nodes * width, T::zero());
        let rest = &mut self.rest[..];
        // The differences to the next row, from which the right side is computed.
        for i in 0..nodes {
            let (done, row) = rest.split_at_mut(i * width);
            let row = &mut row[..width];
            let value = &values[i * width..(i + 1) * width];
            let forward = self.forwards[i];
            if i > 0 {
                let before = &values[(i - 1) * width..i * width];
                let done = &done[(i - 1) * width..];
                for (((out, value), before), done) in
                    row.iter_mut().zip(value).zip(before).zip(done)
                {
                    *out = (*value - *before) * self.stiffness - forward * *done;
                }
            } else {
                row.fill(T::zero());
            }
            if i + 1 < nodes {
                let behind = &values[(i + 1) * width..(i + 2) * width];
                for ((out, value), behind) in row.iter_mut().zip(value).zip(behind) {
                    *out += (*value - *behind) * self.stiffness;
                }
            }
        }
        for i in (0..nodes).rev() {
            let (row, behind) = rest[i * width..].split_at_mut(width);
            let value = &mut values[i * width..(i + 1) * width];
            let pivot = self.pivots[i];
            if i + 1 < nodes {
                let backward = self.backwards[i];
                for ((row, behind), value) in row.iter_mut().zip(behind.iter()).zip(value) {
                    *row = *row * pivot - backward * *behind;
                    *value -= *row;
                }
            } else {
                for (row, value) in row.iter_mut().zip(value) {
                    *row *= pivot;
                    *value -= *row;
                }
            }
        }
    }

    /// Smooths along each row; a row has one value for each node.
    pub fn along(&mut self, values: &mut [T]) {
        let nodes = self.pivots.len();
        let mut block = core::mem::take(&mut self.block);
        for rows in values.chunks_mut(nodes * BLOCK) {
            let count = rows.len() / nodes;
            block.resize(nodes * count, T::zero());
            for (r, row) in rows.chunks_exact(nodes).enumerate() {
                for (i, value) in row.iter().enumerate() {
                    block[i * count + r] = *value;
                }
            }
            self.across(&mut block, count);
            for (r, row) in rows.chunks_exact_mut(nodes).enumerate() {
                for (i, value) in row.iter_mut().enumerate() {
                    *value = block[i * count + r];
                }
            }
        }
        self.block = block;
    }
}
