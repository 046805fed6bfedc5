//! The lines that are tried: their steppers, random states, and their actions as sums typed by hand.

use super::action::{Configuration, D, trace};
use clebsch::nalgebra::{Matrix3, SMatrix, Vector2, Vector3};
use clebsch::scalar::largest;
use clebsch::{BodyMomentum, Real, Rotation};
use clebsch_models::lattices::coupled_tops::*;
use clebsch_models::lattices::elastic_rod::*;
use clebsch_models::lattices::shallow_water::*;
use clebsch_models::lattices::sine_gordon::*;
use clebsch_models::lattices::toda_chain::*;

clebsch::model! {
    /// Charges in the plane, across a uniform field, joined by springs to the next and to the one after.
    pub model ChargeChain {
        label i in 0..N;
        param m: Real at nodes;
        param f, k, c: Real;
        field X: Vec<2> at nodes;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + (f/2)*dot(perp(X), next(X))
            - h*k*dot(next(X, i) - X, next(X, i) - X)/2
            - h*c*dot(next(X, i) - 2*X + prev(X, i), next(X, i) - 2*X + prev(X, i))/2;
    }
}

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

/// A line that is tried.
pub trait Line {
    /// What it is.
    fn name(&self) -> String;
    /// How many terms its action has.
    fn terms(&self) -> usize;
    /// The action of an edge, each term times a number.
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D;
    /// Whether an end holds this coordinate.
    fn held(&self, at: usize) -> bool;
    /// Three nodes from a random start.
    fn three(&self, seed: u64) -> [Configuration<f64>; 3];
    /// The momenta at its first node.
    fn given(&self, seed: u64) -> Vec<f64>;
    /// How far steps forward and back end from where they began.
    fn there_and_back(&self, steps: u64) -> f64;
    /// The largest relative change of the energy and of a conserved total.
    fn kept(&self, steps: u64) -> [f64; 2];
    /// What that of the energy may be.
    fn energy_bound(&self) -> f64;
    /// That of the energy by that at half the step.
    fn energy_ratio(&self) -> f64;
    /// The largest mass over the step, by which the rounding of places shows in momenta.
    fn mass_by_step(&self) -> f64;

    /// The action of an edge.
    fn action(&self, a: &Configuration<D>, b: &Configuration<D>) -> D {
        self.weighed(&vec![1.0; self.terms()], a, b)
    }
}

/// A line with the sign of one term of its action changed.
pub struct Flipped<'a>(pub &'a dyn Line, pub usize);

impl Line for Flipped<'_> {
    fn name(&self) -> String {
        self.0.name()
    }
    fn terms(&self) -> usize {
        self.0.terms()
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let mut w = w.to_vec();
        w[self.1] = -w[self.1];
        self.0.weighed(&w, a, b)
    }
    fn held(&self, at: usize) -> bool {
        self.0.held(at)
    }
    fn three(&self, seed: u64) -> [Configuration<f64>; 3] {
        self.0.three(seed)
    }
    fn given(&self, seed: u64) -> Vec<f64> {
        self.0.given(seed)
    }
    fn there_and_back(&self, steps: u64) -> f64 {
        self.0.there_and_back(steps)
    }
    fn kept(&self, steps: u64) -> [f64; 2] {
        self.0.kept(steps)
    }
    fn energy_bound(&self) -> f64 {
        self.0.energy_bound()
    }
    fn energy_ratio(&self) -> f64 {
        self.0.energy_ratio()
    }
    fn mass_by_step(&self) -> f64 {
        self.0.mass_by_step()
    }
}

/// Every line of this size, with every end.
pub fn all(n: usize) -> Vec<Box<dyn Line>> {
    let mut out: Vec<Box<dyn Line>> = vec![
        Box::new(Toda::ring(n)),
        Box::new(Toda { n, ring: false }),
        Box::new(Tops::new(n, false)),
        Box::new(Tops::new(n, true)),
        Box::new(Water::new(n)),
        Box::new(Charges::new(n)),
    ];
    out.push(Box::new(Named { n, end: false }));
    out.push(Box::new(Named { n, end: true }));
    let sine = (0..5).filter(|ends| n > 1 || *ends < 4);
    out.extend(sine.map(|ends| Box::new(Sine::new(n, ends)) as Box<dyn Line>));
    let rods = (0..9).filter(|ends| n > 1 || *ends == 0);
    out.extend(rods.map(|ends| Box::new(Rod::new(n, ends)) as Box<dyn Line>));
    out
}

/// Numbers between -1 and 1.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(12345))
    }
    pub fn number(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 / (1u64 << 53) as f64).mul_add(2.0, -1.0)
    }
    fn vector(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.number())
    }
}

fn c(x: f64) -> D {
    D::constant(x)
}

fn diagonal(x: f64, y: f64, z: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(x, y, z))
}

/// What every line does with its stepper.
macro_rules! stepped {
    ($h:expr, $bound:expr) => {
        fn three(&self, seed: u64) -> [Configuration<f64>; 3] {
            let model = self.stepper();
            let (mut state, mut work) = model.start(self.initial(seed), $h).expect("starts");
            let a = self.seen(&state);
            model.step(&mut state, &mut work).expect("steps");
            let b = self.seen(&state);
            model.step(&mut state, &mut work).expect("steps");
            [a, b, self.seen(&state)]
        }
        fn there_and_back(&self, steps: u64) -> f64 {
            let model = self.stepper();
            let (mut state, mut work) = model.start(self.initial(7), $h).expect("starts");
            let from = self.seen(&state);
            for _ in 0..steps {
                model.step(&mut state, &mut work).expect("steps");
            }
            let mut back = model.workspace(&state, -$h).expect("a step back");
            for _ in 0..steps {
                model.step(&mut state, &mut back).expect("steps back");
            }
            let to = self.seen(&state);
            let x = from.x.iter().zip(&to.x).map(|(a, b)| (a - b).abs());
            let r = from.r.iter().zip(&to.r).map(|(a, b)| (a - b).amax());
            largest(x.chain(r))
        }
        fn kept(&self, steps: u64) -> [f64; 2] {
            self.kept_with($h, steps)
        }
        fn energy_bound(&self) -> f64 {
            $bound
        }
        fn energy_ratio(&self) -> f64 {
            let one = self.kept_with($h, 400)[0];
            let half = self.kept_with($h / 2.0, 800)[0];
            one / half
        }
    };
}

macro_rules! keeping {
    ($model:ty, $total:expr) => {
        fn kept_with(&self, h: f64, steps: u64) -> [f64; 2] {
            let model = self.stepper();
            let (mut state, mut work) = model.start(self.initial(4), h).expect("starts");
            let total: fn(&$model, &_) -> f64 = $total;
            let (energy, first) = (model.energy(&state), total(&model, &state));
            let (kinetic, _) = model.energies(&state);
            let (mut worst, mut off) = (0.0_f64, 0.0_f64);
            for _ in 0..steps {
                model.step(&mut state, &mut work).expect("steps");
                worst = worst.max((model.energy(&state) - energy).abs());
                off = off.max((total(&model, &state) - first).abs());
            }
            [worst / (energy.abs() + kinetic), off / (1.0 + first.abs())]
        }
    };
}

/// Toda's chain.
pub struct Toda {
    pub n: usize,
    pub ring: bool,
}

impl Toda {
    pub fn ring(n: usize) -> Self {
        Self { n, ring: true }
    }
    pub fn stepper(&self) -> TodaChain {
        let ends = match self.ring {
            true => TodaChainEnds::Ring { L: 0.3 },
            false => TodaChainEnds::Open,
        };
        let parameters = TodaChainParameters {
            m: 1.3,
            a: 0.7,
            b: 1.1,
        };
        TodaChain::new(parameters, TodaChainSites { N: self.n, ends }).expect("a chain")
    }
    /// A ring of harder springs.
    pub fn hard(n: usize) -> TodaChain {
        let ends = TodaChainEnds::Ring { L: 0.3 };
        let parameters = TodaChainParameters {
            m: 1.3,
            a: 2.7,
            b: 1.1,
        };
        TodaChain::new(parameters, TodaChainSites { N: n, ends }).expect("a chain")
    }
    fn nodes(&self) -> usize {
        self.n + usize::from(!self.ring)
    }
    pub fn initial(&self, seed: u64) -> TodaChainInitial {
        let mut r = Random::new(seed);
        let mut list = |size: f64| {
            (0..self.nodes())
                .map(|_| SMatrix::repeat(size * r.number()))
                .collect()
        };
        TodaChainInitial {
            q: list(0.5),
            momentum_q: list(1.0),
        }
    }
    fn seen(&self, s: &TodaChainState) -> Configuration<f64> {
        Configuration {
            x: s.q().iter().map(|q| q[0]).collect(),
            r: Vec::new(),
        }
    }
    keeping!(TodaChain, |m, s: &TodaChainState| m.total_momentum(s));
}

impl Line for Toda {
    fn name(&self) -> String {
        format!("Toda {} ring {}", self.n, self.ring)
    }
    fn terms(&self) -> usize {
        // Around a ring the linear term is the offset, which nothing changes.
        if self.ring { 2 } else { 3 }
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (h, linear) = (0.05, w.get(2).unwrap_or(&1.0));
        let mut s = c(0.0);
        for (x, y) in a.x.iter().zip(&b.x) {
            s += c(w[0] * 1.3 / (2.0 * h)) * (*y - *x) * (*y - *x);
        }
        for q in [&a.x, &b.x] {
            for i in 0..self.n {
                let next = match i + 1 < q.len() {
                    true => q[i + 1],
                    false => q[0] + c(0.3),
                };
                let r = next - q[i];
                s -= c(0.5 * h) * (c(w[1] * 0.7 / 1.1) * (c(-1.1) * r).exp() + c(linear * 0.7) * r);
            }
        }
        s
    }
    fn held(&self, _: usize) -> bool {
        false
    }
    fn given(&self, seed: u64) -> Vec<f64> {
        self.initial(seed).momentum_q.iter().map(|p| p[0]).collect()
    }
    stepped!(0.05, 2e-3);
    fn mass_by_step(&self) -> f64 {
        1.3 / 0.05
    }
}

/// The sine-Gordon equation: a ring, free, held first, held last, held at both ends.
pub struct Sine {
    n: usize,
    ends: usize,
}

impl Sine {
    pub fn new(n: usize, ends: usize) -> Self {
        Self { n, ends }
    }
    fn nodes(&self) -> usize {
        self.n + usize::from(self.ends != 0)
    }
    fn weight(&self, i: usize) -> f64 {
        0.4 * if self.ends != 0 && (i == 0 || i == self.n) {
            0.5
        } else {
            1.0
        }
    }
    fn stepper(&self) -> SineGordon {
        let (first, last) = (self.ends == 2 || self.ends == 4, self.ends >= 3);
        let ends = match self.ends {
            0 => SineGordonEnds::Ring { L: 6.0 },
            _ => SineGordonEnds::Open {
                first: if first {
                    SineGordonFirst::Pinned
                } else {
                    SineGordonFirst::Free
                },
                last: if last {
                    SineGordonLast::Pinned
                } else {
                    SineGordonLast::Free
                },
            },
        };
        let w = (0..self.nodes()).map(|i| self.weight(i)).collect();
        let parameters = SineGordonParameters { s: 0.4, w, k: 1.7 };
        SineGordon::new(parameters, SineGordonSites { N: self.n, ends }).expect("a line")
    }
    fn initial(&self, seed: u64) -> SineGordonInitial {
        let mut r = Random::new(seed);
        let mut list = |size: f64| {
            (0..self.nodes())
                .map(|_| SMatrix::repeat(size * r.number()))
                .collect()
        };
        let mut initial = SineGordonInitial {
            u: list(1.0),
            momentum_u: list(0.5),
        };
        if self.ends == 0 {
            let n = self.n as f64;
            initial
                .u
                .iter_mut()
                .enumerate()
                .for_each(|(i, u)| u[0] += 6.0 * i as f64 / n);
        }
        initial
    }
    fn seen(&self, s: &SineGordonState) -> Configuration<f64> {
        Configuration {
            x: s.u().iter().map(|u| u[0]).collect(),
            r: Vec::new(),
        }
    }
    keeping!(SineGordon, |_, _: &SineGordonState| 0.0);
}

impl Line for Sine {
    fn name(&self) -> String {
        format!("sine-Gordon {} ends {}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        3
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let h = 0.05;
        let mut s = c(0.0);
        for (i, (x, y)) in a.x.iter().zip(&b.x).enumerate() {
            s += c(w[0] * self.weight(i) / (2.0 * h)) * (*y - *x) * (*y - *x);
        }
        for u in [&a.x, &b.x] {
            for i in 0..self.n {
                let next = if i + 1 < u.len() {
                    u[i + 1]
                } else {
                    u[0] + c(6.0)
                };
                s -= c(w[1] * 0.5 * h / (2.0 * 0.4)) * (next - u[i]) * (next - u[i]);
            }
            for (i, u) in u.iter().enumerate() {
                s -= c(w[2] * 0.5 * h * self.weight(i) * 1.7) * (c(1.0) - u.cos());
            }
        }
        s
    }
    fn held(&self, at: usize) -> bool {
        let (first, last) = (self.ends == 2 || self.ends == 4, self.ends >= 3);
        first && at == 0 || last && at == self.n
    }
    fn given(&self, seed: u64) -> Vec<f64> {
        self.initial(seed).momentum_u.iter().map(|p| p[0]).collect()
    }
    stepped!(0.05, 2e-2);
    fn mass_by_step(&self) -> f64 {
        0.4 / 0.05
    }
}

/// Coupled heavy tops.
pub struct Tops {
    n: usize,
    ring: bool,
}

impl Tops {
    pub fn new(n: usize, ring: bool) -> Self {
        Self { n, ring }
    }
    fn nodes(&self) -> usize {
        self.n + usize::from(!self.ring)
    }
    fn parameters() -> CoupledTopsParameters {
        CoupledTopsParameters {
            s: 0.8,
            J: Matrix3::new(0.6, 0.05, 0.02, 0.05, 0.5, 0.01, 0.02, 0.01, 0.9),
            C: Matrix3::new(0.3, 0.04, 0.0, 0.04, 0.2, 0.03, 0.0, 0.03, 0.4),
            gU: Vector3::new(0.1, -0.2, 0.7),
            z: Vector3::new(0.0, 0.6, 0.8),
        }
    }
    fn stepper(&self) -> CoupledTops {
        let ends = if self.ring {
            CoupledTopsEnds::Ring
        } else {
            CoupledTopsEnds::Open
        };
        CoupledTops::new(Self::parameters(), CoupledTopsSites { N: self.n, ends }).expect("tops")
    }
    fn initial(&self, seed: u64) -> CoupledTopsInitial {
        let mut r = Random::new(seed);
        CoupledTopsInitial {
            Λ: (0..self.nodes())
                .map(|_| Rotation::exp(&(r.vector() * 0.7)))
                .collect(),
            body_momentum_Λ: (0..self.nodes())
                .map(|_| BodyMomentum(r.vector()))
                .collect(),
        }
    }
    fn seen(&self, s: &CoupledTopsState) -> Configuration<f64> {
        Configuration {
            x: Vec::new(),
            r: s.Λ().map(|r| r.matrix()).collect(),
        }
    }
    keeping!(CoupledTops, |_, s: &CoupledTopsState| {
        let total: Vector3<f64> = s.spatial_momentum_Λ().map(|m| m.0).sum();
        total.dot(&Vector3::new(0.0, 0.6, 0.8))
    });
}

fn vector(x: &Vector3<f64>) -> Vector3<D> {
    x.map(c)
}

impl Line for Tops {
    fn name(&self) -> String {
        format!("tops {} ring {}", self.n, self.ring)
    }
    fn terms(&self) -> usize {
        3
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (h, p) = (0.04, Self::parameters());
        let mut s = c(0.0);
        for (x, y) in a.r.iter().zip(&b.r) {
            s -= c(w[0] * p.s / h) * trace(&p.J.map(c), &(x.transpose() * y));
        }
        for r in [&a.r, &b.r] {
            for x in r {
                let vertical = x.transpose() * vector(&p.z);
                s -= c(w[1] * 0.5 * h * p.s) * vector(&p.gU).dot(&vertical);
            }
            for i in 0..self.n {
                let next = &r[(i + 1) % r.len()];
                s += c(w[2] * 0.5 * h / p.s) * trace(&p.C.map(c), &(r[i].transpose() * next));
            }
        }
        s
    }
    fn held(&self, _: usize) -> bool {
        false
    }
    fn given(&self, seed: u64) -> Vec<f64> {
        let all = self.initial(seed).body_momentum_Λ;
        all.iter().flat_map(|m| [m.0[0], m.0[1], m.0[2]]).collect()
    }
    stepped!(0.04, 2e-2);
    fn mass_by_step(&self) -> f64 {
        0.0
    }
}

/// An elastic rod: free, pinned, clamped at its first end; free, pinned, loaded at its last.
pub struct Rod {
    n: usize,
    ends: usize,
}

impl Rod {
    pub fn new(n: usize, ends: usize) -> Self {
        Self { n, ends }
    }
    fn mass(&self, i: usize) -> f64 {
        0.5 * if i == 0 || i == self.n { 0.5 } else { 1.0 }
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
    fn stiffness() -> [Matrix3<f64>; 2] {
        let shear = Matrix3::new(2.0, 0.1, 0.2, 0.1, 2.5, 0.0, 0.2, 0.0, 3.0);
        [shear, diagonal(0.5, 0.4, 0.7)]
    }
    pub fn stepper(&self) -> ElasticRod {
        let first = match self.ends / 3 {
            0 => ElasticRodFirst::Free,
            1 => ElasticRodFirst::Pinned,
            _ => ElasticRodFirst::Clamped { Λw: Self::wall() },
        };
        let last = match self.ends % 3 {
            0 => ElasticRodLast::Free,
            1 => ElasticRodLast::Pinned,
            _ => ElasticRodLast::Load {
                force: Self::force(),
            },
        };
        let parameters = ElasticRodParameters {
            s: 0.5,
            m: (0..=self.n).map(|i| self.mass(i)).collect(),
            J: (0..self.n).map(Self::inertia).collect(),
            S: Self::stiffness()[0],
            B: Self::stiffness()[1],
            g: Vector3::new(0.0, 0.1, -0.3),
        };
        let sites = ElasticRodSites {
            N: self.n,
            ends: ElasticRodEnds::Open { first, last },
        };
        ElasticRod::new(parameters, sites).expect("a rod")
    }
    pub fn initial(&self, seed: u64) -> ElasticRodInitial {
        let mut r = Random::new(seed);
        ElasticRodInitial {
            φ: (0..=self.n)
                .map(|i| Vector3::z() * (0.5 * i as f64) + r.vector() * 0.1)
                .collect(),
            momentum_φ: (0..=self.n).map(|_| r.vector() * 0.2).collect(),
            Λ: (0..self.n)
                .map(|_| Rotation::exp(&(r.vector() * 0.3)))
                .collect(),
            body_momentum_Λ: (0..self.n)
                .map(|_| BodyMomentum(r.vector() * 0.2))
                .collect(),
        }
    }
    fn seen(&self, s: &ElasticRodState) -> Configuration<f64> {
        Configuration {
            x: s.φ().iter().flat_map(|x| [x[0], x[1], x[2]]).collect(),
            r: s.Λ().map(|r| r.matrix()).collect(),
        }
    }
    keeping!(ElasticRod, |_, _: &ElasticRodState| 0.0);
}

impl Line for Rod {
    fn name(&self) -> String {
        format!("rod {} ends {}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        5 + usize::from(self.ends >= 6) + usize::from(self.ends % 3 == 2)
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (h, l) = (0.02, 0.5);
        let [shear, bend] = Self::stiffness().map(|m| m.map(c));
        let at = |x: &[D], i: usize| Vector3::new(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
        let mut s = c(0.0);
        for i in 0..=self.n {
            let d = at(&b.x, i) - at(&a.x, i);
            s += c(w[0] * self.mass(i) / (2.0 * h)) * d.dot(&d);
        }
        for (i, (x, y)) in a.r.iter().zip(&b.r).enumerate() {
            s -= c(w[2] * l / h) * trace(&Self::inertia(i).map(c), &(x.transpose() * y));
        }
        for q in [a, b] {
            let half = 0.5 * h;
            for i in 0..=self.n {
                let g = Vector3::new(0.0, 0.1, -0.3);
                s += c(w[1] * half * self.mass(i)) * vector(&g).dot(&at(&q.x, i));
            }
            for i in 0..self.n {
                let along = (at(&q.x, i + 1) - at(&q.x, i)) * c(1.0 / l);
                let strain = q.r[i].transpose() * along - vector(&Vector3::z());
                s -= c(w[3] * half * l / 2.0) * strain.dot(&(shear * strain));
                if i + 1 < self.n {
                    s += c(w[4] * half / l) * trace(&bend, &(q.r[i].transpose() * q.r[i + 1]));
                }
            }
            let mut term = 5;
            if self.ends >= 6 {
                let wall = Self::wall().map(c);
                s += c(w[term] * half * 2.0 / l) * trace(&bend, &(wall.transpose() * q.r[0]));
                term += 1;
            }
            if self.ends % 3 == 2 {
                s += c(w[term] * half) * vector(&Self::force()).dot(&at(&q.x, self.n));
            }
        }
        s
    }
    fn held(&self, at: usize) -> bool {
        let (first, last) = (self.ends >= 3, self.ends % 3 == 1);
        let fields = 3 * (self.n + 1);
        first && at < 3 || last && at >= fields - 3 && at < fields
    }
    fn given(&self, seed: u64) -> Vec<f64> {
        let all = self.initial(seed);
        let p = all.momentum_φ.iter().flat_map(|p| [p[0], p[1], p[2]]);
        let m = all
            .body_momentum_Λ
            .iter()
            .flat_map(|m| [m.0[0], m.0[1], m.0[2]]);
        p.chain(m).collect()
    }
    stepped!(0.02, 5e-2);
    fn mass_by_step(&self) -> f64 {
        0.5 / 0.02
    }
}

/// Shallow water on a ring.
pub struct Water {
    n: usize,
}

impl Water {
    pub fn new(n: usize) -> Self {
        Self { n }
    }
    fn mass(i: usize) -> f64 {
        1.0 + 0.2 * (i % 4) as f64
    }
    fn length(&self) -> f64 {
        self.n as f64
    }
    fn stepper(&self) -> ShallowWater {
        let parameters = ShallowWaterParameters {
            m: (0..self.n).map(Self::mass).collect(),
            g: 0.9,
            f: 0.6,
        };
        let ends = ShallowWaterEnds::Ring { L: self.length() };
        ShallowWater::new(parameters, ShallowWaterSites { N: self.n, ends }).expect("water")
    }
    fn initial(&self, seed: u64) -> ShallowWaterInitial {
        let mut r = Random::new(seed);
        let mut list = |size: f64| {
            (0..self.n)
                .map(|_| SMatrix::repeat(size * r.number()))
                .collect()
        };
        let mut initial = ShallowWaterInitial {
            X: list(0.2),
            momentum_X: list(0.3),
            Y: list(0.5),
            momentum_Y: list(0.3),
        };
        initial
            .X
            .iter_mut()
            .enumerate()
            .for_each(|(i, x)| x[0] += i as f64);
        initial
    }
    fn seen(&self, s: &ShallowWaterState) -> Configuration<f64> {
        let x = s.X().iter().chain(s.Y()).map(|x| x[0]);
        Configuration {
            x: x.collect(),
            r: Vec::new(),
        }
    }
    keeping!(ShallowWater, |_, s: &ShallowWaterState| s
        .momentum_Y()
        .iter()
        .map(|p| p[0])
        .sum());
}

impl Line for Water {
    fn name(&self) -> String {
        format!("water {}", self.n)
    }
    fn terms(&self) -> usize {
        4
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (dt, n) = (0.02, self.n);
        let mut s = c(0.0);
        for i in 0..n {
            let (u, v) = (b.x[i] - a.x[i], b.x[n + i] - a.x[n + i]);
            let m = Self::mass(i);
            s += c(m / (2.0 * dt)) * (c(w[0]) * u * u + c(w[1]) * v * v);
            s += c(w[2] * m * 0.6 * 0.5) * (a.x[i] + b.x[i]) * v;
        }
        for q in [&a.x, &b.x] {
            for i in 0..n {
                let next = if i + 1 < n {
                    q[i + 1]
                } else {
                    q[0] + c(self.length())
                };
                let before = if i > 0 {
                    q[i - 1]
                } else {
                    q[n - 1] - c(self.length())
                };
                let m = Self::mass(i);
                s -= c(w[3] * 0.5 * dt * 0.9 / 2.0 * m * 2.0 * m) / (next - before);
            }
        }
        s
    }
    fn held(&self, _: usize) -> bool {
        false
    }
    fn given(&self, seed: u64) -> Vec<f64> {
        let all = self.initial(seed);
        all.momentum_X
            .iter()
            .chain(&all.momentum_Y)
            .map(|p| p[0])
            .collect()
    }
    stepped!(0.02, 5e-2);
    fn mass_by_step(&self) -> f64 {
        1.6 / 0.02
    }
}

/// Charges joined by springs, free at both ends.
pub struct Charges {
    n: usize,
}

impl Charges {
    pub fn new(n: usize) -> Self {
        Self { n }
    }
    fn mass(i: usize) -> f64 {
        1.0 + 0.3 * (i % 2) as f64
    }
    fn stepper(&self) -> ChargeChain {
        let parameters = ChargeChainParameters {
            m: (0..=self.n).map(Self::mass).collect(),
            f: 0.8,
            k: 0.5,
            c: 0.2,
        };
        let sites = ChargeChainSites {
            N: self.n,
            ends: ChargeChainEnds::Open,
        };
        ChargeChain::new(parameters, sites).expect("charges")
    }
    fn initial(&self, seed: u64) -> ChargeChainInitial {
        let mut r = Random::new(seed);
        let mut list = |size: f64| {
            (0..=self.n)
                .map(|_| Vector2::new(size * r.number(), size * r.number()))
                .collect()
        };
        ChargeChainInitial {
            X: list(1.0),
            momentum_X: list(0.5),
        }
    }
    fn seen(&self, s: &ChargeChainState) -> Configuration<f64> {
        Configuration {
            x: s.X().iter().flat_map(|x| [x[0], x[1]]).collect(),
            r: Vec::new(),
        }
    }
    // With half of the field's impulse: what translations keep.
    keeping!(ChargeChain, |_, s: &ChargeChainState| {
        s.momentum_X()
            .iter()
            .zip(s.X())
            .map(|(p, x)| p[0] - 0.4 * x[1])
            .sum()
    });
}

impl Line for Charges {
    fn name(&self) -> String {
        format!("charges {}", self.n)
    }
    fn terms(&self) -> usize {
        if self.n > 1 { 4 } else { 3 }
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let h = 0.03;
        let at = |x: &[D], i: usize| Vector2::new(x[2 * i], x[2 * i + 1]);
        let mut s = c(0.0);
        for i in 0..=self.n {
            let (x, y) = (at(&a.x, i), at(&b.x, i));
            let d = y - x;
            s += c(w[0] * Self::mass(i) / (2.0 * h)) * d.dot(&d);
            s += c(w[1] * 0.4) * (x[0] * y[1] - x[1] * y[0]);
        }
        for q in [&a.x, &b.x] {
            for i in 0..self.n {
                let d = at(q, i + 1) - at(q, i);
                s -= c(w[2] * 0.5 * h * 0.5 / 2.0) * d.dot(&d);
                if i > 0 {
                    let d = at(q, i + 1) - at(q, i) * c(2.0) + at(q, i - 1);
                    s -= c(w[3] * 0.5 * h * 0.2 / 2.0) * d.dot(&d);
                }
            }
        }
        s
    }
    fn held(&self, _: usize) -> bool {
        false
    }
    fn given(&self, seed: u64) -> Vec<f64> {
        let all = self.initial(seed).momentum_X;
        all.iter().flat_map(|p| [p[0], p[1]]).collect()
    }
    stepped!(0.03, 5e-2);
    fn mass_by_step(&self) -> f64 {
        1.3 / 0.03
    }
}

/// Names that a stepper might take for its own.
pub struct Named {
    n: usize,
    end: bool,
}

impl Named {
    const A: [f64; 3] = [0.7, 0.1, 0.5];
    fn at_segment(i: usize) -> [f64; 2] {
        [0.4 + 0.1 * (i % 3) as f64, 0.3 - 0.1 * (i % 2) as f64]
    }
    fn stepper(&self) -> NamedLikeLocals {
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
        let mut list = |size: f64| {
            let each = (0..=self.n).map(|_| Vector2::new(size * r.number(), size * r.number()));
            each.collect()
        };
        NamedLikeLocalsInitial {
            q: list(0.5),
            momentum_q: list(0.5),
            q_1: list(0.5),
            momentum_q_1: list(0.5),
        }
    }
    fn seen(&self, s: &NamedLikeLocalsState) -> Configuration<f64> {
        let both = s.q().iter().chain(s.q_1());
        Configuration {
            x: both.flat_map(|x| [x[0], x[1]]).collect(),
            r: Vec::new(),
        }
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
    fn held(&self, _: usize) -> bool {
        false
    }
    fn given(&self, seed: u64) -> Vec<f64> {
        let all = self.initial(seed);
        let both = all.momentum_q.iter().chain(&all.momentum_q_1);
        both.flat_map(|p| [p[0], p[1]]).collect()
    }
    stepped!(0.02, 5e-2);
    fn mass_by_step(&self) -> f64 {
        1.1 / 0.02
    }
}
