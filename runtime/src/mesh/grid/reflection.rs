//! Reflection of particles that have crossed a wall. In the exact flow particles never cross; with finite steps some
//! do. The reflection mirrors their position and velocity. It leaves the kinetic energy and the depth on a grid
//! unchanged, since the depth is even about the walls.

use super::super::{Domain, MeshError, Wall};
use crate::Real;

impl<const D: usize> Domain<D> {
    /// Puts a particle back that is beyond walls, its coordinates and the components of its kinetic velocity given, and
    /// says how many it was beyond: 0 of most particles. `cell[d]` is how far beyond a wall a particle may be. Where
    /// the momentum has a term of a vector potential, the velocity without it is what a wall turns.
    ///
    /// # Errors
    /// [`MeshError::Outside`] with the number of the particle, `site`, if it is further beyond a wall;
    /// [`MeshError::NotFinite`] if it is nowhere. The particle is as it was then.
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
