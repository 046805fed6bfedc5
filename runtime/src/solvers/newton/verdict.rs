//! Checks that the solution of a step is the principal root: a quick test in every step and, if it fails, a trace of
//! each lane. Takes the residual at rest, then the equations lane by lane; gives the principal roots if the solution
//! differs from them in some lane.

use super::parts::{comes_near, varies_little};
use super::principal::{Equations, Fold, OnGroup, Traced, trace};
use super::{Found, LAST_ATTEMPT, Newton, OLDEST_TANGENT};
use crate::groups::Group;
use crate::scalar::{OfScalars, Real};
use nalgebra::SVector;

impl<T: Real, G, const D: usize, W: Group<T>, const E: usize> Newton<'_, T, G, D, W, E>
where
    G: Group<T> + Found<W>,
{
    /// Whether the solution is the principal root: either it is connected to rest, where the residual is `at_rest`, or
    /// the search began at the traced principal root and stayed near it.
    #[inline(always)]
    pub fn is_principal(
        &self,
        solution: &W,
        at_rest: &SVector<T, D>,
        residual: impl Fn(&G) -> SVector<T, D>,
    ) -> bool {
        self.follows(&G::within(solution), at_rest, residual) || self.is_anchored(solution)
    }

    /// Whether the search began at the traced principal root and the solution is within its reach.
    #[inline(always)]
    pub(super) fn is_anchored(&self, solution: &W) -> bool {
        self.anchor
            .is_some_and(|anchor| anchor.holds::<T>(*solution))
    }

    /// Whether the first correction from rest, with the current tangent, leaves at most a quarter of the distance to
    /// the solution, in every part and every lane. The second correction would then be that small, too.
    #[inline(always)]
    fn follows(
        &self,
        solution: &G,
        at_rest: &SVector<T, D>,
        residual: impl Fn(&G) -> SVector<T, D>,
    ) -> bool {
        let search = &*self.search;
        let Some(correction) = search.factors.solve(&(at_rest * search.unit)) else {
            return false;
        };
        let (units, noise) = (&search.units, &search.noise);
        if !comes_near(&correction, solution, units, noise) {
            return false;
        }
        let left = |share: f64, at: &G| {
            let goal = at_rest * T::from_f64(1.0 - share);
            search.factors.solve(&((residual(at) - goal) * search.unit))
        };
        !search.open || varies_little(&correction, solution, left, units, noise)
    }

    /// The verdict on a solution, or on a missing one, before any lane is traced.
    #[cold]
    pub fn verdict(&mut self, solution: Option<&W>) -> Verdict<W, E> {
        // An old tangent may be the reason that the test failed.
        self.search.age = OLDEST_TANGENT;
        let noise = core::array::from_fn(|b| match E == D {
            true => self.search.noise.get(b).copied().unwrap_or(0.0),
            false => 0.0,
        });
        Verdict::about(solution.copied().unwrap_or_else(W::identity), noise)
    }

    /// Restarts from the principal root. Returns false if the iteration already did so, because then the root cannot be
    /// polished.
    #[cold]
    pub fn restart(&mut self, anchor: Anchor<W, E>) -> bool {
        if self.anchor.is_some() {
            return false;
        }
        self.attempt = LAST_ATTEMPT;
        self.begin_at(G::within(&anchor.root));
        self.anchor = Some(anchor);
        true
    }
}

/// The principal root, and the distance within which a polished solution must stay.
#[derive(Clone, Copy, Debug)]
pub struct Anchor<G, const D: usize> {
    pub(super) root: G,
    reach: [f64; D],
}

impl<G: Copy, const D: usize> Anchor<G, D> {
    /// Whether the solution is within reach of the root.
    #[cold]
    pub(super) fn holds<T>(self, solution: G) -> bool
    where
        G: Group<T>,
    {
        let from = self.root.inverse().compose(&solution);
        from.is_within(&self.reach)
    }
}

/// The combined results of all lanes.
#[derive(Clone, Copy, Debug)]
pub struct Verdict<G, const D: usize> {
    anchor: Anchor<G, D>,
    elsewhere: bool,
    noise: [f64; D],
}

impl<G: Copy, const D: usize> Verdict<G, D> {
    /// The state before any lane is traced; `solution` is the element to judge.
    pub(super) fn about(solution: G, noise: [f64; D]) -> Self {
        Self {
            anchor: Anchor {
                root: solution,
                reach: [f64::INFINITY; D],
            },
            elsewhere: false,
            noise,
        }
    }

    /// Traces a lane; returns its principal root if the solution differs from it.
    ///
    /// # Errors
    /// [`Fold`] if the principal root of the lane does not exist.
    pub fn trace<L: Group<f64>>(
        &mut self,
        lane: usize,
        equations: &Equations<L, D>,
        solution: Option<&L>,
    ) -> Result<Option<L>, Fold> {
        let curve = OnGroup::new(equations, self.noise);
        match trace(&curve, solution).map_err(|fold| fold.in_lane(lane))? {
            Traced::Principal => Ok(None),
            Traced::Elsewhere { root, reach } => {
                self.elsewhere = true;
                for (least, own) in self.anchor.reach.iter_mut().zip(reach) {
                    *least = least.min(own);
                }
                Ok(Some(root))
            }
        }
    }

    /// The element that collects the roots. Overwrite a lane if its root differs from the solution.
    pub fn root_mut(&mut self) -> &mut G {
        &mut self.anchor.root
    }

    /// The roots, if the solution differs in some lane.
    #[must_use]
    pub fn elsewhere(self) -> Option<Anchor<G, D>> {
        self.elsewhere.then_some(self.anchor)
    }
}

/// The numbers of an element in one lane, to be copied into an element with all lanes.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    list: [f64; 64],
    count: usize,
}

impl Numbers {
    /// Reads the numbers of an element, at most the 64 numbers of an 8 x 8 matrix.
    pub fn of<X: OfScalars<Scalar = f64>>(element: &X) -> Self {
        let mut numbers = Self {
            list: [0.0; 64],
            count: 0,
        };
        let _ = element.over(&mut |x: f64| {
            if let Some(place) = numbers.list.get_mut(numbers.count) {
                *place = x;
            }
            numbers.count += 1;
            x
        });
        numbers
    }

    /// A function that overwrites one lane of an element with all lanes, number by number.
    pub fn put<T: Real>(&self, lane: usize) -> impl FnMut(T) -> T {
        let mut place = 0;
        move |mut x: T| {
            let own = self.list.get(place).copied().unwrap_or(f64::NAN);
            x.set_lane(lane, T::One::from_f64(own));
            place += 1;
            x
        }
    }
}
