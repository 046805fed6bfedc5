//! Velocities of all sites at once, where momenta hold velocities of neighbours: Newton's method from rest
//! with block-tridiagonal derivatives. Takes the momenta of sites and of terms of neighbours, with their
//! derivatives; gives the velocities, or the site at which they cannot be followed.

use super::blocks::Blocks;
use super::root::{Lists, Momenta, NoRoot, follow, scales_of};
use crate::Real;
use nalgebra::{SMatrix, SVector};

/// What is kept from step to step: room for the equations of a line of sites with `N` components each.
#[derive(Clone, Debug)]
pub struct Band<T, const N: usize> {
    sites: usize,
    /// Whether derivatives are the same at all places and velocities: they are factored once.
    constant: bool,
    factored: bool,
    blocks: Blocks<T>,
    velocity: Vec<T>,
    from: Vec<T>,
    momenta: Vec<T>,
    whole: Vec<T>,
    correction: Vec<T>,
    known: Vec<T>,
    scales: Vec<f64>,
}

/// The velocities at which momenta are wanted.
#[derive(Clone, Copy, Debug)]
pub struct Velocities<'a, T, const N: usize>(&'a [T]);

impl<T: Real, const N: usize> Velocities<'_, T, N> {
    /// Those of a site.
    #[inline(always)]
    pub fn at(&self, site: usize) -> SVector<T, N> {
        SVector::from_column_slice(&self.0[N * site..N * (site + 1)])
    }
}

/// Momenta of sites and their derivatives, to which terms of neighbours are added.
#[derive(Debug)]
pub struct Rows<'a, T, const N: usize> {
    momenta: &'a mut [T],
    /// None where derivatives are known.
    blocks: Option<&'a mut Blocks<T>>,
}

impl<T: Real, const N: usize> Rows<'_, T, N> {
    /// Adds what a term gives to the sites that it touches: momenta, and their derivatives, of the first index by
    /// the velocity of the second.
    #[inline(always)]
    pub fn add<const K: usize>(
        &mut self,
        sites: [usize; K],
        (momenta, derivatives): ([SVector<T, N>; K], [[SMatrix<T, N, N>; K]; K]),
    ) {
        for (i, row) in sites.into_iter().enumerate() {
            let own = &mut self.momenta[N * row..N * (row + 1)];
            for (x, y) in own.iter_mut().zip(momenta[i].iter()) {
                *x += *y;
            }
            if let Some(blocks) = &mut self.blocks {
                for (j, column) in sites.into_iter().enumerate() {
                    blocks.add(row, column, derivatives[i][j].as_slice());
                }
            }
        }
    }
}

/// The equations of a line.
struct Line<'a, T, A, B, const N: usize> {
    blocks: &'a mut Blocks<T>,
    moving: [usize; 2],
    own: A,
    between: B,
    /// Whether derivatives are known.
    known: bool,
}

impl<T: Real, A, B, const N: usize> Momenta<T> for Line<'_, T, A, B, N>
where
    A: Fn(usize, &SVector<T, N>) -> (SVector<T, N>, SMatrix<T, N, N>),
    B: Fn(Velocities<'_, T, N>, &mut Rows<'_, T, N>),
{
    #[inline(always)]
    fn at(&mut self, velocity: &[T], momenta: &mut [T]) {
        let all = Velocities(velocity);
        if !self.known {
            self.blocks.clear();
        }
        let sites = velocity.len() / N.max(1);
        for site in 0..sites {
            let (own, derivative) = (self.own)(site, &all.at(site));
            momenta[N * site..N * (site + 1)].copy_from_slice(own.as_slice());
            if !self.known {
                self.blocks.add(site, site, derivative.as_slice());
            }
        }
        let mut rows = Rows {
            momenta,
            blocks: match self.known {
                true => None,
                false => Some(&mut *self.blocks),
            },
        };
        (self.between)(all, &mut rows);
        let [first, last] = self.moving;
        for site in (0..first).chain(last..sites) {
            momenta[N * site..N * (site + 1)].fill(T::zero());
            if !self.known {
                self.blocks.hold(site);
            }
        }
    }

    fn scales(&self, scales: &mut [f64]) {
        for (site, own) in scales.chunks_exact_mut(N).enumerate() {
            scales_of(N, self.blocks.own(site), own);
        }
    }

    #[inline(always)]
    fn factor(&mut self) -> bool {
        self.blocks.factor(N, 0.0).is_ok()
    }

    #[inline(always)]
    fn solve(&mut self, x: &mut [T]) {
        self.blocks.solve(N, x);
    }
}

impl<T: Real, const N: usize> Band<T, N> {
    /// Room for so many sites, of a ring or of an open line; `constant` where derivatives are the same at all
    /// places and velocities, for one model and step.
    #[must_use]
    pub fn new(sites: usize, ring: bool, constant: bool) -> Self {
        let list = || vec![T::zero(); N * sites];
        Self {
            sites,
            constant,
            factored: false,
            blocks: Blocks::new(N, sites, ring),
            velocity: list(),
            from: list(),
            momenta: list(),
            whole: list(),
            correction: list(),
            known: list(),
            scales: vec![0.0; N * sites],
        }
    }

    /// The velocities of sites whose momenta are `known`, those outside `moving` zero: `own` gives momenta and
    /// their derivative by the velocity of one site, `between` adds those of terms of neighbours.
    ///
    /// # Errors
    /// [`NoRoot`] where none follow from rest, and the site where that shows most.
    pub fn solve(
        &mut self,
        moving: [usize; 2],
        known: impl Fn(usize) -> SVector<T, N>,
        own: impl Fn(usize, &SVector<T, N>) -> (SVector<T, N>, SMatrix<T, N, N>),
        between: impl Fn(Velocities<'_, T, N>, &mut Rows<'_, T, N>),
        out: &mut [SVector<T, N>],
    ) -> Result<(), (usize, NoRoot)> {
        self.known.fill(T::zero());
        for site in moving[0]..moving[1] {
            let value = known(site);
            self.known[N * site..N * (site + 1)].copy_from_slice(value.as_slice());
        }
        let mut line = Line {
            blocks: &mut self.blocks,
            moving,
            own,
            between,
            known: self.factored,
        };
        if self.constant {
            // Linear: from rest in one step.
            self.velocity.fill(T::zero());
            line.at(&self.velocity, &mut self.momenta);
            line.scales(&mut self.scales);
            self.factored = self.factored || line.factor();
            for i in 0..self.known.len() {
                self.velocity[i] = self.known[i] - self.momenta[i];
            }
            if self.factored {
                line.solve(&mut self.velocity);
            }
            let found = self.factored && self.velocity.iter().all(|x| x.is_finite());
            self.correction.copy_from_slice(&self.velocity);
            if !found {
                return Err((self.worst(), NoRoot { share: 0.0 }));
            }
            self.put(out);
            return Ok(());
        }
        let mut lists = Lists {
            velocity: &mut self.velocity,
            from: &mut self.from,
            momenta: &mut self.momenta,
            whole: &mut self.whole,
            correction: &mut self.correction,
            scales: &mut self.scales,
        };
        if let Err(e) = follow(&self.known, &mut line, &mut lists) {
            return Err((self.worst(), e));
        }
        self.put(out);
        Ok(())
    }

    fn put(&self, out: &mut [SVector<T, N>]) {
        for (site, out) in out.iter_mut().enumerate().take(self.sites) {
            *out = Velocities(&self.velocity).at(site);
        }
    }

    /// The site of the largest correction, or of the first that is no number.
    #[cold]
    fn worst(&self) -> usize {
        let sizes = self.correction.iter().zip(&self.scales);
        let sizes = sizes.map(|(x, scale)| x.magnitude() * scale);
        let mut worst = (0, -1.0);
        for (at, size) in sizes.enumerate() {
            if size.is_nan() {
                return at / N.max(1);
            }
            if size > worst.1 {
                worst = (at, size);
            }
        }
        worst.0 / N.max(1)
    }
}
