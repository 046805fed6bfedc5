//! Where the equation of a left factor stops having a principal solution.
//! Takes the factor and `h N`; gives the exact bound ratio.

use super::factor::LeftFactor;
use crate::Real;
use crate::solvers::golden_section::peak;
use nalgebra::SMatrix;

impl<const N: usize, T: Real> LeftFactor<N, T> {
    /// The ratio of `h N` to its exact bound: at most 1 if and only if the principal solution
    /// exists, linear in the length of `h_n`. Of several lanes, the worst; NaN when not finite.
    ///
    /// It is the maximum over `nu > 0` of the norm of `D^-1/2 V D^-1/2`, `D = nu + C C^T / nu`: the
    /// Hermitian matrix polynomial `nu^2 + C C^T - i nu V` must not lose its positivity.
    #[must_use]
    pub fn reach(&self, h_n: &SMatrix<T, N, N>) -> f64 {
        let v = self.framed_momentum(h_n);
        let mut worst: f64 = 0.0;
        for lane in 0..T::LANES {
            let spectrum = self.spectrum().map(|x| x.lane(lane).max(0.0));
            let ratio = ratio(&spectrum, &v.map(|x| x.lane(lane)));
            if ratio.is_nan() {
                return ratio;
            }
            worst = worst.max(ratio);
        }
        worst
    }
}

/// The ratio of [`LeftFactor::reach`] for a factor that nothing is prepared of.
#[must_use]
pub fn reach_of<T: Real, const N: usize>(c: &SMatrix<T, N, N>, v: &SMatrix<T, N, N>) -> f64 {
    let mut worst: f64 = 0.0;
    for lane in 0..T::LANES {
        let (c, v) = (c.map(|x| x.lane(lane)), v.map(|x| x.lane(lane)));
        let square = c * c.transpose();
        let frame = crate::linalg::principal_frame(&square);
        let spectrum = frame.tr_mul(&(square * frame)).diagonal();
        let spectrum = spectrum.map(|x| x.max(0.0).sqrt());
        let ratio = ratio(&spectrum, &frame.tr_mul(&(v * frame)));
        if ratio.is_nan() {
            return ratio;
        }
        worst = worst.max(ratio);
    }
    worst
}

/// The ratio for a diagonal factor.
fn ratio<const N: usize>(c: &nalgebra::SVector<f64, N>, v: &SMatrix<f64, N, N>) -> f64 {
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
    // Outside the squares of the spectrum D grows in every direction: the norm falls. A flat body
    // has its first end at 0, which 1e-12 of the last stands for.
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

/// The largest singular value of a skew matrix: of its square the largest eigenvalue, by Jacobi
/// rotations.
fn largest_singular_value<const N: usize>(w: &SMatrix<f64, N, N>) -> f64 {
    let gram = w.tr_mul(w);
    let frame = crate::linalg::principal_frame(&gram);
    let diagonal = frame.tr_mul(&(gram * frame));
    (0..N).map(|i| diagonal[(i, i)]).fold(0.0, f64::max).sqrt()
}
