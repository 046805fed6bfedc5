//! What is known to be principal without another proof: velocities near rest, at nodes near one.
//! Takes what was found out lane by lane; gives a test that every step can afford.

use super::node::{NodeValues, Spread};
use super::principal::Traced;
use crate::groups::Group;
use crate::scalar::{OfScalars, Real};

/// Steps without a proof that lasts, after which one is looked for again.
const PATIENCE: u32 = 16;

/// Velocities that are principal roots: those whose coordinates do not exceed `reach`, part by
/// part, at nodes within `spread` of `node`.
#[derive(Clone, Copy, Debug)]
pub struct Certificate<V, const D: usize> {
    reach: [f64; D],
    node: Option<V>,
    spread: Spread,
    misses: u32,
}

impl<V, const D: usize> Certificate<V, D> {
    /// For nothing.
    #[must_use]
    pub fn none() -> Self {
        Self {
            reach: [0.0; D],
            node: None,
            spread: Spread::HERE,
            misses: 0,
        }
    }
}

impl<V: NodeValues, const D: usize> Certificate<V, D> {
    /// Whether a velocity that solves the equations at this node is the principal root.
    #[inline(always)]
    pub fn holds<G: Group<V::Scalar>>(&self, velocity: &G, values: &V) -> bool {
        let Some(node) = &self.node else {
            return false;
        };
        velocity.is_within(&self.reach) & values.is_near(node, self.spread)
    }

    /// Whether it is worth while to look for a proof that lasts.
    #[must_use]
    pub fn is_generous(&self) -> bool {
        self.misses.is_multiple_of(PATIENCE)
    }
}

/// A solution to be polished, in the only place where it may be.
#[derive(Clone, Copy, Debug)]
pub struct Anchor<G, const D: usize> {
    pub(super) root: G,
    pub(super) reach: [f64; D],
}

/// What was found out of all lanes together.
#[derive(Clone, Copy, Debug)]
pub struct Verdict<G, const D: usize> {
    anchor: Anchor<G, D>,
    elsewhere: bool,
    reach: [f64; D],
    spread: Spread,
}

impl<G: Copy, const D: usize> Verdict<G, D> {
    /// Of no lane yet; `solution` is what is asked about.
    #[must_use]
    pub fn about(solution: G) -> Self {
        Self {
            anchor: Anchor {
                root: solution,
                reach: [f64::INFINITY; D],
            },
            elsewhere: false,
            reach: [f64::INFINITY; D],
            spread: Spread {
                turned: true,
                share: f64::INFINITY,
            },
        }
    }

    /// Adds a lane; its root, where that is another than the solution.
    pub fn add<L>(&mut self, lane: Traced<L, D>) -> Option<L> {
        let least = |all: &mut [f64; D], own: [f64; D]| {
            for (x, y) in all.iter_mut().zip(own) {
                *x = x.min(y);
            }
        };
        match lane {
            Traced::Principal { reach, spread } => {
                least(&mut self.reach, reach);
                self.spread = self.spread.and(spread);
                None
            }
            Traced::Elsewhere { root, reach } => {
                self.elsewhere = true;
                least(&mut self.anchor.reach, reach);
                Some(root)
            }
        }
    }

    /// The roots found so far, to be put right where a lane has another.
    pub fn root_mut(&mut self) -> &mut G {
        &mut self.anchor.root
    }

    /// Renews the certificate; gives the roots where the solution is none in some lane.
    pub fn close<V: NodeValues>(
        self,
        certificate: &mut Certificate<V, D>,
        values: &V,
    ) -> Option<Anchor<G, D>> {
        if self.elsewhere {
            certificate.misses = certificate.misses.wrapping_add(1);
            return Some(self.anchor);
        }
        let lasts = self.reach.first().is_some_and(|x| *x > 0.0);
        if lasts {
            *certificate = Certificate {
                reach: self.reach,
                node: Some(*values),
                spread: self.spread,
                misses: 0,
            };
        } else {
            certificate.misses = certificate.misses.wrapping_add(1);
        }
        None
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
