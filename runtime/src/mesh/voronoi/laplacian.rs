//! `A + alpha^2 K` on the edges of a mesh, with `K` the Laplace operator of linear finite elements on the Delaunay
//! triangles, `(K f)_a = sum_b (l/R) (f_a - f_b)`. Its rows are computed from the half-edges at every update. It is
//! symmetric and positive definite, because `l/R` is never negative in a Delaunay triangulation.

use super::mesh::{Plane, Voronoi, left};
use super::rows::Rows;
use super::smoothed::Operator;
use crate::Real;
use crate::mesh::{MeshError, Setting};
use nalgebra::SVector;

/// The operator at the positions of the last update.
#[derive(Clone, Debug)]
pub struct Cotangents<T> {
    rows: Rows<T>,
    /// Half the cotangent of the angle opposite each half-edge.
    halves: Vec<T>,
    alpha_squared: T,
}

impl<T: Real> Operator<T> for Cotangents<T> {
    fn new(setting: &Setting<2>, alpha: T) -> Self {
        let sites = setting.particles;
        Self {
            rows: Rows::new(sites, 6 * sites),
            halves: vec![T::zero(); 6 * sites],
            alpha_squared: alpha * alpha,
        }
    }

    fn update(&mut self, mesh: &Voronoi<T>) -> Result<(), MeshError> {
        let rows = &mut self.rows;
        mesh.sum_areas(&mut rows.areas);
        rows.diagonal.copy_from_slice(&rows.areas);
        for (halves, triangle) in self.halves.chunks_exact_mut(3).zip(mesh.triangles()) {
            halves.copy_from_slice(&triangle.weights);
        }
        let edges = &mesh.delaunay.edges;
        rows.start.fill(0);
        for &origin in &edges.origin {
            rows.start[origin as usize] += 1;
        }
        let mut before = 0;
        for start in &mut rows.start {
            before += *start;
            *start = before;
        }
        // Filling backwards moves the start of each row to its final index.
        for e in (0..edges.len()).rev() {
            let (a, b) = mesh.ends(e);
            let twin = edges.twin[e] as usize;
            // Edges between copies of the same site contribute nothing.
            let flow = if a == b {
                T::zero()
            } else {
                self.alpha_squared * (self.halves[e] + self.halves[twin])
            };
            rows.start[a] -= 1;
            let place = rows.start[a] as usize;
            rows.columns[place] = b as u32;
            rows.entries[place] = -flow;
            rows.diagonal[a] += flow;
        }
        rows.invert_diagonal();
        Ok(())
    }

    fn rows(&self) -> &Rows<T> {
        &self.rows
    }

    fn add_gradient(&mut self, mesh: &Voronoi<T>, u: &[T], v: &[T], out: &mut [SVector<T, 2>]) {
        mesh.add_area_gradient(|a| -(u[a] * v[a]), out);
        let half = T::from_f64(0.5) * self.alpha_squared;
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.sites;
            // Gradients of the three linear basis functions, times twice the area.
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
