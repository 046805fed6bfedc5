//! Constraints on sums over sites: the centre of mass, the length of the chain, and the sum of squares of a field. The model is
//! defined in this file.

use super::{Line, Random, c, keeping, stepped};
use crate::action::{Configuration, D};
use clebsch::Real;
use clebsch::nalgebra::{DMatrix, DVector, SMatrix, Vector2};

clebsch::model! {
    /// Beads in the plane, each with a number whose velocity is coupled to the velocity of the position. The centre
    /// of mass, the sum of squared distances, and a moment of the numbers are constrained.
    pub model WeighedBeads {
        label i in 0..N;
        periodic;
        param m: Real at nodes;
        param X: Vec<2>;
        param R, Q, f, e, k: Real;
        field φ: Vec<2> at nodes offset L;
        field q: Real at nodes;
        hold c: sum(m*φ) = X;
        hold ρ: R = sum(dot(next(φ, i) - φ, next(φ, i) - φ) + (next(q, i) - q)^2, segments);
        hold κ: (sum(m*q^2) - Q)/2 = 0;
        let d = next(φ) - φ;
        lagrangian = m*dot(d, d)/(2*h) + m*(next(q) - q)^2/(2*h) + e*(next(q) - q)*d[1]/h
            + (f/2)*dot(perp(φ), next(φ)) - (h/4)*k*dot(φ, φ)^2 - (h/2)*m*(next(q, i) - q)^2;
        end i = 0 { free; }
        end i = N { free; load { param F: Vec<2>; term h*dot(F, φ); } }
    }
}

const H: f64 = 0.01;
const F: f64 = 0.4;
const E: f64 = 0.2;
const K: f64 = 0.3;

/// The beads: a ring, free, or loaded at the last.
pub struct Sums {
    pub n: usize,
    pub ends: usize,
}

fn mass(i: usize) -> f64 {
    0.7 + 0.1 * (i % 3) as f64
}

fn load() -> Vector2<f64> {
    Vector2::new(0.2, -0.1)
}

fn offset() -> Vector2<f64> {
    Vector2::new(0.5, 0.3)
}

impl Sums {
    fn nodes(&self) -> usize {
        self.n + usize::from(self.ends != 0)
    }
    fn places(&self) -> (Vec<Vector2<f64>>, Vec<f64>) {
        let mut r = Random::new(31);
        let place = |_| (Vector2::new(r.number(), r.number()), r.number());
        (0..self.nodes()).map(place).unzip()
    }
    fn at_start(&self) -> Configuration<f64> {
        let (places, numbers) = self.places();
        let x = places.iter().flat_map(|x| [x[0], x[1]]).chain(numbers);
        Configuration::of(x.collect(), vec![], vec![])
    }
    pub fn stepper(&self) -> WeighedBeads {
        let own = self.constraints(&self.at_start().lifted());
        let ends = match self.ends {
            0 => WeighedBeadsEnds::Ring { L: offset() },
            ends => WeighedBeadsEnds::Open {
                first: WeighedBeadsFirst::Free,
                last: match ends {
                    1 => WeighedBeadsLast::Free,
                    _ => WeighedBeadsLast::Load { F: load() },
                },
            },
        };
        let parameters = WeighedBeadsParameters {
            m: (0..self.nodes()).map(mass).collect(),
            X: Vector2::new(own[0].value(), own[1].value()),
            R: own[2].value(),
            Q: own[3].value(),
            f: F,
            e: E,
            k: K,
        };
        WeighedBeads::new(parameters, WeighedBeadsSites { N: self.n, ends }).expect("beads")
    }
    /// Random velocities, projected so that the sums stay constant.
    fn velocities(&self, seed: u64) -> DVector<f64> {
        let at = self.at_start();
        let mut r = Random::new(seed + 40);
        let mut v = DVector::from_fn(at.coordinates(), |_, _| r.number());
        let columns = (0..at.coordinates()).map(|k| self.constraints(&at.varied(k)));
        let columns: Vec<Vec<D>> = columns.collect();
        let all = DMatrix::from_fn(columns.len(), 4, |i, j| columns[i][j].dual[0]);
        let basis = all.qr().q();
        for _ in 0..2 {
            v -= &basis * (basis.transpose() * &v);
        }
        v
    }
    pub fn initial(&self, seed: u64) -> WeighedBeadsInitial {
        let ((places, numbers), v) = (self.places(), self.velocities(seed));
        let nodes = self.nodes();
        let both = |i: usize| (Vector2::new(v[2 * i], v[2 * i + 1]), v[2 * nodes + i]);
        let of_place = |i: usize| {
            let ((u, w), x) = (both(i), places[i]);
            u * mass(i) + Vector2::x() * (E * w) + Vector2::new(-x[1], x[0]) * (F / 2.0)
        };
        let of_number = |i: usize| both(i).1 * mass(i) + E * both(i).0[0];
        WeighedBeadsInitial {
            momentum_φ: (0..nodes).map(of_place).collect(),
            momentum_q: (0..nodes).map(|i| SMatrix::repeat(of_number(i))).collect(),
            φ: places,
            q: numbers.into_iter().map(SMatrix::repeat).collect(),
        }
    }
    fn seen(&self, s: &WeighedBeadsState) -> Configuration<f64> {
        let places = s.φ().iter().flat_map(|x| [x[0], x[1]]);
        Configuration::of(
            places.chain(s.q().iter().map(|q| q[0])).collect(),
            vec![],
            vec![],
        )
    }
    keeping!(WeighedBeads, |_, _: &WeighedBeadsState| 0.0);
}

impl Line for Sums {
    fn name(&self) -> String {
        format!("beads with sums {} ends {}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        6 + usize::from(self.ends == 2)
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let nodes = self.nodes();
        let mut s = c(0.0);
        for i in 0..nodes {
            let (x, y, q) = (2 * i, 2 * i + 1, 2 * nodes + i);
            let d = [x, y, q].map(|k| b.x[k] - a.x[k]);
            s += c(w[0] * mass(i) / (2.0 * H)) * (d[0] * d[0] + d[1] * d[1]);
            s += c(w[1] * mass(i) / (2.0 * H)) * d[2] * d[2];
            s += c(w[2] * E / H) * d[2] * d[0];
            s += c(w[3] * F / 2.0) * (a.x[x] * b.x[y] - a.x[y] * b.x[x]);
            for at in [a, b] {
                let square = at.x[x] * at.x[x] + at.x[y] * at.x[y];
                s -= c(w[4] * 0.5 * H / 4.0 * K) * square * square;
            }
        }
        for at in [a, b] {
            for i in 0..self.n {
                let d = at.x[2 * nodes + (i + 1) % nodes] - at.x[2 * nodes + i];
                s -= c(w[5] * 0.5 * H / 2.0 * mass(i)) * d * d;
            }
            if self.ends == 2 {
                let last = 2 * self.n;
                let pulled = c(load()[0]) * at.x[last] + c(load()[1]) * at.x[last + 1];
                s += c(w[6] * 0.5 * H) * pulled;
            }
        }
        s
    }
    fn constraints(&self, at: &Configuration<D>) -> Vec<D> {
        let nodes = self.nodes();
        let mut sums = [c(0.0); 4];
        for i in 0..nodes {
            let q = at.x[2 * nodes + i];
            sums[0] += c(mass(i)) * at.x[2 * i];
            sums[1] += c(mass(i)) * at.x[2 * i + 1];
            sums[3] += c(mass(i)) * q * q;
        }
        for i in 0..self.n {
            let j = (i + 1) % nodes;
            let seam = if self.ends == 0 && j == 0 {
                offset()
            } else {
                Vector2::zeros()
            };
            let x = at.x[2 * j] + c(seam[0]) - at.x[2 * i];
            let y = at.x[2 * j + 1] + c(seam[1]) - at.x[2 * i + 1];
            let q = at.x[2 * nodes + j] - at.x[2 * nodes + i];
            sums[2] += x * x + y * y + q * q;
        }
        sums.to_vec()
    }
    stepped!([momentum_φ momentum_q], 0.01, 5e-2, 0.9 / H);
}

/// Chains with `n` segments; a single node cannot move.
pub fn all(n: usize) -> Vec<Sums> {
    let all = (0..3).map(|ends| Sums { n, ends });
    all.filter(|line| n > 1 || line.ends > 0).collect()
}
