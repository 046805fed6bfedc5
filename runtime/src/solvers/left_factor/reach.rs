//! The existence bound of the principal solution for a left factor. Takes the factor and `h N`; gives
//! the ratio to the exact bound, and the plane that rotates fastest.

use super::factor::LeftFactor;
use crate::Real;
use crate::groups::Part;
use crate::scalar::largest;
use crate::solvers::golden_section::peak;
use nalgebra::{SMatrix, SVector};

impl<const N: usize, T: Real> LeftFactor<N, T> {
    /// The ratio of `h N` to its exact bound, in the worst lane. It is at most 1 if and only if the
    /// principal solution exists, and linear in the length of `h_n`. NaN if `h_n` is not finite.
    ///
    /// It is the maximum over `nu > 0` of the norm of `D^-1/2 V D^-1/2`, `D = nu + C C^T / nu`: the
    /// Hermitian matrix polynomial `nu^2 + C C^T - i nu V` must not lose its positivity.
    #[must_use]
    pub fn reach(&self, h_n: &SMatrix<T, N, N>) -> f64 {
        self.farthest(h_n).0
    }

    /// Like `reach`, with the lane that attains it.
    pub(super) fn farthest(&self, h_n: &SMatrix<T, N, N>) -> (f64, usize) {
        let v = self.framed_momentum(h_n);
        farthest::<T>(|lane| {
            let spectrum = self.spectrum().map(|x| x.lane(lane).max(0.0));
            ratio(&spectrum, &v.map(|x| x.lane(lane)))
        })
    }
}

/// The largest ratio over the lanes, and its lane; NaN counts as the largest.
fn farthest<T: Real>(ratio: impl Fn(usize) -> f64) -> (f64, usize) {
    let mut worst = (0.0, 0);
    for lane in 0..T::LANES {
        let ratio = ratio(lane);
        if ratio > worst.0 || ratio.is_nan() {
            worst = (ratio, lane);
        }
        if ratio.is_nan() {
            break;
        }
    }
    worst
}

/// In one lane, the plane with the largest `|h N_ij| / (P_ii + P_jj)`, momentum over moment of inertia. A short step
/// rotates fastest in this plane.
pub(super) fn fastest<T: Real, const N: usize>(
    p: &SMatrix<T, N, N>,
    h_n: &SMatrix<T, N, N>,
    lane: usize,
) -> Part {
    let (mut largest, mut plane) = (-1.0, (0, 1));
    for i in 0..N {
        for j in i + 1..N {
            let moment = p[(i, i)].lane(lane) + p[(j, j)].lane(lane);
            let angle = (h_n[(i, j)].lane(lane) / moment).abs();
            if angle > largest || (angle.is_nan() && !f64::is_nan(largest)) {
                (largest, plane) = (angle, (i, j));
            }
        }
    }
    Part::plane(plane.0, plane.1, N)
}

/// Like [`LeftFactor::reach`], for a factor without prepared data.
#[must_use]
pub fn reach_of<T: Real, const N: usize>(c: &SMatrix<T, N, N>, v: &SMatrix<T, N, N>) -> f64 {
    farthest_of(c, v).0
}

/// Like `reach_of`, with the lane that attains it.
pub(super) fn farthest_of<T: Real, const N: usize>(
    c: &SMatrix<T, N, N>,
    v: &SMatrix<T, N, N>,
) -> (f64, usize) {
    farthest::<T>(|lane| {
        let v = v.map(|x| x.lane(lane));
        let (frame, spectrum) = positive_part(c, lane);
        ratio(&spectrum, &frame.tr_mul(&(v * frame)))
    })
}

/// The principal frame and the spectrum of `P` in `C = P Q`, of one lane.
fn positive_part<T: Real, const N: usize>(
    c: &SMatrix<T, N, N>,
    lane: usize,
) -> (SMatrix<f64, N, N>, SVector<f64, N>) {
    let c = c.map(|x| x.lane(lane));
    let square = c * c.transpose();
    let frame = crate::linalg::principal_frame(&square);
    let spectrum = frame.tr_mul(&(square * frame)).diagonal();
    (frame, spectrum.map(|x| x.max(0.0).sqrt()))
}

/// Like [`fastest`], for a factor without prepared data.
pub(super) fn fastest_of<T: Real, const N: usize>(
    c: &SMatrix<T, N, N>,
    h_n: &SMatrix<T, N, N>,
    lane: usize,
) -> Part {
    let (frame, spectrum) = positive_part(c, lane);
    let p = frame * SMatrix::from_diagonal(&spectrum) * frame.transpose();
    fastest(&p, &h_n.map(|x| x.lane(lane)), 0)
}

/// The ratio for a diagonal factor.
fn ratio<const N: usize>(c: &SVector<f64, N>, v: &SMatrix<f64, N, N>) -> f64 {
    let (length, unit) = (v.amax(), c.amax());
    if !v.iter().all(|x| x.is_finite()) || !c.iter().all(|x| x.is_finite()) {
        return f64::NAN;
    }
    if length == 0.0 {
        return 0.0;
    }
    let (c, v) = (c / unit, v / length);
    // With x = nu^2 the entries are V_ab sqrt(x / ((x + a^2)(x + b^2))).
    let norm = |log: f64| {
        let x = log.exp();
        let scale = c.map(|a| (x.sqrt() / (x + a * a)).sqrt());
        let w = SMatrix::<f64, N, N>::from_fn(|i, j| scale[i] * v[(i, j)] * scale[j]);
        largest_singular_value(&w)
    };
    // Outside the squares of the spectrum D grows in every direction, so the norm decreases. For a flat
    // body the first end is 0, which 1e-12 of the last replaces.
    let last = 2.0 * c.amax().ln();
    let first = 2.0 * c.min().max(1e-12 * c.amax()).ln();
    let count = ((last - first) / 0.25).ceil().max(1.0);
    let spacing = (last - first) / count;
    let at = |i: i32| norm(first + spacing * f64::from(i));
    // `first` is at least `last` - 56: at most 224 intervals.
    let count = count as i32;
    let mut best = at(0).max(at(count));
    for i in 0..=count {
        let here = at(i);
        if here >= at(i - 1) && here >= at(i + 1) {
            let centre = first + spacing * f64::from(i);
            best = best.max(peak(&norm, centre - spacing, centre + spacing, 45));
        }
    }
    best * length / unit
}

/// The largest singular value of a skew matrix: the square root of the largest eigenvalue of its negative square, by
/// Jacobi rotations.
fn largest_singular_value<const N: usize>(w: &SMatrix<f64, N, N>) -> f64 {
    let gram = w.tr_mul(w);
    let frame = crate::linalg::principal_frame(&gram);
    let diagonal = frame.tr_mul(&(gram * frame));
    largest((0..N).map(|i| diagonal[(i, i)])).sqrt()
}
