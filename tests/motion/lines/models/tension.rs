//! The rod with uniform tension.

use super::{Line, Random, c, diagonal, keeping, stepped, vector};
use crate::action::{Configuration, D, trace};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation};
use clebsch_models::lattices::uniform_tension_rod::*;

/// A ring, or an open rod whose first and last ends are free or clamped.
pub struct Tension {
    pub n: usize,
    pub ends: Option<[bool; 2]>,
}

const S: f64 = 0.5;
const H: f64 = 0.02;

fn moments(i: usize) -> Matrix3<f64> {
    diagonal(0.3, 0.4, 0.5) * (1.0 + 0.1 * (i % 3) as f64)
}

fn stiffness() -> Matrix3<f64> {
    diagonal(0.5, 0.4, 0.7)
}

fn wall(last: bool) -> Matrix3<f64> {
    let turn = if last { -0.2 } else { 0.1 };
    Rotation::exp(&Vector3::new(turn, 0.2, -0.1)).matrix()
}

impl Tension {
    fn attitudes(&self) -> Vec<Rotation> {
        let mut r = Random::new(23);
        let turns = (0..self.n).map(|_| Rotation::exp(&(r.vector() * 0.6)));
        turns.collect()
    }
    fn across(&self) -> Vector3<f64> {
        let each = self.attitudes();
        each.iter().map(|r| r.matrix() * Vector3::z() * S).sum()
    }
    pub fn stepper(&self) -> UniformTensionRod {
        let ends = match self.ends {
            None => UniformTensionRodEnds::Ring,
            Some([first, last]) => UniformTensionRodEnds::Open {
                first: match first {
                    false => UniformTensionRodFirst::Free,
                    true => UniformTensionRodFirst::Clamped { Λw: wall(false) },
                },
                last: match last {
                    false => UniformTensionRodLast::Free,
                    true => UniformTensionRodLast::Clamped { Λw: wall(true) },
                },
            },
        };
        let parameters = UniformTensionRodParameters {
            s: S,
            J: (0..self.n).map(moments).collect(),
            B: stiffness(),
            X: self.across(),
        };
        let sites = UniformTensionRodSites { N: self.n, ends };
        UniformTensionRod::new(parameters, sites).expect("a rod")
    }
    /// Sections with random spins that keep the end-to-end vector; rotations about axes perpendicular to each section cancel its
    /// rate of change.
    pub fn initial(&self, seed: u64) -> UniformTensionRodInitial {
        let (attitudes, mut r) = (self.attitudes(), Random::new(seed + 300));
        let z = Vector3::z();
        let across = Matrix3::identity() - z * z.transpose();
        let turns: Vec<Matrix3<f64>> = attitudes.iter().map(Rotation::matrix).collect();
        let mut spins: Vec<Vector3<f64>> = turns.iter().map(|_| r.vector()).collect();
        let rate: Vector3<f64> = turns.iter().zip(&spins).map(|(t, w)| t * w.cross(&z)).sum();
        let answer: Matrix3<f64> = turns.iter().map(|t| t * across * t.transpose()).sum();
        let by = answer.try_inverse().expect("not straight") * rate;
        for (turn, spin) in turns.iter().zip(&mut spins) {
            *spin -= z.cross(&(turn.transpose() * by));
        }
        let inertia = |i: usize| {
            let j = moments(i) * S;
            Matrix3::identity() * j.trace() - j
        };
        let momenta = spins.iter().enumerate();
        UniformTensionRodInitial {
            body_momentum_Λ: momenta.map(|(i, w)| BodyMomentum(inertia(i) * w)).collect(),
            Λ: attitudes,
        }
    }
    fn seen(&self, s: &UniformTensionRodState) -> Configuration<f64> {
        Configuration::of(vec![], s.Λ().map(|r| r.matrix()).collect(), vec![])
    }
    keeping!(UniformTensionRod, |_, _: &UniformTensionRodState| 0.0);
}

impl Line for Tension {
    fn name(&self) -> String {
        format!("rod of one tension {} ends {:?}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        let clamped = self.ends.iter().flatten().filter(|c| **c).count();
        2 + clamped
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let bend = stiffness().map(c);
        let mut s = c(0.0);
        for (i, (x, y)) in a.r.iter().zip(&b.r).enumerate() {
            s -= c(w[0] * S / H) * trace(&moments(i).map(c), &(x.transpose() * y));
        }
        for q in [a, b] {
            for i in 0..self.n - usize::from(self.ends.is_some()) {
                let j = (i + 1) % self.n;
                s += c(w[1] * 0.5 * H / S) * trace(&bend, &(q.r[i].transpose() * q.r[j]));
            }
            let [first, last] = self.ends.unwrap_or_default();
            if first {
                let wall = wall(false).map(c);
                s += c(w[2] * H / S) * trace(&bend, &(wall.transpose() * q.r[0]));
            }
            if last {
                let wall = wall(true).map(c);
                let own = 2 + usize::from(first);
                s += c(w[own] * H / S) * trace(&bend, &(q.r[self.n - 1].transpose() * wall));
            }
        }
        s
    }
    fn constraints(&self, q: &Configuration<D>) -> Vec<D> {
        let each = q.r.iter().map(|r| r * vector(&Vector3::z()) * c(S));
        let sum = each.fold(Vector3::repeat(c(0.0)), |sum, d| sum + d);
        vec![sum[0], sum[1], sum[2]]
    }
    stepped!([body_momentum_Λ], 0.02, 5e-2, 0.0);
}

/// Rods with `n` sections. A single section has two directions, fewer than the three end-to-end constraints.
pub fn all(n: usize) -> Vec<Tension> {
    let ends = [
        None,
        Some([false, false]),
        Some([true, false]),
        Some([true, true]),
    ];
    let all = ends.into_iter().map(|ends| Tension { n, ends });
    all.filter(|_| n > 1).collect()
}
