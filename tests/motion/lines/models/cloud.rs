//! Particles in the plane with two functionals of all particles: one of their positions, and one of the first functional. This file
//! defines both; the engine knows only their names.

use super::{Line, Random, c, keeping, numbers, stepped};
use crate::action::{Configuration, D};
use clebsch::mesh::{Functional, MeshError, Setting};
use clebsch::nalgebra::{SVector, Vector2};
use clebsch::{ParameterError, Real};

/// A depth from Gaussian kernels: `D_a = sum_b m_b exp(-|X_a - X_b|^2/r^2)`.
#[allow(non_camel_case_types)]
#[derive(Clone, Debug)]
pub struct soft_depth<T> {
    mass: Vec<T>,
    width: T,
}

impl<T: Real> Functional<T, 2> for soft_depth<T> {
    type Argument = SVector<T, 2>;
    type Data<'a> = (&'a [T], T);

    fn new(_: &Setting<2>, (mass, width): (&[T], T)) -> Result<Self, ParameterError> {
        let mass = mass.to_vec();
        Ok(Self { mass, width })
    }
    fn sites(&self) -> usize {
        self.mass.len()
    }
    fn value(&mut self, at: &[SVector<T, 2>], out: &mut [T]) -> Result<(), MeshError> {
        for (x, out) in at.iter().zip(out) {
            let mut all = T::zero();
            for (y, m) in at.iter().zip(&self.mass) {
                let d = (x - y) / self.width;
                all += (-d.dot(&d)).exp() * *m;
            }
            if !all.value().is_finite() {
                return Err(MeshError::NotFinite { site: 0 });
            }
            *out = all;
        }
        Ok(())
    }
    fn pull_back(
        &mut self,
        at: &[SVector<T, 2>],
        seed: &[T],
        out: &mut [SVector<T, 2>],
    ) -> Result<(), MeshError> {
        out.fill(SVector::zeros());
        for a in 0..at.len() {
            for b in 0..at.len() {
                let d = (at[a] - at[b]) / self.width;
                let e = (-d.dot(&d)).exp() * self.mass[b] * seed[a];
                let change = d * (e * T::from_f64(-2.0) / self.width);
                out[a] += change;
                out[b] -= change;
            }
        }
        Ok(())
    }
}

/// A functional of another functional: `S_a = D_a^2 + q D_{a+1}`, cyclic in the sites.
#[allow(non_camel_case_types)]
#[derive(Clone, Debug)]
pub struct spread<T> {
    sites: usize,
    q: T,
}

impl<T: Real> Functional<T, 2> for spread<T> {
    type Argument = T;
    type Data<'a> = (T,);

    fn new(setting: &Setting<2>, (q,): (T,)) -> Result<Self, ParameterError> {
        let sites = setting.particles;
        Ok(Self { sites, q })
    }
    fn sites(&self) -> usize {
        self.sites
    }
    fn value(&mut self, at: &[T], out: &mut [T]) -> Result<(), MeshError> {
        for (a, out) in out.iter_mut().enumerate() {
            *out = at[a] * at[a] + self.q * at[(a + 1) % at.len()];
        }
        Ok(())
    }
    fn pull_back(&mut self, at: &[T], seed: &[T], out: &mut [T]) -> Result<(), MeshError> {
        for (a, out) in out.iter_mut().enumerate() {
            let before = (a + at.len() - 1) % at.len();
            *out = at[a] * seed[a] * T::from_f64(2.0) + self.q * seed[before];
        }
        Ok(())
    }
}

clebsch::model! {
    /// Particles that repel each other by functions of a depth, about a centre, in a rotating frame.
    pub model Clouds {
        label a in 0..N;
        param m, e: Real at a;
        param f, r, q, k: Real;
        field X: Vec<2> at a on torus(L);
        mesh D: Real at a = crate::models::cloud::soft_depth(X, m, r);
        mesh S: Real at a = crate::models::cloud::spread(D, q);
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + (m*f/2)*dot(perp(X), next(X))
            - h*k*m*dot(X, X)/2 - h*m*log(1 + D^2) - h*e*S*(1 + dot(X, X)) - h*q*m/(1 + D);
    }
}

/// A cloud.
pub struct Cloud {
    pub n: usize,
}

const F: f64 = 0.7;
const R: f64 = 0.6;
const Q: f64 = 0.4;
const K: f64 = 0.8;

impl Cloud {
    fn mass(i: usize) -> f64 {
        1.0 + 0.25 * (i % 3) as f64
    }
    fn weight(i: usize) -> f64 {
        0.2 + 0.1 * (i % 2) as f64
    }
    pub fn stepper(&self) -> Clouds {
        let parameters = CloudsParameters {
            m: (0..self.n).map(Self::mass).collect(),
            e: (0..self.n).map(Self::weight).collect(),
            f: F,
            r: R,
            q: Q,
            k: K,
        };
        let sites = CloudsSites {
            N: self.n,
            L: [1.0, 1.0],
            scalar: Default::default(),
        };
        Clouds::new(parameters, sites).expect("a cloud")
    }
    fn initial(&self, seed: u64) -> CloudsInitial {
        let mut r = Random::new(seed);
        let n = self.n;
        CloudsInitial {
            X: r.list(n, 0.7),
            momentum_X: r.list(n, 0.5),
        }
    }
    fn seen(&self, s: &CloudsState) -> Configuration<f64> {
        Configuration::of(numbers(s.X()), vec![], vec![])
    }
    // The functionals are not invariant under translations or rotations.
    keeping!(Clouds, |_, _: &CloudsState| 0.0);
}

impl Line for Cloud {
    fn name(&self) -> String {
        format!("cloud {}", self.n)
    }
    fn terms(&self) -> usize {
        6
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (h, n) = (0.02, self.n);
        let at = |x: &[D], i: usize| Vector2::new(x[2 * i], x[2 * i + 1]);
        let mut s = c(0.0);
        for i in 0..n {
            let (x, y) = (at(&a.x, i), at(&b.x, i));
            let d = y - x;
            let m = Self::mass(i);
            s += c(w[0] * m / (2.0 * h)) * d.dot(&d);
            s += c(w[1] * m * F / 2.0) * (x[0] * y[1] - x[1] * y[0]);
        }
        for q in [&a.x, &b.x] {
            let depth = |i: usize| -> D {
                let each = (0..n).map(|j| {
                    let d = at(q, i) - at(q, j);
                    c(Self::mass(j)) * (d.dot(&d) * c(-1.0 / (R * R))).exp()
                });
                each.fold(c(0.0), |s, x| s + x)
            };
            for i in 0..n {
                let (m, x, d) = (Self::mass(i), at(q, i), depth(i));
                let next = depth((i + 1) % n);
                let square = x.dot(&x);
                s -= c(w[2] * 0.5 * h * K * m / 2.0) * square;
                s -= c(w[3] * 0.5 * h * m) * (c(1.0) + d * d).ln();
                let spread = d * d + c(Q) * next;
                s -= c(w[4] * 0.5 * h * Self::weight(i)) * spread * (c(1.0) + square);
                s -= c(w[5] * 0.5 * h * Q * m) / (c(1.0) + d);
            }
        }
        s
    }
    stepped!([momentum_X], 0.02, 5e-2, 1.5 / 0.02);
}
