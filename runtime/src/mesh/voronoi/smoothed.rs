//! Depths smoothed on a mesh, once or several times: `phi_1 = H^-1 m`, `phi_2 = H^-1 A phi_1`, ..., with the areas `A`
//! of the Voronoi cells and an operator `H = A + alpha^2 K` that maps constants to multiples of `A`. Takes positions on
//! a torus, masses and the length; gives the depth after the last smoothing, and exact derivatives.

use super::conjugate::Iteration;
use super::extrapolated::Extrapolated;
use super::masses::check_masses;
use super::mesh::{Plane, Voronoi, cleared};
use super::rows::Rows;
use crate::line::Threads;
use crate::mesh::length::check_length;
use crate::mesh::{Functional, MeshError, Setting};
use crate::{ParameterError, Real};
use nalgebra::SVector;

/// A smoothing operator `H = A + alpha^2 K`, with `K` symmetric, positive semidefinite, and zero for constants.
pub trait Operator<T: Real>: Clone + Send + Sync {
    /// A workspace for the operator.
    fn new(setting: &Setting<2>, alpha: T) -> Self;

    /// Updates the operator to a mesh.
    ///
    /// # Errors
    /// If the operator is undefined on the mesh.
    fn update(&mut self, mesh: &Voronoi<T>) -> Result<(), MeshError>;

    /// The rows of the operator.
    fn rows(&self) -> &Rows<T>;

    /// Adds the gradient of `-u.(H v)` with respect to the positions to `out`.
    fn add_gradient(&mut self, mesh: &Voronoi<T>, u: &[T], v: &[T], out: &mut [SVector<T, 2>]);
}

/// Depths at the particles, smoothed `TIMES` times, each to a relative residual of 1e-12.
///
/// Every solution starts from an extrapolation of the last four solutions, and is reused at the same positions. The
/// derivative of `sum seed_a phi_a` needs `TIMES` adjoint solutions, `H lambda = seed` and so on. If the seed is a
/// multiple of the masses, as for the potential energy, they are the same multiple of the depths in reverse order and
/// need no further solution.
#[derive(Clone, Debug)]
pub struct Smoothed<T, O, const TIMES: usize> {
    pub(super) mesh: Voronoi<T>,
    operator: O,
    iteration: Iteration<T>,
    masses: Vec<T>,
    /// The positions of the last evaluation.
    pub(super) at: Vec<Plane<T>>,
    /// The depths.
    pub(super) depths: [Extrapolated<T>; TIMES],
    /// Whether the mesh and the operator belong to the last evaluation.
    pub(super) ready: bool,
    adjoints: [Vec<T>; TIMES],
    right: Vec<T>,
    products: usize,
    adjoint_products: usize,
}

impl<T: Real, O: Operator<T>, const TIMES: usize> Smoothed<T, O, TIMES> {
    /// The mesh at the positions of the last evaluation.
    #[must_use]
    pub fn mesh(&self) -> &Voronoi<T> {
        &self.mesh
    }

    /// How often the last evaluation and the last derivative applied the operator. The second number is 0 if the seed
    /// is a multiple of the masses.
    #[must_use]
    pub fn products(&self) -> (usize, usize) {
        (self.products, self.adjoint_products)
    }

    /// The masses for which the depth at the positions `at` is `depth`.
    ///
    /// # Errors
    /// The errors of [`Voronoi::update`].
    pub fn masses(
        mesh: &mut Voronoi<T>,
        at: &[SVector<T, 2>],
        alpha: T,
        depth: &[T],
    ) -> Result<Vec<T>, MeshError> {
        let particles = mesh.sites();
        MeshError::unless_of_length(depth, particles)?;
        mesh.update(at)?;
        let setting = Setting {
            domain: crate::mesh::Domain::torus(mesh.lengths()),
            grid: None,
            particles,
        };
        let mut operator = O::new(&setting, alpha);
        operator.update(mesh)?;
        let rows = operator.rows();
        let mut depth = depth.to_vec();
        for turn in 0..TIMES {
            let above: Vec<T> = (0..particles).map(|a| rows.row(a, &depth)).collect();
            depth = above;
            if turn + 1 < TIMES {
                depth
                    .iter_mut()
                    .zip(&rows.areas)
                    .for_each(|(d, a)| *d /= *a);
            }
        }
        Ok(depth)
    }

    /// The factor if the seed is a multiple of the masses.
    fn multiple(&self, seed: &[T]) -> Option<T> {
        let factor = seed[0] / self.masses[0];
        let rounding = 8.0 * T::EPSILON;
        let same = seed.iter().zip(&self.masses).all(|(s, m)| {
            let expected = factor * *m;
            (*s - expected).magnitude() <= rounding * expected.magnitude()
        });
        same.then_some(factor)
    }

    /// Solves for the depths, one after another.
    fn solve(&mut self) -> Result<(), MeshError> {
        let rows = self.operator.rows();
        self.products = 0;
        for turn in 0..TIMES {
            let (before, from) = self.depths.split_at_mut(turn);
            let right = match before.last() {
                None => &self.masses,
                Some(before) => {
                    weighted(&mut self.right, &rows.areas, before.latest());
                    &self.right
                }
            };
            let solution = from[0].next(|a| right[a] / rows.areas[a]);
            self.products += self.iteration.solve(rows, right, solution)?;
        }
        self.depths.iter_mut().for_each(Extrapolated::accept);
        Ok(())
    }

    /// Solves for the adjoints of the depths, in reverse order.
    fn solve_back(&mut self, seed: &[T]) -> Result<(), MeshError> {
        let rows = self.operator.rows();
        self.adjoint_products = 0;
        for turn in 0..TIMES {
            let (before, from) = self.adjoints.split_at_mut(turn);
            let right = match before.last() {
                None => seed,
                Some(before) => {
                    weighted(&mut self.right, &rows.areas, before);
                    &self.right
                }
            };
            from[0].fill(T::zero());
            self.adjoint_products += self.iteration.solve(rows, right, &mut from[0])?;
        }
        Ok(())
    }
}

/// Multiplies values by areas.
fn weighted<T: Real>(out: &mut [T], areas: &[T], values: &[T]) {
    let pairs = areas.iter().zip(values);
    out.iter_mut()
        .zip(pairs)
        .for_each(|(out, (area, x))| *out = *area * *x);
}

impl<T: Real, O: Operator<T>, const TIMES: usize> Functional<T, 2> for Smoothed<T, O, TIMES> {
    type Argument = SVector<T, 2>;
    /// The masses and the smoothing length.
    type Data<'a> = (&'a [T], T);

    fn new(setting: &Setting<2>, (masses, alpha): (&[T], T)) -> Result<Self, ParameterError> {
        let mesh = Voronoi::new(&setting.domain, setting.particles)?;
        check_masses(masses, setting.particles)?;
        check_length(alpha, &setting.domain)?;
        let zeros = vec![T::zero(); setting.particles];
        Ok(Self {
            mesh,
            operator: O::new(setting, alpha),
            iteration: Iteration::new(setting.particles),
            masses: masses.to_vec(),
            at: vec![Plane::zeros(); setting.particles],
            depths: core::array::from_fn(|_| Extrapolated::new(setting.particles)),
            ready: false,
            adjoints: core::array::from_fn(|_| zeros.clone()),
            right: if TIMES > 1 { zeros } else { Vec::new() },
            products: 0,
            adjoint_products: 0,
        })
    }

    fn sites(&self) -> usize {
        self.mesh.sites()
    }

    fn value(&mut self, at: &[Self::Argument], out: &mut [T]) -> Result<(), MeshError> {
        MeshError::unless_of_length(out, self.sites())?;
        let again = self.depths[TIMES - 1].solved > 0 && self.at == at;
        if !(again && self.ready) {
            self.ready = false;
            self.mesh.update(at)?;
            self.operator.update(&self.mesh)?;
            self.ready = true;
        }
        if again {
            self.products = 0;
        } else {
            if let Err(error) = self.solve() {
                // After a failure, no stored solution is used for extrapolation.
                self.depths.iter_mut().for_each(|depth| depth.solved = 0);
                return Err(error);
            }
            self.at.copy_from_slice(at);
        }
        out.copy_from_slice(self.depths[TIMES - 1].latest());
        Ok(())
    }

    fn pull_back(
        &mut self,
        _: &[Self::Argument],
        seed: &[T],
        out: &mut [Self::Argument],
    ) -> Result<(), MeshError> {
        cleared(seed, out, self.sites())?;
        match self.multiple(seed) {
            Some(factor) => {
                for (adjoint, depth) in self.adjoints.iter_mut().zip(&self.depths) {
                    let each = adjoint.iter_mut().zip(depth.latest());
                    each.for_each(|(adjoint, depth)| *adjoint = factor * *depth);
                }
                self.adjoint_products = 0;
            }
            None => self.solve_back(seed)?,
        }
        for (turn, depth) in self.depths.iter().enumerate() {
            let (adjoint, depth) = (&self.adjoints[TIMES - 1 - turn], depth.latest());
            self.operator.add_gradient(&self.mesh, adjoint, depth, out);
            if turn + 1 < TIMES {
                // The right side of the next adjoint equation.
                let next = &self.adjoints[TIMES - 2 - turn];
                self.mesh.add_area_gradient(|a| next[a] * depth[a], out);
            }
        }
        Ok(())
    }

    fn share(&mut self, threads: Threads) {
        self.mesh.share(threads);
        self.iteration.share(threads);
    }
}
