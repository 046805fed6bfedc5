//! Shallow water on a beta plane, on Voronoi cells. The model is defined in this file.

use super::cells::{DT, area, at, cell, mass, momenta, places, seen};
use super::{Line, Random, c, keeping, stepped};
use crate::action::{Configuration, D};
use clebsch::nalgebra::Vector2;

clebsch::model! {
    /// Rotating shallow water on a beta plane: the rotation is taken in the middle of the step.
    pub model BetaPlane2D {
        time k step dt;
        label a in 0..N;
        param m: Real at a;
        param g, f: Real;
        /// gradient of the rotation
        param b: Vec<2>;
        field X: Vec<2> at a on torus(L);
        mesh A: Real at a = voronoi_area(X);
        lagrangian = (m/(2*dt))*dot(next(X) - X, next(X) - X)
            + (m/2)*(f + dot(b, X + next(X))/2)*dot(perp(X), next(X)) - dt*g*m*(m/A)/2;
    }
}

const G: f64 = 0.9;
const F: f64 = 0.7;
const B: f64 = 1.1;

/// Particles on a beta plane.
pub struct Beta {
    pub n: usize,
}

impl Beta {
    fn stepper(&self) -> BetaPlane2D {
        let parameters = BetaPlane2DParameters {
            m: (0..self.n).map(|i| mass(self.n, i)).collect(),
            g: G,
            f: F,
            b: Vector2::new(0.0, B),
        };
        let sites = BetaPlane2DSites {
            N: self.n,
            L: [1.0, 1.0],
            scalar: Default::default(),
        };
        BetaPlane2D::new(parameters, sites).expect("cells")
    }
    fn initial(&self, seed: u64) -> BetaPlane2DInitial {
        let mut r = Random::new(seed + 11);
        BetaPlane2DInitial {
            X: places(self.n, &mut r),
            momentum_X: momenta(self.n, &mut r),
        }
    }
    fn seen(&self, s: &BetaPlane2DState) -> Configuration<f64> {
        seen(s.X())
    }
    keeping!(BetaPlane2D, |_, _: &BetaPlane2DState| 0.0);
}

impl Line for Beta {
    fn name(&self) -> String {
        format!("beta plane {}", self.n)
    }
    fn terms(&self) -> usize {
        4
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let n = self.n;
        let mut s = c(0.0);
        for (i, (x, y)) in at(&a.x).into_iter().zip(at(&b.x)).enumerate() {
            let d = y - x;
            let swept = x[0] * y[1] - x[1] * y[0];
            s += c(w[0] * mass(n, i) / (2.0 * DT)) * d.dot(&d);
            s += c(w[1] * mass(n, i) * F / 2.0) * swept;
            s += c(w[2] * mass(n, i) * B / 4.0) * (x[1] + y[1]) * swept;
        }
        for q in [&a.x, &b.x] {
            let at = at(q);
            for i in 0..n {
                let m = mass(n, i);
                s -= c(w[3] * 0.5 * DT * G * m * m / 2.0) / area(&cell(&at, i));
            }
        }
        s
    }
    fn is_smooth(&self) -> bool {
        false
    }
    stepped!([momentum_X], DT, 5e-2);
    fn mass_by_step(&self) -> f64 {
        1.4 / self.n as f64 / DT
    }
}
