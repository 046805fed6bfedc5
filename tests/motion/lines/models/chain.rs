//! The chain of rigid links.

use super::{Line, Random, c, keeping, numbers, stepped};
use crate::action::{Configuration, D};
use clebsch::nalgebra::Vector3;
use clebsch_models::lattices::hanging_chain::*;

/// A chain: free, fixed at the first bead, at the last, or at both; or a ring.
pub struct Chain {
    pub n: usize,
    pub ends: usize,
}

const H: f64 = 0.01;

fn mass(i: usize) -> f64 {
    0.5 + 0.2 * (i % 3) as f64
}

fn length(i: usize) -> f64 {
    0.6 + 0.1 * (i % 2) as f64
}

fn gravity() -> Vector3<f64> {
    Vector3::new(0.1, 0.2, -0.8)
}

impl Chain {
    fn is_ring(&self) -> bool {
        self.ends == 4
    }
    fn nodes(&self) -> usize {
        self.n + usize::from(!self.is_ring())
    }
    fn lengths(&self) -> Vec<f64> {
        let x = self.initial(0).x;
        let n = self.nodes();
        (0..self.n)
            .map(|i| (x[(i + 1) % n] - x[i]).norm())
            .collect()
    }
    pub fn stepper(&self) -> HangingChain {
        let ends = match self.ends {
            4 => HangingChainEnds::Ring,
            ends => HangingChainEnds::Open {
                first: match ends % 2 {
                    1 => HangingChainFirst::Pinned,
                    _ => HangingChainFirst::Free,
                },
                last: match ends / 2 {
                    1 => HangingChainLast::Pinned,
                    _ => HangingChainLast::Free,
                },
            },
        };
        let parameters = HangingChainParameters {
            m: (0..self.nodes()).map(mass).collect(),
            a: self.lengths(),
            g: gravity(),
        };
        HangingChain::new(parameters, HangingChainSites { N: self.n, ends }).expect("a chain")
    }
    /// Links that rotate independently, or a ring that moves as a whole; at rest if both ends are fixed.
    pub fn initial(&self, seed: u64) -> HangingChainInitial {
        // One shape for all seeds, with random velocities.
        let (mut shape, mut r) = (Random::new(21), Random::new(seed));
        let (mut x, mut v) = (vec![shape.vector()], vec![r.vector() * 0.3]);
        if self.ends == 1 || self.ends == 3 {
            v[0] = Vector3::zeros();
        }
        for i in 0..self.n {
            let (link, spin) = (
                (Vector3::z() + shape.vector() * 0.5).normalize() * length(i),
                r.vector(),
            );
            x.push(x[i] + link);
            v.push(v[i] + spin.cross(&link));
        }
        match self.ends {
            2 => {
                let last = v[self.n];
                v.iter_mut().for_each(|v| *v -= last);
            }
            3 => v.iter_mut().for_each(|v| *v = Vector3::zeros()),
            4 => {
                let (angle, spin) = (std::f64::consts::TAU / self.n as f64, r.vector());
                let out = |i: usize| {
                    Vector3::new((angle * i as f64).cos(), (angle * i as f64).sin(), 0.0)
                };
                x = (0..self.n).map(|i| out(i) + shape.vector() * 0.1).collect();
                v = x.iter().map(|x| spin.cross(x)).collect();
            }
            _ => {}
        }
        let n = self.nodes();
        HangingChainInitial {
            momentum_x: (0..n).map(|i| v[i] * mass(i)).collect(),
            x: x[..n].to_vec(),
        }
    }
    fn seen(&self, s: &HangingChainState) -> Configuration<f64> {
        Configuration::of(numbers(s.x()), vec![], vec![])
    }
    keeping!(HangingChain, |_, _: &HangingChainState| 0.0);
}

impl Line for Chain {
    fn name(&self) -> String {
        format!("chain {} ends {}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        2
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let at = |x: &[D], i: usize| Vector3::new(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
        let mut s = c(0.0);
        for i in 0..self.nodes() {
            let d = at(&b.x, i) - at(&a.x, i);
            s += c(w[0] * mass(i) / (2.0 * H)) * d.dot(&d);
            for q in [a, b] {
                s += c(w[1] * 0.5 * H * mass(i)) * gravity().map(c).dot(&at(&q.x, i));
            }
        }
        s
    }
    fn constraints(&self, q: &Configuration<D>) -> Vec<D> {
        let at = |i: usize| Vector3::new(q.x[3 * i], q.x[3 * i + 1], q.x[3 * i + 2]);
        let link = |i: usize| {
            let d = at((i + 1) % self.nodes()) - at(i);
            d.dot(&d)
        };
        (0..self.n).map(link).collect()
    }
    fn held(&self, at: usize) -> bool {
        let fields = 3 * self.nodes();
        !self.is_ring() && (self.ends % 2 == 1 && at < 3 || self.ends / 2 == 1 && at >= fields - 3)
    }
    stepped!([momentum_x], 0.01, 5e-2, 0.9 / H);
}
