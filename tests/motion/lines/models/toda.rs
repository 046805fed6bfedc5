//! Toda's chain.

use super::{Line, Random, c, keeping, numbers, stepped};
use crate::action::{Configuration, D};
use clebsch::Real;
use clebsch_models::lattices::toda_chain::*;

/// Toda's chain.
pub struct Toda {
    pub n: usize,
    pub ring: bool,
}

impl Toda {
    pub fn ring(n: usize) -> Self {
        Self { n, ring: true }
    }
    pub fn stepper(&self) -> TodaChain {
        let ends = match self.ring {
            true => TodaChainEnds::Ring { L: 0.3 },
            false => TodaChainEnds::Open,
        };
        let parameters = TodaChainParameters {
            m: 1.3,
            a: 0.7,
            b: 1.1,
        };
        TodaChain::new(parameters, TodaChainSites { N: self.n, ends }).expect("a chain")
    }
    /// A ring of stiffer springs.
    pub fn hard(n: usize) -> TodaChain {
        let ends = TodaChainEnds::Ring { L: 0.3 };
        let parameters = TodaChainParameters {
            m: 1.3,
            a: 2.7,
            b: 1.1,
        };
        TodaChain::new(parameters, TodaChainSites { N: n, ends }).expect("a chain")
    }
    fn nodes(&self) -> usize {
        self.n + usize::from(!self.ring)
    }
    pub fn initial(&self, seed: u64) -> TodaChainInitial {
        let mut r = Random::new(seed);
        let n = self.nodes();
        TodaChainInitial {
            q: r.list(n, 0.5),
            momentum_q: r.list(n, 1.0),
        }
    }
    fn seen(&self, s: &TodaChainState) -> Configuration<f64> {
        Configuration::of(numbers(s.q()), vec![], vec![])
    }
    keeping!(TodaChain, |m, s: &TodaChainState| m.total_momentum(s));
}

impl Line for Toda {
    fn name(&self) -> String {
        format!("Toda {} ring {}", self.n, self.ring)
    }
    fn terms(&self) -> usize {
        // Around a ring, the linear term is a constant offset.
        if self.ring { 2 } else { 3 }
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (h, linear) = (0.05, w.get(2).unwrap_or(&1.0));
        let mut s = c(0.0);
        for (x, y) in a.x.iter().zip(&b.x) {
            s += c(w[0] * 1.3 / (2.0 * h)) * (*y - *x) * (*y - *x);
        }
        for q in [&a.x, &b.x] {
            for i in 0..self.n {
                let next = match i + 1 < q.len() {
                    true => q[i + 1],
                    false => q[0] + c(0.3),
                };
                let r = next - q[i];
                s -= c(0.5 * h) * (c(w[1] * 0.7 / 1.1) * (c(-1.1) * r).exp() + c(linear * 0.7) * r);
            }
        }
        s
    }
    stepped!([momentum_q], 0.05, 2e-3, 1.3 / 0.05);
}
