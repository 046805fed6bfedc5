//! Relative equilibria with known verdicts.

use crate::bodies::{Body, Sphere};
use crate::systems::Line;
use clebsch_analysis::{Definiteness, EquilibriumError, Search, equilibrium};
use nalgebra::Vector3;

#[test]
fn axes_of_a_rigid_body() {
    let body = Body {
        inertia: [1.0, 2.0, 3.0],
        symmetric: false,
    };
    let verdicts = [
        Definiteness::Maximum,
        Definiteness::Saddle {
            negative: 1,
            positive: 1,
        },
        Definiteness::Minimum,
    ];
    for axis in 0..3 {
        let mut start = Vector3::new(0.1, -0.05, 0.08);
        start[axis] = 0.9;
        let found = equilibrium(&body, &start, &[0.5], 2.0, &Search::default()).unwrap();
        let mut truth = Vector3::zeros();
        truth[axis] = 1.0;
        // A residual of a few roundings, over the smallest difference of inverse inertias, 1/6.
        assert!((found.state - truth).norm() < 1e-14, "{:?}", found.state);
        // The multiplier is minus the angular velocity over the momentum.
        assert!((found.multipliers[0] + 1.0 / body.inertia[axis]).abs() < 1e-14);
        assert_eq!(found.variation.definiteness, verdicts[axis]);
        assert_eq!(found.variation.definiteness.is_definite(), axis != 1);
        let mut eigenvalues: Vec<f64> = (0..3)
            .filter(|&i| i != axis)
            .map(|i| 1.0 / body.inertia[i] - 1.0 / body.inertia[axis])
            .collect();
        eigenvalues.sort_by(f64::total_cmp);
        let pairs = eigenvalues.iter().zip(&found.variation.eigenvalues);
        assert!(
            pairs.clone().count() == 2 && pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-13)
        );
        assert!((found.energy - 0.5 / body.inertia[axis]).abs() < 1e-14);
    }
}

#[test]
fn equator_of_a_symmetric_body() {
    // All directions on the equator are equilibria. They are one orbit of rotations about the axis.
    for symmetric in [false, true] {
        let body = Body {
            inertia: [1.0, 1.0, 3.0],
            symmetric,
        };
        let start = Vector3::new(0.5, 0.8, 0.2);
        let found = equilibrium(&body, &start, &[0.5], 1.0, &Search::default()).unwrap();
        assert!(found.state.z.abs() < 1e-14 && (found.state.norm() - 1.0).abs() < 1e-14);
        // Steps of least norm do not turn along the equator, up to a rounding over the threshold 1e-9 of the rank.
        assert!((found.state.y / found.state.x - 1.6).abs() < 1e-6);
        let (verdict, null) = match symmetric {
            true => (Definiteness::Maximum, 1),
            false => (
                Definiteness::Degenerate {
                    null: 1,
                    negative: 1,
                    positive: 0,
                },
                0,
            ),
        };
        assert_eq!(
            (found.variation.definiteness, found.variation.symmetric),
            (verdict, null)
        );
    }
}

#[test]
fn units_of_energy_do_not_matter() {
    for scale in [1e-15, 1e15] {
        let body = Body {
            inertia: [scale, 2.0 * scale, 3.0 * scale],
            symmetric: false,
        };
        let found = equilibrium(
            &body,
            &Vector3::new(0.1, 0.9, 0.2),
            &[0.5],
            2.0 * scale,
            &Search::default(),
        )
        .unwrap();
        assert!(
            (found.state - Vector3::y()).norm() < 1e-14,
            "{:?}",
            found.state
        );
        assert!(
            (found.multipliers[0] * scale + 0.5).abs() < 1e-14
                && (found.energy * scale - 0.25).abs() < 1e-14
        );
        assert!((found.variation.eigenvalues[1] * scale - 0.5).abs() < 1e-14);
        assert_eq!(found.variation.negative, 1);
    }
}

#[test]
fn a_manifold_without_conserved_quantities() {
    let cases = [
        (Vector3::new(0.9, 0.1, 0.1), Definiteness::Maximum),
        (
            Vector3::new(0.1, 0.9, 0.1),
            Definiteness::Saddle {
                negative: 1,
                positive: 1,
            },
        ),
        (Vector3::new(0.1, 0.1, 0.9), Definiteness::Minimum),
    ];
    for (start, verdict) in cases {
        let found = equilibrium(&Sphere, &start.normalize(), &[], 0.0, &Search::default()).unwrap();
        assert_eq!(found.variation.definiteness, verdict);
        assert!(
            found.residual < 1e-15 && found.iterations <= 6,
            "{} {}",
            found.residual,
            found.iterations
        );
        assert!((found.state.amax() - 1.0).abs() < 1e-15);
    }
}

#[test]
fn values_that_cannot_be_reached() {
    let body = Body {
        inertia: [1.0, 2.0, 3.0],
        symmetric: false,
    };
    let start = Vector3::new(0.3, 0.4, 0.5);
    let error = equilibrium(&body, &start, &[-0.5], 2.0, &Search::default()).unwrap_err();
    let EquilibriumError::NoConvergence {
        residual, stopped, ..
    } = &error
    else {
        panic!("{error}")
    };
    // |m|^2 / 2 + 1/2 is at least 1/2, in units of the gradient at the start: sqrt(1/2).
    assert!(*residual >= 0.5 && stopped.len() == 3, "{error}");
}

#[test]
fn damping_where_full_steps_diverge() {
    // Newton's method for arctan x = 0 diverges from |x| > 1.4.
    let energy = Line(|x: f64, _: f64| Some([0.0, x.atan(), 1.0 / (1.0 + x * x), 0.0]));
    let found = equilibrium(&energy, &10.0, &[], 0.0, &Search::default()).unwrap();
    assert!(found.state.abs() < 1e-15 && found.variation.definiteness == Definiteness::Minimum);
    // A trial state without an energy shortens the step as well.
    let energy = Line(|x: f64, _: f64| (x > 0.0).then(|| [0.0, 1.0 - 1.0 / x, 1.0 / (x * x), 0.0]));
    let found = equilibrium(&energy, &30.0, &[], 0.0, &Search::default()).unwrap();
    assert!((found.state - 1.0).abs() < 1e-15, "{}", found.state);
}
