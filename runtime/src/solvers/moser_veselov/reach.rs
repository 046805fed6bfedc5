//! The existence bound of the principal solution of the Moser-Veselov equation. Takes the body and `h N`; gives the
//! ratio to the bound.

use super::Poinsot;
use crate::linalg::symmetric_eigenvalues;
use crate::solvers::golden_section::peak;
use nalgebra::Vector3;

/// The ratio of `h N` to its exact bound: at most 1 if and only if the principal solution exists.
/// It is linear in the length of `h_n`. NaN when `h_n` is not finite.
///
/// Let `j_i` be the eigenvalues of `J` and `v = h N`. The square of the ratio is the maximum over `x > 0`
/// of `x (x |v|^2 + |J v|^2) / prod_i (x + j_i^2)` (factorisation of Hermitian matrix polynomials).
/// Each principal component contributes one bump in `log x`, with its peak at the product of the two
/// other eigenvalues and at least as wide as `sech^2`.
#[must_use]
pub fn reach(body: &Poinsot<f64>, h_n: &Vector3<f64>) -> f64 {
    let length = h_n.amax();
    if !h_n.iter().all(|x| x.is_finite()) {
        return f64::NAN;
    }
    if length == 0.0 {
        return 0.0;
    }
    let v = h_n / length;
    let j = body.matrix() / body.unit;
    let (vv, jv) = (v.norm_squared(), (j * v).norm_squared());
    let [j1, j2, j3] = symmetric_eigenvalues(&j).map(|x| x.max(0.0));
    let square = |t: f64| {
        let x = t.exp();
        x / (x + j1 * j1) * ((x * vv + jv) / ((x + j2 * j2) * (x + j3 * j3)))
    };
    // The outermost peaks bracket the maximum. For a flat body the first is at x = 0, which 1e-24 of
    // the last replaces without a visible difference.
    let last = (j2 * j3).ln();
    let first = (j1 * j2).max(j2 * j3 * 1e-24).ln();
    // A quarter of a unit is a fourteenth of the width of the narrowest bump.
    let count = ((last - first) / 0.25).ceil().max(1.0);
    let spacing = (last - first) / count;
    let at = |i: i32| square(first + spacing * f64::from(i));
    let mut best: f64 = 0.0;
    // `first` is at least `last` - 55, hence at most 222 intervals.
    for i in 0..=(count as i32) {
        if at(i) >= at(i - 1) && at(i) >= at(i + 1) {
            let centre = first + spacing * f64::from(i);
            best = best.max(peak(&square, centre - spacing, centre + spacing, 50));
        }
    }
    // Equal peaks collapse the bracket to a point; rounding may shift a peak just outside.
    best = best.max(at(0)).max(at(count as i32));
    best.sqrt() * (length / body.unit)
}
