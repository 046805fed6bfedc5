//! Velocity coupling of neighbours, solved together along the chain. The models are defined in this file.

use super::{Line, Random, Wide, c, keeping_between, numbers, stepped};
use crate::action::{Configuration, D};
use clebsch::Real;
use clebsch::nalgebra::{SMatrix, Vector2};

clebsch::model! {
    /// Beads with coupled velocities and positions: rods between beads have masses.
    pub model LinkedChain {
        label i in 0..N;
        end i = 0 { free; pinned { q = given; } }
        end i = N { free; pinned { q = given; } }
        periodic;
        param m: Real at nodes;
        param c, e: Real;
        field q: Real at nodes offset L;
        lagrangian = m*(next(q) - q)^2/(2*h) + c*(next(q) - q)*(next(next(q, i)) - next(q, i))/h
            - h*e*(next(q, i) - q)^2/2;
    }
}

clebsch::model! {
    /// Beads in the plane, each with a number: the velocity coupling depends on the numbers and on the positions.
    pub model WovenChain {
        label i in 0..N;
        periodic;
        param m: Real at nodes;
        param b, c, e: Real;
        field q: Real at nodes;
        field X: Vec<2> at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h) + m*dot(next(X) - X, next(X) - X)/(2*h)
            + c*(1 + b*cos((q + next(q))/2))*dot(next(X) - X, next(next(X, i)) - next(X, i))/h
            + c*b*(next(q) - q)^2*(next(next(q, i)) - next(q, i))^2/h^3
            - h*e*(next(q, i) - q)^2/2 - h*e*dot(next(X, i) - X, next(X, i) - X)/2;
    }
}

const H: f64 = 0.05;
const C: f64 = 0.3;
const E: f64 = 0.6;

/// The scalar chain, by end: ring, free, first prescribed, last prescribed.
pub struct Linked {
    pub n: usize,
    pub ends: usize,
}

fn mass(i: usize) -> f64 {
    1.0 + 0.3 * (i % 2) as f64
}

impl Linked {
    fn nodes(&self) -> usize {
        self.n + usize::from(self.ends != 0)
    }
    fn links(&self) -> impl Iterator<Item = [usize; 2]> {
        let nodes = self.nodes();
        (0..self.n).map(move |i| [i, (i + 1) % nodes])
    }
    pub fn stepper(&self) -> LinkedChain {
        let parameters = LinkedChainParameters {
            m: (0..self.nodes()).map(mass).collect(),
            c: C,
            e: E,
        };
        let (first, last) = match self.ends {
            2 => (LinkedChainFirst::Pinned, LinkedChainLast::Free),
            3 => (LinkedChainFirst::Free, LinkedChainLast::Pinned),
            _ => (LinkedChainFirst::Free, LinkedChainLast::Free),
        };
        let ends = match self.ends {
            0 => LinkedChainEnds::Ring { L: 2.0 },
            _ => LinkedChainEnds::Open { first, last },
        };
        LinkedChain::new(parameters, LinkedChainSites { N: self.n, ends }).expect("a chain")
    }
    pub fn initial(&self, seed: u64) -> LinkedChainInitial {
        let mut r = Random::new(seed);
        let n = self.nodes();
        LinkedChainInitial {
            q: r.list(n, 1.0),
            momentum_q: r.list(n, 1.0),
        }
    }
    /// Three steps, with derivatives with respect to all positions and momenta.
    pub fn moved(&self, q: Vec<Wide>, p: Vec<Wide>) -> [Vec<Wide>; 2] {
        let k = Wide::constant;
        let parameters = LinkedChainParameters {
            m: (0..self.nodes()).map(|i| k(mass(i))).collect(),
            c: k(C),
            e: k(E),
        };
        let ends = match self.ends {
            0 => LinkedChainEnds::Ring { L: k(2.0) },
            _ => LinkedChainEnds::Open {
                first: LinkedChainFirst::Free,
                last: LinkedChainLast::Free,
            },
        };
        let model = LinkedChain::new(parameters, LinkedChainSites { N: self.n, ends });
        let model = model.expect("a chain");
        let list = |x: Vec<Wide>| x.into_iter().map(SMatrix::repeat).collect();
        let initial = LinkedChainInitial {
            q: list(q),
            momentum_q: list(p),
        };
        let (mut state, mut work) = model.start(initial, k(H)).expect("starts");
        for _ in 0..3 {
            model.step(&mut state, &mut work).expect("steps");
        }
        [state.q(), state.momentum_q()].map(|list| list.iter().map(|x| x[0]).collect())
    }
    fn seen(&self, s: &LinkedChainState) -> Configuration<f64> {
        Configuration::of(numbers(s.q()), vec![], vec![])
    }
    /// The offset of the neighbour across the seam of the ring.
    fn beyond(&self, [_, j]: [usize; 2]) -> f64 {
        if self.ends == 0 && j == 0 { 2.0 } else { 0.0 }
    }
    /// The energy between two nodes, from the velocity of the edge and the mean of both potentials.
    fn energy(&self, a: &[f64], b: &[f64], h: f64) -> f64 {
        let v: Vec<f64> = a.iter().zip(b).map(|(a, b)| (b - a) / h).collect();
        let own = v.iter().enumerate().map(|(i, v)| mass(i) * v * v / 2.0);
        let mut e: f64 = own.sum();
        for [i, j] in self.links() {
            e += C * v[i] * v[j];
            for x in [a, b] {
                let d = x[j] + self.beyond([i, j]) - x[i];
                e += 0.5 * E * d * d / 2.0;
            }
        }
        e
    }
    keeping_between!(
        x,
        |line: &Self, s: &LinkedChainState| match line.ends {
            0 | 1 => s.momentum_q().iter().map(|p| p[0]).sum(),
            _ => 0.0,
        },
        0.0
    );
}

impl Line for Linked {
    fn name(&self) -> String {
        format!("linked {} ends {}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        // In a ring of one site, the spring has constant length.
        if self.ends == 0 && self.n == 1 { 2 } else { 3 }
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let mut s = c(0.0);
        let d = |i: usize| b.x[i] - a.x[i];
        for i in 0..self.nodes() {
            s += c(w[0] * mass(i) / (2.0 * H)) * d(i) * d(i);
        }
        for [i, j] in self.links() {
            s += c(w[1] * C / H) * d(i) * d(j);
            for x in [&a.x, &b.x].into_iter().filter(|_| self.terms() > 2) {
                let r = x[j] + c(self.beyond([i, j])) - x[i];
                s -= c(w[2] * 0.5 * H * E / 2.0) * r * r;
            }
        }
        s
    }
    fn held(&self, at: usize) -> bool {
        self.ends == 2 && at == 0 || self.ends == 3 && at == self.n
    }
    stepped!([momentum_q], 0.05, 2e-2, 1.9 / H);
}

/// Beads in the plane, in an open chain or a ring.
pub struct Woven {
    pub n: usize,
    pub ring: bool,
}

const B: f64 = 0.5;

impl Woven {
    fn nodes(&self) -> usize {
        self.n + usize::from(!self.ring)
    }
    pub fn stepper(&self) -> WovenChain {
        let parameters = WovenChainParameters {
            m: (0..self.nodes()).map(mass).collect(),
            b: B,
            c: 0.2,
            e: E,
        };
        let ends = match self.ring {
            true => WovenChainEnds::Ring,
            false => WovenChainEnds::Open,
        };
        WovenChain::new(parameters, WovenChainSites { N: self.n, ends }).expect("beads")
    }
    fn initial(&self, seed: u64) -> WovenChainInitial {
        let mut r = Random::new(seed);
        let n = self.nodes();
        let (q, momentum_q) = (r.list(n, 1.0), r.list(n, 0.5));
        WovenChainInitial {
            q,
            momentum_q,
            X: r.list(n, 1.0),
            momentum_X: r.list(n, 0.5),
        }
    }
    fn seen(&self, s: &WovenChainState) -> Configuration<f64> {
        Configuration::of([numbers(s.q()), numbers(s.X())].concat(), vec![], vec![])
    }
    keeping_between!(
        x,
        |_: &Self, s: &WovenChainState| s.momentum_X().iter().map(|p| p[0]).sum(),
        0.0
    );
    /// The energy between two nodes, from the velocities of the edge and the mean of both ends.
    fn energy(&self, a: &[f64], b: &[f64], h: f64) -> f64 {
        let n = self.nodes();
        let v: Vec<f64> = a.iter().zip(b).map(|(a, b)| (b - a) / h).collect();
        let at = |x: &[f64], i: usize| Vector2::new(x[n + 2 * i], x[n + 2 * i + 1]);
        let own = (0..n).map(|i| mass(i) * (v[i] * v[i] + at(&v, i).norm_squared()) / 2.0);
        let mut e: f64 = own.sum();
        for i in 0..self.n {
            let j = (i + 1) % n;
            let bend = 1.0 + B * (0.5 * (a[i] + b[i])).cos();
            e += 0.2 * bend * at(&v, i).dot(&at(&v, j)) + 3.0 * 0.2 * B * (v[i] * v[j]).powi(2);
            for x in [a, b] {
                let (d, r) = (x[j] - x[i], at(x, j) - at(x, i));
                e += 0.5 * E * (d * d + r.norm_squared()) / 2.0;
            }
        }
        e
    }
}

impl Line for Woven {
    fn name(&self) -> String {
        format!("woven {} ring {}", self.n, self.ring)
    }
    fn terms(&self) -> usize {
        if self.ring && self.n == 1 { 4 } else { 6 }
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let n = self.nodes();
        let at = |x: &[D], i: usize| Vector2::new(x[n + 2 * i], x[n + 2 * i + 1]);
        let dq = |i: usize| b.x[i] - a.x[i];
        let dx = |i: usize| at(&b.x, i) - at(&a.x, i);
        let mut s = c(0.0);
        for i in 0..n {
            s += c(w[0] * mass(i) / (2.0 * H)) * dq(i) * dq(i);
            s += c(w[1] * mass(i) / (2.0 * H)) * dx(i).dot(&dx(i));
        }
        for i in 0..self.n {
            let j = (i + 1) % n;
            let bend = c(1.0) + c(B) * ((a.x[i] + b.x[i]) * c(0.5)).cos();
            s += c(w[2] * 0.2 / H) * bend * dx(i).dot(&dx(j));
            let both = dq(i) * dq(j);
            s += c(w[3] * 0.2 * B / H.powi(3)) * both * both;
            for x in [&a.x, &b.x].into_iter().filter(|_| self.terms() > 4) {
                let (d, r) = (x[j] - x[i], at(x, j) - at(x, i));
                s -= c(w[4] * 0.5 * H * E / 2.0) * d * d;
                s -= c(w[5] * 0.5 * H * E / 2.0) * r.dot(&r);
            }
        }
        s
    }
    stepped!([momentum_q momentum_X], 0.05, 1e-1, 2.0 / H);
}
