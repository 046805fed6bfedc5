//! Errata of appendix C, particles of shallow water. At random points, gives the printed and the correct form to `judge`.

use super::judge;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

/// A particle of mass `m` on the f-plane with `R = f0 (-y, x)/2`.
struct Particle {
    mass: f64,
    f0: f64,
    /// `g (h + 2 b)/2`.
    height: f64,
    x: [f64; 2],
    u: [f64; 2],
}

impl Particle {
    fn random(s: &mut Source) -> Particle {
        Particle {
            mass: s.between(0.5, 2.0),
            f0: s.between(1.0, 2.0),
            height: s.between(0.5, 1.0),
            x: from_fn(|_| s.between(0.3, 1.0)),
            u: from_fn(|_| s.between(0.3, 1.0)),
        }
    }

    fn r(&self) -> [f64; 2] {
        [-0.5 * self.f0 * self.x[1], 0.5 * self.f0 * self.x[0]]
    }

    /// `∂L/∂U = m (U + R)`.
    fn momentum(&self) -> [f64; 2] {
        from_fn(|i| self.mass * (self.u[i] + self.r()[i]))
    }
}

fn plane(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[test]
fn c_3_is_not_the_legendre_transform() {
    judge("(C.3)", |s| {
        let q = Particle::random(s);
        let (p, r) = (q.momentum(), q.r());
        // L of (4.1) for one particle; H = P·U - L.
        let kinetic = 0.5 * plane(&q.u, &q.u) + plane(&r, &q.u);
        let wanted = plane(&p, &q.u) - q.mass * (kinetic - q.height);
        let printed = plane(&p, &p) / q.mass + 2.0 * plane(&r, &p) - 2.0 * q.height;
        let moved: [f64; 2] = from_fn(|i| p[i] - q.mass * r[i]);
        let right = plane(&moved, &moved) / (2.0 * q.mass) + q.mass * q.height;
        ((printed - wanted).abs(), (right - wanted).abs())
    });
}

#[test]
fn c_5_turns_the_wrong_way() {
    judge("(C.5), Coriolis term", |s| {
        let q = Particle::random(s);
        // Euler-Lagrange without height: d/dt (U + R) = (∇R)ᵀ U, that is U̇ = -f0 k × U (4.25).
        let rate = [q.f0 * q.u[1], -q.f0 * q.u[0]];
        let turned = [-q.u[1], q.u[0]].map(|x| q.f0 * x);
        let off = |sign: f64| {
            worse(
                (sign * turned[0] - rate[0]).abs(),
                (sign * turned[1] - rate[1]).abs(),
            )
        };
        (off(1.0), off(-1.0))
    });
    judge("(C.5), velocity", |s| {
        let q = Particle::random(s);
        let (p, r) = (q.momentum(), q.r());
        let off = |v: [f64; 2]| worse((v[0] - q.u[0]).abs(), (v[1] - q.u[1]).abs());
        let printed = off(p.map(|x| x / q.mass));
        (printed, off(from_fn(|i| p[i] / q.mass - r[i])))
    });
}
