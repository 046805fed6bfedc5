//! The sine-Gordon equation.

use super::{Line, Random, c, keeping, numbers, stepped};
use crate::action::{Configuration, D};
use clebsch::Real;
use clebsch_models::lattices::sine_gordon::*;

/// The sine-Gordon equation, by end: ring, free, first prescribed, last prescribed, both prescribed.
pub struct Sine {
    pub n: usize,
    ends: usize,
}

impl Sine {
    pub fn new(n: usize, ends: usize) -> Self {
        Self { n, ends }
    }
    fn nodes(&self) -> usize {
        self.n + usize::from(self.ends != 0)
    }
    fn weight(&self, i: usize) -> f64 {
        0.4 * if self.ends != 0 && (i == 0 || i == self.n) {
            0.5
        } else {
            1.0
        }
    }
    pub fn stepper(&self) -> SineGordon {
        let (first, last) = (self.ends == 2 || self.ends == 4, self.ends >= 3);
        let ends = match self.ends {
            0 => SineGordonEnds::Ring { L: 6.0 },
            _ => SineGordonEnds::Open {
                first: if first {
                    SineGordonFirst::Pinned
                } else {
                    SineGordonFirst::Free
                },
                last: if last {
                    SineGordonLast::Pinned
                } else {
                    SineGordonLast::Free
                },
            },
        };
        let w = (0..self.nodes()).map(|i| self.weight(i)).collect();
        let parameters = SineGordonParameters { s: 0.4, w, k: 1.7 };
        SineGordon::new(parameters, SineGordonSites { N: self.n, ends }).expect("a line")
    }
    fn initial(&self, seed: u64) -> SineGordonInitial {
        let mut r = Random::new(seed);
        let n = self.nodes();
        let mut initial = SineGordonInitial {
            u: r.list(n, 1.0),
            momentum_u: r.list(n, 0.5),
        };
        if self.ends == 0 {
            let n = self.n as f64;
            initial
                .u
                .iter_mut()
                .enumerate()
                .for_each(|(i, u)| u[0] += 6.0 * i as f64 / n);
        }
        initial
    }
    fn seen(&self, s: &SineGordonState) -> Configuration<f64> {
        Configuration::of(numbers(s.u()), vec![], vec![])
    }
    keeping!(SineGordon, |_, _: &SineGordonState| 0.0);
}

impl Line for Sine {
    fn name(&self) -> String {
        format!("sine-Gordon {} ends {}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        3
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let h = 0.05;
        let mut s = c(0.0);
        for (i, (x, y)) in a.x.iter().zip(&b.x).enumerate() {
            s += c(w[0] * self.weight(i) / (2.0 * h)) * (*y - *x) * (*y - *x);
        }
        for u in [&a.x, &b.x] {
            for i in 0..self.n {
                let next = if i + 1 < u.len() {
                    u[i + 1]
                } else {
                    u[0] + c(6.0)
                };
                s -= c(w[1] * 0.5 * h / (2.0 * 0.4)) * (next - u[i]) * (next - u[i]);
            }
            for (i, u) in u.iter().enumerate() {
                s -= c(w[2] * 0.5 * h * self.weight(i) * 1.7) * (c(1.0) - u.cos());
            }
        }
        s
    }
    fn held(&self, at: usize) -> bool {
        let (first, last) = (self.ends == 2 || self.ends == 4, self.ends >= 3);
        first && at == 0 || last && at == self.n
    }
    stepped!([momentum_u], 0.05, 2e-2, 0.4 / 0.05);
}
