//! The scalar unknown of the Moser-Veselov equation: the smallest root of a quartic.
//! Takes the body, `a = |u|^2` and `e = u . adj(I) u`; gives `kappa`, or nothing beyond the bound.
//!
//! The quartic is
//! `g = k^4 - s1 k^3 + (s2 + 2a) k^2 - (s3 + s1 a) k + (e + a^2)`.
//! It is positive at 0; without a real root there is no principal solution.

use super::Poinsot;
use crate::Real;

/// Below this, `s1 a / s3` and `s2 e / s3^2` leave the quartic so close to its linear part that
/// the series start is inside the basin of the smallest root: in units of `e / s3` it reads
/// `1 - w + y w^2 - ...` with higher coefficients below `y^2/3` and `y^3/27`, and a double root
/// needs `y` near 1/4.
const SMALL: f64 = 1.0 / 16.0;

/// From the series start, third-order convergence needs one to three iterations.
const MOST_FAST: usize = 6;

/// Near a double root Newton's method halves the error per iteration until `g` is at rounding
/// level, after half the bits of the significand; before, the monotone approach takes up to about
/// ten. Double-double needs 53 + 10.
const MOST_MONOTONE: usize = 100;

struct Quartic<T> {
    c0: T,
    c1: T,
    c2: T,
    c3: T,
}

impl<T: Real> Quartic<T> {
    #[inline(always)]
    fn value(&self, k: T) -> T {
        let square = k * k;
        (self.c0 - self.c1 * k) + square * ((self.c2 - self.c3 * k) + square)
    }

    #[inline(always)]
    fn slope(&self, k: T) -> T {
        let (two, three, four) = (T::from_f64(2.0), T::from_f64(3.0), T::from_f64(4.0));
        ((two * self.c2) * k - self.c1) + (k * k) * (four * k - three * self.c3)
    }

    /// Half the second derivative.
    #[inline(always)]
    fn half_curvature(&self, k: T) -> T {
        let (three, six) = (T::from_f64(3.0), T::from_f64(6.0));
        self.c2 + k * (six * k - three * self.c3)
    }

    /// One step of Chebyshev's iteration (Newton's with a correction for the curvature: third
    /// order at the price of one division), and whether it has arrived in every lane.
    #[inline(always)]
    fn chebyshev(&self, k: T) -> (T, bool) {
        let per_slope = T::one() / self.slope(k);
        let newton = self.value(k) * per_slope;
        let bend = newton * (self.half_curvature(k) * per_slope);
        let next = (k - newton) - newton * bend;
        // The error left is about newton * bend^2; it must be below a rounding of the root.
        let left = bend * bend * newton;
        let allowed = next * T::from_f64(T::EPSILON);
        (next, (left * left - allowed * allowed).greatest() <= 0.0)
    }

    /// Newton steps that make the derivative parts of `k` exact; none for plain numbers.
    #[inline(always)]
    fn polished(&self, mut k: T) -> T {
        for _ in 0..T::ORDER {
            k -= self.value(k) / self.slope(k);
        }
        k
    }

    /// Newton's method from `c0/c1`, which is below the smallest root: the iterates rise to it and
    /// never pass it. A point with `g > 0` and `g' >= 0` on the way proves that there is no root.
    fn monotone(&self) -> Option<T> {
        let one = T::one();
        let mut k = self.c0 / self.c1;
        if !k.is_finite() {
            return None;
        }
        // Rounding of the sum in `value`, whose terms are up to about 2 c0 at a double root.
        let noise = T::from_f64(4.0 * T::EPSILON) * self.c0;
        for _ in 0..MOST_MONOTONE {
            let (value, slope) = (self.value(k), self.slope(k));
            // 1 in the lanes still on their way, 0 in those that have arrived.
            let active = (value - noise).where_positive(one);
            if active.greatest() <= 0.0 {
                return self.finished(k);
            }
            let descent = active * -slope + (one - active);
            let descends = descent.least() > 0.0;
            if !descends {
                return None;
            }
            k += active * (value / descent);
        }
        None
    }

    /// One more step where the slope is not itself rounding: it takes the last digits, and makes
    /// the derivative parts exact.
    fn finished(&self, mut k: T) -> Option<T> {
        let one = T::one();
        for _ in 0..=T::ORDER {
            let slope = self.slope(k);
            let threshold = T::from_f64(T::EPSILON.sqrt()) * self.c1;
            let steep = (-slope - threshold).where_positive(one);
            let safe = steep * slope - (one - steep);
            k -= steep * (self.value(k) / safe);
        }
        k.is_finite().then_some(k)
    }
}

/// The smallest root, in units of the body.
///
/// Inlined is the case of a moderate step, where one iteration from the series does.
#[inline(always)]
pub(super) fn kappa<T: Real>(body: &Poinsot<T>, a: T, e: T) -> Option<T> {
    let quartic = Quartic {
        c0: e + a * a,
        c1: body.s3 + body.s1 * a,
        c2: body.s2 + (a + a),
        c3: body.s1,
    };
    // First terms of the series of the root in c0/c1, and of 1/c1, without a division.
    let [per_s3, s1_per_s3, s2_per_s3_squared] = body.series;
    let z = s1_per_s3 * a;
    let y = s2_per_s3_squared * e;
    let start = (per_s3 * quartic.c0) * (y + (T::one() - z));
    let (k, arrived) = quartic.chebyshev(start);
    let small =
        (z - T::from_f64(SMALL)).greatest() <= 0.0 && (y - T::from_f64(SMALL)).greatest() <= 0.0;
    if small && arrived {
        Some(quartic.polished(k))
    } else {
        iterated(quartic, small.then_some(k))
    }
}

/// The root where one iteration does not do: more of them, or the monotone approach.
#[inline(never)]
fn iterated<T: Real>(quartic: Quartic<T>, start: Option<T>) -> Option<T> {
    if let Some(mut k) = start {
        for _ in 0..MOST_FAST {
            let arrived;
            (k, arrived) = quartic.chebyshev(k);
            if arrived {
                return Some(quartic.polished(k));
            }
        }
    }
    quartic.monotone()
}
