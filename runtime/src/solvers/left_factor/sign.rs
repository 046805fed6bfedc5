//! Solves by the matrix sign function of the Hamiltonian matrix, as a cross-check. Takes a left factor and `h N`; gives
//! the principal solution to some tens of roundings.
//!
//! With `H = [[V/2, 1], [V^2/4 + C C^T, V/2]]` the columns of `1 + sign(H)` span the invariant
//! subspace of the right half plane, `[1; S]`, and `Omega C^T = S + V/2` (Roberts, Int. J. Control
//! 32, 1980; Cardoso and Leite 2003).

use super::factor::{LARGEST, LeftFactor};
use super::{Refusal, Unsolved};
use crate::Real;
use crate::groups::Orthogonal;
use crate::linalg::{inverse, inverse_leading, solve_many};
use crate::scalar::largest;
use crate::solvers::Method;
use nalgebra::SMatrix;

/// The number of rows of the largest Hamiltonian matrix.
const ROWS: usize = 2 * LARGEST;

/// The largest number of iterations. Within the bound, about ten suffice with scaling.
const STEPS: usize = 40;

/// The blocks `[[V/2, 1], [V^2/4 + C C^T, V/2]]` in the leading `2N` rows and columns.
pub(super) fn hamiltonian<T: Real, const N: usize>(
    c: &SMatrix<T, N, N>,
    v: &SMatrix<T, N, N>,
) -> SMatrix<T, ROWS, ROWS> {
    let half = v * T::from_f64(0.5);
    let lower = half * half + c * c.transpose();
    SMatrix::from_fn(|i, j| match (i / N, j / N) {
        (0, 0) => half[(i, j)],
        (0, 1) if i + N == j => T::one(),
        (1, 0) => lower[(i - N, j)],
        (1, 1) => half[(i - N, j - N)],
        _ => T::zero(),
    })
}

/// Computes `Omega` from the symmetric part `S` of `Omega C^T`; rejects it unless it solves the equation.
pub(super) fn finish<T: Real, const N: usize>(
    factor: &LeftFactor<N, T>,
    h_n: &SMatrix<T, N, N>,
    s: &SMatrix<T, N, N>,
    method: Method,
) -> Result<Orthogonal<N, T>, Unsolved> {
    let c = factor.matrix();
    let Some(back) = inverse(&c) else {
        return Err(factor.unsolved(method, h_n, Refusal::DoesNotApply));
    };
    let a = s + h_n * T::from_f64(0.5);
    let omega = Orthogonal::nearby(&(a * back.transpose()));
    let product = omega.matrix() * c.transpose();
    let f = product - product.transpose() - h_n;
    let residual = largest(f.iter().map(|x| x.magnitude()));
    let unit = largest(c.iter().map(|x| x.magnitude()));
    // The subspace is exact to rounding times its condition; a larger residual is an error.
    if residual <= 1e6 * T::EPSILON * unit && omega_is_rotation(&omega) {
        return Ok(omega);
    }
    Err(Unsolved {
        residual,
        ..factor.unsolved(method, h_n, Refusal::NotConverged)
    })
}

fn omega_is_rotation<T: Real, const N: usize>(omega: &Orthogonal<N, T>) -> bool {
    crate::Group::<T>::distance_from_group(omega) <= 1e6 * T::EPSILON
}

/// The principal solution.
pub(super) fn solve<T: Real, const N: usize>(
    factor: &LeftFactor<N, T>,
    h_n: &SMatrix<T, N, N>,
) -> Result<Orthogonal<N, T>, Unsolved> {
    let refuse = |refusal| factor.unsolved(Method::Sign, h_n, refusal);
    if !h_n.iter().all(|x| x.is_finite()) {
        return Err(refuse(Refusal::NotFinite));
    }
    let size = 2 * N;
    let half = T::from_f64(0.5);
    let norm = |a: &SMatrix<T, ROWS, ROWS>| {
        let mut sum = T::zero();
        for i in 0..size {
            for j in 0..size {
                sum += a[(i, j)] * a[(i, j)];
            }
        }
        sum.sqrt()
    };
    let mut z = hamiltonian(&factor.matrix(), h_n);
    let mut previous = f64::INFINITY;
    for step in 0..STEPS {
        let Some(back) = inverse_leading(&z, size) else {
            return Err(refuse(Refusal::NotConverged));
        };
        // Scaling accelerates the first iterations, but disturbs the last ones.
        let scale = match previous > 1e-2 {
            true => (norm(&back) / norm(&z)).sqrt(),
            false => T::one(),
        };
        let next = (z * scale + back * (T::one() / scale)) * half;
        let change = (norm(&(next - z)) / norm(&next)).greatest();
        z = next;
        let stalled = change <= 1e-10 && change >= 0.5 * previous;
        if (change <= 64.0 * T::EPSILON || stalled) && step > 2 {
            break;
        }
        if change.is_nan() {
            return Err(refuse(Refusal::NotConverged));
        }
        previous = change;
    }
    // [1 + Z11; Z21] = [1; S] (1 + Z11): S^T solves (1 + Z11)^T S^T = Z21^T.
    let first =
        SMatrix::<T, N, N>::from_fn(|i, j| z[(j, i)] + if i == j { T::one() } else { T::zero() });
    let second = SMatrix::<T, N, N>::from_fn(|i, j| z[(N + j, i)]);
    let Some(s) = solve_many(&first, &second) else {
        return Err(refuse(Refusal::NotConverged));
    };
    finish(factor, h_n, &((s + s.transpose()) * half), Method::Sign)
}
