//! The places on the way from rest, or along a stage, at which equations are looked at, and the tests there.
//!
//! A correction leaves a share of the way at each look, which tells how the equations vary: its differences from look to
//! look are what the tangent at hand does not foresee. Fourth differences of smooth equations are small; larger ones are
//! the tails of something between two looks.
//!
//! Takes what is left at each look; gives what is compared with the first correction.

use super::principal::FALLS;
use crate::scalar::larger;

/// The number of pieces into which the checks divide the path.
const PIECES: u8 = 16;

/// The first look: nearly at rest, where the tangent at hand is not known to hold.
const FIRST: f64 = 1.0 / 128.0;

/// The largest admitted deviation from the prediction of the tangent between two checks, per length.
const SLOPE: f64 = 0.5;

/// The largest fourth difference of smooth equations.
const ROUGH: f64 = 1e-4;

/// The sum of the absolute weights of a fourth difference.
const WEIGHTS: f64 = 16.0;

/// One look.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    /// The share of the way.
    pub share: f64,
    /// The distance to the previous check.
    apart: f64,
    /// Which of the equally distant looks it is, counted from rest.
    number: Option<u8>,
}

impl Look {
    /// Whether it is one of those at equal distances.
    pub(super) fn is_regular(self) -> bool {
        self.number.is_some()
    }
}

/// A solution is at most so many times as far as the first correction that comes near it, with room for rounding.
const FARTHEST: f64 = 1.4;

/// All looks at a way, up to a share of it: 1, or more if the solution lies beyond the end of the way.
#[inline(always)]
pub(super) fn looks(share: f64) -> impl Iterator<Item = Look> {
    let last = share.clamp(1.0, FARTHEST);
    let first = Look {
        share: FIRST,
        apart: FIRST,
        number: None,
    };
    let apart = 1.0 / f64::from(PIECES);
    let others = (1..2 * PIECES).map(move |k| Look {
        share: f64::from(k) * apart,
        apart,
        number: Some(k),
    });
    core::iter::once(first).chain(others.take_while(move |look| look.share < last))
}

/// The noise of differences: equations of other parts bring theirs, so that all parts are as uncertain as the one that is
/// most, in their units.
#[inline(always)]
pub(super) fn shared_noise(noise: &[f64], units: &[f64]) -> f64 {
    let each = noise.iter().zip(units).map(|(noise, unit)| noise / unit);
    each.filter(|x| x.is_finite()).fold(0.0, larger)
}

/// A difference that is judged as what is left: times `factor`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Judged<V> {
    pub difference: V,
    pub factor: f64,
    /// How many times the noise of the remainder the difference has.
    noise: f64,
}

impl<V> Judged<V> {
    /// The gain between looks that are so far apart.
    #[inline(always)]
    pub(super) fn slope(difference: V, apart: f64) -> Self {
        Self {
            difference,
            factor: FALLS / (SLOPE * apart),
            noise: 2.0,
        }
    }

    /// The noise beside which the difference is judged.
    #[inline(always)]
    pub(super) fn noise(&self, noise: f64) -> f64 {
        self.noise * noise * self.factor / FALLS
    }
}

/// The remainders at the looks so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left<V> {
    /// The last remainder and its differences, up to the third.
    last: [V; 4],
}

impl<V: Clone> Left<V> {
    /// Nothing at rest.
    #[inline(always)]
    pub(super) fn nothing(zero: V) -> Self {
        Self {
            last: [zero.clone(), zero.clone(), zero.clone(), zero],
        }
    }

    /// The remainder at another look: the slope from the look before, and the fourth difference where there is one.
    #[inline(always)]
    pub(super) fn next(
        &mut self,
        look: Look,
        off: &V,
        less: impl Fn(&V, &V) -> V,
    ) -> [Option<Judged<V>>; 2] {
        let first = less(off, &self.last[0]);
        let slope = Some(Judged::slope(first.clone(), look.apart));
        let Some(number) = look.number else {
            return [slope, None];
        };
        let second = less(&first, &self.last[1]);
        let third = less(&second, &self.last[2]);
        let fourth = less(&third, &self.last[3]);
        self.last = [off.clone(), first, second, third];
        let rough = (number >= 4).then_some(Judged {
            difference: fourth,
            factor: FALLS / ROUGH,
            noise: WEIGHTS,
        });
        [slope, rough]
    }
}
