//! The elastic rod.

use super::{Line, Random, c, diagonal, keeping, numbers, stepped, vector};
use crate::action::{Configuration, D, trace};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation};
use clebsch_models::lattices::geometrically_exact_rod::*;

/// The condition at an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EndCondition {
    Free,
    Pinned,
    Clamped,
    Load,
}

impl EndCondition {
    pub const FIRST: [EndCondition; 3] = [
        EndCondition::Free,
        EndCondition::Pinned,
        EndCondition::Clamped,
    ];
    pub const LAST: [EndCondition; 4] = [
        EndCondition::Free,
        EndCondition::Pinned,
        EndCondition::Clamped,
        EndCondition::Load,
    ];

    fn holds(self) -> bool {
        matches!(self, EndCondition::Pinned | EndCondition::Clamped)
    }
}

/// An elastic rod, open or closed to a ring; once around the ring, the centreline advances by a constant vector.
pub struct Rod {
    pub n: usize,
    ends: Option<[EndCondition; 2]>,
}

impl Rod {
    pub fn free(n: usize) -> Self {
        Self::new(n, Some([EndCondition::Free; 2]))
    }
    pub fn new(n: usize, ends: Option<[EndCondition; 2]>) -> Self {
        Self { n, ends }
    }
    fn nodes(&self) -> usize {
        self.n + usize::from(self.ends.is_some())
    }
    fn is(&self, end: usize, held: EndCondition) -> bool {
        self.ends.is_some_and(|ends| ends[end] == held)
    }
    fn mass(&self, i: usize) -> f64 {
        let last = self.ends.is_some() && (i == 0 || i == self.n);
        0.5 * if last { 0.5 } else { 1.0 }
    }
    fn inertia(i: usize) -> Matrix3<f64> {
        diagonal(0.3, 0.4, 0.5) * (1.0 + 0.1 * (i % 3) as f64)
    }
    fn wall() -> Matrix3<f64> {
        Rotation::exp(&Vector3::new(0.1, 0.2, -0.1)).matrix()
    }
    fn force() -> Vector3<f64> {
        Vector3::new(0.2, -0.1, 0.3)
    }
    /// The advance of the centreline once around the ring.
    fn grows(&self) -> Vector3<f64> {
        Vector3::new(0.05, -0.02, 0.5 * self.n as f64)
    }
    fn stiffness() -> [Matrix3<f64>; 2] {
        let shear = Matrix3::new(2.0, 0.1, 0.2, 0.1, 2.5, 0.0, 0.2, 0.0, 3.0);
        [shear, diagonal(0.5, 0.4, 0.7)]
    }
    pub fn stepper(&self) -> GeometricallyExactRod {
        GeometricallyExactRod::new(self.parameters(), self.sites()).expect("a rod")
    }
    pub fn sites(&self) -> GeometricallyExactRodSites {
        let ends = match self.ends {
            None => GeometricallyExactRodEnds::Ring { X: self.grows() },
            Some([first, last]) => GeometricallyExactRodEnds::Open {
                first: match first {
                    EndCondition::Pinned => GeometricallyExactRodFirst::Pinned,
                    EndCondition::Clamped => {
                        GeometricallyExactRodFirst::Clamped { Λw: Self::wall() }
                    }
                    _ => GeometricallyExactRodFirst::Free,
                },
                last: match last {
                    EndCondition::Free => GeometricallyExactRodLast::Free,
                    EndCondition::Pinned => GeometricallyExactRodLast::Pinned,
                    EndCondition::Clamped => GeometricallyExactRodLast::Clamped {
                        Λw: Self::wall().transpose(),
                    },
                    EndCondition::Load => GeometricallyExactRodLast::Load {
                        force: Self::force(),
                    },
                },
            },
        };
        GeometricallyExactRodSites { N: self.n, ends }
    }
    pub fn parameters(&self) -> GeometricallyExactRodParameters {
        GeometricallyExactRodParameters {
            s: 0.5,
            m: (0..self.nodes()).map(|i| self.mass(i)).collect(),
            J: (0..self.n).map(Self::inertia).collect(),
            S: Self::stiffness()[0],
            B: Self::stiffness()[1],
            g: Vector3::new(0.0, 0.1, -0.3),
        }
    }
    pub fn initial(&self, seed: u64) -> GeometricallyExactRodInitial {
        let mut r = Random::new(seed);
        GeometricallyExactRodInitial {
            φ: (0..self.nodes())
                .map(|i| Vector3::z() * (0.5 * i as f64) + r.vector() * 0.1)
                .collect(),
            momentum_φ: (0..self.nodes()).map(|_| r.vector() * 0.2).collect(),
            Λ: (0..self.n)
                .map(|_| Rotation::exp(&(r.vector() * 0.3)))
                .collect(),
            body_momentum_Λ: (0..self.n)
                .map(|_| BodyMomentum(r.vector() * 0.2))
                .collect(),
        }
    }
    fn seen(&self, s: &GeometricallyExactRodState) -> Configuration<f64> {
        Configuration::of(numbers(s.φ()), s.Λ().map(|r| r.matrix()).collect(), vec![])
    }
    keeping!(
        GeometricallyExactRod,
        |_, _: &GeometricallyExactRodState| 0.0
    );
}

impl Line for Rod {
    fn name(&self) -> String {
        format!("rod {} ends {:?}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        let clamps = (0..2)
            .filter(|end| self.is(*end, EndCondition::Clamped))
            .count();
        5 + clamps + usize::from(self.is(1, EndCondition::Load))
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (h, l) = (0.02, 0.5);
        let [shear, bend] = Self::stiffness().map(|m| m.map(c));
        let at = |x: &[D], i: usize| Vector3::new(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
        let mut s = c(0.0);
        for i in 0..self.nodes() {
            let d = at(&b.x, i) - at(&a.x, i);
            s += c(w[0] * self.mass(i) / (2.0 * h)) * d.dot(&d);
        }
        for (i, (x, y)) in a.r.iter().zip(&b.r).enumerate() {
            s -= c(w[2] * l / h) * trace(&Self::inertia(i).map(c), &(x.transpose() * y));
        }
        for q in [a, b] {
            let half = 0.5 * h;
            for i in 0..self.nodes() {
                let g = Vector3::new(0.0, 0.1, -0.3);
                s += c(w[1] * half * self.mass(i)) * vector(&g).dot(&at(&q.x, i));
            }
            for i in 0..self.n {
                let next = if i + 1 < self.nodes() {
                    at(&q.x, i + 1)
                } else {
                    at(&q.x, 0) + vector(&self.grows())
                };
                let along = (next - at(&q.x, i)) * c(1.0 / l);
                let strain = q.r[i].transpose() * along - vector(&Vector3::z());
                s -= c(w[3] * half * l / 2.0) * strain.dot(&(shear * strain));
                if i + 1 < self.n || self.ends.is_none() {
                    let next = q.r[(i + 1) % self.n];
                    s += c(w[4] * half / l) * trace(&bend, &(q.r[i].transpose() * next));
                }
            }
            let mut term = 5;
            for (end, wall) in [Self::wall(), Self::wall().transpose()]
                .into_iter()
                .enumerate()
            {
                if self.is(end, EndCondition::Clamped) {
                    let by = wall.map(c).transpose() * q.r[end * (self.n - 1)];
                    s += c(w[term] * half * 2.0 / l) * trace(&bend, &by);
                    term += 1;
                }
            }
            if self.is(1, EndCondition::Load) {
                s += c(w[term] * half) * vector(&Self::force()).dot(&at(&q.x, self.n));
            }
        }
        s
    }
    fn held(&self, at: usize) -> bool {
        let [first, last] = self
            .ends
            .map_or([false; 2], |ends| ends.map(EndCondition::holds));
        let fields = 3 * self.nodes();
        first && at < 3 || last && at >= fields - 3 && at < fields
    }
    stepped!([momentum_φ body_momentum_Λ], 0.02, 5e-2, 0.5 / 0.02);
}
