//! Coupled heavy tops.

use super::{Line, Random, attitudes, c, keeping, stepped, vector};
use crate::action::{Configuration, D, trace};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch_models::lattices::coupled_tops::*;

/// Coupled heavy tops.
pub struct Tops {
    pub n: usize,
    ring: bool,
}

impl Tops {
    pub fn new(n: usize, ring: bool) -> Self {
        Self { n, ring }
    }
    fn nodes(&self) -> usize {
        self.n + usize::from(!self.ring)
    }
    fn parameters() -> CoupledTopsParameters {
        CoupledTopsParameters {
            s: 0.8,
            J: Matrix3::new(0.6, 0.05, 0.02, 0.05, 0.5, 0.01, 0.02, 0.01, 0.9),
            C: Matrix3::new(0.3, 0.04, 0.0, 0.04, 0.2, 0.03, 0.0, 0.03, 0.4),
            gU: Vector3::new(0.1, -0.2, 0.7),
            z: Vector3::new(0.0, 0.6, 0.8),
        }
    }
    pub fn stepper(&self) -> CoupledTops {
        let ends = if self.ring {
            CoupledTopsEnds::Ring
        } else {
            CoupledTopsEnds::Open
        };
        CoupledTops::new(Self::parameters(), CoupledTopsSites { N: self.n, ends }).expect("tops")
    }
    fn initial(&self, seed: u64) -> CoupledTopsInitial {
        let (turns, momenta) = attitudes(self.nodes(), &mut Random::new(seed));
        CoupledTopsInitial {
            Λ: turns,
            body_momentum_Λ: momenta,
        }
    }
    fn seen(&self, s: &CoupledTopsState) -> Configuration<f64> {
        Configuration::of(vec![], s.Λ().map(|r| r.matrix()).collect(), vec![])
    }
    keeping!(CoupledTops, |_, s: &CoupledTopsState| {
        let total: Vector3<f64> = s.spatial_momentum_Λ().map(|m| m.0).sum();
        total.dot(&Vector3::new(0.0, 0.6, 0.8))
    });
}

impl Line for Tops {
    fn name(&self) -> String {
        format!("tops {} ring {}", self.n, self.ring)
    }
    fn terms(&self) -> usize {
        3
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (h, p) = (0.04, Self::parameters());
        let mut s = c(0.0);
        for (x, y) in a.r.iter().zip(&b.r) {
            s -= c(w[0] * p.s / h) * trace(&p.J.map(c), &(x.transpose() * y));
        }
        for r in [&a.r, &b.r] {
            for x in r {
                let vertical = x.transpose() * vector(&p.z);
                s -= c(w[1] * 0.5 * h * p.s) * vector(&p.gU).dot(&vertical);
            }
            for i in 0..self.n {
                let next = &r[(i + 1) % r.len()];
                s += c(w[2] * 0.5 * h / p.s) * trace(&p.C.map(c), &(r[i].transpose() * next));
            }
        }
        s
    }
    stepped!([body_momentum_Λ], 0.04, 2e-2, 0.0);
}
