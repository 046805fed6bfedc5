//! The continuous motion of a heavy (or free) body to rounding, by Taylor series of the Euler-Poincare equations. Takes J, gU, z,
//! attitude, body momentum and a time; gives attitude and body momentum at that time. Independent of every discrete scheme: mu' =
//! mu x w + Gamma x gU, Gamma' = Gamma x w, q' = q (0, w)/2, w = I^-1 mu.

use crate::handwritten::attitude::{Matrix, Quaternion, Vector, apply, apply_transposed};
use crate::handwritten::heavy_top::Top;

/// Number of coefficients. With expansion length 1/20 and rates of a few units, the last is below 1e-20.
const TERMS: usize = 24;

/// Length of one expansion.
const STEP: f64 = 0.05;

/// A state of the continuous motion.
#[derive(Clone, Copy, Debug)]
pub struct Phase {
    /// Attitude body -> space.
    pub attitude: Quaternion,
    /// Angular momentum in body axes.
    pub body_momentum: Vector,
}

type Series = [f64; TERMS];

/// Coefficient n of the product of two series with known coefficients up to n.
fn product(a: &Series, b: &Series, n: usize) -> f64 {
    (0..=n).map(|k| a[k] * b[n - k]).sum()
}

/// Coefficient n of one component of the cross product of two series.
fn turned(a: &[Series; 3], b: &[Series; 3], component: usize, n: usize) -> f64 {
    let (j, k) = ((component + 1) % 3, (component + 2) % 3);
    product(&a[j], &b[k], n) - product(&a[k], &b[j], n)
}

/// Inverse of the inertia matrix tr(J) Id - J, by cofactors.
pub fn inverse_inertia(poinsot: &Matrix) -> Matrix {
    let trace = poinsot[0][0] + poinsot[1][1] + poinsot[2][2];
    let i = [0, 1, 2].map(|r| {
        [0, 1, 2].map(|c| {
            if r == c {
                trace - poinsot[r][c]
            } else {
                -poinsot[r][c]
            }
        })
    });
    let cofactor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        i[r1][c1] * i[r2][c2] - i[r1][c2] * i[r2][c1]
    };
    let determinant =
        i[0][0] * cofactor(0, 0) + i[0][1] * cofactor(0, 1) + i[0][2] * cofactor(0, 2);
    [0, 1, 2].map(|r| [0, 1, 2].map(|c| cofactor(c, r) / determinant))
}

/// The state after `time`.
pub fn flow(top: &Top, start: &Phase, time: f64) -> Phase {
    let inverse = inverse_inertia(&top.poinsot);
    let count = (time / STEP).ceil().max(1.0);
    let step = time / count;
    let mut here = *start;
    for _ in 0..count as u64 {
        here = expand(top, &inverse, &here, step);
    }
    here
}

fn expand(top: &Top, inverse: &Matrix, start: &Phase, step: f64) -> Phase {
    let zero = [0.0; TERMS];
    let (mut mu, mut gamma, mut w, mut q) = ([zero; 3], [zero; 3], [zero; 3], [zero; 4]);
    let vertical = apply_transposed(&start.attitude.matrix(), &top.up);
    for i in 0..3 {
        mu[i][0] = start.body_momentum[i];
        gamma[i][0] = vertical[i];
    }
    for (series, component) in q.iter_mut().zip(start.attitude.0) {
        series[0] = component;
    }
    for n in 0..TERMS - 1 {
        let rate = apply(inverse, &[mu[0][n], mu[1][n], mu[2][n]]);
        for i in 0..3 {
            w[i][n] = rate[i];
        }
        let next = 1.0 / (n + 1) as f64;
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let torque = gamma[j][n] * top.weight[k] - gamma[k][n] * top.weight[j];
            mu[i][n + 1] = next * (turned(&mu, &w, i, n) + torque);
            gamma[i][n + 1] = next * turned(&gamma, &w, i, n);
            // Component i + 1 of q (0, w) / 2.
            let spin = product(&q[0], &w[i], n) + product(&q[j + 1], &w[k], n)
                - product(&q[k + 1], &w[j], n);
            q[i + 1][n + 1] = 0.5 * next * spin;
        }
        let away: f64 = (0..3).map(|i| product(&q[i + 1], &w[i], n)).sum();
        q[0][n + 1] = -0.5 * next * away;
    }
    let sum = |s: &Series| s.iter().rev().fold(0.0, |value, c| value * step + c);
    Phase {
        attitude: Quaternion([sum(&q[0]), sum(&q[1]), sum(&q[2]), sum(&q[3])]).normalised(),
        body_momentum: [sum(&mu[0]), sum(&mu[1]), sum(&mu[2])],
    }
}
