//! What is known to be principal without another proof: velocities near rest, at nodes near one.
//! Takes what was found out lane by lane; gives a test that every step can afford.

use super::node::{NodeValues, Spread};
use super::principal::{Care, Traced};
use crate::groups::Group;
use crate::linalg::Factors;
use crate::saved::{Saved, Words, optional};
use crate::scalar::{OfScalars, Real};

/// Steps without a proof that lasts, after which one is looked for again.
pub(super) const PATIENCE: u32 = 16;

/// What a factored tangent serves for: nodes as near to its own as this part of their values. The
/// root that it leads to is near the one foreseen: another is only met with new tangents.
pub(super) const DRIFT: f64 = 0.25;

/// Steps for which a proof made at one node serves where the tangent is another at every node.
pub(super) const LASTS: u32 = 65536;

/// By how much the inverse of a later tangent may be larger than that at the proof, and what two
/// parts may have in common besides, as a share of what each has by itself.
pub(super) const LARGER: f64 = 1.5;
pub(super) const COMMON: f64 = 0.2;

/// Velocities that are principal roots: those whose coordinates do not exceed `reach`, part by
/// part. Where the tangent is the same at every node, that is proved once for all steps.
///
/// Elsewhere it is proved at `node`, and anew after 65536 steps. In between it serves at nodes
/// within `spread` of this one where the inverse of the tangent does not exceed `inverse`, part by
/// part, which each new tangent is asked: the tangent moves with the velocity by the same order of
/// magnitude everywhere, and where a fold comes near its inverse grows. A proof for each step costs
/// a hundred times the step; where none is found, its root is followed closely instead.
#[derive(Clone, Copy, Debug)]
pub struct Certificate<V, const D: usize> {
    reach: [f64; D],
    node: Option<V>,
    spread: Spread,
    inverse: [[f64; D]; D],
    /// The node of the tangent factored last.
    factored: Option<V>,
    /// Whether its inverse is bounded so.
    bounded: bool,
    /// Whether it is too far from the node at hand to serve there.
    stale: bool,
    /// For how many steps more.
    left: u32,
    misses: u32,
    purpose: Purpose,
}

impl<V: NodeValues + Saved, const D: usize> Saved for Certificate<V, D> {
    fn words(&mut self, words: &mut Words) {
        let Self {
            reach,
            node,
            spread,
            inverse,
            factored,
            bounded,
            stale,
            left,
            misses,
            // Steps are made to go on from there.
            purpose: _,
        } = self;
        reach.words(words);
        optional(node, words, || Some(V::blank()));
        spread.words(words);
        inverse.words(words);
        optional(factored, words, || Some(V::blank()));
        bounded.words(words);
        stale.words(words);
        left.words(words);
        misses.words(words);
    }
}

/// What steps are made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// To go on from there.
    Run,
    /// To offer this one instead of one refused.
    Offer,
    /// To find out which one to offer: the roots are followed, not proved.
    Trial,
}

impl<V, const D: usize> Certificate<V, D> {
    /// For nothing.
    #[must_use]
    pub fn none() -> Self {
        Self {
            reach: [0.0; D],
            node: None,
            spread: Spread::HERE,
            inverse: [[f64::NAN; D]; D],
            factored: None,
            bounded: false,
            stale: false,
            left: 0,
            misses: 0,
            purpose: Purpose::Run,
        }
    }

    /// For nothing, where one step is tried.
    #[must_use]
    pub(super) fn to_try() -> Self {
        Self {
            purpose: Purpose::Trial,
            ..Self::none()
        }
    }

    /// For nothing, with the same purpose.
    #[must_use]
    pub(super) fn alike<W, const E: usize>(&self) -> Certificate<W, E> {
        Certificate {
            purpose: self.purpose,
            ..Certificate::none()
        }
    }

    /// For nothing, where one step is to be offered.
    #[must_use]
    pub(super) fn to_offer() -> Self {
        Self {
            purpose: Purpose::Offer,
            ..Self::none()
        }
    }
}

impl<V: NodeValues, const D: usize> Certificate<V, D> {
    /// Whether a velocity that solves the equations at this node is the principal root.
    #[inline(always)]
    pub(super) fn holds<G: Group<V::Scalar>>(&self, velocity: &G, values: &V) -> bool {
        let Some(node) = &self.node else {
            return false;
        };
        let everywhere = !V::ANY;
        velocity.is_within(&self.reach)
            && (everywhere || self.bounded && self.left > 0 && values.is_near(node, self.spread))
    }

    /// Whether a tangent must be factored before it can hold at this node.
    #[inline(always)]
    pub(super) fn wants_tangent(&mut self, values: &V) -> bool {
        let served = |at: &V| self.bounded && values.is_near(at, Spread::drifted(DRIFT));
        self.stale = V::ANY && self.node.is_some() && !self.factored.as_ref().is_some_and(served);
        self.stale
    }

    /// Before a proof with this tangent: until there is one, nothing holds.
    #[cold]
    pub(super) fn ask<T: Real, G: Group<T>, const K: usize>(&mut self, factors: &Factors<T, K>) {
        // Where some unknowns are solved for beforehand the tangent is the same at every node.
        if !V::ANY || K != D {
            return;
        }
        let now = factors.inverse_bounds(G::part_of);
        self.inverse = core::array::from_fn(|a| {
            core::array::from_fn(|b| LARGER * now[a][b] + COMMON * (now[a][a] * now[b][b]).sqrt())
        });
        self.left = 0;
    }

    /// Counts a step.
    #[inline(always)]
    pub(super) fn count(&mut self) {
        self.left = self.left.saturating_sub(1);
    }

    /// Takes note of a tangent that was factored at a trial, where the one noted last does not serve.
    #[inline(always)]
    pub(super) fn note<T: Real, G: Group<T>, const K: usize>(
        &mut self,
        factors: &Factors<T, K>,
        trial: &G,
        values: &V,
    ) {
        if !V::ANY || !self.stale {
            return;
        }
        let found = factors.inverse_bounds(G::part_of);
        let mut bounded = trial.is_within(&self.reach);
        for (own, most) in found.iter().zip(&self.inverse).take(G::PARTS) {
            for (x, most) in own.iter().zip(most).take(G::PARTS) {
                // NaN is not bounded.
                bounded &= x <= most;
            }
        }
        self.factored = Some(*values);
        self.bounded = bounded;
    }

    /// Whether no step follows.
    pub(super) fn tries(&self) -> bool {
        self.purpose != Purpose::Run
    }

    /// What the step at hand is worth: a proof that lasts where one may be found and will be used.
    #[must_use]
    pub fn care(&self) -> Care {
        Care {
            lasting: !self.tries() && self.misses.is_multiple_of(PATIENCE),
            everywhere: !V::ANY,
            proved: self.purpose != Purpose::Trial,
        }
    }
}

/// A solution to be polished, in the only place where it may be.
#[derive(Clone, Copy, Debug)]
pub struct Anchor<G, const D: usize> {
    pub(super) root: G,
    pub(super) reach: [f64; D],
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
    ) -> Option<Anchor<G, D>>
    where
        G: Group<V::Scalar>,
    {
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
                factored: Some(*values),
                bounded: true,
                left: LASTS,
                misses: 0,
                ..*certificate
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
