//! Rotations whose kinetic energy is not quadratic, each solved by Newton's method at its site. The model is defined in this file.

use super::{Line, Random, attitudes, c, keeping_between, stepped, vector};
use crate::action::{Configuration, D, trace};
use clebsch::nalgebra::{Matrix3, Vector3};

clebsch::model! {
    /// Bodies with a kinetic energy of second and fourth order, and moments that depend on the vertical in the body
    /// frame.
    pub model FastTops {
        label i in 0..N;
        end i = 0 { free; pinned { Λ = given; } }
        end i = N { free; pinned { Λ = given; } }
        periodic;
        param J, C: Sym<3>;
        param b, a: Real;
        param g, z: Vec<3>;
        group Λ: SO<3> at nodes velocity Ω;
        advected Γ: Vec<3> at nodes = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h + b*tr(Id - Ω)^2/h^3 + (a/(2*h))*dot(next(Γ) - Γ, next(Γ) - Γ)
            - h*dot(g, Γ) + h*tr(C*Λ^T*next(Λ, i));
    }
}

const H: f64 = 0.06;
const B: f64 = 0.2;
const A: f64 = 0.5;

/// The bodies, by end: ring, free, first prescribed, last prescribed.
pub struct Fast {
    pub n: usize,
    pub ends: usize,
}

impl Fast {
    fn nodes(&self) -> usize {
        self.n + usize::from(self.ends != 0)
    }
    fn moments() -> Matrix3<f64> {
        Matrix3::new(1.0, 0.05, 0.02, 0.05, 0.8, 0.01, 0.02, 0.01, 0.6)
    }
    fn stiffness() -> Matrix3<f64> {
        Matrix3::new(0.3, 0.04, 0.0, 0.04, 0.2, 0.03, 0.0, 0.03, 0.4)
    }
    fn weight() -> Vector3<f64> {
        Vector3::new(0.2, -0.4, 0.7)
    }
    fn vertical() -> Vector3<f64> {
        Vector3::new(0.0, 0.6, 0.8)
    }
    fn stepper(&self) -> FastTops {
        let parameters = FastTopsParameters {
            J: Self::moments(),
            C: Self::stiffness(),
            b: B,
            a: A,
            g: Self::weight(),
            z: Self::vertical(),
        };
        let first = match self.ends {
            2 => FastTopsFirst::Pinned,
            _ => FastTopsFirst::Free,
        };
        let last = match self.ends {
            3 => FastTopsLast::Pinned,
            _ => FastTopsLast::Free,
        };
        let ends = match self.ends {
            0 => FastTopsEnds::Ring,
            _ => FastTopsEnds::Open { first, last },
        };
        FastTops::new(parameters, FastTopsSites { N: self.n, ends }).expect("bodies")
    }
    fn initial(&self, seed: u64) -> FastTopsInitial {
        let (turns, momenta) = attitudes(self.nodes(), &mut Random::new(seed));
        FastTopsInitial {
            Λ: turns,
            body_momentum_Λ: momenta,
        }
    }
    fn seen(&self, s: &FastTopsState) -> Configuration<f64> {
        Configuration::of(vec![], s.Λ().map(|r| r.matrix()).collect(), vec![])
    }
    /// The energy between two nodes, from the rotation of the edge and the mean of both potentials.
    fn energy(&self, a: &[Matrix3<f64>], b: &[Matrix3<f64>], h: f64) -> f64 {
        let z = Self::vertical();
        let mut e = 0.0;
        for (x, y) in a.iter().zip(b) {
            let rest = Matrix3::identity() - x.transpose() * y;
            let spur = rest.trace();
            e += (Self::moments() * rest).trace() / (h * h) + 3.0 * B * spur * spur / h.powi(4);
            e += A * ((y - x).transpose() * z).norm_squared() / (2.0 * h * h);
        }
        for r in [a, b] {
            for x in r {
                e += 0.5 * Self::weight().dot(&(x.transpose() * z));
            }
            for i in 0..self.n {
                let next = &r[(i + 1) % r.len()];
                e -= 0.5 * (Self::stiffness() * r[i].transpose() * next).trace();
            }
        }
        e
    }
    // The kinetic energy per body is about one.
    keeping_between!(
        r,
        |line: &Self, s: &FastTopsState| match line.ends {
            0 | 1 => {
                let all: Vector3<f64> = s.spatial_momentum_Λ().map(|m| m.0).sum();
                all.dot(&Self::vertical())
            }
            _ => 0.0,
        },
        1.0
    );
}

impl Line for Fast {
    fn name(&self) -> String {
        format!("fast {} ends {}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        5
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (z, g) = (vector(&Self::vertical()), vector(&Self::weight()));
        let mut s = c(0.0);
        for (x, y) in a.r.iter().zip(&b.r) {
            let turn = x.transpose() * y;
            s -= c(w[0] / H) * trace(&Self::moments().map(c), &turn);
            let spur = c(3.0) - turn.trace();
            s += c(w[1] * B / H.powi(3)) * spur * spur;
            let sinks = (y - x).transpose() * z;
            s += c(w[2] * A / (2.0 * H)) * sinks.dot(&sinks);
        }
        let stiffness = Self::stiffness().map(c);
        for r in [&a.r, &b.r] {
            for x in r {
                s -= c(w[3] * 0.5 * H) * (x.transpose() * z).dot(&g);
            }
            for i in 0..self.n {
                let next = &r[(i + 1) % r.len()];
                s += c(w[4] * 0.5 * H) * trace(&stiffness, &(r[i].transpose() * next));
            }
        }
        s
    }
    fn held(&self, at: usize) -> bool {
        self.ends == 2 && at / 3 == 0 || self.ends == 3 && at / 3 == self.n
    }
    stepped!([body_momentum_Λ], H, 2e-2, 5.0 / H);
}
