//! The impulses of the constraints of a chain. One search finds the impulses that make the constraints vanish at the
//! end of a step, by Newton's method from zero with block-tridiagonal derivatives. The projection of a momentum solves
//! one such system. Takes the constraints and their derivatives, site by site; gives impulses, or the site at which the
//! search fails.
//!
//! The model drives the search: between its calls it computes the positions for the current impulses. Impulses `y` are
//! followed along `c(y) = (1 - τ) c(0)` in stages, mostly one, by Newton's method. A stage is accepted if its second
//! correction is at most a quarter of the first (Deuflhard, Newton Methods for Nonlinear Problems, 2011, sections 2.1
//! and 5.1). That is a test at points, not a proof.

// Several lists run along one index.
#![allow(clippy::needless_range_loop)]

use super::blocks::{Blocks, Fixed, Read, Size};
use super::error::Place;
use super::root::scales_of;
use crate::Real;
use crate::solvers::newton::principal::FALLS;
use core::fmt;
use nalgebra::{SMatrix, SVector};

/// Shortest stage, as a part of the way.
const SHORTEST: f64 = 1e-12;

/// Most evaluations of a search.
const MOST: usize = 1000;

/// A correction so small, of the impulses, leaves rounding when the next would be its square.
const LAST: f64 = 1e-8;

/// The part of a stage that is tried where corrections do not fall.
const WORSE: f64 = 0.2;

/// A constraint vanishes if it is at most this many roundings of its terms.
const ROUNDINGS: f64 = 32.0;

/// Rotations and positions have rounding of their own. If corrections no longer decrease, this many roundings count as
/// zero.
const STALLED: f64 = 4096.0;

/// A pivot below this share of the derivatives of its constraint is rounding of zero.
const FLOOR: f64 = 64.0 * f64::EPSILON;

/// The search for the constraint forces of a chain failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoReaction {
    /// The share of the way from zero constraint forces to the constraints up to which they were found. It is 1 if they
    /// were found, but the momentum there cannot be projected.
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

/// Where a search is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// Before the first correction of a stage.
    Begin,
    /// Before the second.
    Second,
    /// Before another one.
    Later,
    /// Derivatives of the solution are exact to one order more after each further correction.
    Further,
    /// Places are wanted for the last time.
    Last,
    Found,
    Lost,
}

/// The search, and room for the constraints of a line.
#[derive(Clone, Debug)]
pub struct Multipliers<T> {
    n: usize,
    sites: usize,
    ring: bool,
    /// Whether impulses belong to no site.
    of_sums: bool,
    /// The number of constrained sites of each component.
    counts: Vec<usize>,
    blocks: Blocks<T>,
    impulses: Vec<T>,
    /// Where a stage began.
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
    /// Whether the last constraints were corrected by known derivatives.
    corrected: bool,
}

/// Puts a value at each site of a list that has one place more on either side, which repeat a ring.
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
    /// Room for the constraints of a line, open or a ring: at how many of its first sites each component is held.
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

    /// At how many sites constraints are held.
    #[must_use]
    pub fn sites(&self) -> usize {
        self.sites
    }

    /// Whether the first site and the last are neighbours.
    #[must_use]
    pub fn is_ring(&self) -> bool {
        self.ring
    }

    /// Begins a search: no impulses.
    #[inline]
    pub fn begin_search<const N: usize>(&mut self, out: &mut [SVector<T, N>]) {
        self.begin();
        put(self, out);
    }

    /// Begins a search with zero impulses, without writing any values.
    pub fn begin(&mut self) {
        self.impulses.fill(T::zero());
        self.from.fill(T::zero());
        (self.phase, self.share, self.length) = (Phase::Begin, 0.0, 1.0);
        (self.passes, self.further) = (0, T::ORDER);
    }

    /// Whether places are wanted for the impulses that are put out.
    #[inline]
    #[must_use]
    pub fn goes_on(&self) -> bool {
        !matches!(self.phase, Phase::Found | Phase::Lost)
    }

    /// Takes the constraints at the current positions, with the sizes of their terms; returns whether it needs
    /// derivatives. If the known derivatives suffice for the last correction, it corrects the impulses by them.
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

    /// Like `wants_derivatives`, given the numbers of each site: values, then sizes.
    pub fn wants<'a>(&mut self, n: usize, held: impl Fn(usize) -> &'a [T]) -> bool
    where
        T: 'a,
    {
        self.wants_by(Read(n), held)
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
                // NaN remains the worst, except zero over zero.
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
        // The tangent of the correction before leaves as small a part of what is held as it did then.
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

    /// Whether the last call with constraints corrected the impulses.
    #[must_use]
    pub fn is_corrected(&self) -> bool {
        self.corrected
    }

    /// The share of the initial constraints that remains at the end of the stage.
    #[inline(always)]
    fn left(&self) -> f64 {
        match self.length >= 1.0 - self.share {
            true => 0.0,
            false => 1.0 - (self.share + self.length),
        }
    }

    /// Corrects the impulses by the derivatives of the constraints: of each site by the impulses of the previous site,
    /// of itself, and of the next site, side by side.
    #[inline]
    pub fn correct<const N: usize, const W: usize>(
        &mut self,
        rows: &[SMatrix<T, N, W>],
        out: &mut [SVector<T, N>],
    ) {
        self.corrected_by(Fixed::<N>, |site| rows[site].as_slice());
        put(self, out);
    }

    /// Like `correct`, given the numbers of each site, column by column.
    pub fn correct_by<'a>(&mut self, n: usize, rows: impl Fn(usize) -> &'a [T])
    where
        T: 'a,
    {
        self.corrected_by(Read(n), rows);
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

    /// At the end of a stage.
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

    /// Restarts the stage with a shorter length.
    #[cold]
    fn shorter(&mut self, part: f64) {
        self.length = self.length.min(1.0 - self.share) * part;
        self.impulses.copy_from_slice(&self.from);
        self.phase = match self.length < SHORTEST || self.phase == Phase::Further {
            true => Phase::Lost,
            false => Phase::Begin,
        };
    }

    /// Loads the derivatives of all sites into blocks. Components without a constraint at a site get a zero impulse.
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

    /// Like `load`, for a ring of one or two sites, where both neighbours of a site are the same site.
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

    /// The largest entry in units of scales; NaN if any is.
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

    /// The site, or [`Place::ALL`] if the impulses belong to sums.
    fn place(&self, site: usize) -> usize {
        match self.of_sums {
            true => Place::ALL,
            false => site,
        }
    }

    /// Whether impulses were found.
    ///
    /// # Errors
    /// [`NoReaction`], and the site of the largest correction.
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
        self.projected_by(Read(n), rows, rates)
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
