//! The elastic rod in unit quaternions, and coupled spins with terms that depend on the quaternion sign.

use super::{Line, Random, c, keeping, numbers, stepped, vector};
use crate::action::{Configuration, D, conjugate, hamilton, imaginary, seen_from_body};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Real, Rotation, UnitQuaternion};
use clebsch_models::lattices::quaternion_rod::*;

clebsch::model! {
    /// Bodies along a chain in unit quaternions, whose kinetic energy and coupling depend on the sign of the
    /// quaternion.
    pub model TwistedSpins {
        label i in 0..N step s;
        periodic;
        /// moments of inertia, body frame
        param A: Sym<3> at nodes;
        /// the part of them that multiplies the real part
        param b: Real at nodes;
        /// stiffness between neighbours, and the part of it that multiplies the real part
        param K: Sym<3>;
        param c: Real;
        /// a direction of the body, and the direction in space towards which it is pulled
        param a, z: Vec<3>;
        group q: SU<2> at nodes velocity W;
        constraint next(q) = q*W;
        let U = q^T*next(q, i);
        lagrangian = (2/h)*dot(im(W), (A - b*Id)*im(W)) - (4*b/h)*re(W) + h*dot(z, rot(q)*a)
            + (4*c*h/s)*re(U) - (2*h/s)*dot(im(U), (K - c*Id)*im(U)) + h*re(q)*dot(z, im(q));
    }
}

/// The unit quaternion of a rotation vector.
pub fn turn(v: Vector3<f64>) -> UnitQuaternion {
    UnitQuaternion::from_components(Rotation::exp(&v).quaternion()).expect("of unit length")
}

fn lifted(q: &UnitQuaternion) -> [D; 4] {
    q.components().map(c)
}

/// The energy `2/s u.K u` of a relative quaternion.
fn bending(k: &Matrix3<D>, s: f64, x: [D; 4], y: [D; 4]) -> D {
    let u = imaginary(hamilton(conjugate(x), y));
    c(2.0 / s) * u.dot(&(k * u))
}

/// An elastic rod in quaternions. The first end is free, pinned or clamped, the last end free, pinned or loaded; the tenth case is
/// a ring.
pub struct QRod {
    pub n: usize,
    pub ends: usize,
}

const RING: usize = 9;

impl QRod {
    fn is_ring(&self) -> bool {
        self.ends == RING
    }
    fn nodes(&self) -> usize {
        self.n + usize::from(!self.is_ring())
    }
    fn mass(&self, i: usize) -> f64 {
        let is_end = !self.is_ring() && (i == 0 || i == self.n);
        0.5 * if is_end { 0.5 } else { 1.0 }
    }
    fn inertia(i: usize) -> Matrix3<f64> {
        let one = Matrix3::new(0.9, 0.05, 0.0, 0.05, 0.8, 0.02, 0.0, 0.02, 0.7);
        one * (1.0 + 0.1 * (i % 3) as f64)
    }
    fn wall() -> UnitQuaternion {
        turn(Vector3::new(0.1, 0.2, -0.1))
    }
    fn force() -> Vector3<f64> {
        Vector3::new(0.2, -0.1, 0.3)
    }
    fn offset(&self) -> Vector3<f64> {
        Vector3::new(0.02, -0.01, 0.5) * self.n as f64
    }
    fn stiffness() -> [Matrix3<f64>; 2] {
        let shear = Matrix3::new(2.0, 0.1, 0.2, 0.1, 2.5, 0.0, 0.2, 0.0, 3.0);
        let bend = Matrix3::new(1.1, 0.05, 0.0, 0.05, 1.2, 0.1, 0.0, 0.1, 0.9);
        [shear, bend]
    }
    pub fn parameters<T: Real>(&self, k: &dyn Fn(f64) -> T) -> QuaternionRodParameters<T> {
        QuaternionRodParameters {
            s: k(0.5),
            m: (0..self.nodes()).map(|i| k(self.mass(i))).collect(),
            I: (0..self.n).map(|i| Self::inertia(i).map(k)).collect(),
            S: Self::stiffness()[0].map(k),
            K: Self::stiffness()[1].map(k),
            g: Vector3::new(0.0, 0.1, -0.3).map(k),
        }
    }
    pub fn stepper(&self) -> QuaternionRod {
        self.stepper_of(&|x| x)
    }
    pub fn stepper_of<T: Real>(&self, k: &dyn Fn(f64) -> T) -> QuaternionRod<T> {
        let ends = match self.ends {
            RING => QuaternionRodEnds::Ring {
                X: self.offset().map(k),
            },
            ends => QuaternionRodEnds::Open {
                first: match ends / 3 {
                    0 => QuaternionRodFirst::Free,
                    1 => QuaternionRodFirst::Pinned,
                    _ => QuaternionRodFirst::Clamped {
                        qw: Self::wall().matrix().map(k),
                    },
                },
                last: match ends % 3 {
                    0 => QuaternionRodLast::Free,
                    1 => QuaternionRodLast::Pinned,
                    _ => QuaternionRodLast::Load {
                        force: Self::force().map(k),
                    },
                },
            },
        };
        let sites = QuaternionRodSites { N: self.n, ends };
        QuaternionRod::new(self.parameters(k), sites).expect("a rod")
    }
    pub fn initial(&self, seed: u64) -> QuaternionRodInitial {
        let mut r = Random::new(seed);
        QuaternionRodInitial {
            φ: (0..self.nodes())
                .map(|i| Vector3::z() * (0.5 * i as f64) + r.vector() * 0.1)
                .collect(),
            momentum_φ: (0..self.nodes()).map(|_| r.vector() * 0.2).collect(),
            q: (0..self.n).map(|_| turn(r.vector() * 0.3)).collect(),
            body_momentum_q: (0..self.n)
                .map(|_| BodyMomentum(r.vector() * 0.2))
                .collect(),
        }
    }
    fn seen(&self, s: &QuaternionRodState) -> Configuration<f64> {
        Configuration::of(
            numbers(s.φ()),
            vec![],
            s.q().map(|q| q.components()).collect(),
        )
    }
    keeping!(QuaternionRod, |_, _: &QuaternionRodState| 0.0);
}

impl Line for QRod {
    fn name(&self) -> String {
        format!("rod in quaternions {} ends {}", self.n, self.ends)
    }
    fn terms(&self) -> usize {
        let open = !self.is_ring();
        5 + usize::from(open && self.ends >= 6) + usize::from(open && self.ends % 3 == 2)
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (h, l) = (0.02, 0.5);
        let [shear, bend] = Self::stiffness().map(|m| m.map(c));
        let nodes = self.nodes();
        let at = |x: &[D], i: usize| {
            let (round, i) = (i / nodes, i % nodes);
            let place = Vector3::new(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
            place + vector(&(self.offset() * round as f64))
        };
        let mut s = c(0.0);
        for i in 0..nodes {
            let d = at(&b.x, i) - at(&a.x, i);
            s += c(w[0] * self.mass(i) / (2.0 * h)) * d.dot(&d);
        }
        for (i, (x, y)) in a.q.iter().zip(&b.q).enumerate() {
            // The same expression as for bending, with the step size instead of the spacing.
            s += c(w[2] * l) * bending(&Self::inertia(i).map(c), h, *x, *y);
        }
        for q in [a, b] {
            let half = 0.5 * h;
            for i in 0..nodes {
                let g = Vector3::new(0.0, 0.1, -0.3);
                s += c(w[1] * half * self.mass(i)) * vector(&g).dot(&at(&q.x, i));
            }
            for i in 0..self.n {
                let along = (at(&q.x, i + 1) - at(&q.x, i)) * c(1.0 / l);
                let strain = seen_from_body(q.q[i], &along) - vector(&Vector3::z());
                s -= c(w[3] * half * l / 2.0) * strain.dot(&(shear * strain));
                if i + 1 < self.n || self.is_ring() {
                    s -= c(w[4] * half) * bending(&bend, l, q.q[i], q.q[(i + 1) % self.n]);
                }
            }
            let mut term = 5;
            if !self.is_ring() && self.ends >= 6 {
                let wall = lifted(&Self::wall());
                s -= c(w[term] * half) * bending(&bend, l / 2.0, wall, q.q[0]);
                term += 1;
            }
            if !self.is_ring() && self.ends % 3 == 2 {
                s += c(w[term] * half) * vector(&Self::force()).dot(&at(&q.x, self.n));
            }
        }
        s
    }
    fn held(&self, at: usize) -> bool {
        let open = !self.is_ring();
        let (first, last) = (open && self.ends >= 3, open && self.ends % 3 == 1);
        let fields = 3 * self.nodes();
        first && at < 3 || last && at >= fields - 3 && at < fields
    }
    stepped!([momentum_φ body_momentum_q], 0.02, 5e-2, 0.5 / 0.02);
}

/// Spins, in an open chain or a ring.
pub struct Spins {
    pub n: usize,
    pub ring: bool,
}

impl Spins {
    fn nodes(&self) -> usize {
        self.n + usize::from(!self.ring)
    }
    fn inertia(i: usize) -> (Matrix3<f64>, f64) {
        let one = Matrix3::new(1.5, 0.05, 0.02, 0.05, 1.4, 0.01, 0.02, 0.01, 1.9);
        (one, 0.5 + 0.1 * (i % 2) as f64)
    }
    fn parameters(&self) -> TwistedSpinsParameters {
        TwistedSpinsParameters {
            s: 0.8,
            A: (0..self.nodes()).map(|i| Self::inertia(i).0).collect(),
            b: (0..self.nodes()).map(|i| Self::inertia(i).1).collect(),
            K: Matrix3::new(0.6, 0.04, 0.0, 0.04, 0.5, 0.03, 0.0, 0.03, 0.7),
            c: 0.4,
            a: Vector3::new(0.1, -0.2, 0.7),
            z: Vector3::new(0.0, 0.6, 0.8),
        }
    }
    pub fn stepper(&self) -> TwistedSpins {
        let ends = match self.ring {
            true => TwistedSpinsEnds::Ring,
            false => TwistedSpinsEnds::Open,
        };
        TwistedSpins::new(self.parameters(), TwistedSpinsSites { N: self.n, ends }).expect("spins")
    }
    pub fn initial(&self, seed: u64) -> TwistedSpinsInitial {
        let mut r = Random::new(seed);
        TwistedSpinsInitial {
            q: (0..self.nodes()).map(|_| turn(r.vector() * 0.6)).collect(),
            body_momentum_q: (0..self.nodes())
                .map(|_| BodyMomentum(r.vector()))
                .collect(),
        }
    }
    fn seen(&self, s: &TwistedSpinsState) -> Configuration<f64> {
        Configuration::of(vec![], vec![], s.q().map(|q| q.components()).collect())
    }
    keeping!(TwistedSpins, |_, _: &TwistedSpinsState| 0.0);
}

/// Spins with inertia and stiffness only, equal at all sites.
pub struct TwistedSpinsOf {
    pub model: TwistedSpins,
    pub s: f64,
    pub inertia: Matrix3<f64>,
    pub stiffness: Matrix3<f64>,
}

impl TwistedSpinsOf {
    pub fn of(spins: &Spins) -> Self {
        let ends = match spins.ring {
            true => TwistedSpinsEnds::Ring,
            false => TwistedSpinsEnds::Open,
        };
        let given = spins.parameters();
        let (s, inertia, stiffness) = (given.s, Spins::inertia(0).0, given.K);
        let parameters = TwistedSpinsParameters {
            z: Vector3::zeros(),
            ..given
        };
        let sites = TwistedSpinsSites { N: spins.n, ends };
        let model = TwistedSpins::new(parameters, sites).expect("spins");
        Self {
            model,
            s,
            inertia,
            stiffness,
        }
    }
    pub fn initial(
        &self,
        q: Vec<UnitQuaternion>,
        body_momentum_q: Vec<BodyMomentum>,
    ) -> TwistedSpinsInitial {
        TwistedSpinsInitial { q, body_momentum_q }
    }
}

impl Line for Spins {
    fn name(&self) -> String {
        format!("spins {} ring {}", self.n, self.ring)
    }
    fn terms(&self) -> usize {
        6
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let (h, p) = (0.04, self.parameters());
        let mut s = c(0.0);
        for (i, (x, y)) in a.q.iter().zip(&b.q).enumerate() {
            let (inertia, real) = Self::inertia(i);
            let rest = (inertia - Matrix3::identity() * real).map(c);
            s += c(w[0]) * bending(&rest, h, *x, *y);
            s -= c(w[1] * 4.0 * real / h) * hamilton(conjugate(*x), *y)[0];
        }
        for all in [&a.q, &b.q] {
            let half = 0.5 * h;
            for q in all {
                let up = vector(&p.z);
                s += c(w[2] * half) * seen_from_body(*q, &up).dot(&vector(&p.a));
                s += c(w[3] * half) * q[0] * up.dot(&imaginary(*q));
            }
            for i in 0..self.n {
                let next = all[(i + 1) % all.len()];
                let rest = (p.K - Matrix3::identity() * p.c).map(c);
                s += c(w[4] * half * 4.0 * p.c / p.s) * hamilton(conjugate(all[i]), next)[0];
                s -= c(w[5] * half) * bending(&rest, p.s, all[i], next);
            }
        }
        s
    }
    stepped!([body_momentum_q], 0.04, 2e-2, 0.0);
}
