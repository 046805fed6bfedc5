//! Carlson's symmetric elliptic integral of a positive definite matrix, R_F(B) = ½ ∫ det(B + s)^{-1/2} ds from
//! 0 to infinity, and its gradient: the potential of a homogeneous ellipsoid whose shape is B. Takes B of
//! three rows; gives a number, or the symmetric matrix of derivatives. Both depend only on the principal
//! invariants of B, so equal axes do not need a special case. Theorem of duplication and series: DLMF 19.26.18
//! and 19.36.1.

use super::jet::{Jet, Number};
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

/// The same with second derivatives.
const NEARER: f64 = 1e-10;

/// Newton's iterations for the trace of the root, which converge from above.
const MOST_CORRECTIONS: usize = 64;

impl carlson_rf {
    /// R_F(B) of a symmetric positive definite matrix; NaN for any other matrix.
    #[must_use]
    pub fn value<T: Real>(&self, b: &SMatrix<T, 3, 3>) -> T {
        integral(invariants(b), []).value
    }

    /// The derivative along a symmetric matrix.
    #[must_use]
    pub fn along_1<T: Real>(&self, b: &SMatrix<T, 3, 3>, along: &SMatrix<T, 3, 3>) -> T {
        let gradient = self.pull_back_1(b, &T::one());
        gradient.component_mul(along).sum()
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

    /// The derivative of this gradient along a symmetric matrix.
    #[must_use]
    pub fn pull_back_1_along_1<T: Real>(
        &self,
        b: &SMatrix<T, 3, 3>,
        along: &SMatrix<T, 3, 3>,
        seed: &T,
    ) -> SMatrix<T, 3, 3> {
        let even = |a: &SMatrix<T, 3, 3>| (a + a.transpose()) * T::from_f64(0.5);
        let (b, along) = (even(b), even(along));
        let unit = SMatrix::identity();
        let own = invariants(&b);
        let [second, third] = [unit * own[0] - b, b * b - b * own[0] + unit * own[1]];
        let [along_1, along_2, along_3] =
            [unit, second, third].map(|gradient| gradient.component_mul(&along).sum());
        let first_order = integral(own, [0, 1, 2]).along.map(|x| x * *seed);
        let [x, y, z] = bent(own, [along_1, along_2, along_3], [0, 1, 2]).map(|x| x * *seed);
        let turning = unit * along_1 - along;
        let third_turning = b * along + along * b - b * along_1 - along * own[0] + unit * along_2;
        unit * x
            + second * y
            + third * z
            + turning * first_order[1]
            + third_turning * first_order[2]
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

    /// The derivative along the trace.
    #[must_use]
    pub fn along_1<T: Real>(&self, first: &T, second: &T, third: &T, along: &T) -> T {
        self.pull_back_1(first, second, third, along)
    }

    /// The derivative along the second invariant.
    #[must_use]
    pub fn along_2<T: Real>(&self, first: &T, second: &T, third: &T, along: &T) -> T {
        self.pull_back_2(first, second, third, along)
    }

    /// The derivative along the determinant.
    #[must_use]
    pub fn along_3<T: Real>(&self, first: &T, second: &T, third: &T, along: &T) -> T {
        self.pull_back_3(first, second, third, along)
    }
}

/// Second derivatives with respect to the invariants, as methods for emitted code.
macro_rules! second_derivatives {
    ($($name:ident: $by:literal $along:literal;)*) => {
        impl carlson_rf_of_invariants {
            $(
                /// A second derivative, times a number and the change of an invariant.
                #[must_use]
                pub fn $name<T: Real>(&self, first: &T, second: &T, third: &T, along: &T, seed: &T) -> T {
                    let mut change = [T::zero(); 3];
                    change[$along] = *along;
                    bent([*first, *second, *third], change, [$by])[0] * *seed
                }
            )*
        }
    };
}

second_derivatives! {
    pull_back_1_along_1: 0 0;
    pull_back_1_along_2: 0 1;
    pull_back_1_along_3: 0 2;
    pull_back_2_along_1: 1 0;
    pull_back_2_along_2: 1 1;
    pull_back_2_along_3: 1 2;
    pull_back_3_along_1: 2 0;
    pull_back_3_along_2: 2 1;
    pull_back_3_along_3: 2 2;
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
        _ => iterated(variables(of, by)),
    }
}

/// The derivatives with respect to some of the invariants, differentiated along a change of all invariants.
fn bent<T: Real, const N: usize>(of: [T; 3], along: [T; 3], by: [usize; N]) -> [T; N] {
    let inputs = || of.into_iter().chain(along).collect();
    match T::whole(bent_numbers::<N>, &by, &inputs, N).as_deref() {
        Some(found) => core::array::from_fn(|i| found[i]),
        None => {
            let moving = core::array::from_fn(|i| Jet {
                value: of[i],
                along: [along[i]],
            });
            let found: Jet<Jet<T, 1>, N> = iterated(variables(moving, by));
            found.along.map(|x| x.along[0])
        }
    }
}

/// Like `bent`, over plain numbers: invariants, then their change.
fn bent_numbers<const N: usize>(by: &[usize], of: &[f64], out: &mut [f64]) {
    let found = bent::<f64, N>(
        core::array::from_fn(|i| of[i]),
        core::array::from_fn(|i| of[3 + i]),
        core::array::from_fn(|i| by[i]),
    );
    out.copy_from_slice(&found);
}

/// Like `integral`, over plain numbers: the value, then the derivatives with respect to the invariants.
fn in_numbers<const N: usize>(by: &[usize], of: &[f64], out: &mut [f64]) {
    let found = iterated::<f64, N>(variables(
        core::array::from_fn(|i| of[i]),
        core::array::from_fn(|i| by[i]),
    ));
    out[0] = found.value;
    out[1..].copy_from_slice(&found.along);
}

/// The invariants, some of them as variables.
fn variables<A: Number, const N: usize>(of: [A; 3], by: [usize; N]) -> [Jet<A, N>; 3] {
    let which = |i: usize| by.iter().position(|k| *k == i);
    core::array::from_fn(|i| Jet::variable(of[i], which(i)))
}

fn iterated<A: Number, const N: usize>(mut all: [Jet<A, N>; 3]) -> Jet<A, N> {
    let bound = if A::DEPTH == 0 { NEAR } else { NEARER };
    for _ in 0..MOST {
        let [mean, second, third] = deviations(all);
        // False for NaN.
        let near = |x: A::Base| x.greatest().max(-x.least()) <= bound;
        if near(second.base()) && near(third.base()) {
            return series(mean, second, third);
        }
        if !mean.base().is_finite() {
            break;
        }
        all = duplicated(all);
    }
    let [mean, second, third] = deviations(all);
    series(mean, second, third)
}

/// A constant.
fn number<A: Number, const N: usize>(x: f64) -> Jet<A, N> {
    Jet::constant(A::Base::from_f64(x))
}

/// A third of the trace, and the second and third invariants of the deviations from it, in units of it.
fn deviations<A: Number, const N: usize>([first, second, third]: [Jet<A, N>; 3]) -> [Jet<A, N>; 3] {
    let mean = first.times(1.0 / 3.0);
    let square = mean * mean;
    let e2 = second / square - number(3.0);
    let e3 = (mean * second - third) / (square * mean) - number(2.0);
    [mean, e2, e3]
}

fn series<A: Number, const N: usize>(mean: Jet<A, N>, e2: Jet<A, N>, e3: Jet<A, N>) -> Jet<A, N> {
    let one = number(1.0);
    let (square, product) = (e2 * e2, e2 * e3);
    let sum = one - e2.times(0.1) + e3.times(1.0 / 14.0) + square.times(1.0 / 24.0)
        - product.times(3.0 / 44.0)
        - (square * e2).times(5.0 / 208.0)
        + (e3 * e3).times(3.0 / 104.0)
        + (square * e3).times(1.0 / 16.0);
    sum / mean.root()
}

/// The invariants of `(B + λ)/4`, where λ is the second invariant of the root of B.
fn duplicated<A: Number, const N: usize>([first, second, third]: [Jet<A, N>; 3]) -> [Jet<A, N>; 3] {
    let root = third.root();
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
fn trace_of_root<A: Number, const N: usize>(
    first: Jet<A, N>,
    second: Jet<A, N>,
    root: Jet<A, N>,
) -> Jet<A, N> {
    let mut start = A::Base::from_f64(0.0);
    for lane in 0..A::Base::LANES {
        let known = [first, second, root].map(|x| x.base().lane(lane));
        start.set_lane(lane, <A::Base as Real>::One::from_f64(plain_trace(known)));
    }
    let mut u = A::constant(start);
    let precise = u32::from(A::Base::EPSILON < 1e-20);
    for _ in 0..A::Base::order() + precise + A::DEPTH {
        u = improved(Jet::variable(u, None), first, second, root).value;
    }
    improved(Jet::variable(u, None), first, second, root)
}

/// One correction of Newton's method.
fn improved<A: Number, const N: usize>(
    u: Jet<A, N>,
    first: Jet<A, N>,
    second: Jet<A, N>,
    root: Jet<A, N>,
) -> Jet<A, N> {
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
