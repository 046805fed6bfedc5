//! Equations in which some unknowns are eliminated in closed form; Newton's method finds the others. Takes an element
//! with all unknowns; gives the unknowns that Newton's method finds.

use super::parts::{SlowPartTest, comes_near, with_kinds};
use super::{Newton, Progress, Solved};
use crate::groups::{Group, RigidMotion, Rotation};
use crate::linalg::Factors;
use crate::saved::{Saved, Words};
use crate::scalar::Real;
use core::marker::PhantomData;
use nalgebra::{SMatrix, SVector};

/// The inverse of the tangent of all equations at rest, if some unknowns are eliminated. It is the same at every node.
#[derive(Clone, Copy, Debug)]
pub(super) struct AtRest<T, W, const E: usize> {
    inverse: SMatrix<T, E, E>,
    units: [f64; E],
    known: bool,
    whole: PhantomData<W>,
}

impl<T: Real, W, const E: usize> AtRest<T, W, E> {
    pub(super) fn unknown() -> Self {
        Self {
            inverse: SMatrix::zeros(),
            units: [1.0; E],
            known: false,
            whole: PhantomData,
        }
    }

    #[cold]
    fn set(&mut self, tangent: &SMatrix<T, E, E>)
    where
        W: Group<T>,
    {
        let units = &mut self.units[..W::PARTS.min(E)];
        let entry = |i, j| tangent[(i, j)].lane(0);
        with_kinds::<T, W, _, E>(|kinds| kinds.units_into(&entry, SlowPartTest::OfStep, units));
        let mut factors = Factors::none();
        factors.set(tangent, W::DIMENSION);
        for (k, mut column) in self.inverse.column_iter_mut().enumerate() {
            let axis = SVector::from_fn(|i, _| if i == k { T::one() } else { T::zero() });
            let unknown = || SVector::repeat(T::from_f64(f64::NAN));
            column.copy_from(&factors.solve(&axis).unwrap_or_else(unknown));
        }
        self.known = true;
    }
}

impl<W, const E: usize> Saved for AtRest<f64, W, E> {
    fn words(&mut self, words: &mut Words) {
        let Self {
            inverse,
            units,
            known,
            whole: _,
        } = self;
        inverse.words(words);
        units.words(words);
        known.words(words);
    }
}

/// The part of an element that Newton's method finds; the remaining unknowns follow from it.
pub trait Found<W> {
    /// Extracts this part.
    fn within(whole: &W) -> Self;
}

impl<G: Copy> Found<G> for G {
    #[inline(always)]
    fn within(whole: &G) -> G {
        *whole
    }
}

impl<T: Copy> Found<RigidMotion<T>> for Rotation<T> {
    #[inline(always)]
    fn within(whole: &RigidMotion<T>) -> Self {
        whole.rotation
    }
}

impl<T: Copy, const N: usize> Found<[RigidMotion<T>; N]> for [Rotation<T>; N] {
    #[inline(always)]
    fn within(whole: &[RigidMotion<T>; N]) -> Self {
        core::array::from_fn(|i| whole[i].rotation)
    }
}

impl<T: Real, G, const D: usize, W: Group<T>, const E: usize> Newton<'_, T, G, D, W, E>
where
    G: Group<T> + Found<W>,
{
    /// Whether the residual is needed. At the last trial, only the remaining unknowns are.
    #[inline(always)]
    pub fn wants_residual(&self) -> bool {
        self.found.is_none()
    }

    /// Like [`correct`](Newton::correct), if some unknowns are eliminated; `whole` is the trial with all unknowns.
    #[inline(always)]
    pub fn correct_part(&mut self, whole: W) -> Progress<W> {
        self.completed(whole, Newton::correct)
    }

    /// Like `correct_part`, for [`correct_from_left`](Newton::correct_from_left).
    #[inline(always)]
    pub fn correct_part_from_left(&mut self, whole: W) -> Progress<W> {
        self.completed(whole, Newton::correct_from_left)
    }

    /// [`is_principal`](Newton::is_principal) for all unknowns: `tangent` is the tangent of all equations at rest.
    #[inline(always)]
    pub fn is_part_of_principal(
        &mut self,
        solution: &W,
        at_rest: &SVector<T, E>,
        tangent: impl FnOnce() -> SMatrix<T, E, E>,
    ) -> bool {
        let rest = &mut self.search.whole;
        if !rest.known {
            rest.set(&tangent());
        }
        let correction = rest.inverse * at_rest;
        comes_near(&correction, solution, &rest.units, &[0.0; E]) || self.is_anchored(solution)
    }

    #[inline(always)]
    fn completed(
        &mut self,
        element: W,
        correct: impl FnOnce(&mut Self) -> Progress<G>,
    ) -> Progress<W> {
        let found = match self.polished() {
            true if self.is_outdated() => return Progress::Continue,
            true => Some(self.iteration),
            false => self.found,
        };
        if let Some(iterations) = found {
            return Progress::Solved(Solved {
                element,
                iterations,
                residual: self.size,
            });
        }
        match correct(self) {
            Progress::Continue => Progress::Continue,
            // The eliminated unknowns of this solution are computed at the next trial.
            Progress::Solved(solved) => {
                self.found = Some(solved.iterations);
                Progress::Continue
            }
            Progress::Failed(e) => Progress::Failed(e),
        }
    }
}
