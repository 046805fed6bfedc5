//! Equations of which some unknowns are solved for beforehand, in closed form: Newton's method finds the
//! others, and a proof that the root is principal is of all of them together.
//! Takes an element with all unknowns; gives the part that is searched for.

use super::{Newton, NodeValues, Progress, Solved};
use crate::groups::{Group, RigidMotion, Rotation};
use crate::scalar::Real;

/// The part of an element that Newton's method finds, where the rest follows from it.
pub trait Found<W> {
    /// That part.
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

impl<T: Real, G, V: NodeValues<Scalar = T>, const D: usize, W: Group<T>, const E: usize>
    Newton<'_, T, G, V, D, W, E>
where
    G: Group<T> + Found<W>,
{
    /// Whether the residual is wanted: not at the last trial, whose rest alone is.
    #[inline(always)]
    pub fn wants_residual(&self) -> bool {
        self.found.is_none()
    }

    /// [`correct`](Newton::correct) where the rest of a solution follows from what is found: `whole` is
    /// the trial with its rest.
    #[inline(always)]
    pub fn correct_part(&mut self, whole: W) -> Progress<W> {
        self.completed(whole, Newton::correct)
    }

    /// The same of [`correct_from_left`](Newton::correct_from_left).
    #[inline(always)]
    pub fn correct_part_from_left(&mut self, whole: W) -> Progress<W> {
        self.completed(whole, Newton::correct_from_left)
    }

    #[inline(always)]
    fn completed(
        &mut self,
        element: W,
        correct: impl FnOnce(&mut Self) -> Progress<G>,
    ) -> Progress<W> {
        let found = match self.polished() {
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
            // What was corrected last has its rest at the next trial.
            Progress::Solved(solved) => {
                self.found = Some(solved.iterations);
                Progress::Continue
            }
            Progress::Failed(e) => Progress::Failed(e),
        }
    }
}
