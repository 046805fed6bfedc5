//! A chain whose kinetic energy is quartic in the velocity, with free or prescribed ends. The model is defined in this file.

use super::{Line, Random, Wide, c, keeping_between, numbers, stepped};
use crate::action::{Configuration, D};
use clebsch::nalgebra::SMatrix;

clebsch::model! {
    /// Numbers with a kinetic energy of second and fourth order, joined by springs.
    pub model QuarticChain {
        label i in 0..N;
        end i = 0 { free; pinned { q = given; } }
        end i = N { free; pinned { q = given; } }
        periodic;
        param m: Real at nodes;
        param b, e: Real;
        field q: Real at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h) + b*(next(q) - q)^4/(4*h^3) - h*e*(next(q, i) - q)^2/2;
    }
}

/// The chain, by end: ring, free, first prescribed, last prescribed.
pub struct Quartic {
    pub n: usize,
    pub ends: usize,
}

impl Quartic {
    fn nodes(&self) -> usize {
        self.n + usize::from(self.ends != 0)
    }
    fn mass(i: usize) -> f64 {
        1.0 + 0.3 * (i % 2) as f64
    }
    pub fn stepper(&self) -> QuarticChain {
        let parameters = QuarticChainParameters {
            m: (0..self.nodes()).map(Self::mass).collect(),
            b: 0.8,
            e: 0.6,
        };
        let (first, last) = match self.ends {
            2 => (QuarticChainFirst::Pinned, QuarticChainLast::Free),
            3 => (QuarticChainFirst::Free, QuarticChainLast::Pinned),
            _ => (QuarticChainFirst::Free, QuarticChainLast::Free),
        };
        let ends = match self.ends {
            0 => QuarticChainEnds::Ring,
            _ => QuarticChainEnds::Open { first, last },
        };
        QuarticChain::new(parameters, QuarticChainSites { N: self.n, ends }).expect("a chain")
    }
    fn initial(&self, seed: u64) -> QuarticChainInitial {
        let mut r = Random::new(seed);
        let n = self.nodes();
        QuarticChainInitial {
            q: r.list(n, 1.0),
            momentum_q: r.list(n, 2.0),
        }
    }
    /// Three steps, with derivatives with respect to all positions and momenta.
    pub fn moved(&self, q: Vec<Wide>, p: Vec<Wide>) -> [Vec<Wide>; 2] {
        let k = Wide::constant;
        let parameters = QuarticChainParameters {
            m: (0..self.nodes()).map(|i| k(Self::mass(i))).collect(),
            b: k(0.8),
            e: k(0.6),
        };
        let ends = match self.ends {
            0 => QuarticChainEnds::Ring,
            _ => QuarticChainEnds::Open {
                first: QuarticChainFirst::Free,
                last: QuarticChainLast::Free,
            },
        };
        let model = QuarticChain::new(parameters, QuarticChainSites { N: self.n, ends });
        let model = model.expect("a chain");
        let list = |x: Vec<Wide>| x.into_iter().map(SMatrix::repeat).collect();
        let initial = QuarticChainInitial {
            q: list(q),
            momentum_q: list(p),
        };
        let (mut state, mut work) = model.start(initial, k(0.05)).expect("starts");
        for _ in 0..3 {
            model.step(&mut state, &mut work).expect("steps");
        }
        [state.q(), state.momentum_q()].map(|list| list.iter().map(|x| x[0]).collect())
    }
    fn seen(&self, s: &QuarticChainState) -> Configuration<f64> {
        Configuration::of(numbers(s.q()), vec![], vec![])
    }
    fn springs(&self) -> bool {
        self.ends != 0 || self.n > 1
    }
    /// The energy between two nodes, from the velocity of the edge and the mean of both potentials.
    fn energy(&self, a: &[f64], b: &[f64], h: f64) -> f64 {
        let mut e = 0.0;
        for i in 0..self.nodes() {
            let v = (b[i] - a[i]) / h;
            e += Self::mass(i) * v * v / 2.0 + 0.75 * 0.8 * v.powi(4);
        }
        for x in [a, b] {
            for i in 0..self.n {
                let d = x[(i + 1) % x.len()] - x[i];
                e += 0.5 * 0.6 * d * d / 2.0;
            }
        }
        e
    }
    keeping_between!(
        x,
        |line: &Self, s: &QuarticChainState| match line.ends {
            0 | 1 => s.momentum_q().iter().map(|p| p[0]).sum(),
            _ => 0.0,
        },
        0.0
    );
}

impl Line for Quartic {
    fn name(&self) -> String {
        format!("quartic {} ends {}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        if self.springs() { 3 } else { 2 }
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let h: f64 = 0.05;
        let mut s = c(0.0);
        for i in 0..self.nodes() {
            let d = b.x[i] - a.x[i];
            s += c(w[0] * Self::mass(i) / (2.0 * h)) * d * d;
            s += c(w[1] * 0.8 / (4.0 * h.powi(3))) * d * d * d * d;
        }
        for x in [&a.x, &b.x].into_iter().filter(|_| self.springs()) {
            for i in 0..self.n {
                let d = x[(i + 1) % x.len()] - x[i];
                s -= c(w[2] * 0.5 * h * 0.6 / 2.0) * d * d;
            }
        }
        s
    }
    fn held(&self, at: usize) -> bool {
        self.ends == 2 && at == 0 || self.ends == 3 && at == self.n
    }
    stepped!([momentum_q], 0.05, 2e-2);
    // At velocities of one, including the derivative of the cube.
    fn mass_by_step(&self) -> f64 {
        (1.3 + 3.0 * 0.8) / 0.05
    }
}
