//! One stage on the way to the principal root: from a point of the curve to another, within a region
//! that holds both.
//! Takes the equations, a point and the tangent there; gives how far the velocity moves, and the
//! point at the end.

use super::bounds::Region;
use super::node::Spread;
use super::principal::Equations;
use super::region::Strain;
use crate::groups::Group;
use crate::linalg::{balance, inverse_leading};
use nalgebra::{SMatrix, SVector};

/// Corrections by which a stage is solved.
const MOST_CORRECTIONS: usize = 12;

/// A stage is solved when its last correction is this part of the region, at most: that is
/// quadratic in what is left. Close to a fold rounding permits no less.
const SOLVED: f64 = 1e-6;

/// How much larger than what is needed a region is tried.
pub(super) const MARGIN: f64 = 1.6;

/// The beginning of a stage: a point of the curve.
#[derive(Clone, Copy)]
pub(super) struct Stage<G, const D: usize> {
    element: G,
    pub(super) residual: SVector<f64, D>,
    tangent: SMatrix<f64, D, D>,
    inverse: SMatrix<f64, D, D>,
}

impl<G: Group<f64>, const D: usize> Stage<G, D> {
    /// `None` where the tangent is singular or not finite.
    pub(super) fn at<E, const K: usize>(
        equations: &Equations<G, E, D, K>,
        element: G,
        residual: SVector<f64, D>,
    ) -> Option<Self> {
        let tangent = (equations.tangent)(&element);
        let inverse = scaled_inverse(&tangent, G::DIMENSION.min(D))?;
        Some(Self {
            element,
            residual,
            tangent,
            inverse,
        })
    }

    /// The inverse of the tangent.
    pub(super) fn inverse(&self) -> &SMatrix<f64, D, D> {
        &self.inverse
    }

    /// `B` times what the residual changes by on the way to `goal`.
    pub(super) fn toward(&self, goal: &SVector<f64, D>) -> SVector<f64, D> {
        self.inverse * (goal - self.residual)
    }

    /// What a length of each part is measured by: 1 for pure numbers; for translations the radius
    /// that makes them weigh as much as the angles of the same element.
    pub(super) fn units(&self) -> [f64; D] {
        let block = |b: usize| {
            let size = G::DIMENSION.min(D);
            let own = (0..size).filter(|k| G::part_of(*k) == b);
            own.fold(0.0, |most: f64, k| most.max(self.tangent[(k, k)].abs()))
        };
        let units: [f64; D] = core::array::from_fn(|b| {
            if b >= G::PARTS || G::is_pure(b) {
                return 1.0;
            }
            let unit = (block(b.saturating_sub(1)) / block(b)).sqrt();
            if unit.is_finite() { unit } else { 0.0 }
        });
        let size = G::DIMENSION.min(D);
        let entry = |i: usize, j: usize| self.tangent[(i, j)];
        let unit_of = |k: usize| units.get(G::part_of(k)).copied().unwrap_or(1.0);
        core::array::from_fn(|b| {
            if b >= G::PARTS || G::is_pure(b) || block(b) != 0.0 {
                return units[b];
            }
            let own = (0..size).filter(|k| G::part_of(*k) == b);
            of_multiplier(own, size, &entry, &unit_of)
        })
    }

    /// A bound of how far the velocity moves, part by part, where the equations move by `own`
    /// seen through `B`; holds if it does not exceed the radii. The strain besides.
    pub(super) fn move_within<E, const K: usize>(
        &self,
        equations: &Equations<G, E, D, K>,
        radii: &[f64; D],
        own: &[f64; D],
    ) -> (Option<[f64; D]>, f64)
    where
        E: Region<K, Centre = G>,
    {
        let whole = self.strain::<E, K>(equations, radii);
        let moved = whole.spread(own).and_then(|moved| {
            if fits::<G, D>(&moved, radii) {
                return Some(moved);
            }
            let half = self.strain::<E, K>(equations, &radii.map(|r| 0.5 * r));
            whole.mean(&half).spread(own)
        });
        (moved, whole.largest(radii))
    }

    /// The same with the tangent at one point in place of all of them.
    pub(super) fn move_foreseen<E, const K: usize>(
        &self,
        equations: &Equations<G, E, D, K>,
        toward: &SVector<f64, D>,
        radii: &[f64; D],
        own: &[f64; D],
    ) -> (Option<[f64; D]>, f64) {
        let whole = self.strain_at(equations, &(toward * MARGIN));
        let regular = whole.spread(own).is_some();
        let moved = whole.mean(&Strain::none::<G>()).spread(own);
        (moved.filter(|_| regular), whole.largest(radii))
    }

    /// The strain at one point.
    pub(super) fn strain_at<E, const K: usize>(
        &self,
        equations: &Equations<G, E, D, K>,
        toward: &SVector<f64, D>,
    ) -> Strain<D> {
        let there = self.element.retract(toward.as_slice());
        Strain::of::<G>(&(self.inverse * (equations.tangent)(&there)))
    }

    /// The strain over the region around this point.
    fn strain<E, const K: usize>(
        &self,
        equations: &Equations<G, E, D, K>,
        radii: &[f64; D],
    ) -> Strain<D>
    where
        E: Region<K, Centre = G>,
    {
        let region = E::around(&self.element, radii, 0);
        let tangent = (equations.enclosed)(Spread::HERE, &region);
        Strain::over::<E, K>(&self.inverse, &tangent, radii)
    }

    /// The only point of the region where the residual is `goal`.
    pub(super) fn solve<E, const K: usize>(
        &self,
        equations: &Equations<G, E, D, K>,
        first: &SVector<f64, D>,
        goal: &SVector<f64, D>,
        radii: &[f64; D],
    ) -> Option<G> {
        let mut at = self.element.retract(first.as_slice());
        for _ in 0..MOST_CORRECTIONS {
            let inverse = scaled_inverse(&(equations.tangent)(&at), G::DIMENSION.min(D))?;
            let step = inverse * (goal - (equations.residual)(&at));
            at = at.retract(step.as_slice());
            let own = lengths::<G, D>(&step);
            let parts = own.iter().zip(radii).take(G::PARTS);
            // Also refuses NaN.
            if parts.clone().all(|(x, r)| *x <= SOLVED * r) {
                let mut from = [0.0; D];
                self.element.inverse().compose(&at).extents(&mut from);
                return fits::<G, D>(&from, radii).then_some(at);
            }
        }
        None
    }
}

/// The unit of a part that stands in none of its own equations, as a multiplier does: what acts in the
/// equations of the others as one unit of theirs.
pub(super) fn of_multiplier(
    own: impl Iterator<Item = usize>,
    size: usize,
    entry: &dyn Fn(usize, usize) -> f64,
    unit_of: &dyn Fn(usize) -> f64,
) -> f64 {
    let mut unit = f64::INFINITY;
    for column in own {
        for k in 0..size {
            let like = entry(k, k).abs() * unit_of(k) / entry(k, column).abs();
            if like > 0.0 && like < unit {
                unit = like;
            }
        }
    }
    if unit.is_finite() { unit } else { 0.0 }
}

/// Whether no part exceeds its bound; false for NaN.
pub(super) fn fits<G: Group<f64>, const D: usize>(lengths: &[f64; D], bounds: &[f64; D]) -> bool {
    lengths
        .iter()
        .zip(bounds)
        .take(G::PARTS)
        .all(|(x, r)| x <= r)
}

/// The lengths of the parts.
pub(super) fn lengths<G: Group<f64>, const D: usize>(x: &SVector<f64, D>) -> [f64; D] {
    let mut squares = [0.0; D];
    for (k, x) in x.iter().enumerate().take(G::DIMENSION) {
        if let Some(square) = squares.get_mut(G::part_of(k)) {
            *square += x * x;
        }
    }
    squares.map(f64::sqrt)
}

/// The inverse of the leading block, its rows and columns brought to one size by powers of two:
/// the choice of pivots then does not depend on units.
fn scaled_inverse<const D: usize>(
    a: &SMatrix<f64, D, D>,
    size: usize,
) -> Option<SMatrix<f64, D, D>> {
    let scale: [f64; D] = core::array::from_fn(|i| balance(a[(i, i)]));
    let scaled = SMatrix::<f64, D, D>::from_fn(|i, j| a[(i, j)] * scale[i] * scale[j]);
    let inverse = inverse_leading(&scaled, size)?;
    let whole = SMatrix::<f64, D, D>::from_fn(|i, j| inverse[(i, j)] * scale[i] * scale[j]);
    whole.iter().all(|x| x.is_finite()).then_some(whole)
}
