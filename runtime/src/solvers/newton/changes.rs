//! Measures the change of the tangent along a stage.
//!
//! For two points, it uses the eigenvalues of the tangent at one point times the inverse of the first tangent, minus
//! the identity. They are independent of coordinates and units, so they also show changes in parts that move little and
//! along directions without motion. If all moduli are below one, the tangent is regular.
//!
//! Only coordinates without a natural scale are checked, because rotations turn with the motion.
//!
//! Takes tangents; gives the largest modulus of these eigenvalues.

use super::parts::Parts;
use crate::linalg::Dense;
use crate::scalar::largest;

/// The largest admissible change along a stage.
pub(super) const CHANGE: f64 = 0.75;

/// If the tangents at two points differ by more than this, a point in between is checked.
const DIFFERENCE: f64 = 0.125;

/// The number of pieces into which a stage is first divided, and the largest number of times that a piece is halved.
const PIECES: u8 = 4;
const HALVINGS: u8 = 6;

/// The number of times a matrix is squared. The norm of its eighth power is the eighth power of the largest eigenvalue,
/// up to a factor of a few.
const SQUARINGS: u8 = 3;

/// Changes relative to the tangent at the start of a stage.
pub(super) struct Changes<'a> {
    inverse: &'a Dense<f64>,
    /// The coordinates without a natural scale, and their units.
    units: Vec<(usize, f64)>,
}

impl<'a> Changes<'a> {
    /// Starts from the inverse of a tangent; `units` belong to the parts.
    pub(super) fn from(inverse: &'a Dense<f64>, units: &[f64], parts: &Parts) -> Self {
        let known = |x: f64| if x > 0.0 && x.is_finite() { x } else { 1.0 };
        let of = |k: usize| {
            let part = parts.part_of(k);
            let open = parts.open.get(part).copied().unwrap_or(false);
            let unit = units.get(part).copied().unwrap_or(1.0);
            open.then(|| (k, known(unit)))
        };
        Self {
            inverse,
            units: (0..parts.dimension()).filter_map(of).collect(),
        }
    }

    /// The largest change on the path to the tangent `end`; `tangent` gives the tangent at a fraction of the path.
    /// Stops as soon as a change is too large.
    pub(super) fn on_the_way(&self, tangent: &dyn Fn(f64) -> Dense<f64>, end: &Dense<f64>) -> f64 {
        let last = self.seen(end);
        let mut most = modulus(last.clone());
        let mut before = (0.0, Dense::zeros(last.rows, last.cols));
        for k in 1..=PIECES {
            // The comparison is false for NaN, so NaN counts as too large.
            let little = most <= CHANGE;
            if !little {
                break;
            }
            let share = f64::from(k) / f64::from(PIECES);
            let there = match k == PIECES {
                true => last.clone(),
                false => self.seen(&tangent(share)),
            };
            let there = (share, there);
            most = largest([most, self.between(tangent, [&before, &there], HALVINGS)]);
            before = there;
        }
        most
    }

    /// The largest change on a piece of the path, relative to the start of the stage.
    fn between(
        &self,
        tangent: &dyn Fn(f64) -> Dense<f64>,
        [from, to]: [&(f64, Dense<f64>); 2],
        halvings: u8,
    ) -> f64 {
        let most = modulus(to.1.clone());
        let looks = halvings > 0 && most <= CHANGE;
        if !looks || modulus(to.1.minus(&from.1)) <= DIFFERENCE {
            return most;
        }
        let share = 0.5 * (from.0 + to.0);
        let middle = (share, self.seen(&tangent(share)));
        let before = self.between(tangent, [from, &middle], halvings - 1);
        let after = self.between(tangent, [&middle, to], halvings - 1);
        largest([before, after])
    }

    /// The tangent times the inverse of the tangent at the start, minus the identity.
    fn seen(&self, tangent: &Dense<f64>) -> Dense<f64> {
        let less = self.inverse.times(tangent).minus_one();
        let size = self.units.len();
        Dense::from_fn(size, size, |i, j| {
            match (self.units.get(i), self.units.get(j)) {
                (Some((row, own)), Some((column, other))) => less.at(*row, *column) * (other / own),
                _ => 0.0,
            }
        })
    }
}

/// An upper estimate of the largest modulus of the eigenvalues; only a bound if it is small.
fn modulus(mut a: Dense<f64>) -> f64 {
    let mut size = a.squares().sqrt();
    let mut modulus = size;
    for squared in 1..=SQUARINGS {
        if modulus <= DIFFERENCE || !modulus.is_finite() {
            break;
        }
        a = a.scaled(1.0 / size);
        a = a.times(&a);
        size = a.squares().sqrt();
        modulus *= (0..squared).fold(size, |x, _| x.sqrt());
        if size == 0.0 {
            break;
        }
    }
    modulus
}
