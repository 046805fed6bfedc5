//! The bound on which every proof rests: how much the tangent of the equations changes while the
//! velocity moves over a region.
//! Takes the tangent in bounds; gives what that leaves of the inverse function.

use super::bounds::Region;
use crate::groups::Group;
use crate::scalar::{Enclosure, larger, largest};
use nalgebra::SMatrix;
use num_traits::Zero;

/// `|B DT(c) - 1|` part by part, the largest over a region around its centre, where `B` inverts
/// the tangent in the centre: entry `(a, b)` bounds what the coordinates of part `b` do to the
/// equations of part `a`.
///
/// As long as the spectral radius is below one, `T` is one-to-one on the region, which is convex in
/// the coordinates; and where the equations move along a straight line by `x = B dT` in all, the
/// velocity moves by no more than `(1 - e)^-1 |x|`, part by part, as long as it stays in the region.
/// Here the mean of `e` between the centre and the velocity will do. That is the theorem of Newton
/// and Kantorovich with a radius for each part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strain<const D: usize> {
    entries: [[f64; D]; D],
    parts: usize,
}

impl<const D: usize> Strain<D> {
    /// Of the region `|c| <= radii`, part by part, around the centre of the chart.
    ///
    /// `inverse` is `B`, `tangent` the derivative along the algebra at all elements of the region.
    pub(super) fn over<R: Region<K>, const K: usize>(
        inverse: &SMatrix<f64, D, D>,
        tangent: &SMatrix<Enclosure<K>, D, D>,
        radii: &[f64; D],
    ) -> Self {
        let size = R::Centre::DIMENSION.min(D);
        let none = Enclosure::exactly(0.0);
        let moves = tangent.map(|x| x.moved());
        let mut moved = SMatrix::<Enclosure<K>, D, D>::repeat(none);
        R::chart_tangent(radii, 0, &mut |k, j, x| {
            if k < size && j < size {
                let own = x.moved();
                for i in 0..size {
                    let factors = [&tangent[(i, k)], &x];
                    moved[(i, j)].add_product(factors, [moves[(i, k)], own]);
                }
            }
        });
        let mut strain = SMatrix::<Enclosure<K>, D, D>::repeat(none);
        for j in 0..size {
            for k in 0..size {
                // Bodies that do not touch one another.
                if moved[(k, j)].is_zero() {
                    continue;
                }
                for i in 0..size {
                    strain[(i, j)].add_times(&moved[(k, j)], inverse[(i, k)]);
                }
            }
            strain[(j, j)] -= Enclosure::exactly(1.0);
        }
        let mut bounds = Self::none::<R::Centre>();
        for (a, row) in bounds.entries.iter_mut().enumerate().take(bounds.parts) {
            for (b, entry) in row.iter_mut().enumerate().take(bounds.parts) {
                let norm = |of: &dyn Fn(&Enclosure<K>) -> f64| {
                    norm::<R::Centre, K, D>(&strain, [a, b], of)
                };
                // What does not move, then the vectors of three that it moves with.
                let mut bound = norm(&|x| x.middle().abs() + x.still() + x.rest());
                for first in (0..K).step_by(3) {
                    let three = first..(first + 3).min(K);
                    let squares = three.map(|k| norm(&|x| x.along(k).abs()).powi(2));
                    bound += squares.sum::<f64>().sqrt();
                }
                *entry = bound;
            }
        }
        bounds
    }

    /// None.
    pub(super) fn none<G: Group<f64>>() -> Self {
        Self {
            entries: [[0.0; D]; D],
            parts: G::PARTS.min(D),
        }
    }

    /// Of one point, where `B` times the tangent is this.
    pub(super) fn of<G: Group<f64>>(moved: &SMatrix<f64, D, D>) -> Self {
        let change = (moved - SMatrix::identity()).map(Enclosure::<0>::exactly);
        let mut strain = Self::none::<G>();
        for (a, row) in strain.entries.iter_mut().enumerate().take(strain.parts) {
            for (b, entry) in row.iter_mut().enumerate().take(strain.parts) {
                *entry = norm::<G, 0, D>(&change, [a, b], &|x| x.middle().abs());
            }
        }
        strain
    }

    /// The strain of the part that has the most, where all move by as much as their radii; NaN
    /// where it is not known.
    pub(super) fn largest(&self, radii: &[f64; D]) -> f64 {
        let moved = self.entries.iter().map(|row| {
            let pairs = row.iter().zip(radii).take(self.parts);
            pairs.map(|(e, r)| e * r).sum::<f64>()
        });
        let shares = moved.zip(radii).take(self.parts).map(|(x, r)| x / r);
        largest(shares)
    }

    /// A bound of the mean along lines from the centre, given the strain over half the region.
    pub(super) fn mean(&self, half: &Self) -> Self {
        let mut mean = *self;
        for (row, inner) in mean.entries.iter_mut().zip(&half.entries) {
            for (x, y) in row.iter_mut().zip(inner) {
                *x = 0.5 * (*x + y);
            }
        }
        mean
    }

    /// `(1 - e)^-1 lengths`, where the spectral radius of `e` is below one.
    pub(super) fn spread(&self, lengths: &[f64; D]) -> Option<[f64; D]> {
        let n = self.parts;
        let mut a = self.entries;
        for (i, row) in a.iter_mut().enumerate() {
            for (j, x) in row.iter_mut().enumerate() {
                *x = f64::from(u8::from(i == j)) - *x;
            }
        }
        // No exchange of rows: all pivots are positive if and only if the radius is below one.
        let mut y = *lengths;
        for k in 0..n {
            let pivot = a[k][k];
            // Also refuses NaN. What is left of a pivot must be more than rounding.
            let regular = pivot > 1e-6;
            if !regular {
                return None;
            }
            for i in k + 1..n {
                let factor = a[i][k] / pivot;
                let above = a[k];
                for (x, up) in a[i].iter_mut().zip(above).take(n).skip(k) {
                    *x -= factor * up;
                }
                y[i] -= factor * y[k];
            }
        }
        for k in (0..n).rev() {
            let mut sum = y[k];
            for j in k + 1..n {
                sum -= a[k][j] * y[j];
            }
            y[k] = sum / a[k][k];
        }
        y.iter().take(n).all(|x| x.is_finite()).then_some(y)
    }

    /// `(1 + e) lengths`: how far the equations may move with the velocity.
    pub(super) fn pull(&self, lengths: &[f64; D]) -> [f64; D] {
        let mut out = *lengths;
        for (x, row) in out.iter_mut().zip(&self.entries) {
            *x += row.iter().zip(lengths).map(|(e, l)| e * l).sum::<f64>();
        }
        out
    }
}

/// A bound of the spectral norm of one block of the matrix of absolute values: the square root of
/// the largest sum of a row times that of a column.
fn norm<G: Group<f64>, const K: usize, const D: usize>(
    matrix: &SMatrix<Enclosure<K>, D, D>,
    [a, b]: [usize; 2],
    of: &dyn Fn(&Enclosure<K>) -> f64,
) -> f64 {
    let size = G::DIMENSION.min(D);
    let mut columns = [0.0; D];
    let mut widest = 0.0;
    for i in (0..size).filter(|i| G::part_of(*i) == a) {
        let mut row = 0.0;
        for j in (0..size).filter(|j| G::part_of(*j) == b) {
            let x = of(&matrix[(i, j)]);
            row += x;
            columns[j] += x;
        }
        widest = larger(widest, row);
    }
    (widest * largest(columns)).sqrt()
}
