//! Finds the impulses of the constraints of a chain. A search finds the impulses for which the constraints vanish at
//! the end of a step, by Newton's method from zero with block-tridiagonal derivatives. Projecting a momentum solves one
//! such linear system. Takes the constraints and their derivatives, site by site; gives impulses, or the site at which
//! the search fails.
//!
//! The model drives the search: between calls it computes the positions for the current impulses. Newton's method
//! follows the impulses `y` along `c(y) = (1 - τ) c(0)` in stages, usually one. A stage is accepted if its second
//! correction is at most a quarter of the first (Deuflhard, Newton Methods for Nonlinear Problems, 2011, sections 2.1
//! and 5.1). The test samples points and proves nothing.

// Loops use one index for several lists.
#![allow(clippy::needless_range_loop)]

use super::blocks::{Blocks, Fixed, RuntimeSize, Size};
use super::ending::scales_of;
use super::error::Place;
use crate::Real;
use crate::solvers::newton::principal::FALLS;
use core::fmt;
use nalgebra::{SMatrix, SVector};

/// The shortest stage, as a fraction of the path.
const SHORTEST: f64 = 1e-12;

/// The largest number of evaluations in a search.
const MOST: usize = 1000;

/// If a correction is below this fraction of the impulses, the next one, about its square, is rounding.
const LAST: f64 = 1e-8;

/// If corrections do not decrease, the next stage is shorter by this factor.
const WORSE: f64 = 0.2;

/// A constraint vanishes if it is at most this many roundings of its terms.
const ROUNDINGS: f64 = 32.0;

/// Rotations and positions have their own rounding errors. If corrections no longer decrease, constraints of up to this
/// many roundings count as zero.
const STALLED: f64 = 4096.0;

/// A pivot below this fraction of the derivatives of its constraint is a rounded zero.
const FLOOR: f64 = 64.0 * f64::EPSILON;

/// The search for the constraint forces of a chain failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoReaction {
    /// The fraction of the path, from zero impulses to satisfied constraints, for which impulses were found. It is 1 if
    /// they were found but the momentum cannot be projected.
    pub share: f64,
}

impl fmt::Display for NoReaction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.share >= 1.0 {
            return write!(
                f,
                "the constraints are not independent there: their derivatives vanish, or one is a combination of others, so \
                 the constraint forces are undetermined; remove a constraint that follows from others, or prescribe less at \
                 the ends"
            );
        }
        let percent = 100.0 * self.share;
        write!(
            f,
            "no constraint forces enforce the constraints at the end of the step: continuation reached {percent:.1} percent of \
             the way from the unconstrained motion, where the constraints become dependent or change too fast; reduce the \
             step size, or remove a constraint that follows from others"
        )
    }
}

impl std::error::Error for NoReaction {}

/// The phase of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// Before the first correction of a stage.
    Begin,
    /// Before the second correction of a stage.
    Second,
    /// Before a later correction.
    Later,
    /// Further corrections: each makes the solution's derivatives exact to one more order.
    Further,
    /// The positions are needed once more, for the final impulses.
    Last,
    Found,
    Lost,
}

/// The search, and the workspace for the constraints of a chain.
#[derive(Clone, Debug)]
pub struct Multipliers<T> {
    n: usize,
    sites: usize,
    ring: bool,
    /// Whether the impulses belong to constraints on sums over all sites.
    of_sums: bool,
    /// The number of constrained sites of each component.
    counts: Vec<usize>,
    blocks: Blocks<T>,
    impulses: Vec<T>,
    /// The impulses at the start of the stage.
    from: Vec<T>,
    correction: Vec<T>,
    /// The constraints at zero impulses.
    whole: Vec<T>,
    scales: Vec<f64>,
    phase: Phase,
    share: f64,
    length: f64,
    before: f64,
    passes: usize,
    further: u32,
    /// The largest constraint, in roundings of its terms.
    roundings: f64,
    /// Whether the last call corrected the impulses with a known derivative.
    corrected: bool,
}

/// Writes the impulses of site `i` to `out[i + 1]`. On a ring, the first and the last entry of `out` repeat the
/// impulses of the neighbours across the seam.
fn put<T: Real, const N: usize>(all: &Multipliers<T>, out: &mut [SVector<T, N>]) {
    let n = all.sites;
    for site in 0..n {
        out[site + 1] = SVector::from_column_slice(&all.impulses[N * site..N * (site + 1)]);
    }
    if all.ring {
        out[0] = out[n];
        out[n + 1] = out[1];
    }
}

impl<T: Real> Multipliers<T> {
    /// A workspace for the constraints of an open chain or a ring. Component `k` is constrained at the first
    /// `counts[k]` sites.
    #[must_use]
    pub fn new(counts: &[usize], ring: bool) -> Self {
        let (n, sites) = (counts.len(), counts.iter().copied().max().unwrap_or(0));
        let list = || vec![T::zero(); n * sites];
        Self {
            n,
            sites,
            ring,
            of_sums: false,
            counts: counts.to_vec(),
            blocks: Blocks::new(n, sites, ring),
            impulses: list(),
            from: list(),
            correction: list(),
            whole: list(),
            scales: vec![1.0; n * sites],
            phase: Phase::Lost,
            share: 0.0,
            length: 1.0,
            before: 0.0,
            passes: 0,
            further: 0,
            roundings: 0.0,
            corrected: false,
        }
    }

    /// Room for constraints on sums over all sites: `n` impulses, found together as for a single site.
    #[must_use]
    pub fn of_sums(n: usize) -> Self {
        Self {
            of_sums: true,
            ..Self::new(&vec![1; n], false)
        }
    }

    /// The number of constrained sites.
    #[must_use]
    pub fn sites(&self) -> usize {
        self.sites
    }

    /// Whether the first and the last site are neighbours.
    #[must_use]
    pub fn is_ring(&self) -> bool {
        self.ring
    }

    /// Starts a search and writes zero impulses to `out`.
    #[inline]
    pub fn begin_search<const N: usize>(&mut self, out: &mut [SVector<T, N>]) {
        self.begin();
        put(self, out);
    }

    /// Starts a search with zero impulses; writes no output.
    pub fn begin(&mut self) {
        self.impulses.fill(T::zero());
        self.from.fill(T::zero());
        (self.phase, self.share, self.length) = (Phase::Begin, 0.0, 1.0);
        (self.passes, self.further) = (0, T::order());
    }

    /// Whether the search continues and needs the positions for the current impulses.
    #[inline]
    #[must_use]
    pub fn goes_on(&self) -> bool {
        !matches!(self.phase, Phase::Found | Phase::Lost)
    }

    /// Takes the constraints at the current positions and the sizes of their terms; returns whether the search needs
    /// derivatives. If a known derivative suffices for the last correction, the impulses are corrected with it.
    #[inline]
    pub fn wants_derivatives<const N: usize>(
        &mut self,
        held: &[SMatrix<T, N, 2>],
        out: &mut [SVector<T, N>],
    ) -> bool {
        let wants = self.wants_by(Fixed::<N>, |site| held[site].as_slice());
        if self.corrected {
            put(self, out);
        }
        wants
    }

    /// Like `wants_derivatives`, given the numbers of each site: first the values, then the sizes.
    pub fn wants<'a>(&mut self, n: usize, held: impl Fn(usize) -> &'a [T]) -> bool
    where
        T: 'a,
    {
        self.wants_by(RuntimeSize(n), held)
    }

    #[inline(always)]
    fn wants_by<'a>(&mut self, size: impl Size, held: impl Fn(usize) -> &'a [T]) -> bool
    where
        T: 'a,
    {
        let n = size.rows();
        self.corrected = false;
        if self.phase == Phase::Last {
            self.phase = Phase::Found;
            return false;
        }
        if self.passes == 0 {
            for site in 0..self.sites {
                self.whole[n * site..n * (site + 1)].copy_from_slice(&held(site)[..n]);
            }
        }
        self.passes += 1;
        if self.passes > MOST {
            self.phase = Phase::Lost;
            return false;
        }
        let left = self.left();
        let mut worst = 0.0_f64;
        for site in 0..self.sites {
            let own = held(site);
            for k in 0..n {
                let at = n * site + k;
                if site >= self.counts[k] {
                    self.correction[at] = T::zero();
                    continue;
                }
                let aim = match left {
                    0.0 => T::zero(),
                    left => T::from_f64(left) * self.whole[at],
                };
                let r = aim - own[k];
                self.correction[at] = r;
                let size = r.magnitude() / (T::EPSILON * own[n + k].magnitude());
                // NaN counts as the largest size, except for zero over zero.
                if size > worst || size.is_nan() && r.magnitude() != 0.0 {
                    worst = if size.is_nan() { f64::INFINITY } else { size };
                }
            }
        }
        let before = core::mem::replace(&mut self.roundings, worst);
        if worst <= ROUNDINGS && left == 0.0 && self.phase != Phase::Further {
            if self.further == 0 {
                self.phase = Phase::Found;
                return false;
            }
            self.phase = Phase::Further;
        }
        // The last derivative reduces the constraint again by the same factor as before.
        let falls = worst * (worst / before) <= ROUNDINGS;
        let again = matches!(self.phase, Phase::Second | Phase::Later);
        if again && falls && left == 0.0 && self.further == 0 {
            self.blocks.solve(size, &mut self.correction);
            for (x, d) in self.impulses.iter_mut().zip(&self.correction) {
                *x += *d;
            }
            self.phase = Phase::Later;
            self.corrected = true;
            return false;
        }
        true
    }

    /// Whether the last call that took constraints corrected the impulses.
    #[must_use]
    pub fn is_corrected(&self) -> bool {
        self.corrected
    }

    /// The fraction of the initial constraints that remains at the end of the stage.
    #[inline(always)]
    fn left(&self) -> f64 {
        match self.length >= 1.0 - self.share {
            true => 0.0,
            false => 1.0 - (self.share + self.length),
        }
    }

    /// Corrects the impulses with the derivatives of the constraints. Each row holds the derivatives of a site by the
    /// impulses of the previous site, of the site itself, and of the next site.
    #[inline]
    pub fn correct<const N: usize, const W: usize>(
        &mut self,
        rows: &[SMatrix<T, N, W>],
        out: &mut [SVector<T, N>],
    ) {
        self.corrected_by(Fixed::<N>, |site| rows[site].as_slice());
        put(self, out);
    }

    /// Like `correct`, given each row in column-major order.
    pub fn correct_by<'a>(&mut self, n: usize, rows: impl Fn(usize) -> &'a [T])
    where
        T: 'a,
    {
        self.corrected_by(RuntimeSize(n), rows);
    }

    #[inline(always)]
    fn corrected_by<'a>(&mut self, size: impl Size, rows: impl Fn(usize) -> &'a [T])
    where
        T: 'a,
    {
        let n = size.rows();
        self.load(n, rows);
        if self.phase == Phase::Begin {
            for site in 0..self.sites {
                scales_of(
                    n,
                    self.blocks.own(site),
                    &mut self.scales[n * site..n * (site + 1)],
                );
            }
        }
        let solved = (self.blocks).factor_and_solve(size, FLOOR, &mut self.correction);
        if solved.is_err() {
            return match self.phase {
                Phase::Begin => self.phase = Phase::Lost,
                _ => self.shorter(WORSE),
            };
        }
        let own = self.largest(&self.correction);
        if !own.is_finite() {
            return self.shorter(WORSE);
        }
        match self.phase {
            Phase::Second if own > FALLS * self.before && self.roundings > STALLED => {
                return self.shorter((0.8 * FALLS * self.before / own).clamp(0.1, 0.8));
            }
            Phase::Later if own > 0.5 * self.before && self.roundings > STALLED => {
                return self.shorter(WORSE);
            }
            _ => {}
        }
        for (x, d) in self.impulses.iter_mut().zip(&self.correction) {
            *x += *d;
        }
        let stalled = own > 0.5 * self.before && self.roundings <= STALLED;
        let small = own <= LAST * self.largest(&self.impulses) || stalled;
        let begun = self.phase == Phase::Begin;
        self.phase = match self.phase {
            Phase::Begin => Phase::Second,
            Phase::Further => return self.further_one(),
            _ => Phase::Later,
        };
        self.before = own;
        if small && !begun {
            self.arrive();
        }
    }

    /// Ends a stage.
    fn arrive(&mut self) {
        if self.left() == 0.0 {
            self.phase = match self.further {
                0 => Phase::Last,
                _ => Phase::Further,
            };
            return;
        }
        self.share += self.length;
        self.length *= 2.0;
        self.from.copy_from_slice(&self.impulses);
        self.phase = Phase::Begin;
    }

    fn further_one(&mut self) {
        self.further = self.further.saturating_sub(1);
        if self.further == 0 {
            self.phase = Phase::Last;
        }
    }

    /// Restarts the stage with a fraction `part` of its length.
    #[cold]
    fn shorter(&mut self, part: f64) {
        self.length = self.length.min(1.0 - self.share) * part;
        self.impulses.copy_from_slice(&self.from);
        self.phase = match self.length < SHORTEST || self.phase == Phase::Further {
            true => Phase::Lost,
            false => Phase::Begin,
        };
    }

    /// Loads the derivatives of all sites into the blocks. Components without a constraint at a site get zero impulse.
    #[inline(always)]
    fn load<'a>(&mut self, n: usize, rows: impl Fn(usize) -> &'a [T])
    where
        T: 'a,
    {
        match self.ring && self.sites <= 2 {
            true => self.add_rows(n, rows),
            false => {
                for site in 0..self.sites {
                    self.blocks.put_row(n, site, rows(site));
                }
            }
        }
        for k in 0..n {
            for site in self.counts[k]..self.sites {
                self.blocks.hold_component(site, k);
            }
        }
    }

    /// Like `load`, for a ring of one or two sites, where both neighbours of a site coincide.
    fn add_rows<'a>(&mut self, n: usize, rows: impl Fn(usize) -> &'a [T])
    where
        T: 'a,
    {
        self.blocks.clear();
        let (last, size) = (self.sites - 1, n * n);
        for site in 0..self.sites {
            let own = rows(site);
            let before = if site > 0 { site - 1 } else { last };
            let after = if site < last { site + 1 } else { 0 };
            self.blocks.add(site, before, &own[..size]);
            self.blocks.add(site, site, &own[size..2 * size]);
            self.blocks.add(site, after, &own[2 * size..]);
        }
    }

    /// The largest scaled entry; NaN if any entry is NaN.
    #[inline(always)]
    fn largest(&self, list: &[T]) -> f64 {
        let mut most = 0.0;
        for (x, scale) in list.iter().zip(&self.scales) {
            let size = x.greatest().abs().max(x.least().abs()) * scale;
            if x.magnitude().is_nan() || size.is_nan() {
                return f64::NAN;
            }
            if size > most {
                most = size;
            }
        }
        most
    }

    /// The site, or [`Place::ALL`] if the constraints are on sums.
    fn place(&self, site: usize) -> usize {
        match self.of_sums {
            true => Place::ALL,
            false => site,
        }
    }

    /// Checks that the search found impulses.
    ///
    /// # Errors
    /// The site of the largest correction, with [`NoReaction`].
    pub fn root_found(&self) -> Result<(), (usize, NoReaction)> {
        match self.phase {
            Phase::Found => Ok(()),
            _ => Err((self.place(self.worst()), NoReaction { share: self.share })),
        }
    }

    /// The impulses that cancel the rates of change of the constraints, with derivatives as for
    /// [`Multipliers::correct`].
    ///
    /// # Errors
    /// [`NoReaction`] if the constraints are not independent, and the site.
    #[inline]
    pub fn projected<const N: usize, const W: usize>(
        &mut self,
        rows: &[SMatrix<T, N, W>],
        rates: &[SVector<T, N>],
        out: &mut [SVector<T, N>],
    ) -> Result<(), (usize, NoReaction)> {
        self.projected_by(
            Fixed::<N>,
            |site| rows[site].as_slice(),
            |site| rates[site].as_slice(),
        )?;
        put(self, out);
        Ok(())
    }

    /// Like `projected`, given the numbers of each site.
    ///
    /// # Errors
    /// As [`Multipliers::projected`].
    pub fn project<'a>(
        &mut self,
        n: usize,
        rows: impl Fn(usize) -> &'a [T],
        rates: impl Fn(usize) -> &'a [T],
    ) -> Result<(), (usize, NoReaction)>
    where
        T: 'a,
    {
        self.projected_by(RuntimeSize(n), rows, rates)
    }

    #[inline(always)]
    fn projected_by<'a>(
        &mut self,
        size: impl Size,
        rows: impl Fn(usize) -> &'a [T],
        rates: impl Fn(usize) -> &'a [T],
    ) -> Result<(), (usize, NoReaction)>
    where
        T: 'a,
    {
        let n = size.rows();
        self.load(n, rows);
        for site in 0..self.sites {
            let own = rates(site);
            for k in 0..n {
                self.impulses[n * site + k] = match site < self.counts[k] {
                    true => own[k],
                    false => T::zero(),
                };
            }
        }
        let none = NoReaction { share: 1.0 };
        let factored = (self.blocks).factor_and_solve(size, FLOOR, &mut self.impulses);
        factored.map_err(|site| (self.place(site), none))?;
        let lost = self.impulses.iter().position(|x| !x.is_finite());
        match lost {
            None => Ok(()),
            Some(at) => Err((self.place(at / n.max(1)), none)),
        }
    }

    /// The site of the largest impulse.
    #[must_use]
    pub fn largest_impulse(&self) -> usize {
        let mut most = (0, -1.0);
        for (at, x) in self.impulses.iter().enumerate() {
            if x.magnitude() > most.1 {
                most = (at, x.magnitude());
            }
        }
        most.0 / self.n.max(1)
    }

    /// The impulses, site by site.
    #[must_use]
    pub fn impulses(&self) -> &[T] {
        &self.impulses
    }

    /// The site whose block lacks a pivot, else the site of the largest correction, or of the first that is NaN.
    #[cold]
    fn worst(&self) -> usize {
        if let Some(site) = self.blocks.without_pivot() {
            return site;
        }
        let mut worst = (0, -1.0);
        for (at, (x, scale)) in self.correction.iter().zip(&self.scales).enumerate() {
            let size = x.magnitude() * scale;
            if size.is_nan() {
                return at / self.n.max(1);
            }
            if size > worst.1 {
                worst = (at, size);
            }
        }
        worst.0 / self.n.max(1)
    }
}
