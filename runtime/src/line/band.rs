//! Solves for the velocities of all sites together if momenta depend on the velocities of neighbours, by Newton's
//! method from rest with block-tridiagonal derivatives. Takes the momenta of sites and of coupling terms, with
//! derivatives; gives the velocities, or the site at which the continuation fails.

use super::blocks::{Blocks, Fixed, RuntimeSize, Size};
use super::ending::scales_of;
use super::root::{Lists, Momenta, NoRoot, follow};
use super::turn::{of_vector, turn_of};
use super::unknown::{Unknown, begins, field};
use crate::Real;
use core::ops::Deref;
use nalgebra::{Matrix3, SMatrix, SVector};

/// Accumulates the momenta of all sites, and their derivatives, at given velocities.
#[derive(Debug)]
pub struct Sums<'a, T> {
    velocities: &'a [T],
    momenta: &'a mut [T],
    /// `None` if derivatives are not requested.
    blocks: Option<&'a mut Blocks<T>>,
}

impl<T: Real> Sums<'_, T> {
    /// The velocities of a site with `n` components.
    #[inline(always)]
    pub fn velocity(&self, n: usize, site: usize) -> &[T] {
        &self.velocities[n * site..n * (site + 1)]
    }

    /// Sets the momenta of a site. Coupling terms are added afterwards.
    #[inline(always)]
    pub fn put(&mut self, n: usize, site: usize, momenta: &[T]) {
        self.momenta[n * site..n * (site + 1)].copy_from_slice(momenta);
    }

    /// Sets the derivative of a site's momenta by its own velocities, in column-major order.
    #[inline(always)]
    pub fn put_derivative(&mut self, site: usize, derivative: &[T]) {
        if let Some(blocks) = &mut self.blocks {
            blocks.put_own(site, derivative);
        }
    }

    /// Adds to the momenta of a site.
    #[inline(always)]
    pub fn add(&mut self, n: usize, site: usize, momenta: &[T]) {
        let own = &mut self.momenta[n * site..n * (site + 1)];
        for (x, y) in own.iter_mut().zip(momenta) {
            *x += *y;
        }
    }

    /// Adds to the derivative of the momenta of site `row` by the velocities of site `column`, in column-major order.
    #[inline(always)]
    pub fn add_derivative(&mut self, row: usize, column: usize, derivative: &[T]) {
        if let Some(blocks) = &mut self.blocks {
            blocks.add(row, column, derivative);
        }
    }
}

/// The equations of a chain.
struct Line<'a, T, F, S> {
    n: S,
    unknowns: &'a [Unknown],
    ring: bool,
    blocks: &'a mut Blocks<T>,
    moving: [usize; 2],
    all: F,
    /// The velocities at which the factored derivative was evaluated.
    factored: &'a mut [T],
}

impl<T: Real, F: FnMut(&mut Sums<'_, T>), S: Size> Line<'_, T, F, S> {
    #[inline(always)]
    fn evaluate(&mut self, velocities: &[T], momenta: &mut [T], derivatives: bool) {
        let n = self.n.rows();
        if derivatives {
            self.blocks.clear_neighbours();
        }
        let mut sums = Sums {
            velocities,
            momenta,
            blocks: derivatives.then_some(&mut *self.blocks),
        };
        (self.all)(&mut sums);
        let [first, last] = self.moving;
        let sites = velocities.len() / n.max(1);
        for site in (0..first).chain(last..sites) {
            momenta[n * site..n * (site + 1)].fill(T::zero());
            if derivatives {
                self.blocks.hold(site);
            }
        }
    }
}

impl<T: Real, F: FnMut(&mut Sums<'_, T>), S: Size> Momenta<T> for Line<'_, T, F, S> {
    #[inline(always)]
    fn at(&mut self, velocities: &[T], momenta: &mut [T]) {
        self.evaluate(velocities, momenta, true);
    }

    #[inline(always)]
    fn momenta_at(&mut self, velocities: &[T], momenta: &mut [T]) {
        self.evaluate(velocities, momenta, false);
    }

    fn unknowns(&self) -> &[Unknown] {
        self.unknowns
    }

    fn ring(&self) -> bool {
        self.ring
    }

    fn scales(&self, scales: &mut [f64]) {
        let n = self.n.rows();
        for (site, own) in scales.chunks_exact_mut(n).enumerate() {
            scales_of(n, self.blocks.own(site), own);
        }
    }

    #[inline(always)]
    fn factor_and_solve(&mut self, velocities: &[T], x: &mut [T]) -> bool {
        if begins(self.unknowns).next().is_some() {
            self.factored.copy_from_slice(velocities);
        }
        let done = self.blocks.factor_and_solve(self.n, 0.0, x).is_ok();
        self.turned(x);
        done
    }

    #[inline(always)]
    fn solve(&mut self, x: &mut [T]) {
        self.blocks.solve(self.n, x);
        self.turned(x);
    }
}

impl<T: Real, F, S: Size> Line<'_, T, F, S> {
    /// Converts changes of rotations into changes of their Cayley vectors.
    #[inline(always)]
    fn turned(&self, x: &mut [T]) {
        let n = self.n.rows();
        for k in begins(self.unknowns) {
            let at = self.factored.chunks_exact(n);
            for (at, x) in at.zip(x.chunks_exact_mut(n)) {
                of_vector(&at[k..k + 3], &mut x[k..k + 3]);
            }
        }
    }
}

/// The workspace for a chain whose number of components per site is known at run time. It persists between steps.
#[derive(Clone, Debug)]
pub struct AnyBand<T> {
    sites: usize,
    /// Whether the derivatives are independent of positions and velocities, and therefore factored only once.
    constant: bool,
    ring: bool,
    /// The parts of a site's velocity.
    unknowns: Vec<Unknown>,
    factored: bool,
    blocks: Blocks<T>,
    velocity: Vec<T>,
    from: Vec<T>,
    momenta: Vec<T>,
    whole: Vec<T>,
    correction: Vec<T>,
    known: Vec<T>,
    scales: Vec<f64>,
    lengths: Vec<T>,
    weights: Vec<T>,
    rounded: Vec<bool>,
    /// The velocities at which the factored derivative was evaluated.
    factored_at: Vec<T>,
}

impl<T: Real> AnyBand<T> {
    /// A workspace for `sites` sites with `n` components each, on a ring or an open chain. Set `constant` if, for one
    /// model and step size, the derivatives do not depend on positions and velocities.
    #[must_use]
    pub fn new(n: usize, sites: usize, ring: bool, constant: bool) -> Self {
        let list = || vec![T::zero(); n * sites];
        Self {
            sites,
            constant,
            ring,
            unknowns: vec![field(n)],
            factored: false,
            blocks: Blocks::new(n, sites, ring),
            velocity: list(),
            from: list(),
            momenta: list(),
            whole: list(),
            correction: list(),
            known: list(),
            scales: vec![0.0; n * sites],
            lengths: list(),
            weights: list(),
            rounded: vec![false; n * sites],
            factored_at: list(),
        }
    }

    /// This workspace for the given parts of a site's velocity, in order. Without them, it is a single field.
    #[must_use]
    pub fn with_unknowns(self, unknowns: &[Unknown]) -> Self {
        let unknowns = unknowns.to_vec();
        Self { unknowns, ..self }
    }

    /// The components at which the vector of a rotation starts.
    fn turning<const N: usize>(&self) -> [bool; N] {
        let mut turning = [false; N];
        for k in begins(&self.unknowns) {
            turning[k] = true;
        }
        turning
    }

    /// The number of sites.
    pub fn sites(&self) -> usize {
        self.sites
    }

    /// The target momenta, site by site. Set them before you solve.
    pub fn known_mut(&mut self) -> &mut [T] {
        &mut self.known
    }

    /// The last solution, site by site.
    pub fn velocities(&self) -> &[T] {
        &self.velocity
    }

    /// Half the scalar product of the last velocities with the target momenta minus the momenta at rest. If momenta are
    /// linear in velocities, this is the kinetic energy.
    pub fn half_product(&self) -> T {
        let all = self.velocity.iter().zip(&self.known).zip(&self.momenta);
        let sum = all.fold(T::zero(), |sum, ((v, p), rest)| sum + *v * (*p - *rest));
        sum * T::from_f64(0.5)
    }

    /// Solves for the velocities of sites with `n` components from the target momenta. Sites outside `moving` have zero
    /// velocity. `all` sets the momenta of sites and adds the momenta of coupling terms, with their derivatives. The
    /// derivative for a rotation `Ω` is taken along `Ω hat(η)`.
    ///
    /// # Errors
    /// [`NoRoot`] if the solution is not connected to rest, with the site of the largest correction.
    pub fn solve(
        &mut self,
        n: usize,
        moving: [usize; 2],
        all: impl FnMut(&mut Sums<'_, T>),
    ) -> Result<(), (usize, NoRoot)> {
        self.solve_by(RuntimeSize(n), moving, all)
    }

    /// Like `solve`, for a block size that may be known at compile time.
    #[inline(always)]
    fn solve_by(
        &mut self,
        size: impl Size,
        moving: [usize; 2],
        all: impl FnMut(&mut Sums<'_, T>),
    ) -> Result<(), (usize, NoRoot)> {
        let n = size.rows();
        for site in (0..moving[0]).chain(moving[1]..self.sites) {
            self.known[n * site..n * (site + 1)].fill(T::zero());
        }
        let mut line = Line {
            n: size,
            blocks: &mut self.blocks,
            unknowns: &self.unknowns,
            ring: self.ring,
            moving,
            all,
            factored: &mut self.factored_at,
        };
        if self.constant {
            // The momenta are linear in the velocities, so one step from rest suffices.
            self.velocity.fill(T::zero());
            line.evaluate(&self.velocity, &mut self.momenta, !self.factored);
            if !self.factored {
                line.scales(&mut self.scales);
            }
            for i in 0..self.known.len() {
                self.correction[i] = self.known[i] - self.momenta[i];
            }
            match self.factored {
                true => line.solve(&mut self.correction),
                false => {
                    self.factored = line.factor_and_solve(&self.velocity, &mut self.correction);
                }
            }
            self.velocity.copy_from_slice(&self.correction);
            let found = self.factored && self.velocity.iter().all(|x| x.is_finite());
            return match found {
                true => Ok(()),
                false => Err((self.worst(n), NoRoot { share: 0.0 })),
            };
        }
        let mut lists = Lists {
            velocity: &mut self.velocity,
            from: &mut self.from,
            momenta: &mut self.momenta,
            whole: &mut self.whole,
            correction: &mut self.correction,
            scales: &mut self.scales,
            lengths: &mut self.lengths,
            weights: &mut self.weights,
            rounded: &mut self.rounded,
        };
        match follow(&self.known, &mut line, &mut lists) {
            Ok(()) => Ok(()),
            Err(e) => Err((self.worst(n), e)),
        }
    }

    /// The site of the largest correction, or the first site with a NaN.
    #[cold]
    fn worst(&self, n: usize) -> usize {
        let sizes = self.correction.iter().zip(&self.scales);
        let sizes = sizes.map(|(x, scale)| x.magnitude() * scale);
        let mut worst = (0, -1.0);
        for (at, size) in sizes.enumerate() {
            if size.is_nan() {
                return at / n.max(1);
            }
            if size > worst.1 {
                worst = (at, size);
            }
        }
        worst.0 / n.max(1)
    }
}

/// The trial velocities of a site: its components, and up to `R` rotations.
#[derive(Clone, Copy, Debug)]
pub struct Velocity<T, const N: usize, const R: usize> {
    numbers: SVector<T, N>,
    /// The rotations; a vector that starts at component `k` has its rotation at index `k / 3`.
    turns: [Matrix3<T>; R],
}

impl<T: Real, const N: usize, const R: usize> Velocity<T, N, R> {
    /// The rotation whose vector starts at component `row`.
    #[inline(always)]
    pub fn turn(&self, row: usize) -> Matrix3<T> {
        self.turns[row / 3]
    }
}

impl<T, const N: usize, const R: usize> Deref for Velocity<T, N, R> {
    type Target = SVector<T, N>;

    #[inline(always)]
    fn deref(&self) -> &SVector<T, N> {
        &self.numbers
    }
}

/// The workspace for sites with `N` components and up to `R` rotations each.
#[derive(Clone, Debug)]
pub struct Band<T, const N: usize, const R: usize> {
    all: AnyBand<T>,
    velocities: Vec<Velocity<T, N, R>>,
}

/// Accumulates momenta and derivatives of sites and coupling terms.
#[derive(Debug)]
pub struct Rows<'a, 'b, T, const N: usize, const R: usize> {
    sums: &'a mut Sums<'b, T>,
    velocities: &'a [Velocity<T, N, R>],
}

/// The momenta that a coupling term adds at its sites, and their nonzero derivatives. An entry `(i, j, D)` is the
/// derivative of the momentum at the term's site `i` by the velocity at its site `j`.
pub type Added<T, const N: usize, const K: usize, const M: usize> =
    ([SVector<T, N>; K], [(usize, usize, SMatrix<T, N, N>); M]);

impl<T: Real, const N: usize, const R: usize> Rows<'_, '_, T, N, R> {
    /// Sets the momenta of all sites and, on request, their derivatives.
    #[inline(always)]
    fn own(
        &mut self,
        momenta: impl Fn(usize, &Velocity<T, N, R>) -> SVector<T, N>,
        whole: impl Fn(usize, &Velocity<T, N, R>) -> (SVector<T, N>, SMatrix<T, N, N>),
    ) {
        let Self { sums, velocities } = self;
        let out = sums.momenta.as_chunks_mut::<N>().0;
        let all = velocities.iter().zip(out).enumerate();
        match &mut sums.blocks {
            None => {
                for (site, (velocity, out)) in all {
                    *out = momenta(site, velocity).data.0[0];
                }
            }
            Some(blocks) => {
                for ((site, (velocity, out)), block) in all.zip(blocks.own_mut::<N>()) {
                    let (momenta, derivative) = whole(site, velocity);
                    *out = momenta.data.0[0];
                    *block = derivative.data.0;
                }
            }
        }
    }

    /// Adds the momenta of coupling terms at their sites and, on request, their derivatives, for each index from
    /// `first` up to, but not including, `last`.
    #[inline(always)]
    pub fn tie<const K: usize, const M: usize>(
        &mut self,
        [first, last]: [usize; 2],
        sites: impl Fn(usize) -> [usize; K],
        momenta: impl Fn(usize, [&Velocity<T, N, R>; K]) -> [SVector<T, N>; K],
        whole: impl Fn(usize, [&Velocity<T, N, R>; K]) -> Added<T, N, K, M>,
    ) {
        let Self { sums, velocities } = self;
        let out = sums.momenta.as_chunks_mut::<N>().0;
        let add = |out: &mut [[T; N]], sites: &[usize; K], momenta: &[SVector<T, N>; K]| {
            for (site, momenta) in sites.iter().zip(momenta) {
                for (x, y) in out[*site].iter_mut().zip(momenta.iter()) {
                    *x += *y;
                }
            }
        };
        match &mut sums.blocks {
            None => {
                for index in first..last {
                    let sites = sites(index);
                    let at = sites.map(|i| &velocities[i]);
                    add(out, &sites, &momenta(index, at));
                }
            }
            Some(blocks) => {
                for index in first..last {
                    let sites = sites(index);
                    let at = sites.map(|i| &velocities[i]);
                    let (momenta, derivatives) = whole(index, at);
                    add(out, &sites, &momenta);
                    for (of, by, derivative) in derivatives {
                        blocks.add_block(sites[of], sites[by], &derivative.data.0);
                    }
                }
            }
        }
    }
}

impl<T: Real, const N: usize, const R: usize> Band<T, N, R> {
    /// A workspace for `sites` sites, on a ring or an open chain. Set `constant` if, for one model and step size, the
    /// derivatives do not depend on positions and velocities.
    #[must_use]
    pub fn new(sites: usize, ring: bool, constant: bool) -> Self {
        let none = Velocity {
            numbers: SVector::zeros(),
            turns: [Matrix3::identity(); R],
        };
        Self {
            all: AnyBand::new(N, sites, ring, constant),
            velocities: vec![none; sites],
        }
    }

    /// This workspace for the given parts of a site's velocity, in order. Without them, it is a single field.
    #[must_use]
    pub fn with_unknowns<const P: usize>(self, unknowns: [Unknown; P]) -> Self {
        let Self { all, velocities } = self;
        let all = all.with_unknowns(&unknowns);
        Self { all, velocities }
    }

    /// Solves for the velocities of sites with the momenta `known`. Sites outside `moving` have zero velocity.
    /// `momenta` computes the momentum of one site at its velocity; `whole` also computes its derivative. The
    /// derivative for a rotation `Ω` is taken along `Ω hat(η)`. `between` adds the momenta of coupling terms.
    ///
    /// # Errors
    /// [`NoRoot`] if the solution is not connected to rest, with the site of the largest correction.
    pub fn solve_along(
        &mut self,
        moving: [usize; 2],
        known: impl Fn(usize) -> SVector<T, N>,
        momenta: impl Fn(usize, &Velocity<T, N, R>) -> SVector<T, N>,
        whole: impl Fn(usize, &Velocity<T, N, R>) -> (SVector<T, N>, SMatrix<T, N, N>),
        between: impl Fn(&mut Rows<'_, '_, T, N, R>),
        out: &mut [SVector<T, N>],
    ) -> Result<(), (usize, NoRoot)> {
        let Self {
            all: band,
            velocities,
        } = self;
        let aims = band.known.as_chunks_mut::<N>().0;
        let all = aims.iter_mut().enumerate();
        for (site, aim) in all.take(moving[1]).skip(moving[0]) {
            *aim = known(site).data.0[0];
        }
        let turning: [bool; N] = band.turning();
        band.solve_by(Fixed::<N>, moving, |sums| {
            let numbers = sums.velocities.as_chunks::<N>().0;
            for (velocity, numbers) in velocities.iter_mut().zip(numbers) {
                velocity.numbers = SVector::from(*numbers);
            }
            for k in (0..N).filter(|k| turning[*k]) {
                for velocity in &mut *velocities {
                    let v = velocity.numbers.fixed_rows::<3>(k).into_owned();
                    velocity.turns[k / 3] = turn_of(&v);
                }
            }
            let mut rows = Rows {
                sums,
                velocities: &*velocities,
            };
            rows.own(|site, v| momenta(site, v), |site, v| whole(site, v));
            between(&mut rows);
        })?;
        for (out, found) in out.iter_mut().zip(band.velocity.as_chunks::<N>().0) {
            *out = SVector::from(*found);
        }
        Ok(())
    }

    /// The kinetic energy if momenta are linear in the velocities of sites and their neighbours. `known` and `between`
    /// are as for [`Band::solve_along`]; `own` computes the momentum at rest and its derivative. NaN if the velocities
    /// cannot be found.
    pub fn kinetic(
        [sites, first, last]: [usize; 3],
        ring: bool,
        known: impl Fn(usize) -> SVector<T, N>,
        own: impl Fn(usize) -> (SVector<T, N>, SMatrix<T, N, N>),
        between: impl Fn(&mut Rows<'_, '_, T, N, R>),
    ) -> T {
        let mut band = Self::new(sites, ring, true);
        let momenta = |site: usize, _: &Velocity<T, N, R>| own(site).0;
        let whole = |site: usize, _: &Velocity<T, N, R>| own(site);
        match band.solve_along([first, last], known, momenta, whole, between, &mut []) {
            Ok(()) => band.all.half_product(),
            Err(_) => T::from_f64(f64::NAN),
        }
    }
}

/// Adds the contributions of coupling terms at the given velocities, for each index from `first` up to, but not
/// including, `last`.
#[inline(always)]
pub fn spread<T: Real, const N: usize, const K: usize>(
    [first, last]: [usize; 2],
    sites: impl Fn(usize) -> [usize; K],
    velocities: &[SVector<T, N>],
    out: &mut [SVector<T, N>],
    term: impl Fn(usize, [SVector<T, N>; K]) -> [SVector<T, N>; K],
) {
    for index in first..last {
        let sites = sites(index);
        let added = term(index, sites.map(|i| velocities[i]));
        for (site, value) in sites.into_iter().zip(added) {
            out[site] += value;
        }
    }
}
