//! Reflection of particles that have crossed a wall. In the exact flow particles never cross; with finite steps some
//! do. The reflection mirrors their position and velocity. It leaves the kinetic energy and the depth on a grid
//! unchanged, since the depth is even about the walls.

use super::super::{Domain, MeshError, Wall};
use crate::Real;

impl<const D: usize> Domain<D> {
    /// Reflects a particle that is beyond walls, given its coordinates and the components of its kinetic velocity.
    /// Returns the number of walls that it was beyond, which is 0 for most particles. `cell[d]` is the largest
    /// admitted distance beyond a wall. If the momentum contains a vector potential, the wall reverses only the
    /// kinetic velocity.
    ///
    /// # Errors
    /// [`MeshError::Outside`] with the number of the particle, `site`, if it is further beyond a wall;
    /// [`MeshError::NotFinite`] if its coordinates are not finite. The particle is then unchanged.
    pub fn reflect<T: Real>(
        &self,
        site: usize,
        cell: &[f64; D],
        position: &mut [T; D],
        velocity: &mut [T; D],
    ) -> Result<usize, MeshError> {
        let (mut to, mut crossed) = (*position, [false; D]);
        for d in 0..D {
            let x = to[d].value();
            if !x.is_finite() {
                return Err(MeshError::NotFinite { site });
            }
            let length = self.lengths[d];
            let by = match self.walls[d] {
                Wall::Periodic => 0.0,
                Wall::Solid => (-x).max(x - length),
            };
            if by <= 0.0 {
                continue;
            }
            if by > cell[d] || by > length {
                return Err(MeshError::Outside { site, by });
            }
            crossed[d] = true;
            to[d] = match x < 0.0 {
                true => -to[d],
                false => T::from_f64(2.0 * length) - to[d],
            };
        }
        *position = to;
        for (component, crossed) in velocity.iter_mut().zip(crossed) {
            if crossed {
                *component = -*component;
            }
        }
        Ok(crossed.into_iter().filter(|c| *c).count())
    }
}
