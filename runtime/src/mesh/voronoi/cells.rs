//! Voronoi cells: area, centre of mass and second moment of each cell, the faces between cells, and the derivatives of
//! areas by positions. Every formula sums over right triangles: a side of a Delaunay triangle contributes two, each
//! with the midpoint of the side, the circumcentre and one end. Their areas are signed, so the formulas also hold for
//! obtuse triangles.

use super::mesh::{Plane, Voronoi, dot, left};
use crate::Real;
use crate::mesh::MeshError;
use nalgebra::SVector;

/// The face between two cells, and the edge that crosses it.
#[derive(Clone, Copy, Debug)]
pub struct Face<T> {
    /// The sites on either side; the edge leads from the first to the second.
    pub sites: [usize; 2],
    /// The edge.
    pub edge: SVector<T, 2>,
    /// Length of the face over length of the edge: the weight of the edge in the Laplace operator of finite elements.
    pub ratio: T,
    /// The midpoint of the face, relative to the first site.
    pub middle: SVector<T, 2>,
}

impl<T: Real> Voronoi<T> {
    /// The areas of the cells. They add up to the area of the domain.
    ///
    /// # Errors
    /// [`MeshError::Count`] if the number of values differs from the number of sites.
    pub fn areas(&self, out: &mut [T]) -> Result<(), MeshError> {
        MeshError::unless_of_length(out, self.sites())?;
        self.sum_areas(out);
        Ok(())
    }

    /// Like `areas`, for an `out` of the right length.
    pub(super) fn sum_areas(&self, out: &mut [T]) {
        out.fill(T::zero());
        let quarter = T::from_f64(0.25);
        for triangle in self.triangles() {
            let [a, b, c] = triangle.sites;
            let part = |k: usize| {
                let side = triangle.sides[k];
                triangle.weights[k] * dot(side, side) * quarter
            };
            let (ab, bc, ca) = (part(0), part(1), part(2));
            out[a] += ca + ab;
            out[b] += ab + bc;
            out[c] += bc + ca;
        }
    }

    /// Adds the gradient of `sum seed_a A_a` with respect to the positions to `out`.
    pub(super) fn add_area_gradient(&self, seed: impl Fn(usize) -> T, out: &mut [Plane<T>]) {
        let half = T::from_f64(0.5);
        for triangle in self.triangles() {
            let [a, b, c] = triangle.sites;
            let seeds = [seed(a), seed(b), seed(c)];
            // The contribution of a side to its two ends. `w left(d)` leads from its midpoint to the circumcentre.
            let part = |k: usize| {
                let (d, w) = (triangle.sides[k], triangle.weights[k]);
                let difference = (seeds[k] - seeds[(k + 1) % 3]) * w * half;
                let up = left(d) * w;
                ((d + up) * difference, (d - up) * difference)
            };
            let (ab, bc, ca) = (part(0), part(1), part(2));
            out[a] += ab.0 + ca.1;
            out[b] += bc.0 + ab.1;
            out[c] += ca.0 + bc.1;
        }
    }

    /// The vector from every site to the centre of mass of its cell; `areas` are the areas of the cells.
    ///
    /// # Errors
    /// [`MeshError::Count`].
    pub fn centroids(&self, areas: &[T], out: &mut [SVector<T, 2>]) -> Result<(), MeshError> {
        MeshError::unless_of_length(areas, self.sites())?;
        MeshError::unless_of_length(out, self.sites())?;
        out.fill(Plane::zeros());
        self.add_first_moments(|_| T::one(), out);
        for (centre, &area) in out.iter_mut().zip(areas) {
            *centre /= area;
        }
        Ok(())
    }

    /// Adds to `out` the integral of `x - X_a` over each cell, multiplied by `factor`.
    pub(super) fn add_first_moments(&self, factor: impl Fn(usize) -> T, out: &mut [Plane<T>]) {
        let twelfth = T::from_ratio(1, 12);
        for triangle in self.triangles() {
            for k in 0..3 {
                let (d, w) = (triangle.sides[k], triangle.weights[k]);
                let (a, b) = (triangle.sites[k], triangle.sites[(k + 1) % 3]);
                let size = w * dot(d, d) * twelfth;
                let up = left(d) * w;
                out[a] += (d + up) * (size * factor(a));
                out[b] += (up - d) * (size * factor(b));
            }
        }
    }

    /// The integral of `|x - X_a|^2` over every cell.
    ///
    /// # Errors
    /// [`MeshError::Count`].
    pub fn second_moments(&self, out: &mut [T]) -> Result<(), MeshError> {
        MeshError::unless_of_length(out, self.sites())?;
        out.fill(T::zero());
        let (first, second) = (T::from_ratio(1, 32), T::from_ratio(1, 24));
        for triangle in self.triangles() {
            for k in 0..3 {
                let (d, w) = (triangle.sides[k], triangle.weights[k]);
                let square = dot(d, d);
                let part = square * square * w * (first + second * w * w);
                out[triangle.sites[k]] += part;
                out[triangle.sites[(k + 1) % 3]] += part;
            }
        }
        Ok(())
    }

    /// The faces, three for each particle.
    pub fn faces(&self) -> impl Iterator<Item = Face<T>> + '_ {
        let half = T::from_f64(0.5);
        self.edges().map(move |(e, f)| {
            let (triangle, across) = (self.triangle(e / 3), self.triangle(f / 3));
            let edge = triangle.sides[e % 3];
            let (above, below) = (triangle.weights[e % 3], across.weights[f % 3]);
            let (from, to) = self.ends(e);
            Face {
                sites: [from, to],
                edge,
                ratio: above + below,
                middle: (edge + left(edge) * (above - below)) * half,
            }
        })
    }
}
