//! The forced Moser-Veselov solver: residual up to the bound, failure beyond it, special bodies.

use super::common::{Random, body, quaternion_newton, residual};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::solvers::moser_veselov::{forced, largest_step, reach};
use clebsch::{Poinsot, PoinsotError, Rotation};

/// Relative to the trace of `I`: a dozen rounding errors of products of that size; measured 1.5e-15.
const RESIDUAL: f64 = 4e-15;

#[test]
fn residual_is_rounding_up_to_the_bound_and_nothing_is_accepted_beyond() {
    let mut random = Random(1);
    let mut worst: f64 = 0.0;
    let mut least_scalar_part: f64 = 1.0;
    for case in 0..2000 {
        let j = random.poinsot(case);
        let body = Poinsot::new(j).expect("a body");
        let direction = random.vector();
        let at_bound = direction / reach(&body, &direction);
        for fraction in [1e-9, 0.01, 0.1, 0.3, 0.5, 0.9, 0.99, 0.999_999] {
            let h_n = at_bound * fraction;
            let omega = forced(&body, &h_n).unwrap_or_else(|error| {
                panic!("case {case}, fraction {fraction}: {error}");
            });
            worst = worst.max(residual(&j, &omega, &h_n) / body.inertia().trace());
            least_scalar_part = least_scalar_part.min(omega.quaternion()[0]);
        }
        for fraction in [1.000_001, 1.001, 2.0, 1e6] {
            let h_n = at_bound * fraction;
            let error = forced(&body, &h_n).expect_err("beyond the bound");
            assert!((error.ratio / fraction - 1.0).abs() < 1e-12);
            let loads = Vector3::from_fn(|i, _| (h_n[i] / body.inertia()[(i, i)]).abs());
            assert_eq!(error.component, loads.imax());
        }
    }
    assert!(worst <= RESIDUAL, "{worst:e}");
    // On the principal branch, the rotation angle is less than pi.
    assert!(least_scalar_part > 0.4, "{least_scalar_part}");
}

#[test]
fn an_independent_newton_finds_the_same_root() {
    let mut random = Random(2);
    for case in 0..500 {
        let j = random.poinsot(case);
        let body = Poinsot::new(j).expect("a body");
        let direction = random.vector();
        let h_n = direction * (0.9 * random.unit() / reach(&body, &direction));
        let [_, x, y, z] = forced(&body, &h_n).expect("solvable").quaternion();
        let difference = Vector3::new(x, y, z) - quaternion_newton(&j, &h_n);
        // At 0.9 of the bound, the condition number of the root costs one digit.
        assert!(difference.norm() < 2e-14, "case {case}: {difference}");
    }
}

#[test]
fn rotation_about_a_principal_axis_has_a_closed_form() {
    for moments in [
        [2.0, 2.0, 1.0],
        [3.5, 2.5, 2.0],
        [1.0, 2.0, 3.0],
        [5.0, 4.0, 3.0],
    ] {
        let body = body(moments, Vector3::zeros());
        for axis in 0..3 {
            for h_m in [1e-8, 0.1, 0.5, 0.9, 0.99] {
                let mut h_n = Vector3::zeros();
                h_n[axis] = h_m * moments[axis];
                // I sin(theta) = h m.
                let expected = (h_m.asin() / 2.0).sin();
                let q = forced(&body, &h_n).expect("solvable").quaternion();
                // Two rounding errors times the condition number of the arc sine.
                let allowed = 4e-16 / (1.0 - h_m * h_m).sqrt();
                assert!(
                    (q[axis + 1] - expected).abs() < allowed,
                    "{moments:?} {axis} {h_m}"
                );
            }
            let mut h_n = Vector3::zeros();
            h_n[axis] = moments[axis] * 1.000_001;
            let error = forced(&body, &h_n).expect_err("more than a right angle");
            assert!((error.ratio - 1.000_001).abs() < 1e-12);
            assert_eq!(error.component, axis);
        }
    }
}

#[test]
fn flat_and_symmetric_bodies_work() {
    for j in [
        [2.0, 1.0, 0.0],
        [0.0, 1.0, 2.0],
        [1.0, 1.0, 0.0],
        [1.0, 1.0, 1.0],
        [1.0, 1e-12, 0.0],
    ] {
        let j = Matrix3::from_diagonal(&Vector3::from(j));
        let body = Poinsot::new(j).expect("a body");
        let direction = Vector3::new(0.2, -0.3, 0.4);
        for fraction in [0.1, 0.5, 0.999_999] {
            let h_n = direction * (fraction / reach(&body, &direction));
            let omega = forced(&body, &h_n).expect("solvable");
            assert!(residual(&j, &omega, &h_n) <= RESIDUAL * body.inertia().trace());
        }
    }
}

#[test]
fn units_do_not_matter() {
    let j = Matrix3::from_diagonal(&Vector3::new(0.5, 1.5, 2.0));
    let h_n = Vector3::new(0.3, -0.2, 0.4);
    let expected = forced(&Poinsot::new(j).expect("a body"), &h_n).expect("solvable");
    for exponent in [-900, -300, -60, 60, 300, 900] {
        let unit = f64::from(exponent).exp2();
        let body = Poinsot::new(j * unit).expect("a body");
        assert_eq!(forced(&body, &(h_n * unit)).expect("solvable"), expected);
        assert!(
            (reach(&body, &(h_n * unit)) - reach(&Poinsot::new(j).expect("a body"), &h_n)).abs()
                < 1e-15
        );
    }
}

#[test]
fn rest_is_the_identity_and_nan_is_refused() {
    let body = body([3.5, 2.5, 2.0], Vector3::zeros());
    let rest = forced(&body, &Vector3::zeros()).expect("solvable");
    assert_eq!(rest, Rotation::identity());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e200] {
        let error = forced(&body, &Vector3::new(0.1, bad, 0.0)).expect_err("no number");
        assert!(error.ratio.is_nan() || error.ratio > 1e150);
        assert_eq!(error.component, 1);
    }
}

#[test]
fn the_largest_step_offered_can_be_made_and_hardly_more() {
    let body = body([3.5, 2.5, 2.0], Vector3::new(0.3, 0.1, -0.7));
    let (mu, torque) = (Vector3::new(4.0, -5.0, 3.0), Vector3::new(1.0, 7.0, -20.0));
    // An edge momentum with half a kick, as in forced steppers: quadratic in the step size.
    let h_n = |h: f64| (mu + torque * (0.5 * h)) * h;
    let error = forced(&body, &h_n(1.0)).expect_err("too long");
    let largest = largest_step(1.0, |h| Some(reach(&body, &h_n(h))));
    let error = error.with_steps(1.0, largest);
    let offered = error.largest_step.expect("known");
    assert!(forced(&body, &h_n(offered)).is_ok());
    assert!(forced(&body, &h_n(offered * 1.0001)).is_err());
    assert!(
        error
            .to_string()
            .contains("reduce the step size from 1 to at most")
    );
    // The first search succeeds at once, the second fails always.
    assert_eq!(largest_step(0.01, |h| Some(reach(&body, &h_n(h)))), 0.01);
    assert_eq!(largest_step(0.01, |_| None), 0.0);
}

#[test]
fn what_is_no_body_is_refused_with_numbers() {
    let diagonal = |a, b, c| Matrix3::from_diagonal(&Vector3::new(a, b, c));
    assert!(matches!(
        Poinsot::new(diagonal(1.0, f64::NAN, 1.0)),
        Err(PoinsotError::NotFinite { row: 1, column: 1 })
    ));
    let mut crooked = diagonal(1.0, 1.0, 1.0);
    crooked[(0, 2)] = 1e-3;
    assert!(matches!(
        Poinsot::new(crooked),
        Err(PoinsotError::NotSymmetric {
            row: 0,
            column: 2,
            ..
        })
    ));
    // Moments (1, 1, 3) violate the triangle inequality.
    let Err(PoinsotError::Triangle {
        smallest,
        largest_moment,
        sum_of_others,
    }) = Poinsot::from_inertia(&diagonal(1.0, 1.0, 3.0))
    else {
        panic!("no body has these moments");
    };
    assert_eq!((smallest, largest_moment, sum_of_others), (-0.5, 3.0, 2.0));
    assert!(matches!(
        Poinsot::new(diagonal(0.0, 0.0, 1.0)),
        Err(PoinsotError::NoInertia {
            smallest_moment: 0.0
        })
    ));
    assert!(matches!(
        Poinsot::new(diagonal(0.0, 0.0, 0.0)),
        Err(PoinsotError::NoInertia { .. })
    ));
    // A flat body whose moments are not exact in binary.
    assert!(Poinsot::from_inertia(&diagonal(0.1, 0.2, 0.1 + 0.2)).is_ok());
}

#[test]
fn a_million_random_problems_end_in_a_solution_or_an_error() {
    let mut random = Random(31);
    let (mut solved, mut refused, mut worst) = (0_u32, 0_u32, 0.0_f64);
    for case in 0..1_000_000_u64 {
        // Moments over six decades, and momenta over nine decades around the solvability bound.
        let scale = |random: &mut Random, decades: f64| 10_f64.powf(decades * random.symmetric());
        let mut j = random.poinsot(case);
        if case % 3 == 0 {
            j = Matrix3::from_diagonal(&Vector3::from_fn(|_, _| scale(&mut random, 3.0)));
        }
        let Ok(body) = Poinsot::new(j) else {
            panic!("case {case}: {j}");
        };
        let trace = body.inertia().trace();
        let decades = if case % 2 == 0 { 0.5 } else { 4.5 };
        let mut h_n = random.vector() * (trace / 3.0 * scale(&mut random, decades));
        if case % 1000 == 0 {
            h_n[(case / 1000 % 3) as usize] = f64::NAN;
        }
        match forced(&body, &h_n) {
            Ok(omega) => {
                solved += 1;
                // The rounding errors of `adj(I - kappa)` and `det(I - kappa)` scale with their largest terms, which can exceed
                // their values by the spread of the moments.
                let moments = clebsch::linalg::symmetric_eigenvalues(&body.inertia());
                let spread = moments[2] / moments[0];
                worst = worst.max(residual(&j, &omega, &h_n) / (trace * spread));
            }
            Err(error) => {
                refused += 1;
                // Exactly at the bound, both outcomes are correct.
                assert!(
                    error.ratio.is_nan() || error.ratio > 1.0 - 1e-9,
                    "case {case}: {error:?}"
                );
            }
        }
    }
    println!("{solved} solved, {refused} refused, worst residual {worst:.1e} of the spread");
    assert!(solved > 300_000 && refused > 300_000);
    assert!(worst <= RESIDUAL, "{worst:e}");
}

#[test]
fn a_point_mass_is_refused_with_the_reason_and_the_way_out() {
    let mut random = Random(32);
    for case in 0..1000 {
        // Over twelve decades, along random axes or a given one.
        let size = 10_f64.powf(6.0 * random.symmetric());
        let a = match case % 4 {
            0 => Vector3::z(),
            _ => random.vector(),
        } * size;
        let error = Poinsot::new(a * a.transpose()).expect_err("no inertia about a");
        assert!(
            matches!(error, PoinsotError::NoInertia { .. }),
            "{a}: {error}"
        );
        let said = error.in_field("m a aᵀ").to_string();
        for words in [
            "`m a aᵀ`: the smallest moment of inertia is",
            "all mass lies on a line, so momenta do not determine the spin about it",
            "add to J the second moments of the mass about its own centre, so that J has rank two or three",
        ] {
            assert!(said.contains(words), "{words}\n{said}");
        }
        // The suggested remedy: a bob with a thousandth of the length.
        let bob = Matrix3::identity() * (a.norm_squared() * 1e-6);
        assert!(Poinsot::new(a * a.transpose() + bob).is_ok(), "{a}");
    }
}
