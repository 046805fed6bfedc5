//! B-splines of a uniform grid within one interval: the values and slopes of all splines that do not vanish there.
//! Takes the position in the interval, from 0 to 1. The values add up to 1, the slopes to 0. Cubic splines have two
//! continuous derivatives, quintic splines four.

use crate::Real;

/// The splines whose support covers an interval: `K = 4` cubic ones, `K = 6` quintic ones, in the order of their
/// nodes, the first of which is `K/2 - 1` nodes before the interval.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Splines<const K: usize>;

/// Values and slopes of the splines of an interval.
pub(super) trait Basis<const K: usize>: Copy + Send + Sync {
    /// The value of each spline.
    fn values<T: Real>(fraction: T) -> [T; K];

    /// The derivative of each spline with respect to the position, per interval.
    fn slopes<T: Real>(fraction: T) -> [T; K];
}

impl Basis<4> for Splines<4> {
    #[inline(always)]
    fn values<T: Real>(f: T) -> [T; 4] {
        let g = T::one() - f;
        let (half, sixth, middle) = (ratio::<T>(1, 2), ratio::<T>(1, 6), ratio::<T>(2, 3));
        let (ff, gg) = (f * f, g * g);
        [
            gg * g * sixth,
            middle - ff + ff * f * half,
            middle - gg + gg * g * half,
            ff * f * sixth,
        ]
    }

    #[inline(always)]
    fn slopes<T: Real>(f: T) -> [T; 4] {
        let g = T::one() - f;
        let (half, three, two) = (ratio::<T>(1, 2), ratio::<T>(3, 2), ratio::<T>(2, 1));
        [
            -(g * g * half),
            f * (three * f - two),
            g * (two - three * g),
            f * f * half,
        ]
    }
}

impl Basis<6> for Splines<6> {
    #[inline(always)]
    fn values<T: Real>(f: T) -> [T; 6] {
        let g = T::one() - f;
        [outer(g), middle(g), inner(f), inner(g), middle(f), outer(f)]
    }

    #[inline(always)]
    fn slopes<T: Real>(f: T) -> [T; 6] {
        let g = T::one() - f;
        [
            -outer_slope(g),
            -middle_slope(g),
            inner_slope(f),
            -inner_slope(g),
            middle_slope(f),
            outer_slope(f),
        ]
    }
}

/// A constant, rounded once.
#[inline(always)]
fn ratio<T: Real>(num: i64, den: i64) -> T {
    T::from_ratio(num, den)
}

/// The quintic spline near its end: x^5 / 120.
#[inline(always)]
fn outer<T: Real>(x: T) -> T {
    let square = x * x;
    square * square * x * ratio::<T>(1, 120)
}

#[inline(always)]
fn outer_slope<T: Real>(x: T) -> T {
    let square = x * x;
    square * square * ratio::<T>(1, 24)
}

/// Its second piece: (1 + 5x + 10x² + 10x³ + 5x⁴ - 5x⁵) / 120.
#[inline(always)]
fn middle<T: Real>(x: T) -> T {
    let (five, ten) = (ratio::<T>(5, 1), ratio::<T>(10, 1));
    let inner = five + x * (ten + x * (ten + x * (five - x * five)));
    (T::one() + x * inner) * ratio::<T>(1, 120)
}

#[inline(always)]
fn middle_slope<T: Real>(x: T) -> T {
    let (four, six, five) = (ratio::<T>(4, 1), ratio::<T>(6, 1), ratio::<T>(5, 1));
    let inner = four + x * (six + x * (four - x * five));
    (T::one() + x * inner) * ratio::<T>(1, 24)
}

/// Its third piece, from the middle outwards: (66 - 60x² + 30x⁴ - 10x⁵) / 120.
#[inline(always)]
fn inner<T: Real>(x: T) -> T {
    let square = x * x;
    let rest = ratio::<T>(6, 1) - square * (ratio::<T>(3, 1) - x);
    (ratio::<T>(66, 10) - square * rest) * ratio::<T>(1, 12)
}

#[inline(always)]
fn inner_slope<T: Real>(x: T) -> T {
    let square = x * x;
    x * (square * (ratio::<T>(12, 1) - x * ratio::<T>(5, 1)) - ratio::<T>(12, 1))
        * ratio::<T>(1, 12)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;

    /// The B-spline of degree `p` with integer knots, centred at 0, by the recursion of Cox and de Boor.
    fn spline(p: usize, x: f64) -> f64 {
        if p == 0 {
            return f64::from((-0.5..0.5).contains(&x));
        }
        let half = (p as f64 + 1.0) / 2.0;
        ((half + x) * spline(p - 1, x + 0.5) + (half - x) * spline(p - 1, x - 0.5)) / p as f64
    }

    fn compare<const K: usize>()
    where
        Splines<K>: Basis<K>,
    {
        for i in 0..=64 {
            let f = f64::from(i) / 64.0;
            let values = Splines::<K>::values(Dual::<1>::variable(f, 0));
            let slopes = Splines::<K>::slopes(f);
            for k in 0..K {
                let from_node = f + K as f64 / 2.0 - 1.0 - k as f64;
                assert!((values[k].real - spline(K - 1, from_node)).abs() < 3e-16);
                assert!((values[k].dual[0] - slopes[k]).abs() < 4e-16);
            }
            assert!((values.iter().map(|v| v.real).sum::<f64>() - 1.0).abs() < 4e-16);
            assert!(slopes.iter().sum::<f64>().abs() < 4e-16);
        }
    }

    #[test]
    fn pieces_are_those_of_the_recursion_with_their_derivatives() {
        compare::<4>();
        compare::<6>();
    }
}
