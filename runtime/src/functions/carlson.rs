//! Carlson's symmetric elliptic integral of a positive definite matrix, R_F(B) = ½ ∫ det(B + s)^{-1/2} ds from
//! 0 to infinity, and its gradient: the potential of a homogeneous ellipsoid whose shape is B. Takes B of
//! three rows; gives a number, or the symmetric matrix of derivatives. Both depend only on the principal
//! invariants of B, so equal axes do not need a special case. Theorem of duplication and series: DLMF 19.26.18
//! and 19.36.1.

use super::jet::Jet;
use crate::Real;
use nalgebra::SMatrix;

/// The integral, for use in a model.
#[allow(non_camel_case_types)]
#[derive(Clone, Copy, Debug, Default)]
pub struct carlson_rf;

/// The number of duplications after which nothing changes: each reduces the differences to a quarter.
const MOST: usize = 64;

/// Below this, the series and its derivatives are exact to rounding: its error is the seventh power of deviations of
/// 3e-3.
const NEAR: f64 = 1e-5;

/// Newton's iterations for the trace of the root, which converge from above.
const MOST_CORRECTIONS: usize = 64;

impl carlson_rf {
    /// R_F(B) of a symmetric positive definite matrix; NaN for any other matrix.
    #[must_use]
    pub fn value<T: Real>(&self, b: &SMatrix<T, 3, 3>) -> T {
        integral(invariants(b), []).value
    }

    /// The gradient with respect to B times a number, a symmetric matrix.
    #[must_use]
    pub fn pull_back_1<T: Real>(&self, b: &SMatrix<T, 3, 3>, seed: &T) -> SMatrix<T, 3, 3> {
        let own = invariants(b);
        let [first, second, third] = integral(own, [0, 1, 2]).along.map(|x| x * *seed);
        // The gradients of the invariants: 1, tr(B) - B, and the cofactors B² - tr(B) B + I2(B).
        let whole = first + second * own[0] + third * own[1];
        let linear = second + third * own[0];
        let square = b * b;
        SMatrix::from_fn(|i, j| {
            let unit = if i == j { whole } else { T::zero() };
            let even = T::from_f64(0.5);
            let (b, square) = (
                (b[(i, j)] + b[(j, i)]) * even,
                (square[(i, j)] + square[(j, i)]) * even,
            );
            unit - b * linear + square * third
        })
    }
}

/// Carlson's R_F in terms of the principal invariants of B: trace, second invariant and determinant. A model stated with this
/// function is recognised as isotropic.
#[allow(non_camel_case_types)]
#[derive(Clone, Copy, Debug, Default)]
pub struct carlson_rf_of_invariants;

impl carlson_rf_of_invariants {
    /// R_F of a matrix with these invariants; NaN unless the matrix is positive definite.
    #[must_use]
    pub fn value<T: Real>(&self, first: &T, second: &T, third: &T) -> T {
        integral([*first, *second, *third], []).value
    }

    /// The derivative with respect to the trace, times a number.
    #[must_use]
    pub fn pull_back_1<T: Real>(&self, first: &T, second: &T, third: &T, seed: &T) -> T {
        integral([*first, *second, *third], [0]).along[0] * *seed
    }

    /// The derivative with respect to the second invariant, times a number.
    #[must_use]
    pub fn pull_back_2<T: Real>(&self, first: &T, second: &T, third: &T, seed: &T) -> T {
        integral([*first, *second, *third], [1]).along[0] * *seed
    }

    /// The derivative with respect to the determinant, times a number.
    #[must_use]
    pub fn pull_back_3<T: Real>(&self, first: &T, second: &T, third: &T, seed: &T) -> T {
        integral([*first, *second, *third], [2]).along[0] * *seed
    }
}

/// The principal invariants.
fn invariants<T: Real>(b: &SMatrix<T, 3, 3>) -> [T; 3] {
    let minor = |i: usize, j: usize| b[(i, i)] * b[(j, j)] - b[(i, j)] * b[(j, i)];
    [
        b[(0, 0)] + b[(1, 1)] + b[(2, 2)],
        minor(0, 1) + minor(1, 2) + minor(0, 2),
        crate::emitted::determinant(b),
    ]
}

/// The integral with its derivatives with respect to some of the three invariants, as one call if the scalar records.
fn integral<T: Real, const N: usize>(of: [T; 3], by: [usize; N]) -> Jet<T, N> {
    match T::whole(in_numbers::<N>, &by, &|| of.to_vec(), 1 + N).as_deref() {
        Some([value, along @ ..]) => Jet {
            value: *value,
            along: core::array::from_fn(|i| along[i]),
        },
        _ => iterated(of, by),
    }
}

/// Like `integral`, over plain numbers: the value, then the derivatives with respect to the invariants.
fn in_numbers<const N: usize>(by: &[usize], of: &[f64], out: &mut [f64]) {
    let found = iterated::<f64, N>(
        core::array::from_fn(|i| of[i]),
        core::array::from_fn(|i| by[i]),
    );
    out[0] = found.value;
    out[1..].copy_from_slice(&found.along);
}

fn iterated<T: Real, const N: usize>(of: [T; 3], by: [usize; N]) -> Jet<T, N> {
    let which = |i: usize| by.iter().position(|k| *k == i);
    let mut all: [Jet<T, N>; 3] = core::array::from_fn(|i| Jet::variable(of[i], which(i)));
    for _ in 0..MOST {
        let [mean, second, third] = deviations(all);
        // False for NaN.
        let near = |x: T| x.greatest().max(-x.least()) <= NEAR;
        if near(second.value) && near(third.value) {
            return series(mean, second, third);
        }
        if !mean.value.is_finite() {
            break;
        }
        all = duplicated(all);
    }
    let [mean, second, third] = deviations(all);
    series(mean, second, third)
}

/// A third of the trace, and the second and third invariants of the deviations from it, in units of it.
fn deviations<T: Real, const N: usize>([first, second, third]: [Jet<T, N>; 3]) -> [Jet<T, N>; 3] {
    let mean = first.times(1.0 / 3.0);
    let square = mean * mean;
    let e2 = second / square - Jet::constant(T::from_f64(3.0));
    let e3 = (mean * second - third) / (square * mean) - Jet::constant(T::from_f64(2.0));
    [mean, e2, e3]
}

fn series<T: Real, const N: usize>(mean: Jet<T, N>, e2: Jet<T, N>, e3: Jet<T, N>) -> Jet<T, N> {
    let one = Jet::constant(T::one());
    let (square, product) = (e2 * e2, e2 * e3);
    let sum = one - e2.times(0.1) + e3.times(1.0 / 14.0) + square.times(1.0 / 24.0)
        - product.times(3.0 / 44.0)
        - (square * e2).times(5.0 / 208.0)
        + (e3 * e3).times(3.0 / 104.0)
        + (square * e3).times(1.0 / 16.0);
    sum / mean.sqrt()
}

/// The invariants of `(B + λ)/4`, where λ is the second invariant of the root of B.
fn duplicated<T: Real, const N: usize>([first, second, third]: [Jet<T, N>; 3]) -> [Jet<T, N>; 3] {
    let root = third.sqrt();
    let trace = trace_of_root(first, second, root);
    let l = (trace * trace - first).times(0.5);
    let square = l * l;
    [
        (first + l.times(3.0)).times(0.25),
        (second + (l * first).times(2.0) + square.times(3.0)).times(1.0 / 16.0),
        (third + l * second + square * first + square * l).times(1.0 / 64.0),
    ]
}

/// The trace `u` of the root of B, the largest root of `((u² - I1)/2)² = I2 + 2 √I3 u`. The iteration uses plain
/// numbers, lane by lane; final corrections use the scalar type, the last of them with derivatives. Rounding bounds
/// then do not accumulate over the iterations.
fn trace_of_root<T: Real, const N: usize>(
    first: Jet<T, N>,
    second: Jet<T, N>,
    root: Jet<T, N>,
) -> Jet<T, N> {
    let mut u = T::zero();
    for lane in 0..T::LANES {
        let known = [first, second, root].map(|x| x.value.lane(lane));
        u.set_lane(lane, T::One::from_f64(plain_trace(known)));
    }
    let precise = u32::from(T::EPSILON < 1e-20);
    for _ in 0..T::ORDER + precise {
        u = improved(Jet::constant(u), first, second, root).value;
    }
    improved(Jet::constant(u), first, second, root)
}

/// One correction of Newton's method.
fn improved<T: Real, const N: usize>(
    u: Jet<T, N>,
    first: Jet<T, N>,
    second: Jet<T, N>,
    root: Jet<T, N>,
) -> Jet<T, N> {
    let l = (u * u - first).times(0.5);
    let value = l * l - second - (root * u).times(2.0);
    u - value / (u * l - root).times(2.0)
}

/// The root for plain numbers, by Newton's iteration from above. The iterates decrease until rounding stops them.
fn plain_trace([first, second, root]: [f64; 3]) -> f64 {
    let mut u = (3.0 * first).sqrt();
    for _ in 0..MOST_CORRECTIONS {
        let l = 0.5 * (u * u - first);
        let step = (l * l - second - 2.0 * root * u) / (2.0 * (u * l - root));
        u -= step;
        // False for NaN too, which ends the iteration.
        let falls = step > 4.0 * f64::EPSILON * u;
        if !falls {
            break;
        }
    }
    u
}

#[cfg(test)]
mod tests;
