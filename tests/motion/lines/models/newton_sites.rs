//! Sites whose velocities need Newton's method: beads whose masses depend on a dynamic position, in a potential evaluated at the
//! midpoint of the step. The model is defined in this file.

use super::{Line, Random, c, keeping, numbers, stepped};
use crate::action::{Configuration, D};
use clebsch::Real;
use clebsch::nalgebra::Vector2;

clebsch::model! {
    /// Beads in the plane, each with a number on which its mass depends.
    pub model BentChain {
        label i in 0..N;
        periodic;
        param m: Real at nodes;
        param b, k, e: Real;
        field q: Real at nodes;
        field X: Vec<2> at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h)
            + m*(1 + b*((q + next(q))/2)^2)*dot(next(X) - X, next(X) - X)/(2*h)
            + h*k*cos((q + next(q))/2)
            - h*e*(next(q, i) - q)^2/2 - h*e*dot(next(X, i) - X, next(X, i) - X)/2;
    }
}

/// Beads on an open chain, or on a ring.
pub struct Bent {
    pub n: usize,
    pub ring: bool,
}

impl Bent {
    fn nodes(&self) -> usize {
        self.n + usize::from(!self.ring)
    }
    fn mass(i: usize) -> f64 {
        1.0 + 0.3 * (i % 2) as f64
    }
    pub fn stepper(&self) -> BentChain {
        let parameters = BentChainParameters {
            m: (0..self.nodes()).map(Self::mass).collect(),
            b: 0.7,
            k: 0.9,
            e: 0.4,
        };
        let ends = match self.ring {
            true => BentChainEnds::Ring,
            false => BentChainEnds::Open,
        };
        BentChain::new(parameters, BentChainSites { N: self.n, ends }).expect("beads")
    }
    fn initial(&self, seed: u64) -> BentChainInitial {
        let mut r = Random::new(seed);
        let n = self.nodes();
        let (q, momentum_q) = (r.list(n, 1.0), r.list(n, 0.5));
        BentChainInitial {
            q,
            momentum_q,
            X: r.list(n, 1.0),
            momentum_X: r.list(n, 0.5),
        }
    }
    fn seen(&self, s: &BentChainState) -> Configuration<f64> {
        Configuration::of([numbers(s.q()), numbers(s.X())].concat(), vec![], vec![])
    }
    keeping!(BentChain, |_, s: &BentChainState| {
        s.momentum_X().iter().map(|p| p[0]).sum()
    });
}

impl Line for Bent {
    fn name(&self) -> String {
        format!("bent {} ring {}", self.n, self.ring)
    }
    fn terms(&self) -> usize {
        // In a ring of one site, the site is its own neighbour.
        if self.ring && self.n == 1 { 3 } else { 5 }
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (h, n) = (0.05, self.nodes());
        let at = |x: &[D], i: usize| Vector2::new(x[n + 2 * i], x[n + 2 * i + 1]);
        let mut s = c(0.0);
        for i in 0..n {
            let (q, dq) = ((a.x[i] + b.x[i]) * c(0.5), b.x[i] - a.x[i]);
            let d = at(&b.x, i) - at(&a.x, i);
            let m = c(Self::mass(i) / (2.0 * h));
            s += c(w[0]) * m * dq * dq;
            s += c(w[1]) * m * (c(1.0) + c(0.7) * q * q) * d.dot(&d);
            s += c(w[2] * h * 0.9) * q.cos();
        }
        for x in [&a.x, &b.x].into_iter().filter(|_| self.terms() > 3) {
            for i in 0..self.n {
                let j = (i + 1) % n;
                let (dq, d) = (x[j] - x[i], at(x, j) - at(x, i));
                s -= c(w[3] * 0.5 * h * 0.4 / 2.0) * dq * dq;
                s -= c(w[4] * 0.5 * h * 0.4 / 2.0) * d.dot(&d);
            }
        }
        s
    }
    stepped!([momentum_q momentum_X], 0.05, 5e-2, 1.3 * 1.7 / 0.05);
}
