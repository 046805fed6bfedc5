//! The bound on which every proof rests: how much the tangent of the equations changes while the
//! velocity moves over a region.
//! Takes the tangent in bounds; gives what that leaves of the inverse function.

use super::curve::{Enclosed, Parts, add_product, add_times, less_one, moved};
use crate::linalg::Dense;
use crate::scalar::{larger, largest};

/// `|B DT(c) - 1|` part by part, the largest over a region around its centre, where `B` inverts
/// the tangent in the centre: entry `(a, b)` bounds what the coordinates of part `b` do to the
/// equations of part `a`.
///
/// As long as the spectral radius is below one, `T` is one-to-one on the region, which is convex in
/// the coordinates; and where the equations move along a straight line by `x = B dT` in all, the
/// velocity moves by no more than `(1 - e)^-1 |x|`, part by part, as long as it stays in the region.
/// Here the mean of `e` between the centre and the velocity will do. That is the theorem of Newton
/// and Kantorovich with a radius for each part.
#[derive(Clone, Debug)]
pub(super) struct Strain {
    /// Part by part.
    entries: Vec<Vec<f64>>,
}

impl Strain {
    /// Of the region `|c| <= radii`, part by part, around the centre of the chart.
    ///
    /// `inverse` is `B`, `tangent` the derivative along the algebra at all elements of the region.
    pub(super) fn over(parts: &Parts, inverse: &Dense<f64>, tangent: &Enclosed) -> Self {
        let (size, width) = (tangent.dimension(), tangent.width());
        let place = |i: usize, j: usize| {
            let from = (i * size + j) * width;
            from..from + width
        };
        let mut moves = Vec::with_capacity(size * size);
        for i in 0..size {
            moves.extend((0..size).map(|j| moved(tangent.tangent(i, j))));
        }
        let mut turned = vec![0.0; size * size * width];
        for ((k, j), x) in tangent.chart() {
            let own = moved(x);
            for i in 0..size {
                let Some(sum) = turned.get_mut(place(i, j)) else {
                    continue;
                };
                let most = moves.get(i * size + k).copied().unwrap_or(f64::NAN);
                add_product(sum, [tangent.tangent(i, k), x], [most, own]);
            }
        }
        let mut strain = vec![0.0; size * size * width];
        for j in 0..size {
            for k in 0..size {
                let x = turned.get(place(k, j)).unwrap_or(&[]);
                // Bodies that do not touch one another.
                if x.iter().all(|x| *x == 0.0) {
                    continue;
                }
                for i in 0..size {
                    if let Some(sum) = strain.get_mut(place(i, j)) {
                        add_times(sum, x, inverse.at(i, k));
                    }
                }
            }
            if let Some(x) = strain.get_mut(place(j, j)) {
                less_one(x);
            }
        }
        let at = |i: usize, j: usize| strain.get(place(i, j)).unwrap_or(&[]);
        let along = |k: usize| {
            move |x: &[f64]| {
                let along = x.get(3 + k).copied();
                along.unwrap_or(0.0).abs()
            }
        };
        Self::each(parts, |a, b| {
            let norm = |of: &dyn Fn(&[f64]) -> f64| norm(parts, [a, b], &|i, j| of(at(i, j)));
            // What does not move, then the vectors of three that it moves with.
            let mut bound = norm(&|x| match x {
                [middle, still, rest, ..] => middle.abs() + still + rest,
                _ => f64::NAN,
            });
            for first in (0..tangent.variables()).step_by(3) {
                let three = first..(first + 3).min(tangent.variables());
                let squares = three.map(|k| norm(&along(k)).powi(2));
                bound += squares.sum::<f64>().sqrt();
            }
            bound
        })
    }

    fn each(parts: &Parts, entry: impl Fn(usize, usize) -> f64) -> Self {
        let count = parts.count();
        let row = |a: usize| (0..count).map(|b| entry(a, b)).collect();
        Self {
            entries: (0..count).map(row).collect(),
        }
    }

    /// None.
    pub(super) fn none(parts: &Parts) -> Self {
        Self::each(parts, |_, _| 0.0)
    }

    /// Of one point, where `B` times the tangent is this.
    pub(super) fn of(parts: &Parts, moved: &Dense<f64>) -> Self {
        let change = moved.minus_one();
        Self::each(parts, |a, b| {
            norm(parts, [a, b], &|i, j| change.at(i, j).abs())
        })
    }

    /// The strain of the part that has the most, where all move by as much as their radii; NaN
    /// where it is not known.
    pub(super) fn largest(&self, radii: &[f64]) -> f64 {
        let moved = self.entries.iter().map(|row| {
            let pairs = row.iter().zip(radii);
            pairs.map(|(e, r)| e * r).sum::<f64>()
        });
        largest(moved.zip(radii).map(|(x, r)| x / r))
    }

    /// A bound of the mean along lines from the centre, given the strain over half the region.
    pub(super) fn mean(&self, half: &Self) -> Self {
        let mut mean = self.clone();
        for (row, inner) in mean.entries.iter_mut().zip(&half.entries) {
            for (x, y) in row.iter_mut().zip(inner) {
                *x = 0.5 * (*x + y);
            }
        }
        mean
    }

    /// `(1 - e)^-1 lengths`, where the spectral radius of `e` is below one.
    pub(super) fn spread(&self, lengths: &[f64]) -> Option<Vec<f64>> {
        let n = self.entries.len();
        let mut a = self.entries.clone();
        for (i, row) in a.iter_mut().enumerate() {
            for (j, x) in row.iter_mut().enumerate() {
                *x = f64::from(u8::from(i == j)) - *x;
            }
        }
        // No exchange of rows: all pivots are positive if and only if the radius is below one.
        let mut y = lengths.to_vec();
        for k in 0..n {
            let pivot = a[k][k];
            // Also refuses NaN. What is left of a pivot must be more than rounding.
            let regular = pivot > 1e-6;
            if !regular {
                return None;
            }
            let (above, below) = a.split_at_mut(k + 1);
            let above = &above[k];
            for (i, row) in below.iter_mut().enumerate() {
                let factor = row[k] / pivot;
                for (x, up) in row.iter_mut().zip(above).skip(k) {
                    *x -= factor * up;
                }
                y[k + 1 + i] -= factor * y[k];
            }
        }
        for k in (0..n).rev() {
            let mut sum = y[k];
            for j in k + 1..n {
                sum -= a[k][j] * y[j];
            }
            y[k] = sum / a[k][k];
        }
        y.iter().all(|x| x.is_finite()).then_some(y)
    }

    /// `(1 + e) lengths`: how far the equations may move with the velocity.
    pub(super) fn pull(&self, lengths: &[f64]) -> Vec<f64> {
        let mut out = lengths.to_vec();
        for (x, row) in out.iter_mut().zip(&self.entries) {
            *x += row.iter().zip(lengths).map(|(e, l)| e * l).sum::<f64>();
        }
        out
    }
}

/// A bound of the spectral norm of one block of a matrix of absolute values: the square root of
/// the largest sum of a row times that of a column.
fn norm(parts: &Parts, [a, b]: [usize; 2], of: &dyn Fn(usize, usize) -> f64) -> f64 {
    let mut columns = vec![0.0; parts.dimension()];
    let mut widest = 0.0;
    for i in parts.own(a) {
        let mut row = 0.0;
        for j in parts.own(b) {
            let x = of(i, j);
            row += x;
            if let Some(column) = columns.get_mut(j) {
                *column += x;
            }
        }
        widest = larger(widest, row);
    }
    (widest * largest(columns)).sqrt()
}
