//! The scalar unknown of the Moser-Veselov equation: the smallest root of a quartic. Takes the
//! body, `a = |u|^2` and `e = u . I^-1 u`; gives `kappa`, or `None` beyond the bound.
//!
//! Over `s3` the quartic is
//! `g = (e - k) - (s1 a / s3) k + a^2 / s3 + k^2 ((s2 + 2a) / s3 - (s1 / s3) k + k^2 / s3)`.
//! It is positive at 0. The principal solution exists only if the quartic has a real root.

use super::Poinsot;
use crate::Real;
use crate::scalar::lane_view::in_lanes;
use crate::scalar::of_scalars;

/// Below this, `s2 e / s3` leaves the quartic so close to its linear part that the start of the series is inside the
/// basin of the smallest root. In units of `e` the quartic reads `1 - w + y w^2 - ...`, with higher coefficients
/// below `y^2/3` and `y^3/27`, and a double root needs `y` near 1/4. `s1 a / s3` is at most twice as large.
const SMALL: f64 = 1.0 / 32.0;

/// From the series start, fourth-order convergence needs one or two iterations.
const MOST_FAST: usize = 6;

/// Near a double root, Newton's method halves the error per iteration until `g` is at rounding level, after half the
/// bits of the significand. Before this, the monotone method takes up to about ten iterations. Double-double needs
/// 53 + 10.
const MOST_MONOTONE: usize = 100;

/// The invariants of the body for the quartic, all over `s3`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Symmetric<T> {
    /// `1 / s3`.
    pub(super) zeroth: T,
    /// `s1 / s3`.
    pub(super) first: T,
    /// `s2 / s3`.
    pub(super) second: T,
    /// The largest `e` for which one iteration from the series start is exact to rounding.
    easy: T,
}

in_lanes!(Symmetric {
    zeroth,
    first,
    second,
    easy
});

of_scalars!(Symmetric {
    zeroth,
    first,
    second,
    easy
});

impl<T: Real> Symmetric<T> {
    pub(super) fn new(s1: T, s2: T, s3: T) -> Self {
        let zeroth = T::one() / s3;
        let second = s2 * zeroth;
        // With `y = s2 e / s3` the start is off by less than 2 y^2 of the root, and the iteration
        // leaves less than 512 y^11.
        let easy = (T::EPSILON / 512.0).powf(1.0 / 11.0);
        Self {
            zeroth,
            first: s1 * zeroth,
            second,
            easy: T::from_f64(easy) / second,
        }
    }
}

/// The quartic for one momentum.
struct Quartic<T> {
    /// `e`.
    energy: T,
    /// `a^2 / s3`.
    square: T,
    /// `s1 a / s3`.
    turn: T,
    /// `(s2 + 2a) / s3`.
    curvature: T,
    /// `s1 / s3`.
    third: T,
    /// `1 / s3`.
    fourth: T,
}

impl<T: Real> Quartic<T> {
    #[inline(always)]
    fn new(body: &Symmetric<T>, a: T, energy: T) -> Self {
        Self {
            energy,
            square: body.zeroth * (a * a),
            turn: body.first * a,
            curvature: body.second + (body.zeroth + body.zeroth) * a,
            third: body.first,
            fourth: body.zeroth,
        }
    }

    /// The first terms of the series of the root.
    #[inline(always)]
    fn start(&self, deviation: T) -> T {
        (self.energy + self.square) + self.energy * deviation
    }

    #[inline(always)]
    fn value(&self, k: T) -> T {
        let square = k * k;
        (((self.energy - k) + self.square) - self.turn * k)
            + square * ((self.curvature - self.third * k) + square * self.fourth)
    }

    /// Minus the first derivative.
    #[inline(always)]
    fn fall(&self, k: T) -> T {
        let (three, four) = (T::from_f64(3.0), T::from_f64(4.0));
        let linear = (T::one() + self.turn) - (self.curvature + self.curvature) * k;
        linear + (k * k) * (three * self.third - (four * self.fourth) * k)
    }

    /// One step of fourth order: Newton's, and the next two terms of the inverse series.
    #[inline(always)]
    fn improved(&self, k: T) -> T {
        let [newton, bend, twist] = self.change(k);
        let square = newton * newton;
        ((k + newton) + square * bend) + (square * newton) * twist
    }

    /// Newton's change of `k` and the two factors of its square and cube that improve it.
    #[inline(always)]
    fn change(&self, k: T) -> [T; 3] {
        let (three, four, six) = (T::from_f64(3.0), T::from_f64(4.0), T::from_f64(6.0));
        // Half the second derivative and a sixth of the third.
        let second = (self.curvature - (three * self.third) * k) + (six * self.fourth) * (k * k);
        let third = (four * self.fourth) * k - self.third;
        let per_fall = T::one() / self.fall(k);
        let bend = second * per_fall;
        let twist = (bend + bend) * bend + third * per_fall;
        [self.value(k) * per_fall, bend, twist]
    }

    /// 1 in the lanes where a correction from `k` is exact to rounding, otherwise 0: its error is about
    /// `newton^4 bend (bend^2 + twist)`, up to factors of a few.
    fn arrives(&self, k: T) -> T {
        let [newton, bend, twist] = self.change(k);
        let square = newton * newton;
        let allowed = k * T::from_f64(0.125 * T::EPSILON);
        let [first, second] = [bend * bend, twist].map(|x| {
            let left = (square * square) * (bend * x);
            (allowed * allowed - left * left).where_positive(T::one())
        });
        first * second
    }

    /// Newton steps that make the derivative parts of `k` exact; none for plain numbers.
    #[inline(always)]
    fn polished(&self, mut k: T) -> T {
        for _ in 0..T::order() {
            k += self.value(k) / self.fall(k);
        }
        k
    }

    /// Newton's method from below the smallest root, in the lanes where `slow` is 1: the iterates increase to the
    /// root and never pass it. If `g > 0` and `g' >= 0` at an iterate, a real root does not exist.
    fn monotone(&self, slow: T) -> Option<T> {
        let one = T::one();
        let constant = self.energy + self.square;
        let mut k = slow.where_positive(constant / (one + self.turn));
        if !k.is_finite() {
            return None;
        }
        // Rounding of the sum in `value`, whose terms are up to about twice the constant at a
        // double root.
        let noise = T::from_f64(4.0 * T::EPSILON) * constant;
        for _ in 0..MOST_MONOTONE {
            let (value, fall) = (self.value(k), self.fall(k));
            // 1 in the lanes that still iterate, 0 in the lanes that have converged.
            let active = slow * (value - noise).where_positive(one);
            if active.nowhere_positive() {
                return self.finished(k);
            }
            let descent = active * fall + (one - active);
            let descends = descent.exceeds(T::zero());
            if !descends {
                return None;
            }
            k += active * (value / descent);
        }
        None
    }

    /// One more step if the slope is not itself rounding: it corrects the last digits, and makes the derivative parts
    /// exact.
    fn finished(&self, mut k: T) -> Option<T> {
        let one = T::one();
        let threshold = (one + self.turn) * T::from_f64(T::EPSILON.sqrt());
        for _ in 0..=T::order() {
            let fall = self.fall(k);
            let steep = (fall - threshold).where_positive(one);
            let safe = steep * fall + (one - steep);
            k += steep * (self.value(k) / safe);
        }
        k.is_finite().then_some(k)
    }
}

/// The smallest root, in units of the body. `deviation` is `s2 e / s3 - s1 a / s3`, which the
/// caller may know as soon as `energy`.
///
/// Only the case of a moderate step is inlined, in which one iteration from the series suffices.
#[inline(always)]
pub(super) fn kappa<T: Real>(body: &Poinsot<T>, a: T, energy: T, deviation: T) -> Option<T> {
    let (k, found) = kappa_at_once(body, a, energy, deviation);
    if found {
        return Some(k);
    }
    hard(&body.symmetric, a, energy, deviation)
}

/// The root by one iteration, and whether that suffices; without a branch.
#[inline(always)]
pub(super) fn kappa_at_once<T: Real>(
    body: &Poinsot<T>,
    a: T,
    energy: T,
    deviation: T,
) -> (T, bool) {
    let body = &body.symmetric;
    let quartic = Quartic::new(body, a, energy);
    let k = quartic.improved(quartic.start(deviation));
    // The comparison is false for NaN.
    (quartic.polished(k), (energy - body.easy).nowhere_positive())
}

/// The root if one iteration does not suffice: by further iterations, or by the monotone approach.
///
/// Each lane performs the operations that it would perform alone, so its result does not depend on
/// other lanes.
#[cold]
#[inline(never)]
fn hard<T: Real>(body: &Symmetric<T>, a: T, energy: T, deviation: T) -> Option<T> {
    if !(a.is_finite() && energy.is_finite()) {
        return None;
    }
    let one = T::one();
    let quartic = Quartic::new(body, a, energy);
    let easy = one - (energy - body.easy).where_positive(one);
    let mut slow = (energy * body.second - T::from_f64(SMALL)).where_positive(one);
    // 1 in the lanes that still iterate.
    let mut active = one - slow;
    let mut k = quartic.start(deviation);
    for _ in 0..MOST_FAST {
        if active.nowhere_positive() {
            break;
        }
        let last = choose(easy, one, quartic.arrives(k));
        k = choose(active, quartic.improved(k), k);
        active *= one - last;
    }
    slow += active;
    k = quartic.polished(k);
    if !slow.nowhere_positive() {
        k = choose(slow, quartic.monotone(slow)?, k);
    }
    Some(k)
}

/// Selects one of two values in each lane by a mask of 1 or 0.
#[inline(always)]
pub(in crate::solvers) fn choose<T: Real>(mask: T, then: T, otherwise: T) -> T {
    mask.where_positive(then) + (T::one() - mask).where_positive(otherwise)
}
