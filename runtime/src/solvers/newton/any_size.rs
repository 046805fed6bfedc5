//! Newton's method over plain numbers, for groups and numbers of unknowns that are known only at run time. It uses
//! lists instead of arrays, but makes the same decisions and operations as [`Search`](super::Search) and
//! [`Newton`](super::Newton), so solutions agree bit for bit. Takes a chart of the group, residuals and tangents; gives
//! a converged element or an error.

mod chart;
mod principal;
mod saved;

pub use chart::{Chart, Lane};

use super::corrections::{Corrections, NextAction, Residual};
use super::principal::{Fold, Traced, trace};
use super::scale::{Tangent, measure};
use super::{
    BOUND_ROUNDINGS, CONVERGED_ROUNDINGS, LAST_ATTEMPT, LATE, LEAST_SHARE, MOST_ITERATIONS,
    NewtonError, NewtonFailure, OLDEST_SCALE, OLDEST_TANGENT, Progress, REMEMBERED, Solved,
    WORTH_KEEPING,
};
use crate::linalg::{Dense, DenseFactors, Reals};
use crate::scalar::Real;

/// The rounding unit of plain numbers.
const UNIT: f64 = <f64 as Real>::EPSILON;

/// A principal root to be polished, with the distance within which a polished solution must stay.
#[derive(Clone, Debug)]
struct Anchor<G> {
    root: G,
    reach: Reals,
}

/// The search for successive velocities: see [`Search`](super::Search).
#[derive(Clone, Debug)]
pub struct AnySearch<C: Chart> {
    /// The last solutions, the newest first.
    past: Vec<C::Element>,
    next: u64,
    weights: Vec<f64>,
    lengths: Vec<f64>,
    shortest: Vec<f64>,
    weighed: u32,
    units: Vec<f64>,
    noise: Vec<f64>,
    open: bool,
    measured: bool,
    /// Whether this is a trial step.
    tries: bool,
    /// The tangent of all equations at rest and the units of its parts, if some unknowns are eliminated.
    whole: Option<(DenseFactors, Vec<f64>)>,
    factors: DenseFactors,
    unit: f64,
    age: u32,
    work: Work<C::Element>,
}

/// The buffers of a step, stored so that the next step does not allocate.
#[derive(Clone, Debug, Default)]
struct Work<E> {
    trial: E,
    moved: E,
    residual: Vec<f64>,
}

impl<C: Chart> AnySearch<C> {
    /// A search without previous solutions: the first guess is the neutral element. `in_blocks` allows factoring in
    /// blocks of three without row exchanges. Set it if the static size equals the number of equations.
    #[must_use]
    pub fn new(dimension: usize, in_blocks: bool, tries: bool) -> Self {
        Self {
            past: Vec::new(),
            next: 0,
            weights: vec![0.0; dimension],
            lengths: vec![0.0; dimension],
            shortest: Vec::new(),
            weighed: OLDEST_SCALE,
            units: Vec::new(),
            noise: Vec::new(),
            open: false,
            measured: false,
            tries,
            whole: None,
            factors: DenseFactors::none(dimension, in_blocks),
            unit: 1.0,
            age: OLDEST_TANGENT,
            work: Work {
                residual: vec![0.0; dimension],
                ..Work::default()
            },
        }
    }

    /// Copies the scales, units and factored tangent of another search for the same velocities, without allocating.
    /// Stored solutions are unchanged, because only an actual step changes them.
    pub fn measure_as(&mut self, other: &Self) {
        self.next = other.next;
        self.weights.clone_from(&other.weights);
        self.lengths.clone_from(&other.lengths);
        self.shortest.clone_from(&other.shortest);
        self.weighed = other.weighed;
        self.units.clone_from(&other.units);
        self.noise.clone_from(&other.noise);
        (self.open, self.measured) = (other.open, other.measured);
        self.factors.clone_from(&other.factors);
        (self.unit, self.age) = (other.unit, other.age);
    }

    /// Forgets all solutions and measurements.
    fn forget(&mut self) {
        self.past.clear();
        self.weights.fill(0.0);
        self.lengths.fill(0.0);
        self.shortest.clear();
        self.weighed = OLDEST_SCALE;
        self.units.clear();
        self.noise.clear();
        (self.open, self.measured) = (false, false);
        self.whole = None;
        self.factors.forget();
        (self.unit, self.age) = (1.0, OLDEST_TANGENT);
    }

    /// Marks all further steps as trials.
    pub fn only_try(&mut self) {
        self.tries = true;
    }

    /// Whether this is a trial step.
    #[must_use]
    pub fn tries(&self) -> bool {
        self.tries
    }

    /// Starts the solution of the step that leaves `node`: see [`Search::begin`](super::Search::begin). `whole` is the
    /// chart of all unknowns, if some are eliminated.
    pub fn begin<'a>(&'a mut self, [chart, whole]: [&'a C; 2], node: u64) -> AnyNewton<'a, C> {
        if node != self.next {
            self.past.clear();
            self.age = OLDEST_TANGENT;
            self.weighed = OLDEST_SCALE;
        }
        let foreseen = self.past.len() > 1;
        self.begin_at(chart, u32::from(!foreseen));
        if !foreseen {
            self.weighed = OLDEST_SCALE;
        }
        self.work.residual.fill(0.0);
        AnyNewton {
            search: self,
            chart,
            whole,
            attempt: u32::from(!foreseen),
            anchor: None,
            size: f64::NAN,
            previous: f64::INFINITY,
            corrections: Corrections::none(),
            iteration: 0,
            found: None,
            renewed: false,
            has_moved: false,
        }
    }

    /// Sets the trial to the starting element of an attempt.
    fn begin_at(&mut self, chart: &C, attempt: u32) {
        let trial = &mut self.work.trial;
        let weights: &[f64] = match (attempt, self.past.first()) {
            (0, _) => foreseeing(self.past.len()),
            (1, Some(newest)) => return trial.clone_from(newest),
            _ => {
                *trial = chart.identity();
                return;
            }
        };
        chart.combined(weights, &self.past, trial);
    }

    /// Stores the solution of the step that began at `node`.
    pub fn remember(&mut self, node: u64, solution: C::Element) {
        self.past.truncate(REMEMBERED - 1);
        self.past.insert(0, solution);
        self.next = node + 1;
        self.age = self.age.saturating_add(1);
        self.weighed = self.weighed.saturating_add(1);
    }
}

/// The extrapolation weights for this number of previous solutions.
fn foreseeing(known: usize) -> &'static [f64] {
    match known {
        0 | 1 => &[1.0],
        2 => &[2.0, -1.0],
        3 => &[3.0, -3.0, 1.0],
        4 => &[4.0, -6.0, 4.0, -1.0],
        5 => &[5.0, -10.0, 10.0, -5.0, 1.0],
        _ => &[6.0, -15.0, 20.0, -15.0, 6.0, -1.0],
    }
}

/// The state of Newton's method: see [`Newton`](super::Newton).
#[derive(Debug)]
pub struct AnyNewton<'a, C: Chart> {
    search: &'a mut AnySearch<C>,
    chart: &'a C,
    whole: &'a C,
    attempt: u32,
    anchor: Option<Anchor<C::Element>>,
    size: f64,
    previous: f64,
    corrections: Corrections,
    iteration: usize,
    found: Option<usize>,
    renewed: bool,
    /// Whether the last call of [`correct`](Self::correct) moved the trial.
    has_moved: bool,
}

impl<C: Chart> AnyNewton<'_, C> {
    /// The element at which to evaluate the equations.
    #[must_use]
    pub fn trial(&self) -> &C::Element {
        &self.search.work.trial
    }

    /// The element at which the equations were evaluated last. The trial may have moved since.
    #[must_use]
    pub fn assessed(&self) -> &C::Element {
        match self.has_moved {
            true => &self.search.work.moved,
            false => self.trial(),
        }
    }

    /// Whether this is a trial step.
    #[must_use]
    pub fn tries(&self) -> bool {
        self.search.tries
    }

    /// Whether the sizes of the terms are unknown or too old.
    #[must_use]
    pub fn wants_scale(&self) -> bool {
        self.search.weighed >= OLDEST_SCALE || self.attempt > 0
    }

    /// Takes the sizes of the terms at the trial: `rounding` bounds the rounding of each residual.
    pub fn set_scale(&mut self, rounding: &[f64]) {
        let unit = BOUND_ROUNDINGS * f64::EPSILON / 2.0;
        let mut scales: Vec<f64> = rounding.iter().map(|x| x / unit).collect();
        let parts = self.chart.parts();
        for i in 0..scales.len() {
            // An equation without terms takes its scale from the other equations of its part.
            let kinds = parts.kinds();
            let part = kinds.own(parts.part_of(i));
            let most = part.fold(0.0, |most: f64, k| most.max(scales[k]));
            scales[i] = scales[i].max(LEAST_SHARE * most);
        }
        let (factors, unit) = (&self.search.factors, self.search.unit.abs());
        let lengths = self.chart.lengths(self.trial());
        let tangent = Tangent {
            entry: &|i, j| factors.entry(i, j) / unit,
            part_of: &|i| parts.part_of(i),
            lengths: &lengths,
        };
        tangent.raise(&mut scales);
        let mut inverses = vec![0.0; scales.len()];
        tangent.inverse_lengths(&mut inverses);
        let mut shortest = vec![0.0; parts.count()];
        tangent.shortest(&inverses, &mut shortest);
        for (weight, scale) in self.search.weights.iter_mut().zip(&scales) {
            *weight = (1.0 / scale).min(f64::MAX);
        }
        self.search.lengths = inverses;
        self.search.shortest = shortest.iter().map(|x| x * x).collect();
        self.search.measured = false;
        self.search.weighed = 0;
    }

    /// Finds the principal root and compares it with the solution. If they differ, the iteration restarts at the
    /// principal root, unless it already did so.
    ///
    /// # Errors
    /// [`Fold`] if the principal root does not exist.
    #[cold]
    pub fn settle(
        &mut self,
        equations: &Lane<C>,
        solution: Option<&C::Element>,
    ) -> Result<Settled, Fold> {
        // An old tangent may be the reason that the test failed.
        self.search.age = OLDEST_TANGENT;
        let noise = match self.chart.parts() == self.whole.parts() {
            true => self.search.noise.as_slice(),
            false => &[],
        };
        match trace(&equations.with_noise(noise), solution)? {
            Traced::Principal => Ok(Settled::Principal),
            Traced::Elsewhere { root, reach } => {
                if self.anchor.is_some() {
                    return Ok(Settled::Unpolished);
                }
                self.attempt = LAST_ATTEMPT;
                self.begin_at(self.chart.part(self.whole, &root));
                self.anchor = Some(Anchor { root, reach });
                Ok(Settled::Again)
            }
        }
    }

    /// Starts the step again without the solutions and measurements of earlier steps: see
    /// [`Newton::begin_afresh`](super::Newton::begin_afresh).
    #[cold]
    pub fn begin_afresh(&mut self) -> bool {
        if self.search.past.is_empty() {
            return false;
        }
        self.search.forget();
        self.attempt = 1;
        self.anchor = None;
        self.begin_at(self.chart.identity());
        true
    }

    fn begin_at(&mut self, trial: C::Element) {
        self.search.work.trial = trial;
        self.begin_again();
    }

    fn begin_again(&mut self) {
        self.search.weighed = OLDEST_SCALE;
        self.search.age = OLDEST_TANGENT;
        self.previous = f64::INFINITY;
        self.corrections = Corrections::none();
        self.iteration = 0;
        self.found = None;
    }

    /// Takes the residual at the trial; returns whether it needs the tangent there.
    pub fn assess(&mut self, residual: &[f64]) -> bool {
        self.size = largest_of(residual, &self.search.weights);
        self.search.work.residual.clear();
        self.search.work.residual.extend_from_slice(residual);
        if self.iteration > 0 {
            return self.size > WORTH_KEEPING * self.previous && !self.polished();
        }
        // If the prediction is exact to rounding, the tangent of an earlier step suffices.
        !(self.size <= CONVERGED_ROUNDINGS * UNIT && self.search.age < OLDEST_TANGENT)
    }

    fn polished(&self) -> bool {
        self.corrections.are_polished::<f64>(self.seen())
    }

    fn seen(&self) -> Residual {
        Residual {
            size: self.size,
            previous: self.previous,
            iteration: self.iteration,
        }
    }

    /// Takes the tangent at the trial times `unit`, the same number at every step.
    pub fn set_tangent_times(&mut self, tangent: &Dense<f64>, unit: f64) {
        let search = &mut *self.search;
        search.unit = unit;
        if !search.measured {
            let entry = |i, j| tangent.at(i, j) / unit;
            let count = self.chart.parts().count();
            (search.units, search.noise) = (vec![0.0; count], vec![0.0; count]);
            let lists = [&mut search.units[..], &mut search.noise[..]];
            measure(&self.chart.parts().kinds(), &entry, &search.weights, lists);
            search.open = self.chart.parts().kinds().are_open(&entry);
            search.measured = true;
        }
        search.factors.set(tangent);
        search.age = 0;
    }

    /// Whether the residual is needed. At the last trial, only the remaining unknowns are.
    #[must_use]
    pub fn wants_residual(&self) -> bool {
        self.found.is_none()
    }

    /// Like [`correct`](Self::correct), if some unknowns are eliminated; `whole` is the trial with all unknowns.
    pub fn correct_part(&mut self, element: C::Element, from_left: bool) -> Progress<C::Element> {
        self.has_moved = false;
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
        match self.correct(from_left) {
            Progress::Solved(solved) => {
                self.found = Some(solved.iterations);
                Progress::Continue
            }
            other => other,
        }
    }

    /// Moves the trial by Newton's correction, or ends.
    pub fn correct(&mut self, from_left: bool) -> Progress<C::Element> {
        self.has_moved = false;
        if self.polished() {
            return self.solved_unless_outdated();
        }
        let size = self.size;
        let residual = &self.search.work.residual;
        let right: Reals = residual.iter().map(|x| x * self.search.unit).collect();
        let Some(correction) = self.search.factors.solve(&right) else {
            return self.failed();
        };
        let step: Reals = correction.iter().map(|x| -x).collect();
        let moved = largest_of(&step, &self.search.lengths);
        let decrement = || {
            let terms = step.iter().zip(residual);
            f64::abs(terms.fold(0.0, |sum, (x, r)| sum + x * r))
        };
        let next = self.corrections.next::<f64>(self.seen(), moved, decrement);
        if next == NextAction::End {
            return self.solved_unless_outdated();
        }
        let Work { trial, moved, .. } = &mut self.search.work;
        match from_left {
            true => self.chart.retract_from_left(trial, &step, moved),
            false => self.chart.retract(trial, &step, moved),
        }
        core::mem::swap(trial, moved);
        self.has_moved = true;
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

    /// Whether the scales were computed for a longer velocity and must be computed anew before the iteration ends.
    fn is_outdated(&mut self) -> bool {
        if self.attempt > 0 || self.renewed {
            return false;
        }
        let squares = self.chart.squares(self.trial());
        let mut parts = self.search.shortest.iter().zip(&squares);
        let outdated = parts.any(|(shortest, [square, _])| !(shortest - square).nowhere_positive());
        if outdated {
            self.renewed = true;
            self.search.weighed = OLDEST_SCALE;
        }
        outdated
    }

    fn solved_unless_outdated(&mut self) -> Progress<C::Element> {
        match self.is_outdated() {
            true => Progress::Continue,
            false => self.solved(self.iteration),
        }
    }

    fn solved(&self, iterations: usize) -> Progress<C::Element> {
        Progress::Solved(Solved {
            element: self.trial().clone(),
            iterations,
            residual: self.size,
        })
    }

    #[cold]
    fn failed(&mut self) -> Progress<C::Element> {
        if self.attempt == 0 {
            self.attempt = 1;
            self.search.begin_at(self.chart, 1);
            self.begin_again();
            return Progress::Continue;
        }
        if self.attempt < LAST_ATTEMPT && self.begin_afresh() {
            return Progress::Continue;
        }
        let (failure, iterations) = if !self.size.is_finite() {
            (NewtonFailure::NotFinite, self.iteration.saturating_sub(1))
        } else if self.iteration == MOST_ITERATIONS {
            (NewtonFailure::NotConverged, MOST_ITERATIONS)
        } else {
            (NewtonFailure::SingularTangent, self.iteration)
        };
        Progress::Failed(self.error(failure, iterations))
    }

    fn error(&self, failure: NewtonFailure, iterations: usize) -> NewtonError {
        NewtonError {
            tried: self.tries(),
            ..NewtonError::of(
                failure,
                iterations,
                &self.search.work.residual,
                &self.search.weights,
                &|i| self.chart.coordinate(i),
            )
        }
    }

    /// The error if the principal root was found, but its residual exceeds rounding.
    #[cold]
    #[must_use]
    pub fn unpolished(&self) -> NewtonError {
        self.error(NewtonFailure::NotConverged, self.iteration)
    }

    /// The error if the principal root does not exist; `failure` is the cause of an earlier failure.
    #[cold]
    #[must_use]
    pub fn folded(&self, fold: Fold, failure: Option<NewtonError>) -> NewtonError {
        match failure {
            // The curve could not be followed at all.
            Some(e) if fold.share == 0.0 => e,
            _ => NewtonError {
                tried: self.tries(),
                ..NewtonError::at_fold(fold, self.whole.coordinate(fold.fastest))
            },
        }
    }
}

/// The largest absolute value in the given units; NaN if any number is NaN.
fn largest_of(numbers: &[f64], units: &[f64]) -> f64 {
    let (mut sum, mut largest) = (0.0, 0.0);
    for (x, unit) in numbers.iter().zip(units) {
        let x = x * unit;
        sum += x;
        largest = if x.abs() > largest { x.abs() } else { largest };
    }
    // Comparisons ignore NaN; the sum propagates it.
    largest + 0.0 * f64::abs(sum)
}

/// The result of [`AnyNewton::settle`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settled {
    /// The solution is the principal root.
    Principal,
    /// The principal root differs; the iteration has restarted from it.
    Again,
    /// The principal root differs, although the iteration started from it.
    Unpolished,
}
