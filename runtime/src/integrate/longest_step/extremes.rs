//! The slowest and the fastest of small motions, by Lanczos' method in the inner product of the mass.
//! Takes the responses of a model to disturbances; gives the two motions.

use super::probe::Probe;
use super::unknown::Unknown;
use crate::scalar::largest;
use nalgebra::{DMatrix, SymmetricEigen};

/// The maximum dimension of the Krylov space. Half of it finds the fastest of a hundred close frequencies to a
/// fiftieth.
const VECTORS: usize = 60;

/// The maximum dimension for more than `MANY` degrees of freedom, where each vector needs steps of a long chain.
const VECTORS_OF_MANY: usize = 30;
const MANY: usize = 1000;

/// The Krylov space ends if the coupling is below this fraction of the largest square, without and with constraints.
const WEAK: f64 = 1e-6;
const WEAK_HELD: f64 = 1e-4;

/// A small motion: its ω², and its velocity and momentum, scaled to a kinetic energy of one half.
pub(super) struct Motion {
    pub(super) square: f64,
    pub(super) velocity: Vec<f64>,
    pub(super) momentum: Vec<f64>,
}

impl Probe<'_> {
    /// The motions of least and of largest ω² in the space that Lanczos' method spans, in the inner product of the mass.
    pub(super) fn extremes(&self) -> Result<[Motion; 2], Unknown> {
        let count = self.count();
        // Momenta that give about equal velocities, relative to the units of disturbances.
        let nothing = || self.why(Unknown::Kinetic);
        let mut p = self.along(numbers(count)).ok_or_else(nothing)?;
        let first = self.velocity(&p).ok_or_else(nothing)?;
        for ((p, v), unit) in p.iter_mut().zip(&first).zip(&self.units) {
            let own = (v / unit).abs();
            *p /= own.max(1e-3);
        }
        let (mut velocities, mut momenta) = (Vec::<Vec<f64>>::new(), Vec::<Vec<f64>>::new());
        let (mut alphas, mut forces) = (Vec::<f64>::new(), Vec::<Vec<f64>>::new());
        let mut led = Vec::<Vec<f64>>::new();
        let most = if count > MANY {
            VECTORS_OF_MANY
        } else {
            VECTORS
        };
        for _ in 0..most.min(count) {
            // Twice is enough.
            for _ in 0..2 {
                for (v, q) in velocities.iter().zip(&momenta) {
                    let part = dot(v, &p);
                    p.iter_mut().zip(q).for_each(|(p, q)| *p -= part * q);
                }
            }
            // The remainder of an exhausted space may be normal to the constraints.
            let Some(along) = self.along(p) else {
                break;
            };
            let Some(v) = self.velocity(&along) else {
                break;
            };
            p = along;
            let square = dot(&v, &p);
            // The space is exhausted: its remainder is rounding or, with constraints, their curvature over a
            // disturbance of this size. Such a weak coupling changes the extreme squares by at most 1e-8 of the
            // largest.
            let weak = if self.is_held() { WEAK_HELD } else { WEAK };
            let least = weak * largest(alphas.iter().copied());
            if square.is_nan() || square <= 0.0 || (!alphas.is_empty() && square.sqrt() <= least) {
                break;
            }
            let length = square.sqrt();
            let v: Vec<f64> = v.iter().map(|x| x / length).collect();
            momenta.push(p.iter().map(|x| x / length).collect());
            let own = momenta.last().ok_or(Unknown::Still)?;
            let [force, moved] = self.stiffness(&v, own).ok_or_else(nothing)?;
            p = force;
            led.push(moved);
            // Without stiffness every step size is stable.
            if velocities.is_empty() && p.iter().all(|x| *x == 0.0) {
                return Err(Unknown::Still);
            }
            alphas.push(dot(&v, &p));
            forces.push(p.clone());
            velocities.push(v);
        }
        if alphas.is_empty() {
            return Err(nothing());
        }
        // If the Lagrangian has terms linear in velocities, a disturbed state moves with the same momenta. The energy
        // of this motion, counted twice, depends on how the terms are written, so it is subtracted from the stiffness
        // within the space.
        let shares = led
            .iter()
            .map(|w| momenta.iter().map(|q| dot(q, w)).collect());
        let shares: Vec<Vec<f64>> = shares.collect();
        // If the start is not an equilibrium, forces rotate with their frames: only the symmetric part of the
        // stiffness has an energy.
        let part =
            |i: usize, j: usize| dot(&velocities[i], &forces[j]) - dot(&shares[i], &shares[j]);
        let at = |i: usize, j: usize| 0.5 * (part(i, j) + part(j, i));
        let small = SymmetricEigen::new(DMatrix::from_fn(alphas.len(), alphas.len(), at));
        let motion = |k: usize| {
            let of = |all: &[Vec<f64>]| {
                let mut sum = vec![0.0; count];
                for (part, own) in small.eigenvectors.column(k).iter().zip(all) {
                    sum.iter_mut().zip(own).for_each(|(s, x)| *s += part * x);
                }
                sum
            };
            Motion {
                square: small.eigenvalues[k],
                velocity: of(&velocities),
                momentum: of(&momenta),
            }
        };
        let by = |a: &usize, b: &usize| small.eigenvalues[*a].total_cmp(&small.eigenvalues[*b]);
        let least = (0..alphas.len()).min_by(by).unwrap_or(0);
        let largest = (0..alphas.len()).max_by(by).unwrap_or(0);
        Ok([motion(least), motion(largest)])
    }
}

/// Pseudorandom numbers between minus one half and one half, the same in every run.
pub(super) fn numbers(count: usize) -> Vec<f64> {
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        f64::from(u32::try_from(seed >> 33).unwrap_or(0)) / f64::from(1_u32 << 31) - 0.5
    };
    std::iter::repeat_with(next).take(count).collect()
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
