//! Periodic orbits with known periods and multipliers.

use crate::systems::{Plane, Potential, Splitting, henon_heiles, pendulum};
use clebsch_analysis::{OrbitError, Search, orbit};
use nalgebra::{Complex, DMatrix, DVector};
use std::f64::consts::PI;

/// The period of the pendulum with amplitude a: 2 pi / agm(1, cos(a / 2)).
fn period(amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0_f64, (amplitude / 2.0).cos());
    while (a - b).abs() > 1e-15 {
        (a, b) = ((a + b) / 2.0, (a * b).sqrt());
    }
    2.0 * PI / a
}

#[test]
fn pendulum_with_a_period_by_elliptic_integrals() {
    let flow = Splitting::leapfrog(pendulum());
    let amplitude = 1.5_f64;
    let mut errors = Vec::new();
    for steps in [64, 128, 256] {
        let h = period(amplitude) / steps as f64;
        let found = orbit(&flow, &vec![1.4, 0.1], h, steps, &Search::default()).unwrap();
        // Steps of least norm do not fix the phase. The energy gives the amplitude up to the error of the method.
        let energy = found.state[1].powi(2) / 2.0 - found.state[0].cos();
        errors.push((-energy).acos() - amplitude);
        assert!(
            found.residual < 1e-14 && found.iterations < 10,
            "{} {}",
            found.residual,
            found.iterations
        );
        assert!(found.pairing_defect < 1e-12, "{}", found.pairing_defect);
        // Both multipliers are 1, with the square root of the rounding.
        for (value, error) in found.floquet.values.iter().zip(&found.floquet.errors) {
            assert!(
                (value - 1.0).norm() < 1e-6 && (value - 1.0).norm() <= *error,
                "{value} {error}"
            );
        }
    }
    // Second order: about a quarter of the error for half the step. The phase also changes the energy a little.
    assert!(errors[0].abs() < 0.01, "{errors:?}");
    assert!(
        errors
            .windows(2)
            .all(|pair| (3.0..5.0).contains(&(pair[0] / pair[1]))),
        "{errors:?}"
    );
}

#[test]
fn hyperbolic_orbit_of_henon_and_heiles() {
    let flow = Splitting::leapfrog(henon_heiles());
    let (period, steps) = (6.6, 128);
    let found = orbit(
        &flow,
        &vec![0.3, 0.0, 0.0, 0.1],
        period / steps as f64,
        steps,
        &Search::default(),
    )
    .unwrap();
    let mu = &found.floquet.values;
    assert!(
        mu[0].re > 1.5 && mu[0].im == 0.0 && found.size > 0.5,
        "{mu:?}"
    );
    assert!(
        (mu[0] * mu[3] - 1.0).norm() < 1e-11 && found.pairing_defect < 1e-11,
        "{mu:?}"
    );
    // The same orbit six times: the multipliers to the sixth power, 12.7 and its inverse.
    let again = orbit(
        &flow,
        &found.state,
        period / steps as f64,
        6 * steps,
        &Search::default(),
    )
    .unwrap();
    let powers = &again.floquet.values;
    assert!(
        (powers[0] / mu[0].powi(6) - 1.0).norm() < 1e-11,
        "{powers:?}"
    );
    assert!(
        (powers[0] * powers[3] - 1.0).norm() < 1e-11 && again.pairing_defect < 1e-11,
        "{powers:?}"
    );
    assert!(again.iterations <= 1);
}

#[test]
fn elliptic_orbit_of_henon_and_heiles() {
    let flow = Splitting::leapfrog(henon_heiles());
    let found = orbit(
        &flow,
        &vec![0.0, 0.3, 0.0, 0.0],
        6.6 / 128.0,
        128,
        &Search::default(),
    )
    .unwrap();
    let on_circle = |x: &&Complex<f64>| x.im.abs() > 0.1 && (x.norm() - 1.0).abs() < 1e-12;
    assert_eq!(found.floquet.values.iter().filter(on_circle).count(), 2);
    assert!(found.pairing_defect < 1e-11);
    // The orbit lies in the symmetry plane x = 0.
    assert!(found.state[0].abs() < 1e-12 && found.state[2].abs() < 1e-12);
}

/// V = |q|^4 / 4, with rotations as symmetry.
fn quartic() -> Potential {
    Potential {
        dimension: 2,
        gradient: |q| (q[0] * q[0] + q[1] * q[1]) * DVector::from_column_slice(q),
        hessian: |q| {
            let v = DVector::from_column_slice(q);
            2.0 * &v * v.transpose() + v.norm_squared() * DMatrix::identity(2, 2)
        },
    }
}

#[test]
fn circular_orbit_with_phase_and_rotation_as_symmetries() {
    let flow = Splitting::leapfrog(quartic());
    // A circle of radius r has the frequency r. Leapfrog turns it by 2 asin(r h / 2) in a step.
    let (steps, radius) = (100, 1.2);
    let h = 2.0 / radius * (PI / steps as f64).sin();
    let found = orbit(
        &flow,
        &vec![1.21, 0.0, 0.02, 1.43],
        h,
        steps,
        &Search::default(),
    )
    .unwrap();
    let r = found.state[0].hypot(found.state[1]);
    // Orbits of one period include ellipses near the circle, so that only the residual is exact.
    assert!(
        found.residual < 1e-13 && (r - radius).abs() < 0.1,
        "{found:?}"
    );
    assert!(found.pairing_defect < 1e-11);
}

#[test]
fn large_coordinates() {
    // The frequency is the radius over 1e7.
    let potential = Potential {
        dimension: 2,
        gradient: |q| 1e-14 * (q[0] * q[0] + q[1] * q[1]) * DVector::from_column_slice(q),
        hessian: |q| {
            let v = DVector::from_column_slice(q);
            1e-14 * (2.0 * &v * v.transpose() + v.norm_squared() * DMatrix::identity(2, 2))
        },
    };
    let h = 2.0 / 1.2 * (PI / 100.0).sin();
    let start = vec![1.21e7, 0.0, 2e5, 1.43e7];
    let found = orbit(
        &Splitting::leapfrog(potential),
        &start,
        h,
        100,
        &Search::default(),
    )
    .unwrap();
    // Rounding of coordinates of size 1e7.
    assert!(
        found.residual < 1e-6 && found.residual > 0.0,
        "{}",
        found.residual
    );
}

#[test]
fn an_equilibrium_has_size_zero() {
    let flow = Splitting::leapfrog(pendulum());
    let found = orbit(&flow, &vec![0.1, 0.0], 0.1, 30, &Search::default()).unwrap();
    assert!(found.size < 1e-12, "{}", found.size);
}

#[test]
fn a_flow_without_periodic_orbits() {
    let drift = Plane(|[x, y]: [f64; 2], h: f64| {
        Some(([x + h * (1.0 + y * y), y], [1.0, 2.0 * h * y, 0.0, 1.0]))
    });
    let error = orbit(&drift, &[0.0, 0.5], 0.1, 10, &Search::default()).unwrap_err();
    // The residual h n (1 + y^2) is at least 1, and the search moves towards y = 0.
    assert!(
        matches!(&error, OrbitError::NoConvergence { residual, stopped, .. } if *residual >= 1.0 && stopped.len() == 2)
    );
    let ends =
        Plane(|[x, y]: [f64; 2], h: f64| (x < 0.45).then_some(([x + h, y], [1.0, 0.0, 0.0, 1.0])));
    let error = orbit(&ends, &[0.0, 0.5], 0.1, 10, &Search::default()).unwrap_err();
    assert!(matches!(error, OrbitError::Step { step: 5, .. }), "{error}");
}
