//! The area of each particle's Voronoi cell, `mesh A: Real at a = voronoi_area(X);`. A particle's mass over this area
//! is the depth of the layer. Takes positions on a torus; gives areas and their exact derivatives.

use super::mesh::{Voronoi, cleared};
use crate::line::Threads;
use crate::mesh::{Functional, MeshError, Setting};
use crate::{ParameterError, Real};
use nalgebra::SVector;

/// Areas of Voronoi cells.
///
/// With `l`, `R` and `c` of the faces, `dA_a/dX_a = sum_b (l/R) (c - X_a)` and `dA_b/dX_a = -(l/R) (c - X_a)`. The
/// derivative is continuous when neighbours change.
#[allow(non_camel_case_types)] // Models name it.
#[derive(Clone, Debug)]
pub struct voronoi_area<T> {
    pub(super) mesh: Voronoi<T>,
}

impl<T: Real> voronoi_area<T> {
    /// The mesh at the positions of the last evaluation.
    #[must_use]
    pub fn mesh(&self) -> &Voronoi<T> {
        &self.mesh
    }
}

impl<T: Real> Functional<T, 2> for voronoi_area<T> {
    type Argument = SVector<T, 2>;
    type Data<'a> = ();

    fn new(setting: &Setting<2>, (): ()) -> Result<Self, ParameterError> {
        let mesh = Voronoi::new(&setting.domain, setting.particles)?;
        Ok(Self { mesh })
    }

    fn sites(&self) -> usize {
        self.mesh.sites()
    }

    fn value(&mut self, at: &[Self::Argument], out: &mut [T]) -> Result<(), MeshError> {
        MeshError::unless_of_length(out, self.sites())?;
        self.mesh.update(at)?;
        self.mesh.areas(out)
    }

    fn pull_back(
        &mut self,
        _: &[Self::Argument],
        seed: &[T],
        out: &mut [Self::Argument],
    ) -> Result<(), MeshError> {
        cleared(seed, out, self.sites())?;
        self.mesh.add_area_gradient(|a| seed[a], out);
        Ok(())
    }

    fn share(&mut self, threads: Threads) {
        self.mesh.share(threads);
    }
}
