//! The mesh that moves with the particles: triangles with the vectors of their sides. Takes positions. The real parts
//! of the positions decide which sites are neighbours; everything else uses the scalar type of the positions.

use super::delaunay::{Counted, Delaunay};
use super::half_edges::next;
use super::torus::Torus;
use crate::line::Threads;
use crate::mesh::{Domain, MeshError, Wall};
use crate::{ParameterError, Problem, Real};
use nalgebra::SVector;

/// A vector in the plane.
pub(super) type Plane<T> = SVector<T, 2>;

/// The Delaunay triangulation of particles on a torus, and its dual, the Voronoi diagram.
#[derive(Clone, Debug)]
pub struct Voronoi<T> {
    pub(super) delaunay: Delaunay,
    /// The positions without their whole periods.
    local: Vec<Plane<T>>,
}

/// A Delaunay triangle, counterclockwise.
#[derive(Clone, Copy, Debug)]
pub struct Triangle<T> {
    /// The corners.
    pub sites: [usize; 3],
    /// The sides; the first leads from the first corner to the second, and so on.
    pub sides: [SVector<T, 2>; 3],
    /// Twice the area.
    pub twice_area: T,
    /// Half the cotangent of the angle opposite each side. Times the length of the side, this is the distance from its
    /// midpoint to the circumcentre, positive towards the interior.
    pub weights: [T; 3],
}

/// Sets `out` to zero; it has one vector for each particle.
///
/// # Errors
/// [`MeshError::Count`] if `seed` or `out` has another length.
pub(super) fn cleared<T: Real>(
    seed: &[T],
    out: &mut [Plane<T>],
    sites: usize,
) -> Result<(), MeshError> {
    MeshError::unless_of_length(seed, sites)?;
    MeshError::unless_of_length(out, sites)?;
    out.fill(Plane::zeros());
    Ok(())
}

/// The vector rotated counterclockwise by a right angle.
#[inline(always)]
pub(super) fn left<T: Real>(v: Plane<T>) -> Plane<T> {
    Plane::new(-v[1], v[0])
}

/// The scalar product.
#[inline(always)]
pub(super) fn dot<T: Real>(a: Plane<T>, b: Plane<T>) -> T {
    a[0] * b[0] + a[1] * b[1]
}

impl<T: Real> Voronoi<T> {
    /// The most particles of a mesh: half-edges are numbered with 32 bits.
    pub const MOST: usize = (u32::MAX / 6) as usize;

    /// A mesh for this number of particles; set their positions with [`Voronoi::update`].
    ///
    /// # Errors
    /// - The domain is not periodic in both directions, or its area is not positive and finite.
    /// - One period is more than 1e6 times the other.
    /// - The number of particles is zero or above [`Voronoi::MOST`].
    /// - The scalar has several lanes.
    pub fn new(domain: &Domain<2>, particles: usize) -> Result<Self, ParameterError> {
        let refused = |problem, remedy| ParameterError {
            field: "domain",
            problem,
            remedy,
        };
        if domain.walls != [Wall::Periodic; 2] {
            let text = "the domain is periodic in both directions";
            let remedy = "place the particles on a torus: Voronoi meshes do not support walls";
            return Err(refused(Problem::AssumptionFails { text }, remedy));
        }
        for (index, &value) in domain.lengths.iter().enumerate() {
            let remedy = "give the lengths of the two periods";
            if !value.is_finite() {
                return Err(refused(Problem::NotFinite { index, value }, remedy));
            }
            if value <= 0.0 {
                return Err(refused(Problem::NotPositive { value }, remedy));
            }
        }
        let ratio = domain.lengths[0] / domain.lengths[1];
        if ratio.max(1.0 / ratio) > 1e6 {
            let text = "one period is at most 1e6 times the other";
            let remedy = "model this domain in one dimension";
            return Err(refused(Problem::AssumptionFails { text }, remedy));
        }
        if particles == 0 || particles > Self::MOST {
            let value = particles as f64;
            let problem = if particles == 0 {
                Problem::NotPositive { value }
            } else {
                let text = "there are at most 7e8 particles";
                Problem::AssumptionFails { text }
            };
            return Err(ParameterError {
                field: "particles",
                problem,
                remedy: "place at least one particle, and at most 7e8",
            });
        }
        if T::LANES > 1 {
            let text = "the scalar has one lane";
            let remedy = "run the members of an ensemble one after another";
            return Err(refused(Problem::AssumptionFails { text }, remedy));
        }
        let torus = Torus::new(domain.lengths);
        Ok(Self {
            delaunay: Delaunay::new(torus, particles),
            local: vec![Plane::zeros(); particles],
        })
    }

    /// Sets the number of threads that test edges. The flips and their order do not depend on it.
    pub fn share(&mut self, threads: Threads) {
        self.delaunay.threads = threads;
    }

    /// The number of particles.
    #[must_use]
    pub fn sites(&self) -> usize {
        self.local.len()
    }

    /// The work done so far to follow the motion.
    #[must_use]
    pub fn counted(&self) -> Counted {
        self.delaunay.counted
    }

    /// The periods of the domain.
    #[must_use]
    pub fn lengths(&self) -> [f64; 2] {
        self.delaunay.torus.lengths
    }

    /// Moves the particles to new positions, wrapped or not, and updates the mesh.
    ///
    /// # Errors
    /// [`MeshError::Coincident`] if two particles are closer than 1e-15 of the longer period, [`MeshError::Flat`] if
    /// three particles are nearly that close, [`MeshError::NotFinite`], [`MeshError::TooFar`], [`MeshError::Count`].
    /// After an error, do not use the mesh before the next successful update.
    pub fn update(&mut self, at: &[SVector<T, 2>]) -> Result<(), MeshError> {
        MeshError::unless_of_length(at, self.sites())?;
        self.delaunay.follow(|site| {
            let x = &at[site];
            [x[0].value(), x[1].value()]
        })?;
        let lengths = self.lengths();
        let turns = self.delaunay.turns.iter();
        for ((local, x), turns) in self.local.iter_mut().zip(at).zip(turns) {
            for k in 0..2 {
                local[k] = x[k] - T::from_f64(turns[k] * lengths[k]);
            }
        }
        Ok(())
    }

    /// The positions of the particles, within the domain or at most two periods from it.
    #[must_use]
    pub fn places(&self) -> &[SVector<T, 2>] {
        &self.local
    }

    /// The vector between two sites, with the second shifted by `offset` periods.
    #[inline(always)]
    pub(super) fn side(&self, from: usize, to: usize, offset: [i16; 2]) -> Plane<T> {
        let mut side = self.local[to] - self.local[from];
        if offset != [0; 2] {
            let lengths = self.delaunay.torus.lengths;
            for k in 0..2 {
                side[k] += T::from_f64(f64::from(offset[k]) * lengths[k]);
            }
        }
        side
    }

    /// The triangles, two for each particle.
    #[inline]
    pub fn triangles(&self) -> impl Iterator<Item = Triangle<T>> + '_ {
        (0..self.delaunay.edges.len() / 3).map(|t| self.triangle(t))
    }

    /// The triangle with number `t`.
    #[inline(always)]
    pub(super) fn triangle(&self, t: usize) -> Triangle<T> {
        let edges = &self.delaunay.edges;
        let origin = &edges.origin[3 * t..3 * t + 3];
        let offset = &edges.offset[3 * t..3 * t + 3];
        let sites = [origin[0] as usize, origin[1] as usize, origin[2] as usize];
        let first = self.side(sites[0], sites[1], offset[0]);
        let second = self.side(sites[1], sites[2], offset[1]);
        let third = -(first + second);
        let twice_area = first[0] * second[1] - first[1] * second[0];
        let scale = T::from_f64(-0.5) / twice_area;
        Triangle {
            sites,
            sides: [first, second, third],
            twice_area,
            weights: [
                dot(second, third) * scale,
                dot(third, first) * scale,
                dot(first, second) * scale,
            ],
        }
    }

    /// One half-edge of every edge, the one with the smaller number, with its twin.
    pub(super) fn edges(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let twin = self.delaunay.edges.twin.iter().enumerate();
        twin.filter_map(|(e, &f)| (e < f as usize).then_some((e, f as usize)))
    }

    /// The origin and the target of a half-edge.
    pub(super) fn ends(&self, e: usize) -> (usize, usize) {
        let edges = &self.delaunay.edges;
        (edges.origin[e] as usize, edges.origin[next(e)] as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_domain_is_no_thread_along_either_period() {
        let domain = |lengths| Domain {
            lengths,
            walls: [Wall::Periodic; 2],
        };
        for lengths in [[1.0, 3e6], [3e6, 1.0]] {
            assert!(
                Voronoi::<f64>::new(&domain(lengths), 10).is_err(),
                "{lengths:?}"
            );
        }
        for lengths in [[1.0, 3e5], [3e5, 1.0]] {
            assert!(
                Voronoi::<f64>::new(&domain(lengths), 10).is_ok(),
                "{lengths:?}"
            );
        }
    }
}
