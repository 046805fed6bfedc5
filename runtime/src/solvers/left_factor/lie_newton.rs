//! Newton's method on the group, the default solver for any size. Takes a left factor and `h N`; gives the principal
//! solution, to rounding.
//!
//! With `A = R C^T` and `F = A - A^T - V`, the perturbation `cay(X) R` changes `F` by `X A + A^T X`. This is the
//! tangent of the method on the Lie algebra (Owren and Welfert, BIT 40, 2000). A factored tangent is reused in several
//! steps while they converge quickly. In the principal frame of the factor, the tangent at zero momentum is diagonal:
//! `X_ij = F_ij / (c_i + c_j)`. Up to half the bound, this tangent suffices after the iteration for the symmetric part
//! of `A`, and no factorisation is needed.

use super::factor::LeftFactor;
use super::principal::is_principal;
use super::symmetric_part::nearby_rotation;
use super::tangent::Tangent;
use super::{Refusal, Unsolved};
use crate::Real;
use crate::groups::Orthogonal;
use crate::linalg::{product, solve_many};
use crate::solvers::Method;
use nalgebra::SMatrix;

/// The largest number of steps in an attempt. At the bound itself, each step only halves the error.
const MOST_STEPS: usize = 50;

/// The number of attempts on the way from zero to the full momentum, if the direct attempt fails.
const MOST_ATTEMPTS: usize = 60;

/// A residual counts as zero below this many roundings of twice the factor's largest entry. The remaining error has the
/// same effect in every step, so the iteration continues until it no longer decreases.
const CONVERGED_ROUNDINGS: f64 = 1.0;

/// If the residual stops decreasing below this many roundings, the cause is rounding.
const STAGNATED_ROUNDINGS: f64 = 100.0;

/// A factored tangent is reused while each step reduces the residual to at most this fraction.
const QUICK: f64 = 0.1;

/// Below this size, steps use the series of the Cayley map.
const SMALL: f64 = 0.05;

/// The number of steps with the diagonal tangent that improve a guess; each costs a tenth of a factorisation.
const STEPS_BY_FACTOR: usize = 4;

/// Why an attempt failed.
enum Failed {
    /// The iteration did not converge; contains the last residual.
    NotConverged(f64),
    /// The iteration converged to a solution that is not the principal one.
    NotPrincipal,
}

/// The largest real part of an entry, in absolute value, over the lanes.
#[inline(always)]
fn largest<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> f64 {
    a.iter().fold(0.0, |m: f64, x| {
        let size = x.greatest().max(-x.least());
        // The result is NaN if any entry is.
        if size.is_nan() { f64::NAN } else { m.max(size) }
    })
}

/// `cay(X) R`, or for small `X` its series to second order. A Newton step makes the series orthogonal: the error of
/// fourth order in `X` remains only squared.
#[inline]
fn turned<T: Real, const N: usize>(
    x: &SMatrix<T, N, N>,
    r: &SMatrix<T, N, N>,
    size: f64,
) -> Option<SMatrix<T, N, N>> {
    let half = T::from_f64(0.5);
    if size < SMALL {
        let first = product(x, r);
        let near = r + first + product(x, &first) * half;
        let excess = product(&near.transpose(), &near) - SMatrix::identity();
        return Some(near - product(&near, &excess) * half);
    }
    let one = SMatrix::<T, N, N>::identity();
    let back = solve_many(&(one - x * half), r)?;
    Some(back + back - r)
}

/// Solves for the skew `X` with the diagonal part of the tangent: `X_ij = G_ij / (c_i + c_j)`.
#[inline]
fn by_factor<T: Real, const N: usize>(
    reciprocals: &SMatrix<T, N, N>,
    g: &SMatrix<T, N, N>,
) -> SMatrix<T, N, N> {
    g.component_mul(reciprocals)
}

/// One attempt from a guess, in the principal frame. Not inlined: its work arrays are large, and most steps do not need it.
#[inline(never)]
fn attempt<T: Real, const N: usize>(
    factor: &LeftFactor<N, T>,
    v: &SMatrix<T, N, N>,
    guess: &SMatrix<T, N, N>,
) -> Result<SMatrix<T, N, N>, Failed> {
    let unit = unit(factor, v);
    let turned_factor = factor.framed.transpose();
    let mut r = *guess;
    let mut linear = Tangent::<T, N>::blank();
    let mut factorised = false;
    let mut previous = f64::INFINITY;
    let mut size = f64::NAN;
    // The number of steps after the real parts have converged: one for each order of derivatives.
    let mut rest = T::order();
    for _ in 0..MOST_STEPS {
        let a = product(&r, &turned_factor);
        let f = a - a.transpose() - v;
        size = largest(&f);
        if size.is_nan() {
            return Err(Failed::NotConverged(size));
        }
        let done = is_solved(size, previous, unit);
        if done && rest == 0 {
            return match is_principal(&a) {
                true => Ok(r),
                false => Err(Failed::NotPrincipal),
            };
        }
        if done {
            rest -= 1;
        }
        if !factorised || T::order() > 0 || size > QUICK * previous {
            if !linear.factorise(&a) {
                return Err(Failed::NotConverged(size));
            }
            factorised = true;
        }
        let mut x = linear.solve(&-f);
        // A step of more than a radian does not indicate the position of the solution.
        let length = largest(&x);
        if length > 1.0 {
            x *= T::from_f64(1.0 / length);
        }
        r = turned(&x, &r, length).ok_or(Failed::NotConverged(size))?;
        previous = size;
    }
    Err(Failed::NotConverged(size))
}

/// The principal solution from a guess, by steps with the tangent at zero momentum. If they do not suffice, the error
/// contains the best rotation found.
#[inline]
fn by_steps_of_the_factor<T: Real, const N: usize>(
    factor: &LeftFactor<N, T>,
    reciprocals: &SMatrix<T, N, N>,
    v: &SMatrix<T, N, N>,
    guess: &SMatrix<T, N, N>,
) -> Result<SMatrix<T, N, N>, SMatrix<T, N, N>> {
    let unit = unit(factor, v);
    let transposed = factor.framed.transpose();
    let (mut r, mut previous) = (*guess, f64::INFINITY);
    for _ in 0..STEPS_BY_FACTOR {
        let a = product(&r, &transposed);
        let f = a.transpose() - a + v;
        let size = largest(&f);
        if is_solved(size, previous, unit) {
            return if is_principal(&a) { Ok(r) } else { Err(r) };
        }
        // Near the bound these steps diverge.
        if size > 0.5 * previous || size.is_nan() {
            break;
        }
        previous = size;
        let x = by_factor(reciprocals, &f);
        let Some(next) = turned(&x, &r, largest(&x)) else {
            break;
        };
        r = next;
    }
    Err(r)
}

/// The size of one rounding of the residual.
#[inline]
fn unit<T: Real, const N: usize>(factor: &LeftFactor<N, T>, v: &SMatrix<T, N, N>) -> f64 {
    T::EPSILON * (2.0 * largest(&factor.framed)).max(largest(v))
}

/// Whether a residual is at rounding level, given the previous residual.
#[inline]
fn is_solved(size: f64, previous: f64, unit: f64) -> bool {
    size <= CONVERGED_ROUNDINGS * unit
        || (size <= STAGNATED_ROUNDINGS * unit && size >= 0.5 * previous)
}

/// The principal solution.
#[inline]
pub(super) fn solve<T: Real, const N: usize>(
    factor: &LeftFactor<N, T>,
    h_n: &SMatrix<T, N, N>,
) -> Result<Orthogonal<N, T>, Unsolved> {
    let v = factor.framed_momentum(h_n);
    let spectrum = factor.spectrum();
    let mut reciprocals = SMatrix::<T, N, N>::zeros();
    for i in 0..N {
        for j in i + 1..N {
            let x = T::one() / (spectrum[i] + spectrum[j]);
            reciprocals[(i, j)] = x;
            reciprocals[(j, i)] = x;
        }
    }
    let near = nearby_rotation(&spectrum, &reciprocals, &v);
    let guess = match near {
        Some(near) => by_steps_of_the_factor(factor, &reciprocals, &v, &near),
        None => {
            let one = SMatrix::identity();
            let first = by_factor(&reciprocals, &v);
            let turned = turned(&first, &one, largest(&first)).unwrap_or(one);
            by_steps_of_the_factor(factor, &reciprocals, &v, &turned)
        }
    };
    let guess = match guess {
        Ok(r) if T::order() == 0 => return Ok(factor.unframed(&r)),
        Ok(r) | Err(r) => r,
    };
    match attempt(factor, &v, &guess) {
        Ok(r) => Ok(factor.unframed(&r)),
        Err(failed) => by_continuation(factor, h_n, &v, failed),
    }
}

/// Continues from the solution at zero momentum to the solution at the full momentum.
#[cold]
#[inline(never)]
fn by_continuation<T: Real, const N: usize>(
    factor: &LeftFactor<N, T>,
    h_n: &SMatrix<T, N, N>,
    v: &SMatrix<T, N, N>,
    failed: Failed,
) -> Result<Orthogonal<N, T>, Unsolved> {
    let refuse = |failed: &Failed| {
        let (refusal, residual) = match failed {
            Failed::NotConverged(residual) => (Refusal::NotConverged, *residual),
            Failed::NotPrincipal => (Refusal::NotPrincipal, f64::NAN),
        };
        Unsolved {
            residual,
            ..factor.unsolved(Method::LieNewton, h_n, refusal)
        }
    };
    if !h_n.iter().all(|x| x.is_finite()) {
        return Err(factor.unsolved(Method::LieNewton, h_n, Refusal::NotFinite));
    }
    let error = refuse(&failed);
    if error.ratio > 1.0 || error.ratio.is_nan() {
        return Err(Unsolved {
            refusal: Refusal::BeyondBound,
            ..error
        });
    }
    let (mut r, mut reached, mut stride) = (SMatrix::identity(), 0.0_f64, 0.5_f64);
    let mut last = failed;
    for _ in 0..MOST_ATTEMPTS {
        let trial = (reached + stride).min(1.0);
        match attempt(factor, &(v * T::from_f64(trial)), &r) {
            Ok(next) if trial >= 1.0 => return Ok(factor.unframed(&next)),
            Ok(next) => {
                r = next;
                reached = trial;
                stride *= 1.5;
            }
            Err(e) => {
                last = e;
                stride *= 0.5;
            }
        }
    }
    Err(refuse(&last))
}
