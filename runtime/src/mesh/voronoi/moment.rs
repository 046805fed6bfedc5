//! The second moment of each particle's Voronoi cell about the particle, `mesh I: Real at a = second_moment(X);`. In a
//! potential it moves particles towards the centres of their cells, but it also makes the fluid resist shear like a
//! soft solid. Takes positions on a torus; gives moments and their exact derivatives.

use super::mesh::{Voronoi, cleared, dot, left};
use crate::line::Threads;
use crate::mesh::{Functional, MeshError, Setting};
use crate::{ParameterError, Real};
use nalgebra::SVector;

/// The integral `I_a` of `|x - X_a|^2` over the cell of `a`. For equal seeds the derivative is `2 A_a (X_a - C_a)` with
/// the centre of mass `C_a`.
#[allow(non_camel_case_types)] // Models name it.
#[derive(Clone, Debug)]
pub struct second_moment<T> {
    pub(super) mesh: Voronoi<T>,
}

impl<T: Real> Functional<T, 2> for second_moment<T> {
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
        self.mesh.second_moments(out)
    }

    fn pull_back(
        &mut self,
        _: &[Self::Argument],
        seed: &[T],
        out: &mut [Self::Argument],
    ) -> Result<(), MeshError> {
        cleared(seed, out, self.sites())?;
        // The integrand depends on the position of the particle.
        let twice = T::from_f64(-2.0);
        self.mesh.add_first_moments(|a| twice * seed[a], out);
        // The faces move too: by `(x - X_a).dX_a / R` along the edge. On a face, both cells have the same integrand.
        let [half, quarter, third, eighth] =
            [(1, 2), (1, 4), (1, 3), (1, 8)].map(|(n, d)| T::from_ratio(n, d));
        for triangle in self.mesh.triangles() {
            for k in 0..3 {
                let (d, w) = (triangle.sides[k], triangle.weights[k]);
                let (a, b) = (triangle.sites[k], triangle.sites[(k + 1) % 3]);
                let size = (seed[a] - seed[b]) * dot(d, d) * w;
                let along = d * (size * half * (quarter + third * w * w));
                let up = left(d) * (size * w * (eighth + quarter * w * w));
                out[a] += along + up;
                out[b] += along - up;
            }
        }
        Ok(())
    }

    fn share(&mut self, threads: Threads) {
        self.mesh.share(threads);
    }
}
