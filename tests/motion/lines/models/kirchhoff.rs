//! The inextensible rod.

use super::{Line, Random, c, diagonal, keeping, numbers, stepped, vector};
use crate::action::{Configuration, D, trace};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Real, Rotation};
use clebsch_models::lattices::kirchhoff_rod::*;

/// Ends: the first is free, pinned or clamped, and the last is free, pinned or loaded; or the rod is a ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// The numbers of the first and the last end.
    Open(usize, usize),
    /// A ring, closed by the vector that the sections add up to.
    Ring,
}

/// A rod.
pub struct Kirchhoff {
    pub n: usize,
    pub ends: Ends,
}

const S: f64 = 0.5;
const H: f64 = 0.02;

fn mass(i: usize) -> f64 {
    0.5 + 0.1 * (i % 3) as f64
}

fn moments(i: usize) -> Matrix3<f64> {
    diagonal(0.3, 0.4, 0.5) * (1.0 + 0.1 * (i % 3) as f64)
}

fn stiffness() -> Matrix3<f64> {
    diagonal(0.5, 0.4, 0.7)
}

fn gravity() -> Vector3<f64> {
    Vector3::new(0.0, 0.1, -0.3)
}

fn wall() -> Matrix3<f64> {
    Rotation::exp(&Vector3::new(0.1, 0.2, -0.1)).matrix()
}

fn force() -> Vector3<f64> {
    Vector3::new(0.2, -0.1, 0.3)
}

impl Kirchhoff {
    fn nodes(&self) -> usize {
        self.n + usize::from(self.ends != Ends::Ring)
    }
    fn attitudes(&self) -> Vec<Rotation> {
        let mut r = Random::new(11);
        (0..self.n)
            .map(|_| Rotation::exp(&(r.vector() * 0.3)))
            .collect()
    }
    /// The vector from one end to the other.
    fn across(&self) -> Vector3<f64> {
        let each = self.attitudes();
        each.iter().map(|r| r.matrix() * Vector3::z() * S).sum()
    }
    pub fn stepper(&self) -> KirchhoffRod {
        self.stepper_of(&|x| x)
    }
    fn stepper_of<T: Real>(&self, k: &dyn Fn(f64) -> T) -> KirchhoffRod<T> {
        let ends = match self.ends {
            Ends::Ring => KirchhoffRodEnds::Ring {
                X: self.across().map(k),
            },
            Ends::Open(first, last) => KirchhoffRodEnds::Open {
                first: match first {
                    0 => KirchhoffRodFirst::Free,
                    1 => KirchhoffRodFirst::Pinned,
                    _ => KirchhoffRodFirst::Clamped { Λw: wall().map(k) },
                },
                last: match last {
                    0 => KirchhoffRodLast::Free,
                    1 => KirchhoffRodLast::Pinned,
                    _ => KirchhoffRodLast::Load {
                        force: force().map(k),
                    },
                },
            },
        };
        let parameters = KirchhoffRodParameters {
            s: k(S),
            m: (0..self.nodes()).map(|i| k(mass(i))).collect(),
            J: (0..self.n).map(|i| moments(i).map(k)).collect(),
            B: stiffness().map(k),
            g: gravity().map(k),
        };
        KirchhoffRod::new(parameters, KirchhoffRodSites { N: self.n, ends }).expect("a rod")
    }
    /// Rotating sections and the matching node velocities; at rest if both ends are fixed.
    pub fn initial(&self, seed: u64) -> KirchhoffRodInitial {
        let (attitudes, mut r) = (self.attitudes(), Random::new(seed + 100));
        let mut x = vec![r.vector()];
        let held = matches!(self.ends, Ends::Open(1.., _));
        let mut v = vec![if held {
            Vector3::zeros()
        } else {
            r.vector() * 0.3
        }];
        let still = matches!(self.ends, Ends::Open(1.., 1));
        let mut spins = Vec::new();
        for (i, turn) in attitudes.iter().enumerate() {
            let turn = turn.matrix();
            let spin = match self.ends {
                // A spin that leaves the closed curve unchanged.
                Ends::Ring => Vector3::z() * r.number(),
                Ends::Open(_, 1) => Vector3::z() * r.number(),
                Ends::Open(..) => r.vector(),
            };
            let spin = if still { spin * 0.0 } else { spin };
            x.push(x[i] + turn * Vector3::z() * S);
            v.push(v[i] + turn * spin.cross(&Vector3::z()) * S);
            spins.push(spin);
        }
        if let Ends::Open(0, 1) = self.ends {
            v.iter_mut().for_each(|v| *v = Vector3::zeros());
        }
        let inertia = |i: usize| {
            let j = moments(i) * S;
            Matrix3::identity() * j.trace() - j
        };
        let spins = spins.iter().enumerate();
        KirchhoffRodInitial {
            φ: x[..self.nodes()].to_vec(),
            momentum_φ: (0..self.nodes()).map(|i| v[i] * mass(i)).collect(),
            body_momentum_Λ: spins.map(|(i, w)| BodyMomentum(inertia(i) * w)).collect(),
            Λ: attitudes,
        }
    }
    fn seen(&self, s: &KirchhoffRodState) -> Configuration<f64> {
        Configuration::of(numbers(s.φ()), s.Λ().map(|r| r.matrix()).collect(), vec![])
    }
    keeping!(KirchhoffRod, |_, _: &KirchhoffRodState| 0.0);
}

impl Line for Kirchhoff {
    fn name(&self) -> String {
        format!("Kirchhoff rod {} ends {:?}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        let Ends::Open(first, last) = self.ends else {
            return 4;
        };
        4 + usize::from(first == 2) + usize::from(last == 2)
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let at = |x: &[D], i: usize| Vector3::new(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
        let bend = stiffness().map(c);
        let mut s = c(0.0);
        for i in 0..self.nodes() {
            let d = at(&b.x, i) - at(&a.x, i);
            s += c(w[0] * mass(i) / (2.0 * H)) * d.dot(&d);
        }
        for (i, (x, y)) in a.r.iter().zip(&b.r).enumerate() {
            s -= c(w[1] * S / H) * trace(&moments(i).map(c), &(x.transpose() * y));
        }
        for q in [a, b] {
            for i in 0..self.nodes() {
                s += c(w[2] * 0.5 * H * mass(i)) * vector(&gravity()).dot(&at(&q.x, i));
            }
            let bonds = if self.ends == Ends::Ring {
                self.n
            } else {
                self.n - 1
            };
            for i in 0..bonds {
                let j = (i + 1) % self.n;
                s += c(w[3] * 0.5 * H / S) * trace(&bend, &(q.r[i].transpose() * q.r[j]));
            }
            let Ends::Open(first, last) = self.ends else {
                continue;
            };
            let mut term = 4;
            if first == 2 {
                let wall = wall().map(c);
                s += c(w[term] * H / S) * trace(&bend, &(wall.transpose() * q.r[0]));
                term += 1;
            }
            if last == 2 {
                s += c(w[term] * 0.5 * H) * vector(&force()).dot(&at(&q.x, self.n));
            }
        }
        s
    }
    fn constraints(&self, q: &Configuration<D>) -> Vec<D> {
        let at = |i: usize| Vector3::new(q.x[3 * i], q.x[3 * i + 1], q.x[3 * i + 2]);
        let each = (0..self.n).flat_map(|i| {
            let j = (i + 1) % self.nodes();
            // Across the seam, positions differ by a constant.
            let d = at(j) - at(i) - q.r[i] * vector(&Vector3::z()) * c(S);
            [d[0], d[1], d[2]]
        });
        each.collect()
    }
    fn held(&self, at: usize) -> bool {
        let Ends::Open(first, last) = self.ends else {
            return false;
        };
        let fields = 3 * self.nodes();
        first > 0 && at < 3 || last == 1 && at >= fields - 3 && at < fields
    }
    stepped!([momentum_φ body_momentum_Λ], 0.02, 5e-2, 0.7 / H);
}

/// Rods with `n` sections, for all ends with independent constraints.
pub fn all(n: usize) -> Vec<Kirchhoff> {
    let open = (0..9).map(|ends| Ends::Open(ends / 3, ends % 3));
    // A single section between two fixed positions can only rotate about its own axis.
    let open = open.filter(|ends| n > 1 || !matches!(ends, Ends::Open(1.., 1)));
    let ring = (n > 1).then_some(Ends::Ring);
    open.chain(ring).map(|ends| Kirchhoff { n, ends }).collect()
}
