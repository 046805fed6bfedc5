//! `A + alpha^2 G`, where the Laplace operator `G` couples all pairs within a radius,
//! `(G f)_a = sum_b A_a A_b W(R) (f_a - f_b)`. `W` is Wendland's kernel of second order, scaled so that `G`
//! approximates the Laplace operator for smooth functions on even meshes. Derivatives are continuous when neighbours
//! change.

use super::bins::Bins;
use super::mesh::{Plane, Voronoi};
use super::rows::Rows;
use super::smoothed::Operator;
use crate::Real;
use crate::mesh::{MeshError, Setting};
use nalgebra::SVector;

/// The radius, in mean particle distances.
const RADIUS: f64 = 2.5;

/// The operator at the positions of the last update.
#[derive(Clone, Debug)]
pub struct Within<T> {
    rows: Rows<T>,
    bins: Bins,
    radius: f64,
    /// For each entry of the rows, the vector from the first site to the second.
    apart: Vec<Plane<T>>,
    alpha_squared: T,
    seeds: Vec<T>,
}

impl<T: Real> Within<T> {
    /// The distance as a fraction of the radius, and the factor of the kernel. It is normalised so that half the
    /// integral of `W` times the square of one component of the distance is 1.
    fn share(&self, apart: Plane<T>) -> (T, T) {
        let square = apart[0] * apart[0] + apart[1] * apart[1];
        let share = square.sqrt() / T::from_f64(self.radius);
        let factor = 1008.0 / (5.0 * core::f64::consts::PI * self.radius.powi(4));
        (share, T::from_f64(factor))
    }

    /// The kernel `W`.
    fn kernel(&self, apart: Plane<T>) -> T {
        let (share, factor) = self.share(apart);
        let left = T::one() - share;
        let square = left * left;
        factor * square * square * (T::one() + T::from_f64(4.0) * share)
    }

    /// The derivative of the kernel over the distance, `W'/R`.
    fn slope(&self, apart: Plane<T>) -> T {
        let (share, factor) = self.share(apart);
        let left = T::one() - share;
        factor * T::from_f64(-20.0 / (self.radius * self.radius)) * left * left * left
    }
}

impl<T: Real> Operator<T> for Within<T> {
    fn new(setting: &Setting<2>, alpha: T) -> Self {
        let (lengths, sites) = (setting.domain.lengths, setting.particles);
        let spacing = (setting.domain.measure() / sites as f64).sqrt();
        let radius = (RADIUS * spacing).min(0.5 * lengths[0].min(lengths[1]));
        Self {
            rows: Rows::new(sites, 0),
            bins: Bins::new(lengths, radius, sites),
            radius,
            apart: Vec::new(),
            alpha_squared: alpha * alpha,
            seeds: vec![T::zero(); sites],
        }
    }

    fn update(&mut self, mesh: &Voronoi<T>) -> Result<(), MeshError> {
        let at = mesh.places();
        self.bins
            .sort(|site| [at[site][0].value(), at[site][1].value()])?;
        mesh.sum_areas(&mut self.rows.areas);
        self.rows.diagonal.copy_from_slice(&self.rows.areas);
        self.rows.columns.clear();
        self.rows.entries.clear();
        self.apart.clear();
        let farthest = self.radius * self.radius;
        for first in 0..at.len() {
            let (columns, apart) = (&mut self.rows.columns, &mut self.apart);
            self.bins.near(first, |second, shift| {
                let side = at[second] - at[first] + Plane::from(shift).map(T::from_f64);
                let square = side[0].value().powi(2) + side[1].value().powi(2);
                if square < farthest {
                    columns.push(second as u32);
                    apart.push(side);
                }
                Ok(())
            })?;
            self.rows.start[first + 1] = self.rows.columns.len() as u32;
            let mut sum = T::zero();
            for e in self.rows.range(first) {
                let areas = self.rows.areas[first] * self.rows.areas[self.rows.columns[e] as usize];
                let flow = self.alpha_squared * areas * self.kernel(self.apart[e]);
                sum += flow;
                self.rows.entries.push(-flow);
            }
            self.rows.diagonal[first] += sum;
        }
        self.rows.invert_diagonal();
        Ok(())
    }

    fn rows(&self) -> &Rows<T> {
        &self.rows
    }

    fn add_gradient(&mut self, mesh: &Voronoi<T>, u: &[T], v: &[T], out: &mut [SVector<T, 2>]) {
        for a in 0..u.len() {
            let mut sum = u[a] * v[a];
            for e in self.rows.range(a) {
                let b = self.rows.columns[e] as usize;
                let product = self.alpha_squared * (u[a] - u[b]) * (v[a] - v[b]);
                let side = self.apart[e];
                sum += product * self.rows.areas[b] * self.kernel(side);
                let areas = self.rows.areas[a] * self.rows.areas[b];
                out[a] += side * (product * areas * self.slope(side));
            }
            self.seeds[a] = -sum;
        }
        let seeds = &self.seeds;
        mesh.add_area_gradient(|a| seeds[a], out);
    }
}
