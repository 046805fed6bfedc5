//! Bounds of rounding: they hold, and are not too wide.

use super::*;

/// A function with every operation, on any scalar.
fn sample<T: Real>(x: T, y: T) -> T {
    let root = (T::from_f64(3.0) + x * y).sqrt();
    let wave = (x + y).sin() * (x - y).cos();
    let grown = (x * T::from_f64(0.5)).exp() + (T::from_f64(2.0) + y).ln();
    let flat = (x * y).tanh() + y.cosh() - x.sinh() + (x + T::from_f64(0.05)).abs();
    (root - wave) / (T::from_f64(2.0) + grown) + x.powi(3) * flat - y.powr(1, 1)
}

#[test]
fn rounding_is_bounded_and_not_by_much_too_much() {
    use crate::DoubleDouble;
    for i in 0..200 {
        let (x, y) = (0.31 * f64::from(i).sin(), 0.4 * f64::from(i).cos());
        let bound = sample(Rounded::exactly(x), Rounded::exactly(y));
        let exact = sample(DoubleDouble::from_f64(x), DoubleDouble::from_f64(y));
        let plain = sample(x, y);
        let error = (exact - DoubleDouble::from_f64(plain)).value().abs();
        assert!(error <= bound.error(), "{error} {}", bound.error());
        assert!(bound.error() < 1e-14);
    }
}

/// If arguments move within their bounds, the value moves within its own bound.
#[test]
fn rounded_arguments_move_the_value_within_its_bounds() {
    for radius in [0.1, 0.01, 1e-6] {
        for (a, b) in [(0.2, -0.1), (-0.4, 0.3), (0.0, 0.0)] {
            let moved = |value: f64| Rounded {
                value,
                error: radius,
            };
            let all = sample(moved(a), moved(b));
            let mut width = 0.0_f64;
            for i in -8..=8_i32 {
                for j in -8..=8_i32 {
                    let (s, t) = (f64::from(i) / 8.0, f64::from(j) / 8.0);
                    let value = sample(a + radius * s, b + radius * t);
                    assert!(all.least() <= value && value <= all.greatest());
                    width = width.max((value - all.value()).abs());
                }
            }
            assert!(width > 0.05 * radius && all.error() < 12.0 * radius);
        }
    }
}

#[test]
fn what_may_vanish_bounds_nothing() {
    let x = Rounded {
        value: 0.0,
        error: 1.0,
    };
    let zero = Rounded::zero();
    for bad in [Rounded::one() / x, x.sqrt(), x.ln(), Rounded::one() / zero] {
        assert!(!bad.is_finite() && bad.least().is_nan() && bad.greatest().is_nan());
    }
    assert!(zero.sqrt().is_zero());
}
