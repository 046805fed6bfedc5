//! The depth of a layer of fluid, smoothed over a length, `mesh phi: Real at a = helmholtz_depth(X, m, alpha);`: the
//! solution of `(A + alpha^2 K) phi = m` with the areas of the Voronoi cells and the Laplace operator of the Delaunay
//! triangulation. `(g/2) sum m phi` is the potential energy whose waves have
//! `omega^2 = g h k^2 / (1 + alpha^2 k^2)`, and which leaves a lake at rest on any mesh (regularised shallow water:
//! Dixon and Reich, 2004). Takes places on a torus, masses and the length; gives depths and exact derivatives.

use super::conjugate::Iteration;
use super::laplacian::Helmholtz;
use super::masses::check_masses;
use super::mesh::{Plane, Voronoi, cleared};
use crate::line::Threads;
use crate::mesh::length::check_length;
use crate::mesh::{Functional, MeshError, Setting};
use crate::{ParameterError, Real};
use nalgebra::SVector;

/// Depths at the particles, to a relative residual of 1e-12.
///
/// The equation is solved from what the last four values extrapolate to, and not again at the same places. The derivative of `sum seed_a phi_a` takes a
/// second solution, `(A + alpha^2 K) lambda = seed`, but not where the seed is a multiple of the masses, as that of the
/// potential energy is: `lambda` is the same multiple of `phi`.
#[allow(non_camel_case_types)] // Models name it.
#[derive(Clone, Debug)]
pub struct helmholtz_depth<T> {
    pub(super) mesh: Voronoi<T>,
    operator: Helmholtz<T>,
    iteration: Iteration<T>,
    masses: Vec<T>,
    /// Where the last value was taken.
    pub(super) at: Vec<Plane<T>>,
    /// The last values, the latest first.
    pub(super) solutions: [Vec<T>; 4],
    pub(super) solved: usize,
    /// Whether mesh and operator are those of the last value.
    pub(super) ready: bool,
    adjoint: Vec<T>,
    products: usize,
    adjoint_products: usize,
}

impl<T: Real> helmholtz_depth<T> {
    /// The mesh at the places of the last value.
    #[must_use]
    pub fn mesh(&self) -> &Voronoi<T> {
        &self.mesh
    }

    /// Applications of the operator by the last value, and by the last derivative: 0 of a multiple of the masses.
    #[must_use]
    pub fn products(&self) -> (usize, usize) {
        (self.products, self.adjoint_products)
    }

    /// The masses with which the depth at the places `at` is `depth`.
    ///
    /// # Errors
    /// Those of [`Voronoi::update`].
    pub fn masses(
        mesh: &mut Voronoi<T>,
        at: &[SVector<T, 2>],
        alpha: T,
        depth: &[T],
    ) -> Result<Vec<T>, MeshError> {
        MeshError::unless_of_length(depth, mesh.sites())?;
        mesh.update(at)?;
        let mut operator = Helmholtz::new(mesh.sites(), alpha);
        operator.update(mesh);
        Ok((0..depth.len()).map(|a| operator.row(a, depth)).collect())
    }

    /// The factor between a seed and the masses.
    fn multiple(&self, seed: &[T]) -> Option<T> {
        let factor = seed[0] / self.masses[0];
        let rounding = 8.0 * T::EPSILON;
        let same = seed.iter().zip(&self.masses).all(|(s, m)| {
            let expected = factor * *m;
            (*s - expected).magnitude() <= rounding * expected.magnitude()
        });
        same.then_some(factor)
    }

    /// Puts what the last values extrapolate to in front of them.
    fn extrapolate(&mut self) {
        let [latest, earlier, before, earliest] = &mut self.solutions;
        let (three, six) = (T::from_f64(3.0), T::from_f64(6.0));
        let four = T::from_f64(4.0);
        for a in 0..latest.len() {
            let (x, y, z, w) = (latest[a], earlier[a], before[a], earliest[a]);
            earliest[a] = match self.solved {
                0 => self.masses[a] / self.operator.areas[a],
                1 => x,
                2 => x + (x - y),
                3 => three * (x - y) + z,
                _ => four * (x + z) - six * y - w,
            };
        }
        self.solutions.rotate_right(1);
    }
}

impl<T: Real> Functional<T, 2> for helmholtz_depth<T> {
    type Argument = SVector<T, 2>;
    /// Masses, and the length.
    type Data<'a> = (&'a [T], T);

    fn new(setting: &Setting<2>, (masses, alpha): (&[T], T)) -> Result<Self, ParameterError> {
        let mesh = Voronoi::new(&setting.domain, setting.particles)?;
        check_masses(masses, setting.particles)?;
        check_length(alpha, &setting.domain)?;
        let zeros = vec![T::zero(); setting.particles];
        Ok(Self {
            mesh,
            operator: Helmholtz::new(setting.particles, alpha),
            iteration: Iteration::new(setting.particles),
            masses: masses.to_vec(),
            at: vec![Plane::zeros(); setting.particles],
            solutions: core::array::from_fn(|_| zeros.clone()),
            solved: 0,
            ready: false,
            adjoint: zeros,
            products: 0,
            adjoint_products: 0,
        })
    }

    fn sites(&self) -> usize {
        self.mesh.sites()
    }

    fn value(&mut self, at: &[Self::Argument], out: &mut [T]) -> Result<(), MeshError> {
        MeshError::unless_of_length(out, self.sites())?;
        let again = self.solved > 0 && self.at == at;
        if !(again && self.ready) {
            self.ready = false;
            self.mesh.update(at)?;
            self.operator.update(&self.mesh);
            self.ready = true;
        }
        if again {
            self.products = 0;
            out.copy_from_slice(&self.solutions[0]);
            return Ok(());
        }
        self.extrapolate();
        let solution = &mut self.solutions[0];
        match self.iteration.solve(&self.operator, &self.masses, solution) {
            Ok(products) => self.products = products,
            Err(error) => {
                // Nothing is extrapolated from what has failed.
                self.solved = 0;
                return Err(error);
            }
        }
        self.solved = (self.solved + 1).min(4);
        self.at.copy_from_slice(at);
        out.copy_from_slice(solution);
        Ok(())
    }

    fn pull_back(
        &mut self,
        _: &[Self::Argument],
        seed: &[T],
        out: &mut [Self::Argument],
    ) -> Result<(), MeshError> {
        cleared(seed, out, self.sites())?;
        let depth = &self.solutions[0];
        let multiple = self.multiple(seed);
        let starts = self.adjoint.iter_mut().zip(depth);
        match multiple {
            Some(factor) => {
                starts.for_each(|(adjoint, depth)| *adjoint = factor * *depth);
                self.adjoint_products = 0;
            }
            None => {
                starts.for_each(|(adjoint, _)| *adjoint = T::zero());
                let adjoint = &mut self.adjoint;
                self.adjoint_products = self.iteration.solve(&self.operator, seed, adjoint)?;
            }
        }
        self.operator
            .add_gradient(&self.mesh, &self.adjoint, depth, out);
        Ok(())
    }

    fn share(&mut self, threads: Threads) {
        self.mesh.share(threads);
        self.iteration.share(threads);
    }
}
