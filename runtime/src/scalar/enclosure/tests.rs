//! Bounds of functions of several variables: every value lies within, rounding included, and they are not too wide.

use super::*;

type E = Enclosure<2>;

/// A function with every operation, on any scalar.
fn sample<T: Real>(x: T, y: T) -> T {
    let root = (T::from_f64(3.0) + x * y).sqrt();
    let wave = (x + y).sin() * (x - y).cos();
    let grown = (x * T::from_f64(0.5)).exp() + (T::from_f64(2.0) + y).ln();
    let flat = (x * y).tanh() + y.cosh() - x.sinh() + (x + T::from_f64(0.05)).abs();
    (root - wave) / (T::from_f64(2.0) + grown) + x.powi(3) * flat - y.powr(1, 1)
}

#[test]
fn every_value_lies_within_the_bounds() {
    for radius in [0.3, 0.1, 0.01, 1e-6] {
        for (a, b) in [(0.2, -0.1), (-0.4, 0.3), (0.0, 0.0)] {
            let moved = |x: f64, i| E::exactly(x) + E::variable(radius, i);
            let all = sample(moved(a, 0), moved(b, 1));
            let mut width = 0.0_f64;
            for i in -8..=8_i32 {
                for j in -8..=8_i32 {
                    if i * i + j * j > 64 {
                        continue;
                    }
                    let (s, t) = (f64::from(i) / 8.0, f64::from(j) / 8.0);
                    let value = sample(a + radius * s, b + radius * t);
                    assert!(all.least() <= value && value <= all.greatest());
                    let affine = all.middle() + s * all.along(0) + t * all.along(1);
                    assert!((value - affine).abs() <= all.rest() * (1.0 + 1e-12));
                    width = width.max((value - all.middle()).abs());
                }
            }
            // The bounds are worth something: the remainder is of second order.
            assert!(all.rest() < 12.0 * radius * radius + 1e-15);
            assert!(width > 0.05 * radius);
        }
    }
}

#[test]
fn rounding_is_bounded_and_not_by_much_too_much() {
    use crate::DoubleDouble;
    for i in 0..200 {
        let (x, y) = (0.31 * f64::from(i).sin(), 0.4 * f64::from(i).cos());
        let bound = sample(E::exactly(x), E::exactly(y));
        let exact = sample(DoubleDouble::from_f64(x), DoubleDouble::from_f64(y));
        let plain = sample(x, y);
        let error = (exact - DoubleDouble::from_f64(plain)).value().abs();
        assert!(error <= bound.rest(), "{error} {}", bound.rest());
        assert!(bound.rest() < 1e-14);
    }
}

#[test]
fn what_is_not_known_is_kept_from_what_moves() {
    for (spread, radius) in [(0.2, 0.1), (0.05, 0.2), (0.2, 1e-6), (1e-9, 0.1)] {
        let (a, b) = (E::around(0.2, spread), E::exactly(-0.1));
        let all = sample(a, b + E::variable(radius, 1));
        let moves = all.along(1).abs() + all.rest();
        for i in -8..=8_i32 {
            let x = 0.2 + spread * f64::from(i) / 8.0;
            let at_rest = sample(x, -0.1);
            assert!((at_rest - all.middle()).abs() <= all.still() * (1.0 + 1e-12) + 1e-15);
            for j in -8..=8_i32 {
                let value = sample(x, -0.1 + radius * f64::from(j) / 8.0);
                assert!(
                    (value - at_rest).abs() <= moves * (1.0 + 1e-12),
                    "{spread} {radius}"
                );
                assert!(all.least() <= value && value <= all.greatest());
            }
        }
        // As small as the move, however much is not known.
        assert!(moves < 12.0 * radius, "{spread} {radius}: {moves}");
    }
}

#[test]
fn what_may_vanish_bounds_nothing() {
    let x = E::variable(1.0, 0);
    for bad in [E::one() / x, x.sqrt(), x.ln(), E::one() / E::zero()] {
        assert!(!bad.is_finite() && bad.least().is_nan() && bad.greatest().is_nan());
    }
    assert!(E::zero().sqrt().is_zero());
}

#[test]
fn what_moves_is_multiplied_by_what_is_not_known() {
    // Neither has a middle: all that a factor moves the product by is the other one, which is not known.
    for (a, b) in [
        (E::around(0.0, 0.5), E::variable(1.0, 1)),
        (E::variable(1.0, 1), E::around(0.0, 0.5)),
    ] {
        let product = a * b;
        assert!(product.rest() >= 0.5, "{}", product.rest());
        assert!(product.least() <= -0.5 && product.greatest() >= 0.5);
    }
}
