//! The results of all lanes together, and the place where Newton's method may polish the principal root.
//! Takes the equations lane by lane; gives the principal roots where the solution is none in some lane.

use super::principal::{Equations, Fold, OnGroup, Traced, trace};
use crate::groups::Group;
use crate::scalar::{OfScalars, Real};

/// The principal root, in the only place where a solution may be polished.
#[derive(Clone, Copy, Debug)]
pub struct Anchor<G, const D: usize> {
    pub(super) root: G,
    reach: [f64; D],
}

impl<G: Copy, const D: usize> Anchor<G, D> {
    /// Whether the solution is in that place.
    #[cold]
    pub(super) fn holds<T>(self, solution: G) -> bool
    where
        G: Group<T>,
    {
        let from = self.root.inverse().compose(&solution);
        from.is_within(&self.reach)
    }
}

/// The results of all lanes together.
#[derive(Clone, Copy, Debug)]
pub struct Verdict<G, const D: usize> {
    anchor: Anchor<G, D>,
    elsewhere: bool,
    noise: [f64; D],
}

impl<G: Copy, const D: usize> Verdict<G, D> {
    /// No lane yet; `solution` is the element to judge.
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

    /// Looks at a lane: its root, where that is another than the solution.
    ///
    /// # Errors
    /// [`Fold`] where the lane has no principal root.
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

    /// The roots found so far, to be put right where a lane has another.
    pub fn root_mut(&mut self) -> &mut G {
        &mut self.anchor.root
    }

    /// The roots where the solution is none in some lane.
    #[must_use]
    pub fn elsewhere(self) -> Option<Anchor<G, D>> {
        self.elsewhere.then_some(self.anchor)
    }
}

/// The numbers of an element in one lane put into that of all lanes.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    list: [f64; 64],
    count: usize,
}

impl Numbers {
    /// Those of an element: an 8 x 8 matrix has the most.
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

    /// The same element over all lanes, this one put into its lane.
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
