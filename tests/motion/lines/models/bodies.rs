//! Bodies with a velocity coupling between neighbours, solved together along the chain: the gallery model, and models defined in
//! this file with prescribed ends.

use super::{Line, Random, attitudes, c, keeping, numbers, stepped, vector};
use crate::action::{Configuration, D, trace};
use clebsch::Rotation;
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch_models::lattices::coupled_body_chain::*;

clebsch::model! {
    /// Bodies coupled by their velocities, with elastic torques between neighbours and weight.
    pub model DraggedBodies {
        label i in 0..N;
        end i = 0 { free; pinned { Λ = given; } clamped { param Λw: SO<3>; term h*tr(C*Λw^T*Λ); } }
        end i = N { free; pinned { Λ = given; } }
        periodic;
        param J: Sym<3> at nodes;
        param C: Sym<3>;
        param d, g: Vec<3>;
        param e: Real;
        group Λ: SO<3> at nodes velocity Ω;
        advected Γ: Vec<3> at nodes = Λ^T*g;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - (e/h)*dot((Ω - Id)*d, Λ^T*next(Λ, i)*(next(Ω, i) - Id)*d)
            - h*dot(Γ, d) + h*tr(C*Λ^T*next(Λ, i));
    }
}

clebsch::model! {
    /// Bodies with beads: one term couples the vertical velocity of a bead to the velocity of the next bead.
    pub model BeadedBodies {
        label i in 0..N;
        periodic;
        param J: Sym<3>;
        param d, g: Vec<3>;
        param m, e: Real;
        field q: Real at nodes;
        group Λ: SO<3> at nodes velocity Ω;
        advected Γ: Vec<3> at nodes = Λ^T*g;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h + m*(next(q) - q)^2/(2*h) - h*dot(Γ, d) - h*e*(next(q, i) - q)^2/2
            + (e/h)*dot(next(Γ) - Γ, d)*(next(next(q, i)) - next(q, i));
    }
}

const EPS: f64 = 0.4;

fn moments(i: usize) -> Matrix3<f64> {
    let x = 0.1 * (i % 2) as f64;
    Matrix3::new(1.0 + x, 0.05, 0.02, 0.05, 0.8, 0.01, 0.02, 0.01, 0.6)
}

fn arm() -> Vector3<f64> {
    Vector3::new(0.3, 0.4, 0.5)
}

/// `-e` times the product of the changes of `Λ d` of neighbours over the step.
fn dragged(n: usize, a: &[Matrix3<D>], b: &[Matrix3<D>]) -> D {
    let d = vector(&arm());
    let change = |i: usize| (b[i % b.len()] - a[i % a.len()]) * d;
    (0..n).fold(c(0.0), |s, i| s - c(EPS) * change(i).dot(&change(i + 1)))
}

/// The bodies of the gallery: a ring or an open chain.
pub struct Bodies {
    pub n: usize,
    pub ring: bool,
}

impl Bodies {
    fn nodes(&self) -> usize {
        self.n + usize::from(!self.ring)
    }
    pub fn stepper(&self) -> CoupledBodyChain {
        let parameters = CoupledBodyChainParameters {
            J: moments(0),
            d: arm(),
            eps: EPS,
        };
        let ends = match self.ring {
            true => CoupledBodyChainEnds::Ring,
            false => CoupledBodyChainEnds::Open,
        };
        CoupledBodyChain::new(parameters, CoupledBodyChainSites { N: self.n, ends })
            .expect("bodies")
    }
    pub fn initial(&self, seed: u64) -> CoupledBodyChainInitial {
        let (turns, momenta) = attitudes(self.nodes(), &mut Random::new(seed));
        CoupledBodyChainInitial {
            Λ: turns,
            body_momentum_Λ: momenta,
        }
    }
    fn seen(&self, s: &CoupledBodyChainState) -> Configuration<f64> {
        Configuration::of(vec![], s.Λ().map(|r| r.matrix()).collect(), vec![])
    }
    keeping!(CoupledBodyChain, |_, s: &CoupledBodyChainState| {
        let total: Vector3<f64> = s.spatial_momentum_Λ().map(|m| m.0).sum();
        total[1]
    });
}

impl Line for Bodies {
    fn name(&self) -> String {
        format!("bodies {} ring {}", self.n, self.ring)
    }
    fn terms(&self) -> usize {
        2
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let h = 0.04;
        let mut s = c(w[1] / h) * dragged(self.n, &a.r, &b.r);
        for (x, y) in a.r.iter().zip(&b.r) {
            s -= c(w[0] / h) * trace(&moments(0).map(c), &(x.transpose() * y));
        }
        s
    }
    stepped!([body_momentum_Λ], 0.04, 2e-2, 2.0 / 0.04);
}

/// The bodies of this file, by end: ring, free, first prescribed, last prescribed, first clamped and last prescribed.
pub struct Dragged {
    pub n: usize,
    pub ends: usize,
}

fn weight() -> Vector3<f64> {
    Vector3::new(0.2, -0.4, 0.7)
}

impl Dragged {
    fn nodes(&self) -> usize {
        self.n + usize::from(self.ends != 0)
    }
    fn stiffness() -> Matrix3<f64> {
        Matrix3::new(0.3, 0.04, 0.0, 0.04, 0.2, 0.03, 0.0, 0.03, 0.4)
    }
    fn wall() -> Matrix3<f64> {
        Rotation::exp(&Vector3::new(0.2, 0.1, -0.3)).matrix()
    }
    fn stepper(&self) -> DraggedBodies {
        let parameters = DraggedBodiesParameters {
            J: (0..self.nodes()).map(moments).collect(),
            C: Self::stiffness(),
            d: arm(),
            g: weight(),
            e: EPS,
        };
        let first = match self.ends {
            2 => DraggedBodiesFirst::Pinned,
            4 => DraggedBodiesFirst::Clamped { Λw: Self::wall() },
            _ => DraggedBodiesFirst::Free,
        };
        let last = match self.ends {
            3 | 4 => DraggedBodiesLast::Pinned,
            _ => DraggedBodiesLast::Free,
        };
        let ends = match self.ends {
            0 => DraggedBodiesEnds::Ring,
            _ => DraggedBodiesEnds::Open { first, last },
        };
        DraggedBodies::new(parameters, DraggedBodiesSites { N: self.n, ends }).expect("bodies")
    }
    fn initial(&self, seed: u64) -> DraggedBodiesInitial {
        let (turns, momenta) = attitudes(self.nodes(), &mut Random::new(seed));
        DraggedBodiesInitial {
            Λ: turns,
            body_momentum_Λ: momenta,
        }
    }
    fn seen(&self, s: &DraggedBodiesState) -> Configuration<f64> {
        Configuration::of(vec![], s.Λ().map(|r| r.matrix()).collect(), vec![])
    }
    keeping!(DraggedBodies, |_, _: &DraggedBodiesState| 0.0);
}

impl Line for Dragged {
    fn name(&self) -> String {
        format!("dragged {} ends {}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        4
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let h = 0.03;
        let (d, g) = (vector(&arm()), vector(&weight()));
        let mut s = c(w[1] / h) * dragged(self.n, &a.r, &b.r);
        for (i, (x, y)) in a.r.iter().zip(&b.r).enumerate() {
            s -= c(w[0] / h) * trace(&moments(i).map(c), &(x.transpose() * y));
        }
        let stiffness = Self::stiffness().map(c);
        for r in [&a.r, &b.r] {
            let half = 0.5 * h;
            for own in r {
                s -= c(w[2] * half) * (own.transpose() * g).dot(&d);
            }
            for i in 0..self.n {
                let next = &r[(i + 1) % r.len()];
                s += c(w[3] * half) * trace(&stiffness, &(r[i].transpose() * next));
            }
            if self.ends == 4 {
                let wall = Self::wall().map(c);
                s += c(half) * trace(&stiffness, &(wall.transpose() * r[0]));
            }
        }
        s
    }
    fn held(&self, at: usize) -> bool {
        match self.ends {
            2 => at / 3 == 0,
            3 | 4 => at / 3 == self.n,
            _ => false,
        }
    }
    stepped!([body_momentum_Λ], 0.03, 2e-2, 2.0 / 0.03);
}

/// The bodies with beads: a ring or an open chain.
pub struct Beaded {
    pub n: usize,
    pub ring: bool,
}

const MASS: f64 = 1.3;

impl Beaded {
    fn nodes(&self) -> usize {
        self.n + usize::from(!self.ring)
    }
    fn stepper(&self) -> BeadedBodies {
        let parameters = BeadedBodiesParameters {
            J: moments(0),
            d: arm(),
            g: weight(),
            m: MASS,
            e: EPS,
        };
        let ends = match self.ring {
            true => BeadedBodiesEnds::Ring,
            false => BeadedBodiesEnds::Open,
        };
        BeadedBodies::new(parameters, BeadedBodiesSites { N: self.n, ends }).expect("bodies")
    }
    fn initial(&self, seed: u64) -> BeadedBodiesInitial {
        let mut r = Random::new(seed);
        let (turns, momenta) = attitudes(self.nodes(), &mut r);
        let n = self.nodes();
        BeadedBodiesInitial {
            Λ: turns,
            body_momentum_Λ: momenta,
            q: r.list(n, 1.0),
            momentum_q: r.list(n, 1.0),
        }
    }
    fn seen(&self, s: &BeadedBodiesState) -> Configuration<f64> {
        Configuration::of(numbers(s.q()), s.Λ().map(|r| r.matrix()).collect(), vec![])
    }
    keeping!(BeadedBodies, |_, s: &BeadedBodiesState| {
        s.momentum_q().iter().map(|p| p[0]).sum()
    });
}

impl Line for Beaded {
    fn name(&self) -> String {
        format!("beaded {} ring {}", self.n, self.ring)
    }
    fn terms(&self) -> usize {
        5
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (h, nodes) = (0.03, self.nodes());
        let (d, g) = (vector(&arm()), vector(&weight()));
        let mut s = c(0.0);
        for i in 0..nodes {
            s -= c(w[0] / h) * trace(&moments(0).map(c), &(a.r[i].transpose() * b.r[i]));
            let v = b.x[i] - a.x[i];
            s += c(w[1] * MASS / (2.0 * h)) * v * v;
        }
        for i in 0..self.n {
            let j = (i + 1) % nodes;
            let sinks = ((b.r[i] - a.r[i]).transpose() * g).dot(&d);
            s += c(w[2] * EPS / h) * sinks * (b.x[j] - a.x[j]);
        }
        for (r, x) in [(&a.r, &a.x), (&b.r, &b.x)] {
            let half = 0.5 * h;
            for own in r {
                s -= c(w[3] * half) * (own.transpose() * g).dot(&d);
            }
            for i in 0..self.n {
                let apart = x[(i + 1) % nodes] - x[i];
                s -= c(w[4] * half * EPS / 2.0) * apart * apart;
            }
        }
        s
    }
    stepped!([momentum_q body_momentum_Λ], 0.03, 2e-2, 2.0 / 0.03);
}
