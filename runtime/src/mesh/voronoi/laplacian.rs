//! `A + alpha^2 K` on the edges of a mesh, with `K` the Laplace operator of linear finite elements on the Delaunay
//! triangles, `(K f)_a = sum_b (l/R) (f_a - f_b)`: by rows, made of the mesh's half-edges at every update. Symmetric
//! and positive definite, because Delaunay triangulations have no negative `l/R`.

use super::mesh::{Plane, Voronoi, left};
use crate::Real;
use nalgebra::SVector;

/// The operator at the places of the last update.
#[derive(Clone, Debug)]
pub(super) struct Helmholtz<T> {
    /// Where each row begins, and the last one ends.
    start: Vec<u32>,
    /// The neighbours of each site,
    columns: Vec<u32>,
    /// and `-alpha^2 l/R` of the edges to them.
    entries: Vec<T>,
    /// Diagonal entries, and one over them.
    pub diagonal: Vec<T>,
    pub inverse: Vec<T>,
    /// Areas of the cells.
    pub areas: Vec<T>,
    /// Of each half-edge, half the cotangent of the angle across it.
    halves: Vec<T>,
    alpha_squared: T,
}

impl<T: Real> Helmholtz<T> {
    pub fn new(sites: usize, alpha: T) -> Self {
        Self {
            start: vec![0; sites + 1],
            columns: vec![0; 6 * sites],
            entries: vec![T::zero(); 6 * sites],
            diagonal: vec![T::zero(); sites],
            inverse: vec![T::zero(); sites],
            areas: vec![T::zero(); sites],
            halves: vec![T::zero(); 6 * sites],
            alpha_squared: alpha * alpha,
        }
    }

    /// Makes the rows those of a mesh.
    pub fn update(&mut self, mesh: &Voronoi<T>) {
        mesh.sum_areas(&mut self.areas);
        self.diagonal.copy_from_slice(&self.areas);
        for (halves, triangle) in self.halves.chunks_exact_mut(3).zip(mesh.triangles()) {
            halves.copy_from_slice(&triangle.weights);
        }
        let edges = &mesh.delaunay.edges;
        self.start.fill(0);
        for &origin in &edges.origin {
            self.start[origin as usize] += 1;
        }
        let mut before = 0;
        for start in &mut self.start {
            before += *start;
            *start = before;
        }
        // From the last to the first, so that each row comes to begin where it should.
        for e in (0..edges.len()).rev() {
            let (a, b) = mesh.ends(e);
            let twin = edges.twin[e] as usize;
            // Nothing flows between copies of one site.
            let flow = if a == b {
                T::zero()
            } else {
                self.alpha_squared * (self.halves[e] + self.halves[twin])
            };
            self.start[a] -= 1;
            let place = self.start[a] as usize;
            self.columns[place] = b as u32;
            self.entries[place] = -flow;
            self.diagonal[a] += flow;
        }
        for (inverse, diagonal) in self.inverse.iter_mut().zip(&self.diagonal) {
            *inverse = T::one() / *diagonal;
        }
    }

    /// A row applied to `x`.
    #[inline(always)]
    pub fn row(&self, a: usize, x: &[T]) -> T {
        let range = self.start[a] as usize..self.start[a + 1] as usize;
        let columns = &self.columns[range.clone()];
        let mut sum = self.diagonal[a] * x[a];
        for (&b, &entry) in columns.iter().zip(&self.entries[range]) {
            sum += entry * x[b as usize];
        }
        sum
    }

    /// Adds to `out` how `-u.(A + alpha^2 K) v` changes with each place.
    pub fn add_gradient(&self, mesh: &Voronoi<T>, u: &[T], v: &[T], out: &mut [SVector<T, 2>]) {
        mesh.add_area_gradient(|a| -(u[a] * v[a]), out);
        let half = T::from_f64(0.5) * self.alpha_squared;
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.sites;
            // Gradients of the three linear functions that are 1 at one corner, times twice the area.
            let hats = [1, 2, 0].map(|k| left(triangle.sides[k]));
            let slope = |f: &[T]| hats[1] * (f[b] - f[a]) + hats[2] * (f[c] - f[a]);
            let (of_u, of_v) = (slope(u), slope(v));
            let inverse = T::one() / triangle.twice_area;
            let scale = half * inverse * inverse;
            let product = of_u[0] * of_v[0] + of_u[1] * of_v[1];
            let part = |hat: Plane<T>| {
                let along_u = of_u[0] * hat[0] + of_u[1] * hat[1];
                let along_v = of_v[0] * hat[0] + of_v[1] * hat[1];
                (of_u * along_v + of_v * along_u - hat * product) * scale
            };
            out[a] += part(hats[0]);
            out[b] += part(hats[1]);
            out[c] += part(hats[2]);
        }
    }
}
