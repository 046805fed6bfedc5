//! Random bodies and states for comparisons: full inertia matrices, any attitude, momenta within the solvability bound. A seed
//! gives the same draws on every machine.

use super::cases::Start;
use super::measure::worse;
use crate::handwritten::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply_transposed, cross, dot,
};
use crate::handwritten::heavy_top::Top;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// Largest fraction of the exact solvability bound for random momenta.
const LARGEST_REACH: f64 = 0.5;

/// A deterministic stream of draws.
pub struct Draws(Xoshiro256PlusPlus);

impl Draws {
    /// Starts the stream.
    pub fn new(seed: u64) -> Draws {
        Draws(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// Uniform in [low, high).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * unit
    }

    /// A uniformly distributed unit vector.
    pub fn direction(&mut self) -> Vector {
        loop {
            let v = [0, 1, 2].map(|_| self.uniform(-1.0, 1.0));
            let square = dot(&v, &v);
            if (0.01..=1.0).contains(&square) {
                return v.map(|c| c / square.sqrt());
            }
        }
    }

    /// A uniformly distributed attitude.
    pub fn attitude(&mut self) -> Quaternion {
        loop {
            let q = Quaternion([0, 1, 2, 3].map(|_| self.uniform(-1.0, 1.0)));
            if (0.01..=1.0).contains(&q.norm_squared()) {
                return q.normalised();
            }
        }
    }

    /// A free body: J full with eigenvalues in [0.2, 1.2], h |momentum| up to half the bound.
    pub fn free_body(&mut self) -> Start {
        let share = self.share();
        self.draw(0.0, share)
    }

    /// A free body with h |momentum| at this fraction of the exact bound; solvable up to one.
    pub fn free_body_at(&mut self, share: f64) -> Start {
        self.draw(0.0, share)
    }

    /// A heavy top: a free body with a weight of order one and a unit vertical in any direction. The bound applies to the momentum
    /// of the edge, which exceeds the momentum of the node by half a kick.
    pub fn heavy_top(&mut self) -> Start {
        let share = self.share();
        self.draw(2.0, share)
    }

    /// A heavy top whose first edge momentum is this fraction of the exact bound.
    pub fn heavy_top_at(&mut self, share: f64) -> Start {
        self.draw(2.0, share)
    }

    fn share(&mut self) -> f64 {
        LARGEST_REACH * self.uniform(1e-3, 1.0)
    }

    fn draw(&mut self, heaviest: f64, share: f64) -> Start {
        let second_moments = [0, 1, 2].map(|_| self.uniform(0.2, 1.2));
        let axes = self.attitude().matrix();
        let poinsot = rotated(&second_moments, &axes);
        let h = self.uniform(0.01, 0.3);
        let direction = self.direction();
        let unit = reach(&second_moments, &apply_transposed(&axes, &direction));
        let edge_momentum = direction.map(|c| c * share / (unit * h));
        let attitude = self.attitude();
        let up = self.direction();
        let weight = self.direction().map(|c| c * heaviest);
        let vertical = apply_transposed(&attitude.matrix(), &up);
        let body_momentum = add_scaled(&edge_momentum, -0.5 * h, &cross(&vertical, &weight));
        Start {
            top: Top {
                poinsot,
                weight,
                up,
            },
            attitude,
            body_momentum,
            h,
        }
    }
}

/// R diag(j) R^T, exactly symmetric.
fn rotated(j: &Vector, r: &Matrix) -> Matrix {
    let mut m = [[0.0; 3]; 3];
    for a in 0..3 {
        for b in a..3 {
            m[a][b] = (0..3).map(|k| r[a][k] * j[k] * r[b][k]).sum();
            m[b][a] = m[a][b];
        }
    }
    m
}

/// Solvability ratio of Om J - J Om^T = hat(v) in principal axes: sqrt(max over nu > 0 of sum v_i^2 nu^2 / ((nu^2 + j_k^2)(nu^2 +
/// j_l^2))). Solvable if at most one; linear in v.
pub fn reach(j: &Vector, v: &Vector) -> f64 {
    let squares = j.map(|c| c * c);
    let at = |log: f64| {
        let s = (2.0 * log).exp();
        (0..3)
            .map(|i| v[i] * v[i] * s / ((s + squares[(i + 1) % 3]) * (s + squares[(i + 2) % 3])))
            .sum::<f64>()
    };
    // The maximum is flat: a one-percent grid in nu determines it to better than one part in 10^4.
    let largest = (-800..=800)
        .map(|n| at(f64::from(n) * 0.01))
        .fold(0.0, worse);
    largest.sqrt()
}
