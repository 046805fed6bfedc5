//! The largest of some numbers; the result is NaN if any number is. `f64::max` ignores a NaN, so a
//! maximum of residuals would accept a failed solution. Every test of smallness therefore folds by
//! [`larger`].

use super::Real;

/// The larger of two numbers; NaN if either is.
#[inline(always)]
#[must_use]
pub fn larger(a: f64, b: f64) -> f64 {
    // If `a` is NaN, both tests are false and the result is `a`.
    if b > a || b.is_nan() { b } else { a }
}

/// The largest absolute value, zero for an empty list; NaN if any value is NaN.
#[inline]
#[must_use]
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(f64::abs).fold(0.0, larger)
}

/// The greater of two numbers in each lane, by their real parts; NaN if the second number is NaN.
#[inline]
#[must_use]
pub fn greater<T: Real>(a: T, b: T) -> T {
    let one = T::one();
    let mask = (a - b).where_positive(one);
    mask.where_positive(a) + (one - mask).where_positive(b)
}

#[cfg(test)]
mod tests {
    use super::{greater, larger, largest};

    #[test]
    fn the_greater_is_one_of_both() {
        for [a, b] in [
            [1.0, 2.0],
            [2.0, 1.0],
            [0.0, f64::INFINITY],
            [f64::INFINITY; 2],
        ] {
            assert_eq!(greater(a, b), larger(a, b));
        }
        assert!(greater(2.0, f64::NAN).is_nan());
    }

    #[test]
    fn nan_wins_wherever_it_stands() {
        assert_eq!(larger(1.0, 2.0), 2.0);
        assert_eq!(larger(2.0, 1.0), 2.0);
        assert!(larger(f64::NAN, 2.0).is_nan());
        assert!(larger(2.0, f64::NAN).is_nan());
        for place in 0..3 {
            let mut values = [1.0, -5.0, f64::INFINITY];
            assert_eq!(largest(values), f64::INFINITY);
            values[place] = f64::NAN;
            assert!(largest(values).is_nan(), "{place}");
        }
        assert_eq!(largest([]), 0.0);
    }
}
