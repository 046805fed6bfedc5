//! Exponents with known values.

use crate::systems::{Plane, Undefined};
use clebsch_analysis::{Flow, LyapunovError, lyapunov};

type Image = Option<([f64; 2], [f64; 4])>;

/// The standard map of Chirikov with kicks of strength k.
fn standard(k: f64) -> Plane<impl Fn([f64; 2], f64) -> Image> {
    Plane(move |[q, p]: [f64; 2], _| {
        let kicked = p + k * q.sin();
        let c = k * q.cos();
        Some((
            [
                (q + kicked) % std::f64::consts::TAU,
                kicked % std::f64::consts::TAU,
            ],
            [1.0 + c, 1.0, c, 1.0],
        ))
    })
}

#[test]
fn standard_map_far_in_chaos() {
    let found = lyapunov(&standard(10.0), &[0.3, 0.7], 1.0, 100_000, 2).unwrap();
    // ln(K / 2) = 1.609 for large K (Chirikov, Physics Reports 52, 1979); published numbers at K = 10 are near 1.62.
    assert!(
        (found.exponents[0] - 1.62).abs() < 0.02,
        "{:?}",
        found.exponents
    );
    // The map keeps area. 1e5 logarithms of size 2 with a rounding of 1e-16 each.
    assert!(
        (found.exponents[0] + found.exponents[1]).abs() < 1e-12,
        "{:?}",
        found.exponents
    );
    // Independent logarithms have a spread of order one: 1e5 of them give an error of about 0.003.
    assert!(
        found.errors[0] > 5e-4 && found.errors[0] < 0.01,
        "{:?}",
        found.errors
    );
    assert!(
        found.estimates.len() == 200
            && found.estimates.last().unwrap().exponents == found.exponents
    );
}

#[test]
fn standard_map_without_kicks_is_not_chaotic() {
    let found = lyapunov(&standard(0.0), &[0.3, 0.7], 1.0, 20_000, 2).unwrap();
    // The tangent is a shear, which grows like the number of steps: ln(2e4) / 2e4 = 5e-4.
    assert!(found.exponents[0].abs() < 6e-4, "{:?}", found.exponents);
}

#[test]
fn henon_map() {
    let (a, b) = (1.4, 0.3);
    let map = Plane(|[x, y]: [f64; 2], _| {
        Some(([1.0 - a * x * x + y, b * x], [-2.0 * a * x, 1.0, b, 0.0]))
    });
    let found = lyapunov(&map, &[0.1, 0.1], 1.0, 200_000, 2).unwrap();
    // Published: 0.4192. The standard error at 2e5 steps is about 0.001.
    assert!(
        (found.exponents[0] - 0.4192).abs() < 0.004,
        "{:?}",
        found.exponents
    );
    // The determinant of every tangent is -b.
    assert!(
        (found.exponents[0] + found.exponents[1] - b.ln()).abs() < 1e-12,
        "{:?}",
        found.exponents
    );
    assert!(found.errors[0] < 0.003, "{:?}", found.errors);
}

#[test]
fn exponents_are_per_unit_of_time() {
    let map = Plane(|[x, y]: [f64; 2], h: f64| {
        let (up, down) = ((0.5 * h).exp(), (-2.0 * h).exp());
        Some(([x * up, y * down], [up, 0.0, 0.0, down]))
    });
    for h in [0.01, 0.1, -0.1] {
        let found = lyapunov(&map, &[0.0, 0.0], h, 1000, 2).unwrap();
        // A thousand exponentials and logarithms, each with a rounding of 1e-16 / h.
        assert!(
            (found.exponents[0] - 0.5).abs() < 1e-12 && (found.exponents[1] + 2.0).abs() < 1e-12
        );
        assert!(found.errors[0] < 1e-12);
    }
}

#[test]
fn singular_tangents_and_failed_steps_are_named() {
    let flat = Plane(|[x, _]: [f64; 2], _| Some(([x, 0.0], [1.0, 0.0, 0.0, 0.0])));
    let error = lyapunov(&flat, &[0.0, 0.0], 1.0, 10, 2).unwrap_err();
    assert_eq!(
        error,
        LyapunovError::Collapsed {
            step: 0,
            exponent: 1
        }
    );
    assert!(lyapunov(&flat, &[0.0, 0.0], 1.0, 10, 1).is_ok());
    let ends =
        Plane(|[x, y]: [f64; 2], _| (x < 3.0).then_some(([x + 1.0, y], [1.0, 0.0, 0.0, 1.0])));
    let error = lyapunov(&ends, &[0.0, 0.0], 1.0, 10, 1).unwrap_err();
    assert_eq!(
        error,
        LyapunovError::Step {
            step: 3,
            source: Undefined
        }
    );
    assert!(error.to_string().starts_with("Step 3"), "{error}");
    assert_eq!(ends.dimension(), 2);
}
