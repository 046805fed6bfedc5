//! Modes with closed forms.

use crate::systems::{Plane, Potential, Splitting, oscillators, pendulum};
use clebsch_analysis::{LinearError, Stability, linear};
use nalgebra::{DMatrix, DVector};

#[test]
fn oscillators_by_leapfrog() {
    let flow = Splitting::leapfrog(oscillators(3));
    let h = 0.3;
    let found = linear(&flow, &vec![0.0; 6], h, true).unwrap();
    assert_eq!(found.verdict.stability, Stability::SpectrallyStable);
    assert_eq!(found.limit_verdict.stability, Stability::SpectrallyStable);
    for k in 0..3 {
        let omega = (k + 1) as f64;
        // Modes are in order of frequency: -3, -2, -1, 1, 2, 3.
        let discrete = 2.0 / h * (omega * h / 2.0).asin();
        // A few roundings of multipliers of size one, over h.
        assert!(
            (found.modes[3 + k].frequency - discrete).abs() < 1e-13,
            "{:?}",
            found.modes[3 + k]
        );
        // Rounding of the tangent at the smallest step size of the table, about 0.003.
        assert!(
            (found.limit_modes[3 + k].frequency - omega).abs() < 1e-11,
            "{:?}",
            found.limit_modes[3 + k]
        );
        assert!(
            (found.limit_modes[3 + k].frequency - omega).abs() <= found.limit_modes[3 + k].error
        );
        // Mode k moves only coordinate k.
        let outside =
            |(i, x): (usize, &nalgebra::Complex<f64>)| if i % 3 == k { 0.0 } else { x.norm() };
        assert!(
            found.modes[3 + k]
                .vector
                .iter()
                .enumerate()
                .map(outside)
                .sum::<f64>()
                < 1e-13
        );
    }
    let truth = DMatrix::from_fn(6, 6, |i, j| {
        if i + 3 == j {
            1.0
        } else if j + 3 == i {
            -((i - 2) as f64).powi(2)
        } else {
            0.0
        }
    });
    assert!(
        (&found.generator - truth).amax() < 1e-11,
        "{}",
        found.generator
    );
}

#[test]
fn oscillator_by_symplectic_euler() {
    let flow = Splitting {
        potential: oscillators(1),
        leapfrog: false,
    };
    let found = linear(&flow, &vec![0.0; 2], 0.2, false).unwrap();
    // Symplectic Euler is conjugate to leapfrog: the same multipliers.
    assert!((found.modes[1].frequency - 2.0 / 0.2 * 0.1_f64.asin()).abs() < 1e-14);
    // The extrapolation in powers of h uses smaller step sizes than the one in powers of h^2.
    assert!(
        (found.limit_modes[1].frequency - 1.0).abs() < 1e-10,
        "{:?}",
        found.limit_modes
    );
    assert!((found.limit_modes[1].frequency - 1.0).abs() <= found.limit_modes[1].error);
}

#[test]
fn pendulum_upright_and_hanging() {
    let flow = Splitting::leapfrog(pendulum());
    let h = 0.1;
    let upright = linear(&flow, &vec![std::f64::consts::PI, 0.0], h, true).unwrap();
    assert_eq!(upright.verdict.stability, Stability::Unstable);
    assert_eq!(upright.limit_verdict.stability, Stability::Unstable);
    let product = upright.modes[0].eigenvalue * upright.modes[1].eigenvalue;
    assert!((product - 1.0).norm() < 1e-12, "{product}");
    assert!((upright.modes[0].growth - 2.0 / h * (h / 2.0).asinh()).abs() < 1e-13);
    assert!((upright.limit_modes[0].growth - 1.0).abs() < 1e-11);
    let hanging = linear(&flow, &vec![0.0, 0.0], h, true).unwrap();
    assert_eq!(hanging.verdict.stability, Stability::SpectrallyStable);
}

#[test]
fn a_large_step_is_unstable_where_the_limit_is_stable() {
    let flow = Splitting::leapfrog(oscillators(1));
    // Leapfrog is unstable for omega h > 2.
    let found = linear(&flow, &vec![0.0; 2], 2.5, true).unwrap();
    assert_eq!(found.verdict.stability, Stability::Unstable);
    assert_eq!(found.limit_verdict.stability, Stability::SpectrallyStable);
    assert!((found.limit_modes[1].frequency - 1.0).abs() < 1e-11);
}

#[test]
fn damping_attracts_and_drift_is_neutral() {
    let decay = Plane(|[x, y]: [f64; 2], h: f64| {
        let (a, b) = ((-h).exp(), (-2.0 * h).exp());
        Some(([x * a, y * b], [a, 0.0, 0.0, b]))
    });
    let found = linear(&decay, &[0.0, 0.0], 0.1, false).unwrap();
    assert_eq!(found.limit_verdict.stability, Stability::Attracting);
    assert_eq!(found.verdict.stability, Stability::Attracting);
    assert!((found.limit_modes[0].growth + 1.0).abs() < 1e-11);
    let free = Potential {
        dimension: 2,
        gradient: |_| DVector::zeros(2),
        hessian: |_| DMatrix::zeros(2, 2),
    };
    let found = linear(&Splitting::leapfrog(free), &vec![0.0; 4], 0.1, true).unwrap();
    assert_eq!(found.verdict.stability, Stability::SpectrallyStable);
    assert_eq!(found.limit_verdict.stability, Stability::SpectrallyStable);
}

#[test]
fn growth_at_the_size_of_rounding_is_undecided() {
    // The error of a multiplier of a 2 x 2 matrix is about 4 roundings: 1e-15.
    let verdict = |growth: f64| {
        let map = Plane(move |[x, y]: [f64; 2], h: f64| {
            Some((
                [x * (1.0 + growth * h), y],
                [1.0 + growth * h, 0.0, 0.0, 1.0],
            ))
        });
        linear(&map, &[0.0, 0.0], 1.0, false)
            .unwrap()
            .verdict
            .stability
    };
    assert_eq!(verdict(4e-15), Stability::Undecided);
    assert_eq!(verdict(1e-13), Stability::Unstable);
    assert_eq!(verdict(0.0), Stability::SpectrallyStable);
}

#[test]
fn a_wrong_claim_of_reversibility_shows_in_the_error() {
    let flow = Splitting {
        potential: oscillators(1),
        leapfrog: false,
    };
    let found = linear(&flow, &vec![0.0; 2], 0.2, true).unwrap();
    let truth = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -1.0, 0.0]);
    let error = (&found.generator - truth).amax();
    assert!(
        error > 1e-8 && error < 3.0 * found.generator_error,
        "{error} {}",
        found.generator_error
    );
}

#[test]
fn stiff_units() {
    // Frequencies 1e3 and 1e-3 in one system, and a tangent with entries from 1e-6 to 1e6 h.
    let potential = Potential {
        dimension: 2,
        gradient: |q| DVector::from_vec(vec![1e6 * q[0], 1e-6 * q[1]]),
        hessian: |_| DMatrix::from_diagonal(&vec![1e6, 1e-6].into()),
    };
    let found = linear(&Splitting::leapfrog(potential), &vec![0.0; 4], 1e-3, true).unwrap();
    let frequency: Vec<f64> = found
        .limit_modes
        .iter()
        .map(|mode| mode.frequency)
        .collect();
    // The fast mode determines the errors: 1e3 times 1e-12.
    assert!(
        (frequency[3] - 1e3).abs() < 1e-8 && (frequency[2] - 1e-3).abs() < 1e-8,
        "{frequency:?}"
    );
    assert_eq!(found.limit_verdict.stability, Stability::SpectrallyStable);
}

#[test]
fn states_that_move_are_refused() {
    let flow = Splitting::leapfrog(pendulum());
    let error = linear(&flow, &vec![1.0, 0.0], 0.1, true).unwrap_err();
    assert!(
        matches!(error, LinearError::NotFixed { displacement } if displacement > 0.05),
        "{error}"
    );
    let far = Plane(|[x, y]: [f64; 2], _| Some(([2.0 * x, y], [2.0, 0.0, 0.0, 1.0])));
    assert!(matches!(
        linear(&far, &[0.0, 0.0], 0.1, true),
        Err(LinearError::NoLimit { .. })
    ));
}
