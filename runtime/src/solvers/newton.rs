//! Newton's method on a Lie group, for implicit steps without a closed form. Takes an initial guess or previous
//! solutions, the residual and its tangent; gives a converged element or an error.

mod any_size;
mod changes;
mod checked_points;
mod continuation_stage;
mod corrections;
mod failure;
mod parts;
pub(crate) mod principal;
mod reduced;
mod saved;
mod scale;
mod single_equation;
mod verdict;

pub use crate::scalar::Rounded;
pub use any_size::{AnyNewton, AnySearch, Chart, Lane, Settled};
pub use failure::{NewtonError, NewtonFailure};
pub use parts::Parts;
use parts::{squares, with_kinds};
pub use principal::{Equations, Fold};
pub use reduced::Found;
pub use single_equation::solve;
pub use verdict::{Anchor, Numbers, Verdict};

use crate::groups::Group;
use crate::linalg::Factors;
use crate::scalar::Real;
use corrections::{Corrections, NextAction, Residual};
use nalgebra::{SMatrix, SVector};
use reduced::AtRest;

/// The largest number of iterations; quadratic convergence needs fewer than ten.
const MOST_ITERATIONS: usize = 50;

/// A residual counts as zero below this many roundings of the terms of its equation. A residual is a sum of about ten
/// rounded products.
const CONVERGED_ROUNDINGS: f64 = 16.0;

/// Below this the residual is pure rounding, and another step would only change the rounding.
const POLISHED_ROUNDINGS: f64 = 4.0;

/// Two evaluations may differ by twice their bounds of rounding, [`BOUND_ROUNDINGS`] each. If the
/// residual stops decreasing below this, the cause is rounding.
const STAGNATED_ROUNDINGS: f64 = 64.0;

/// The assumed bound of an equation's rounding, in roundings of its terms.
const BOUND_ROUNDINGS: f64 = 8.0;

/// The sizes of the terms are recomputed after this many steps, because they vary little along a trajectory.
const OLDEST_SCALE: u32 = 256;

/// The sizes of the terms are also recomputed after this many iterations, because the terms may have grown.
const LATE: usize = 8;

/// A factored tangent is reused while each correction reduces the residual below this fraction. Otherwise a tangent at
/// the new trial is cheaper.
const WORTH_KEEPING: f64 = 0.02;

/// A tangent younger than this many steps still reduces a residual at rounding level. By then it has rotated with the
/// motion by a few step angles.
const OLDEST_TANGENT: u32 = 8;

/// The next residual may exceed its prediction, from the rate of the last correction, by at most this factor.
const FORESIGHT: f64 = 4.0;

/// A converged solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solved<G> {
    /// The group element that solves the equation.
    pub element: G,
    /// The number of Newton steps, including the polishing step.
    pub iterations: usize,
    /// The residual before the last step relative to the size of its terms: the maximum over equations and lanes.
    pub residual: f64,
}

/// The index of an attempt after which no other follows.
const LAST_ATTEMPT: u32 = 2;

/// If the terms of an equation are smaller than this fraction of the terms of similar equations, the similar equations
/// set its scale.
const LEAST_SHARE: f64 = 1e-30;

/// The number of solutions from which the next guess is extrapolated.
const REMEMBERED: usize = 6;

/// Finds the velocities along a trajectory. It stores the last solutions and predicts the next one from them, to sixth
/// order in the step.
///
/// The stored solutions affect the number of iterations and the rounding of a step, not the equations. If some unknowns
/// are eliminated in closed form, `W` is the group of all unknowns and `E` is their number.
#[derive(Clone, Copy, Debug)]
pub struct Search<T, G, const D: usize, W = G, const E: usize = D> {
    /// A ring buffer, stored twice in a row. The newest solution is at `newest`.
    past: [G; 2 * REMEMBERED],
    newest: usize,
    known: usize,
    /// The node of the step after the newest solution.
    next: u64,
    /// For each equation, the inverse of the size of its terms.
    weights: SVector<T, D>,
    /// For each coordinate, the inverse length of its part of the velocity.
    lengths: SVector<T, D>,
    /// For each part, the square of the length below which `weights` and `lengths` are too old.
    shortest: [T; D],
    /// The number of steps since `weights` and `lengths` were computed.
    weighed: u32,
    /// The unit of length of each part, and the rounding error of its length.
    units: [f64; D],
    noise: [f64; D],
    /// Whether some part lacks a natural scale.
    open: bool,
    /// Whether the units were computed after the sizes of the terms.
    measured: bool,
    /// Whether this is a trial step.
    tries: bool,
    whole: AtRest<T, W, E>,
    /// The last factored tangent, times `unit`.
    factors: Factors<T, D>,
    unit: T,
    /// The age of the factored tangent, in steps.
    age: u32,
    last: Summary,
}

/// Statistics of a solved step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// The number of tangents evaluated and factored. Zero if an earlier tangent sufficed.
    pub tangents: usize,
    /// The number of corrections, including those with a reused tangent.
    pub corrections: usize,
    /// The residual before the last correction, relative to the size of its terms: the maximum over equations.
    pub residual: f64,
}

impl<T: Real, G, const D: usize, W: Group<T>, const E: usize> Search<T, G, D, W, E>
where
    G: Group<T> + Found<W>,
{
    /// A search without previous solutions: the first guess is the neutral element.
    #[must_use]
    pub fn from_rest() -> Self {
        Self {
            past: [G::identity(); 2 * REMEMBERED],
            newest: 0,
            known: 0,
            next: 0,
            weights: SVector::zeros(),
            lengths: SVector::zeros(),
            shortest: [T::zero(); D],
            weighed: OLDEST_SCALE,
            units: [1.0; D],
            noise: [0.0; D],
            open: false,
            measured: false,
            tries: false,
            whole: AtRest::unknown(),
            factors: Factors::none(),
            unit: T::one(),
            age: OLDEST_TANGENT,
            last: Summary {
                tangents: 0,
                corrections: 0,
                residual: 0.0,
            },
        }
    }

    /// Like `from_rest`, for a trial step: if it fails, clebsch does not search for a smaller step size.
    #[cold]
    #[must_use]
    pub fn to_try() -> Self {
        Self {
            tries: true,
            ..Self::from_rest()
        }
    }

    /// A search for other unknowns of the same step. It is a trial if this search is a trial.
    #[cold]
    #[must_use]
    pub fn alike<G2, const D2: usize, W2, const E2: usize>(&self) -> Search<T, G2, D2, W2, E2>
    where
        G2: Group<T> + Found<W2>,
        W2: Group<T>,
    {
        Search {
            tries: self.tries,
            ..Search::from_rest()
        }
    }

    /// Whether this is a trial step: if it fails, clebsch does not search for a shorter one.
    #[must_use]
    pub fn tries(&self) -> bool {
        self.tries
    }

    /// Statistics of the last step; zeros before the first step.
    #[must_use]
    pub fn last(&self) -> Summary {
        self.last
    }

    /// Starts the solution of the step that leaves `node`. The first trial is extrapolated from previous solutions. If
    /// it fails, the next attempt starts at the last solution, and the final attempt at the neutral element.
    #[inline(always)]
    pub fn begin(&mut self, node: u64) -> Newton<'_, T, G, D, W, E> {
        if node != self.next {
            self.known = 0;
            self.age = OLDEST_TANGENT;
            self.weighed = OLDEST_SCALE;
        }
        self.last.tangents = 0;
        let foreseen = self.known > 1;
        let first = if foreseen {
            self.foreseen()
        } else {
            self.start()
        };
        let attempt = if foreseen { 0 } else { 1 };
        if !foreseen {
            self.weighed = OLDEST_SCALE;
        }
        Newton {
            search: self,
            trial: first,
            attempt,
            anchor: None,
            residual: SVector::zeros(),
            size: f64::NAN,
            previous: f64::INFINITY,
            corrections: Corrections::none(),
            iteration: 0,
            found: None,
            renewed: false,
        }
    }

    /// Whether some part of the velocity is much shorter than when the sizes of the terms were computed.
    #[inline(always)]
    fn is_shorter(&self, velocity: &G) -> bool {
        let squares = squares::<T, G, D>(velocity);
        let mut parts = 0..G::PARTS.min(D);
        parts.any(|b| !(self.shortest[b] - squares[b]).nowhere_positive())
    }

    /// The last solution, or the neutral element before the first.
    fn start(&self) -> G {
        match self.known {
            0 => G::identity(),
            _ => self.past[self.newest],
        }
    }

    /// Computes the units of all parts and their rounding errors from a tangent.
    #[cold]
    fn measure(&mut self, tangent: &SMatrix<T, D, D>) {
        let count = G::PARTS.min(D);
        for lane in 0..T::LANES {
            let unit = self.unit.lane(lane);
            let entry = |i, j| tangent[(i, j)].lane(lane) / unit;
            let weights: [f64; D] = core::array::from_fn(|k| self.weights[k].lane(lane));
            let mut noise = [0.0; D];
            let lists = [&mut self.units[..count], &mut noise[..count]];
            self.open = with_kinds::<T, G, _, D>(|kinds| {
                scale::measure(kinds, &entry, &weights, lists);
                kinds.are_open(&entry)
            });
            for (least, own) in self.noise.iter_mut().zip(noise) {
                *least = if lane == 0 { own } else { least.min(own) };
            }
        }
        self.measured = true;
    }

    /// Extrapolates the polynomial through the last solutions by one step.
    #[inline(always)]
    fn foreseen(&self) -> G {
        // Each solution is stored twice, so that the last solutions are contiguous.
        let past = |i: usize| self.past[self.newest + i];
        match self.known {
            0 | 1 => past(0),
            2 => G::combined(&[2.0, -1.0], past),
            3 => G::combined(&[3.0, -3.0, 1.0], past),
            4 => G::combined(&[4.0, -6.0, 4.0, -1.0], past),
            5 => G::combined(&[5.0, -10.0, 10.0, -5.0, 1.0], past),
            _ => G::combined(&[6.0, -15.0, 20.0, -15.0, 6.0, -1.0], past),
        }
    }

    /// Stores the solution of the step that began at `node`.
    #[inline(always)]
    pub fn remember(&mut self, node: u64, solution: &Solved<W>) {
        self.last = Summary {
            corrections: solution.iterations,
            residual: solution.residual,
            ..self.last
        };
        let solution = G::within(&solution.element);
        self.newest = match self.newest {
            0 => REMEMBERED - 1,
            i => i - 1,
        };
        self.past[self.newest] = solution;
        self.past[self.newest + REMEMBERED] = solution;
        self.known = (self.known + 1).min(REMEMBERED);
        self.next = node + 1;
        self.age = self.age.saturating_add(1);
        self.weighed = self.weighed.saturating_add(1);
    }
}

/// The state of Newton's method: the caller evaluates the equations at the trial, and this type
/// decides the next action.
///
/// ```text
/// loop {
///     trial(); if wants_scale() { set_scale(..) }
///     if assess(residual) { set_tangent(..) }
///     match correct() { .. }
/// }
/// ```
///
/// The tangent is the derivative of the residual with respect to the coordinates of
/// [`Group::retract`] at 0, or of [`Group::retract_from_left`]. It is factored once and kept while the
/// corrections decrease fast.
///
/// Each equation is judged by the size of its own terms, its scale. A solution is accepted if the last
/// correction is rounding of the velocity, for any scales (see `corrections`), and if one of these
/// conditions holds for all residuals:
///
/// - they are below `16 EPSILON scale`, and one more correction is made;
/// - the next correction is certain to bring them below `4 EPSILON scale`;
/// - they are below `64 EPSILON scale` and no longer decrease.
///
/// Residuals are measured by their real parts, in every lane. From a real solution, one more step makes
/// the first derivatives exact. Dual numbers therefore get such a step, with a tangent of its own.
///
/// Only the first [`Group::DIMENSION`] of the `D` components count, so that one `D` can serve several
/// sizes of a group.
#[derive(Debug)]
pub struct Newton<'a, T, G, const D: usize, W = G, const E: usize = D> {
    search: &'a mut Search<T, G, D, W, E>,
    trial: G,
    attempt: u32,
    anchor: Option<Anchor<W, E>>,
    residual: SVector<T, D>,
    size: f64,
    previous: f64,
    corrections: Corrections,
    iteration: usize,
    /// The number of iterations of a solution whose remaining unknowns are still needed.
    found: Option<usize>,
    /// Whether the iteration was about to end and computed the sizes of the terms anew.
    renewed: bool,
}

/// The result of a correction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress<G> {
    /// Evaluate the equations at the new trial.
    Continue,
    /// The equations are solved.
    Solved(Solved<G>),
    /// All attempts failed.
    Failed(NewtonError),
}

impl<T: Real, G, const D: usize, W: Group<T>, const E: usize> Newton<'_, T, G, D, W, E>
where
    G: Group<T> + Found<W>,
{
    /// The element at which to evaluate the equations.
    #[inline(always)]
    pub fn trial(&self) -> G {
        self.trial
    }

    /// Whether this is a trial step.
    #[cold]
    pub fn tries(&self) -> bool {
        self.search.tries()
    }

    /// Whether the sizes of the terms are unknown or too old. At the start every trial needs them: the first trial is
    /// at rest, where the bounds of terms with a kink are invalid.
    #[inline(always)]
    pub fn wants_scale(&self) -> bool {
        self.search.weighed >= OLDEST_SCALE || self.attempt > 0
    }

    /// Takes the sizes of the terms at the trial. For each lane, `rounding` bounds the rounding of each residual, in
    /// plain numbers.
    #[cold]
    pub fn set_scale(&mut self, rounding: impl Fn(usize) -> SVector<f64, D>) {
        for lane in 0..T::LANES {
            let mut scales = rounding(lane) / (BOUND_ROUNDINGS * f64::EPSILON / 2.0);
            for i in 0..G::DIMENSION.min(D) {
                // An equation without terms takes its scale from the other equations of its part.
                let part = (0..G::DIMENSION.min(D)).filter(|k| G::part_of(*k) == G::part_of(i));
                let most = part.fold(0.0, |most: f64, k| most.max(scales[k]));
                scales[i] = scales[i].max(LEAST_SHARE * most);
            }
            let search = &*self.search;
            let unit = search.unit.lane(lane).abs();
            let squares = squares::<T, G, D>(&self.trial);
            let lengths = squares.map(|x| x.lane(lane).sqrt());
            let tangent = scale::Tangent {
                entry: &|i, j| search.factors.entry(i, j, lane) / unit,
                part_of: &G::part_of,
                lengths: &lengths,
            };
            tangent.raise(&mut scales.as_mut_slice()[..G::DIMENSION.min(D)]);
            let mut inverses = [0.0; D];
            tangent.inverse_lengths(&mut inverses[..G::DIMENSION.min(D)]);
            let mut shortest = [0.0; D];
            tangent.shortest(&inverses[..G::DIMENSION.min(D)], &mut shortest);
            let search = &mut *self.search;
            for (weight, scale) in search.weights.iter_mut().zip(&scales) {
                weight.set_lane(lane, T::One::from_f64((1.0 / scale).min(f64::MAX)));
            }
            for (own, inverse) in search.lengths.iter_mut().zip(inverses) {
                own.set_lane(lane, T::One::from_f64(inverse));
            }
            for (own, length) in search.shortest.iter_mut().zip(shortest) {
                own.set_lane(lane, T::One::from_f64(length * length));
            }
        }
        self.search.measured = false;
        self.search.weighed = 0;
    }

    pub(super) fn begin_at(&mut self, trial: G) {
        self.trial = trial;
        self.search.weighed = OLDEST_SCALE;
        self.search.age = OLDEST_TANGENT;
        self.previous = f64::INFINITY;
        self.corrections = Corrections::none();
        self.iteration = 0;
        self.found = None;
    }

    /// Takes the residual at the trial; returns whether it needs the tangent there.
    #[inline(always)]
    pub fn assess(&mut self, residual: SVector<T, D>) -> bool {
        self.size = largest(&residual.component_mul(&self.search.weights));
        self.residual = residual;
        if T::order() > 0 {
            return true;
        }
        if self.iteration > 0 {
            return self.size > WORTH_KEEPING * self.previous && !self.polished();
        }
        // If the prediction is exact to rounding, the tangent of an earlier step suffices.
        !(self.size <= CONVERGED_ROUNDINGS * T::EPSILON && self.search.age < OLDEST_TANGENT)
    }

    /// Whether the trial needs no correction.
    #[inline(always)]
    fn polished(&self) -> bool {
        self.corrections.are_polished::<T>(self.seen())
    }

    #[inline(always)]
    fn seen(&self) -> Residual {
        Residual {
            size: self.size,
            previous: self.previous,
            iteration: self.iteration,
        }
    }

    /// Takes the tangent at the trial.
    #[inline(always)]
    pub fn set_tangent(&mut self, tangent: &SMatrix<T, D, D>) {
        self.set_tangent_times(tangent, T::one());
    }

    /// Takes the tangent at the trial times `unit`, the same number at every step.
    #[inline(always)]
    pub fn set_tangent_times(&mut self, tangent: &SMatrix<T, D, D>, unit: T) {
        let search = &mut *self.search;
        search.unit = unit;
        search.factors.set(tangent, G::DIMENSION);
        if !search.measured {
            search.measure(tangent);
        }
        self.search.age = 0;
        self.search.last.tangents += 1;
    }

    /// Moves the trial by Newton's correction, or ends.
    #[inline(always)]
    pub fn correct(&mut self) -> Progress<G> {
        self.correct_by::<false>()
    }

    /// Like `correct`, if the tangent is the derivative along the coordinates of
    /// [`Group::retract_from_left`].
    #[inline(always)]
    pub fn correct_from_left(&mut self) -> Progress<G> {
        self.correct_by::<true>()
    }

    #[inline(always)]
    fn correct_by<const FROM_LEFT: bool>(&mut self) -> Progress<G> {
        if self.polished() {
            return self.solved_unless_outdated();
        }
        let size = self.size;
        let right = self.residual * self.search.unit;
        let Some(correction) = self.search.factors.solve(&right) else {
            return self.failed();
        };
        let step = -correction;
        let moved = largest(&step.component_mul(&self.search.lengths));
        let decrement = || {
            let terms = step.iter().zip(&self.residual);
            let sum = terms.fold(T::zero(), |sum, (x, r)| sum + *x * *r);
            largest(&SVector::<T, 1>::new(sum))
        };
        let next = self.corrections.next::<T>(self.seen(), moved, decrement);
        if next == NextAction::End {
            return self.solved_unless_outdated();
        }
        self.trial = match FROM_LEFT {
            true => self.trial.retract_from_left(step.as_slice()),
            false => self.trial.retract(step.as_slice()),
        };
        if next == NextAction::CorrectAndEnd && !self.is_outdated() {
            return self.solved(self.iteration + 1);
        }
        self.previous = size;
        self.iteration += 1;
        if self.iteration == LATE {
            self.search.weighed = OLDEST_SCALE;
        }
        if self.iteration == MOST_ITERATIONS || !size.is_finite() {
            return self.failed();
        }
        Progress::Continue
    }

    /// Whether the scales are too large for this trial: they were computed for a longer velocity. They must be computed
    /// anew before the iteration ends, but only once: velocities that are only rounding never agree. Later attempts
    /// compute them at every trial.
    #[inline(always)]
    fn is_outdated(&mut self) -> bool {
        let is_shorter = || self.search.is_shorter(&self.trial);
        let outdated = self.attempt == 0 && !self.renewed && is_shorter();
        if outdated {
            self.renewed = true;
            self.search.weighed = OLDEST_SCALE;
        }
        outdated
    }

    #[inline(always)]
    fn solved_unless_outdated(&mut self) -> Progress<G> {
        match self.is_outdated() {
            true => Progress::Continue,
            false => self.solved(self.iteration),
        }
    }

    #[inline(always)]
    fn solved(&self, iterations: usize) -> Progress<G> {
        Progress::Solved(Solved {
            element: self.trial,
            iterations,
            residual: self.size,
        })
    }
}

/// The largest absolute real part over components and lanes; NaN if any is NaN.
#[inline(always)]
fn largest<T: Real, const D: usize>(v: &SVector<T, D>) -> f64 {
    let (mut sum, mut largest) = (T::zero(), 0.0);
    for x in v.iter() {
        sum += *x;
        // For types with a single lane, both are equal.
        let (above, below) = (x.greatest().abs(), x.least().abs());
        let size = if above > below { above } else { below };
        largest = if size > largest { size } else { largest };
    }
    // Comparisons ignore NaN; the sum propagates it.
    largest + 0.0 * sum.magnitude()
}
