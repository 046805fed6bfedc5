//! Shallow water.

use super::{Line, Random, c, keeping, stepped};
use crate::action::{Configuration, D};
use clebsch_models::lattices::shallow_water_1d::*;

/// Shallow water on a ring.
pub struct Water {
    pub n: usize,
}

impl Water {
    pub fn new(n: usize) -> Self {
        Self { n }
    }
    fn mass(i: usize) -> f64 {
        1.0 + 0.2 * (i % 4) as f64
    }
    fn length(&self) -> f64 {
        self.n as f64
    }
    pub fn stepper(&self) -> ShallowWater1D {
        let parameters = ShallowWater1DParameters {
            m: (0..self.n).map(Self::mass).collect(),
            g: 0.9,
            f: 0.6,
        };
        let ends = ShallowWater1DEnds::Ring { L: self.length() };
        ShallowWater1D::new(parameters, ShallowWater1DSites { N: self.n, ends }).expect("water")
    }
    fn initial(&self, seed: u64) -> ShallowWater1DInitial {
        let mut r = Random::new(seed);
        let n = self.n;
        let mut initial = ShallowWater1DInitial {
            X: r.list(n, 0.2),
            momentum_X: r.list(n, 0.3),
            Y: r.list(n, 0.5),
            momentum_Y: r.list(n, 0.3),
        };
        initial
            .X
            .iter_mut()
            .enumerate()
            .for_each(|(i, x)| x[0] += i as f64);
        initial
    }
    fn seen(&self, s: &ShallowWater1DState) -> Configuration<f64> {
        let x = s.X().iter().chain(s.Y()).map(|x| x[0]);
        Configuration::of(x.collect(), vec![], vec![])
    }
    keeping!(ShallowWater1D, |_, s: &ShallowWater1DState| s
        .momentum_Y()
        .iter()
        .map(|p| p[0])
        .sum());
}

impl Line for Water {
    fn name(&self) -> String {
        format!("water {}", self.n)
    }
    fn terms(&self) -> usize {
        4
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (dt, n) = (0.02, self.n);
        let mut s = c(0.0);
        for i in 0..n {
            let (u, v) = (b.x[i] - a.x[i], b.x[n + i] - a.x[n + i]);
            let m = Self::mass(i);
            s += c(m / (2.0 * dt)) * (c(w[0]) * u * u + c(w[1]) * v * v);
            s += c(w[2] * m * 0.6 * 0.5) * (a.x[i] + b.x[i]) * v;
        }
        for q in [&a.x, &b.x] {
            for i in 0..n {
                let next = if i + 1 < n {
                    q[i + 1]
                } else {
                    q[0] + c(self.length())
                };
                let before = if i > 0 {
                    q[i - 1]
                } else {
                    q[n - 1] - c(self.length())
                };
                let m = Self::mass(i);
                s -= c(w[3] * 0.5 * dt * 0.9 / 2.0 * m * 2.0 * m) / (next - before);
            }
        }
        s
    }
    stepped!([momentum_X momentum_Y], 0.02, 5e-2, 1.6 / 0.02);
}
