//! A chain whose names could collide with names in the generated stepper. The model is defined in this file.

use super::{Line, Random, c, keeping, stepped};
use crate::action::{Configuration, D};
use clebsch::Real;
use clebsch::nalgebra::{SMatrix, Vector2};

clebsch::model! {
    /// Quantities whose names a stepper might take for its own.
    pub model NamedLikeLocals {
        label i in 0..N;
        param m, site, known, edges: Real;
        param a: Sym<2>;
        param t1, t2: Real at segments;
        field q, q_1: Vec<2> at nodes;
        assume m > 0;
        lagrangian = m*dot(next(q) - q, next(q) - q)/(2*h) + m*dot(next(q_1) - q_1, next(q_1) - q_1)/(2*h)
            + (site/2)*dot(perp(q), next(q)) - (h/2)*dot(q, a*q) - h*known*dot(q_1, q_1)/2 - h*edges*dot(q, q_1)
            - h*t1*dot(next(q, i) - q - q_1, next(q, i) - q - q_1)/2
            - h*t2*sin(t1*dot(next(q, i), E1))*cos(t2*dot(q, E1));
        end i = 0 { free; one { param t3, R1: Real; term h*R1*sin(t3*dot(q, E1))*cos(t3*dot(q, E2)); } }
    }
}

/// A model with names that could collide.
pub struct Named {
    pub n: usize,
    pub end: bool,
}

impl Named {
    const A: [f64; 3] = [0.7, 0.1, 0.5];
    fn at_segment(i: usize) -> [f64; 2] {
        [0.4 + 0.1 * (i % 3) as f64, 0.3 - 0.1 * (i % 2) as f64]
    }
    pub fn stepper(&self) -> NamedLikeLocals {
        let [xx, xy, yy] = Self::A;
        let list = |k: usize| (0..self.n).map(|i| Self::at_segment(i)[k]).collect();
        let parameters = NamedLikeLocalsParameters {
            m: 1.1,
            site: 0.6,
            known: 0.8,
            edges: 0.2,
            a: SMatrix::<f64, 2, 2>::new(xx, xy, xy, yy),
            t1: list(0),
            t2: list(1),
        };
        let first = match self.end {
            true => NamedLikeLocalsFirst::One { t3: 0.9, R1: 0.4 },
            false => NamedLikeLocalsFirst::Free,
        };
        let ends = NamedLikeLocalsEnds::Open { first };
        NamedLikeLocals::new(parameters, NamedLikeLocalsSites { N: self.n, ends }).expect("a line")
    }
    fn initial(&self, seed: u64) -> NamedLikeLocalsInitial {
        let mut r = Random::new(seed);
        let n = self.n + 1;
        NamedLikeLocalsInitial {
            q: r.list(n, 0.5),
            momentum_q: r.list(n, 0.5),
            q_1: r.list(n, 0.5),
            momentum_q_1: r.list(n, 0.5),
        }
    }
    fn seen(&self, s: &NamedLikeLocalsState) -> Configuration<f64> {
        let both = s.q().iter().chain(s.q_1());
        Configuration::of(both.flat_map(|x| [x[0], x[1]]).collect(), vec![], vec![])
    }
    keeping!(NamedLikeLocals, |_, _: &NamedLikeLocalsState| 0.0);
}

impl Line for Named {
    fn name(&self) -> String {
        format!("names {} end {}", self.n, self.end)
    }
    fn terms(&self) -> usize {
        8 + usize::from(self.end)
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (h, nodes) = (0.02, self.n + 1);
        let [xx, xy, yy] = Self::A;
        let at = |x: &[D], i: usize| Vector2::new(x[2 * i], x[2 * i + 1]);
        let mut s = c(0.0);
        for i in 0..nodes {
            let (x, y) = (at(&a.x, i), at(&b.x, i));
            let (d, e) = (y - x, at(&b.x, nodes + i) - at(&a.x, nodes + i));
            s += c(w[0] * 1.1 / (2.0 * h)) * d.dot(&d) + c(w[1] * 1.1 / (2.0 * h)) * e.dot(&e);
            s += c(w[2] * 0.3) * (x[0] * y[1] - x[1] * y[0]);
        }
        for q in [&a.x, &b.x] {
            let half = 0.5 * h;
            for i in 0..nodes {
                let (x, y) = (at(q, i), at(q, nodes + i));
                let form = c(xx) * x[0] * x[0] + c(2.0 * xy) * x[0] * x[1] + c(yy) * x[1] * x[1];
                s -= c(w[3] * half / 2.0) * form + c(w[4] * half * 0.8 / 2.0) * y.dot(&y);
                s -= c(w[5] * half * 0.2) * x.dot(&y);
            }
            for i in 0..self.n {
                let [t1, t2] = Self::at_segment(i);
                let d = at(q, i + 1) - at(q, i) - at(q, nodes + i);
                s -= c(w[6] * half * t1 / 2.0) * d.dot(&d);
                let wave = (c(t1) * at(q, i + 1)[0]).sin() * (c(t2) * at(q, i)[0]).cos();
                s -= c(w[7] * half * t2) * wave;
            }
            if self.end {
                let x = at(q, 0);
                s += c(w[8] * half * 0.4) * (c(0.9) * x[0]).sin() * (c(0.9) * x[1]).cos();
            }
        }
        s
    }
    stepped!([momentum_q momentum_q_1], 0.02, 5e-2, 1.1 / 0.02);
}
