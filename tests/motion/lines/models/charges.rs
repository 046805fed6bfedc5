//! Charges in the plane. The model is defined in this file.

use super::{Line, Random, c, keeping, numbers, stepped};
use crate::action::{Configuration, D};
use clebsch::nalgebra::Vector2;

clebsch::model! {
    /// Charges in the plane, across a uniform field, joined by springs to the next and to the one after.
    pub model ChargeChain {
        label i in 0..N;
        param m: Real at nodes;
        param f, k, c: Real;
        field X: Vec<2> at nodes;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + (f/2)*dot(perp(X), next(X))
            - h*k*dot(next(X, i) - X, next(X, i) - X)/2
            - h*c*dot(next(X, i) - 2*X + prev(X, i), next(X, i) - 2*X + prev(X, i))/2;
    }
}

/// Charges coupled by springs, free at both ends.
pub struct Charges {
    pub n: usize,
}

impl Charges {
    pub fn new(n: usize) -> Self {
        Self { n }
    }
    fn mass(i: usize) -> f64 {
        1.0 + 0.3 * (i % 2) as f64
    }
    pub fn stepper(&self) -> ChargeChain {
        let parameters = ChargeChainParameters {
            m: (0..=self.n).map(Self::mass).collect(),
            f: 0.8,
            k: 0.5,
            c: 0.2,
        };
        let sites = ChargeChainSites {
            N: self.n,
            ends: ChargeChainEnds::Open,
        };
        ChargeChain::new(parameters, sites).expect("charges")
    }
    fn initial(&self, seed: u64) -> ChargeChainInitial {
        let mut r = Random::new(seed);
        let n = self.n + 1;
        ChargeChainInitial {
            X: r.list(n, 1.0),
            momentum_X: r.list(n, 0.5),
        }
    }
    fn seen(&self, s: &ChargeChainState) -> Configuration<f64> {
        Configuration::of(numbers(s.X()), vec![], vec![])
    }
    // Translations conserve the momentum plus half of the field's impulse.
    keeping!(ChargeChain, |_, s: &ChargeChainState| {
        s.momentum_X()
            .iter()
            .zip(s.X())
            .map(|(p, x)| p[0] - 0.4 * x[1])
            .sum()
    });
}

impl Line for Charges {
    fn name(&self) -> String {
        format!("charges {}", self.n)
    }
    fn terms(&self) -> usize {
        if self.n > 1 { 4 } else { 3 }
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let h = 0.03;
        let at = |x: &[D], i: usize| Vector2::new(x[2 * i], x[2 * i + 1]);
        let mut s = c(0.0);
        for i in 0..=self.n {
            let (x, y) = (at(&a.x, i), at(&b.x, i));
            let d = y - x;
            s += c(w[0] * Self::mass(i) / (2.0 * h)) * d.dot(&d);
            s += c(w[1] * 0.4) * (x[0] * y[1] - x[1] * y[0]);
        }
        for q in [&a.x, &b.x] {
            for i in 0..self.n {
                let d = at(q, i + 1) - at(q, i);
                s -= c(w[2] * 0.5 * h * 0.5 / 2.0) * d.dot(&d);
                if i > 0 {
                    let d = at(q, i + 1) - at(q, i) * c(2.0) + at(q, i - 1);
                    s -= c(w[3] * 0.5 * h * 0.2 / 2.0) * d.dot(&d);
                }
            }
        }
        s
    }
    stepped!([momentum_X], 0.03, 5e-2, 1.3 / 0.03);
}
