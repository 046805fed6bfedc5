//! The equation in unit quaternions: its residual from small to the largest step sizes, for every scalar; errors; and agreement
//! with the Moser-Veselov equation, its special case `β = 0`.

use super::common::{Random, largest, lift, lift_matrix};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::solvers::moser_veselov::{Edge, forced, reach};
use clebsch::solvers::unit_quaternions::{QuaternionBody, QuaternionError};
use clebsch::{DoubleDouble, Dual, Lanes, Poinsot, Real, UnitQuaternion};

type Found<T> = Result<UnitQuaternion<T>, QuaternionError>;

/// The principal solution for `h N`, with `h = 1`.
fn solved<T: Real>(a: &Matrix3<f64>, real: f64, n: &Vector3<T>) -> Found<T> {
    let body = QuaternionBody::new("A", lift_matrix(a), T::from_f64(real)).expect("a body");
    let edge = Edge::new(*n, *n);
    edge.turn_in_quaternions(&body, T::one(), &UnitQuaternion::identity())
        .map(|turned| turned.unit_quaternion())
}

/// `w A v + v x A v + β v - N/2`.
fn residual<T: Real>(a: &Matrix3<f64>, real: f64, q: &UnitQuaternion<T>, n: &Vector3<T>) -> f64 {
    let (a, w, v) = (lift_matrix::<T>(a), q.real(), q.imaginary());
    let image = a * v;
    largest(&(image * w + v.cross(&image) + v * T::from_f64(real) - n * T::from_f64(0.5)))
}

/// A random inertia with moments from 1 to `spread`, with rotated axes in two of three cases. `β` is zero, of the size of the
/// moments, or much larger.
fn random_body(random: &mut Random, case: u64) -> (Matrix3<f64>, f64) {
    let spread: f64 = [1.0, 3.0, 30.0][(case % 3) as usize];
    let moments = Vector3::from_fn(|_, _| spread.powf(random.unit()));
    let r = match case % 3 {
        0 => Matrix3::identity(),
        _ => random.rotation().matrix(),
    };
    let inertia = r * Matrix3::from_diagonal(&moments) * r.transpose();
    let inertia = (inertia + inertia.transpose()) * 0.5;
    let real = [
        0.0,
        random.symmetric() * 3.0,
        1.0,
        random.symmetric() * 20.0,
    ][(case % 4) as usize];
    (inertia - Matrix3::from_diagonal_element(real), real)
}

/// The largest solvable multiple of `n`, by bisection between 0 and 1e3.
fn bound(a: &Matrix3<f64>, real: f64, n: &Vector3<f64>) -> f64 {
    let (mut low, mut high) = (0.0, 1e3);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match solved(a, real, &(n * middle)) {
            Ok(_) => low = middle,
            Err(_) => high = middle,
        }
    }
    low
}

#[test]
fn residual_is_rounding_up_to_the_bound() {
    let mut random = Random(1);
    let (mut worst, mut wide): (f64, f64) = (0.0, 0.0);
    for case in 0..600 {
        let (a, real) = random_body(&mut random, case);
        // The size of the terms of the equation.
        let scale = a.amax() + real.abs() + 1.0;
        let direction = random.vector().normalize();
        let most = bound(&a, real, &direction).min(100.0);
        for fraction in [
            1e-9, 1e-3, 3e-3, 0.01, 0.02, 0.03, 0.1, 0.2, 0.3, 0.5, 0.9, 0.99, 0.999_999,
        ] {
            let n = direction * (most * fraction);
            let q = solved(&a, real, &n).unwrap_or_else(|e| panic!("case {case}, {fraction}: {e}"));
            worst = worst.max(residual(&a, real, &q, &n) / scale);
            if fraction < 0.999 {
                let n = lift::<DoubleDouble>(&n);
                let q = solved(&a, real, &n).unwrap_or_else(|e| panic!("case {case}: {e}"));
                wide = wide.max(residual(&a, real, &q, &n) / scale);
            }
        }
    }
    println!("{worst:e}, double-double {wide:e}");
    // A dozen rounding errors of terms of that size.
    assert!(worst < 4e-15, "{worst:e}");
    // The same for double-double, whose divisions and roots have a few rounding errors.
    assert!(wide < 1e-29, "{wide:e}");
}

#[test]
fn the_solution_grows_out_of_the_neutral_element() {
    let mut random = Random(2);
    for case in 0..200 {
        let (a, real) = random_body(&mut random, case);
        let direction = random.vector().normalize();
        // Bodies with a large `β` may rotate without limit; the jumps below are measured with 400 steps.
        let most = bound(&a, real, &direction).min(6.0);
        let mut last = [1.0, 0.0, 0.0, 0.0];
        for i in 1..400 {
            let n = direction * (most * 0.99 * f64::from(i) / 399.0);
            let q = solved(&a, real, &n).expect("inside the bound").components();
            let jump = last
                .iter()
                .zip(q)
                .map(|(x, y)| (x - y).abs())
                .fold(0.0, clebsch::scalar::larger);
            // Along one branch, none of the 400 steps jumps that far; another branch is at a distance of order one.
            assert!(jump < 0.2, "case {case}, {i}: {jump}");
            last = q;
        }
    }
}

#[test]
fn without_the_number_it_is_the_equation_of_moser_and_veselov() {
    let mut random = Random(3);
    for case in 0..300 {
        let j = random.poinsot(case);
        let body = Poinsot::new(j).expect("a body");
        let a = body.inertia();
        let direction = random.vector();
        let at_bound = direction / reach(&body, &direction);
        for fraction in [0.01, 0.1, 0.5, 0.9, 0.999] {
            let n = at_bound * fraction;
            let ours = solved(&a, 0.0, &n).expect("inside the bound").components();
            let other = forced(&body, &n).expect("inside the bound").quaternion();
            for (x, y) in ours.iter().zip(other) {
                // Rounding error divided by the distance to the bound, where the root is double; flat bodies come near 1e-13.
                let allowed = 1e-13 / (1.0 - fraction).sqrt();
                assert!((x - y).abs() < allowed, "case {case}, {fraction}: {x} {y}");
            }
        }
        for fraction in [1.000_001, 1.1, 30.0] {
            let error = solved(&a, 0.0, &(at_bound * fraction)).expect_err("beyond the bound");
            // The branch is followed to 1e-14 of the momentum, and rounding blurs its end.
            assert!(
                (error.ratio / fraction - 1.0).abs() < 1e-9,
                "{} {fraction}",
                error.ratio
            );
        }
    }
}

#[test]
fn a_refusal_tells_the_step_that_can_be_made() {
    let mut random = Random(4);
    for case in 0..60 {
        let (a, real) = random_body(&mut random, case);
        let body = QuaternionBody::new("A", a, real).expect("a body");
        let direction = random.vector().normalize();
        let most = bound(&a, real, &direction);
        if most > 900.0 {
            continue;
        }
        let push = random.vector() * 0.05;
        // With a torque at the node, the momentum depends on the step size.
        for torque in [Vector3::zeros(), push] {
            let n = |h: f64| direction + torque * h;
            let h = 2.0 * most + 1.0;
            let at = |h: f64| solved(&a, real, &(n(h) * h));
            let Err(e) = at(h) else { continue };
            let told = e.with_searched_step(&body, h, n);
            let largest = told.largest_step.expect("searched");
            assert!(
                told.ratio > 1.0 && largest < h && at(largest).is_ok(),
                "case {case}"
            );
            if torque == Vector3::zeros() {
                assert!(at(largest * (1.0 + 1e-8)).is_err(), "case {case}");
                assert!(
                    (largest / most - 1.0).abs() < 1e-8,
                    "case {case}: {largest} {most}"
                );
            }
            let text = told.to_string();
            assert!(text.contains("at most"), "{text}");
        }
    }
    let nan = Vector3::new(0.1, f64::NAN, 0.0);
    let (a, real) = random_body(&mut random, 1);
    assert!(
        solved(&a, real, &nan)
            .expect_err("not finite")
            .ratio
            .is_nan()
    );
}

#[test]
fn bodies_without_positive_inertia_are_refused() {
    let a = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 0.5));
    let text = |real| {
        QuaternionBody::new("A", a, real)
            .expect_err("refused")
            .to_string()
    };
    assert!(
        text(-0.5).contains("`A`: 0 is not positive"),
        "{}",
        text(-0.5)
    );
    assert!(text(f64::NAN).contains("entry (1, 1)"));
    // A small difference of large numbers is symmetric only to the rounding of these numbers.
    let rounded = Matrix3::new(0.0, 1e-15, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    assert!(QuaternionBody::new("A", rounded, 1.0).is_ok());
    assert!(QuaternionBody::new("A", rounded * 1e6, 1.0).is_err());
    let skew = a + Matrix3::new(0.0, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    let error = QuaternionBody::new("A", skew, 1.0).expect_err("refused");
    assert!(error.to_string().contains("not symmetric"));
    assert!(QuaternionBody::new("A", a, -0.4).is_ok());
}

#[test]
fn a_free_step_keeps_both_momenta_one() {
    let mut random = Random(6);
    let (mut worst, mut before): (f64, f64) = (0.0, 0.0);
    for case in 0..60 {
        let (a, real) = random_body(&mut random, case);
        let body = QuaternionBody::new("A", a, real).expect("a body");
        let space = random.vector().normalize();
        let h = bound(&a, real, &space).min(2.0) * [0.003, 0.05, 0.3][(case % 3) as usize];
        let mut q = UnitQuaternion::identity();
        let mut edge = Edge::new(space, space);
        for _ in 0..2000 {
            // Later in the motion, the body may rotate faster than at the start.
            let Ok((next, following)) = edge.free_in_quaternions(&body, h, &q) else {
                break;
            };
            let turned = edge.turn_in_quaternions(&body, h, &q).expect("the same");
            assert_eq!(turned.unit_quaternion(), next, "case {case}");
            assert_eq!(following.space(), space, "case {case}");
            let seen = |q: &UnitQuaternion<f64>| q.rotation().inverse_rotate(&space);
            worst = worst.max(largest(&(following.body() - seen(&next))));
            before = before.max(largest(&(edge.body() - seen(&next))));
            (q, edge) = (next, following);
        }
    }
    println!("{worst:e}, without the change {before:e}");
    // A few rounding errors of a momentum of length one, for any number of steps.
    assert!(worst < 2e-14 && before > 0.1, "{worst:e} {before:e}");
}

#[test]
fn lanes_are_bodies_alone_and_derivatives_are_exact() {
    let mut random = Random(5);
    for case in 0..120 {
        let (a, real) = random_body(&mut random, case);
        let direction = random.vector().normalize();
        let most = bound(&a, real, &direction).min(100.0);
        let sizes = [0.003, 0.1, 0.3, 0.95].map(|x| x * most);
        let wide = Vector3::from_fn(|i, _| Lanes(sizes.map(|x| x * direction[i])));
        let together = solved(&a, real, &wide)
            .expect("inside the bound")
            .components();
        for (lane, size) in sizes.into_iter().enumerate() {
            let alone = solved(&a, real, &(direction * size))
                .expect("inside")
                .components();
            assert_eq!(together.map(|x| x.lane(lane)), alone, "case {case}");
        }
        for size in [sizes[0], sizes[1], sizes[2]] {
            let n = direction * size;
            let seeded = Vector3::from_fn(|i, _| Dual::<3>::variable(n[i], i));
            let q = solved(&a, real, &seeded).expect("inside the bound");
            // `magnitude` includes the derivatives of the residual.
            let off = residual(&a, real, &q, &seeded);
            assert!(
                off < 1e-13 * (a.amax() + real.abs() + 1.0),
                "case {case}, {size}: {off:e}"
            );
        }
    }
}
