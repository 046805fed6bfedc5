//! An independent computation of the principal root. It follows the curve from zero velocity in small steps, with a
//! finite-difference Jacobian, and monitors the smallest singular value. Takes the derived equations at three configurations; gives
//! the end of the curve, or the fold.

use clebsch::nalgebra::{DMatrix, DVector};

/// The equations of one problem; `E` is a velocity.
pub trait Curve {
    /// A velocity.
    type E: Clone;
    /// Number of coordinates.
    fn dimension(&self) -> usize;
    /// Zero velocity.
    fn rest(&self) -> Self::E;
    /// The velocity after a retraction on the right along `xi`.
    fn moved(&self, velocity: &Self::E, xi: &DVector<f64>) -> Self::E;
    /// The equations, up to a constant.
    fn value(&self, velocity: &Self::E) -> DVector<f64>;
}

/// The end of continuation.
pub struct Followed<E> {
    /// Its end, or the last point before a fold.
    pub end: E,
    /// The fraction of the curve that was followed; 1 for all.
    pub share: f64,
    /// The smallest singular value of the Jacobian at the end, relative to zero velocity.
    pub smallest: f64,
}

const DIFFERENCE: f64 = 1e-5;

/// The Jacobian by central differences, with a relative error of about 1e-10.
fn tangent<C: Curve>(curve: &C, at: &C::E, unit: &DVector<f64>) -> DMatrix<f64> {
    let n = curve.dimension();
    let mut all = DMatrix::zeros(n, n);
    for k in 0..n {
        let f = |times: f64| {
            let mut xi = DVector::zeros(n);
            xi[k] = times * DIFFERENCE * unit[k];
            curve.value(&curve.moved(at, &xi))
        };
        let column = (f(1.0) - f(-1.0)) / (2.0 * DIFFERENCE * unit[k]);
        all.set_column(k, &column);
    }
    all
}

/// Follows the curve until the equations have the value `goal`. `unit` gives a small displacement for each coordinate.
pub fn follow<C: Curve>(
    curve: &C,
    goal: &DVector<f64>,
    unit: &DVector<f64>,
) -> Option<Followed<C::E>> {
    let mut at = curve.rest();
    let first = curve.value(&at);
    let way = goal - &first;
    let scale = DMatrix::from_diagonal(unit);
    let back = (tangent(curve, &at, unit) * &scale).try_inverse()?;
    // Relative to the Jacobian at zero velocity, in the units of the coordinates.
    let relative = |at: &C::E| &back * tangent(curve, at, unit) * &scale;
    let (mut share, mut length) = (0.0_f64, 0.1_f64);
    let mut here = relative(&at);
    let mut shortest_left = false;
    while share < 1.0 {
        length = length.min(1.0 - share);
        if length < 1e-10 {
            shortest_left = true;
            break;
        }
        let step = (share + length).min(1.0);
        let target = &first + &way * step;
        let made = (|| {
            let inverse = here.clone().try_inverse()?;
            let predicted = &inverse * (&back * &way) * length;
            let short = predicted.norm() < 0.2;
            if !short {
                return None;
            }
            let mut next = curve.moved(&at, &predicted.component_mul(unit));
            let mut size = f64::INFINITY;
            // The Jacobian at the beginning suffices, because it changes by at most a fifth.
            for _ in 0..40 {
                let correction = &inverse * (&back * (&target - curve.value(&next)));
                size = correction.norm();
                let short = size < 0.2;
                if !short {
                    return None;
                }
                next = curve.moved(&next, &correction.component_mul(unit));
                if size < 1e-11 {
                    break;
                }
            }
            let there = relative(&next);
            // The Jacobian must change by at most a fifth of itself.
            let changed =
                (&inverse * &there - DMatrix::identity(there.nrows(), there.ncols())).norm();
            (size < 1e-8 && changed < 0.2).then_some((next, there))
        })();
        match made {
            Some((next, there)) => {
                (at, here, share) = (next, there, step);
                length *= 1.6;
            }
            None => length *= 0.5,
        }
    }
    let smallest = here.svd(false, false).singular_values.min();
    let share = if shortest_left { share } else { 1.0 };
    Some(Followed {
        end: at,
        share,
        smallest,
    })
}
