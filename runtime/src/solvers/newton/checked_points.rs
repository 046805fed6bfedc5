//! The points between rest and the solution, or along a stage, at which the equations are checked, and the tests there.
//!
//! The remainder at each point shows how the equations vary: the differences between successive points are what the
//! current tangent does not predict. For smooth equations, fourth differences are small. A larger one indicates a
//! variation between two points.
//!
//! Takes the remainder at each point; gives the quantities that are compared with the first correction.

use super::principal::FALLS;
use crate::scalar::larger;

/// The number of pieces into which the checks divide the path.
const PIECES: u8 = 16;

/// The first point, close to rest, where the current tangent has not been verified.
const FIRST: f64 = 1.0 / 128.0;

/// The largest deviation from the tangent's prediction between two points, per length.
const SLOPE: f64 = 0.5;

/// The largest fourth difference of smooth equations.
const ROUGH: f64 = 1e-4;

/// The sum of the absolute weights of a fourth difference.
const WEIGHTS: f64 = 16.0;

/// A point at which the equations are checked.
#[derive(Clone, Copy, Debug)]
pub(super) struct CheckedPoint {
    /// The position, as a fraction of the path.
    pub share: f64,
    /// The distance to the previous point.
    apart: f64,
    /// The number of the point among the equidistant points, counted from rest.
    number: Option<u8>,
}

impl CheckedPoint {
    /// Whether the point is one of the equidistant points.
    pub(super) fn is_regular(self) -> bool {
        self.number.is_some()
    }
}

/// The largest length of a solution relative to a first correction that is close to it, with a margin for rounding.
const FARTHEST: f64 = 1.4;

/// All points of a path up to a fraction of it: 1, or more if the solution lies beyond the end of the path.
#[inline(always)]
pub(super) fn looks(share: f64) -> impl Iterator<Item = CheckedPoint> {
    let last = share.clamp(1.0, FARTHEST);
    let first = CheckedPoint {
        share: FIRST,
        apart: FIRST,
        number: None,
    };
    let apart = 1.0 / f64::from(PIECES);
    let others = (1..2 * PIECES).map(move |k| CheckedPoint {
        share: f64::from(k) * apart,
        apart,
        number: Some(k),
    });
    core::iter::once(first).chain(others.take_while(move |look| look.share < last))
}

/// The relative rounding error of differences. Equations couple the parts, so every part has the rounding error of the
/// most uncertain part, in its own units.
#[inline(always)]
pub(super) fn shared_noise(noise: &[f64], units: &[f64]) -> f64 {
    let each = noise.iter().zip(units).map(|(noise, unit)| noise / unit);
    each.filter(|x| x.is_finite()).fold(0.0, larger)
}

/// A difference that, multiplied by `factor`, is judged like a remainder.
#[derive(Clone, Copy, Debug)]
pub(super) struct JudgedDifference<V> {
    pub difference: V,
    pub factor: f64,
    /// The rounding error of the difference, in rounding errors of a remainder.
    noise: f64,
}

impl<V> JudgedDifference<V> {
    /// The change between two points at the distance `apart`.
    #[inline(always)]
    pub(super) fn slope(difference: V, apart: f64) -> Self {
        Self {
            difference,
            factor: FALLS / (SLOPE * apart),
            noise: 2.0,
        }
    }

    /// The rounding error below which the difference does not count.
    #[inline(always)]
    pub(super) fn noise(&self, noise: f64) -> f64 {
        self.noise * noise * self.factor / FALLS
    }
}

/// The remainders at the points so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Remainders<V> {
    /// The last remainder and its differences, up to the third.
    last: [V; 4],
}

impl<V: Clone> Remainders<V> {
    /// The remainder at rest, which is zero.
    #[inline(always)]
    pub(super) fn nothing(zero: V) -> Self {
        Self {
            last: [zero.clone(), zero.clone(), zero.clone(), zero],
        }
    }

    /// Takes the remainder at the next point; returns the slope from the previous point, and the fourth difference if
    /// there are enough points.
    #[inline(always)]
    pub(super) fn next(
        &mut self,
        look: CheckedPoint,
        off: &V,
        less: impl Fn(&V, &V) -> V,
    ) -> [Option<JudgedDifference<V>>; 2] {
        let first = less(off, &self.last[0]);
        let slope = Some(JudgedDifference::slope(first.clone(), look.apart));
        let Some(number) = look.number else {
            return [slope, None];
        };
        let second = less(&first, &self.last[1]);
        let third = less(&second, &self.last[2]);
        let fourth = less(&third, &self.last[3]);
        self.last = [off.clone(), first, second, third];
        let rough = (number >= 4).then_some(JudgedDifference {
            difference: fourth,
            factor: FALLS / ROUGH,
            noise: WEIGHTS,
        });
        [slope, rough]
    }
}
