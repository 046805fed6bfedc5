//! Newton's method on groups: solves the problems with closed forms, for every scalar, and reports why it fails.

use super::common::{Random, lift, lift_matrix};
use clebsch::groups::Part;
use clebsch::linalg::{axial_of_difference, hat};
use clebsch::nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use clebsch::solvers::moser_veselov::forced;
use clebsch::solvers::newton::{NewtonError, NewtonFailure, Solved, solve};
use clebsch::{DoubleDouble, Dual, Group, Lanes, Poinsot, Real, Rotation};

/// `vee(Omega J - J Omega^T) - h N`.
fn residual<T: Real>(j: &Matrix3<T>, omega: &Rotation<T>, h_n: &Vector3<T>) -> Vector3<T> {
    axial_of_difference(&(omega.matrix() * *j)) - *h_n
}

/// Its derivative under `Omega -> Omega (1 + hat xi)`.
fn tangent<T: Real>(j: &Matrix3<T>, omega: &Rotation<T>) -> Matrix3<T> {
    let matrix = omega.matrix();
    let columns = [0, 1, 2].map(|i| {
        let mut axis = Vector3::zeros();
        axis[i] = T::one();
        axial_of_difference(&(matrix * hat(&axis) * *j))
    });
    Matrix3::from_columns(&columns)
}

fn moser_veselov<T: Real>(
    j: &Matrix3<f64>,
    h_n: &Vector3<T>,
) -> Result<Solved<Rotation<T>>, NewtonError> {
    let j = lift_matrix::<T>(j);
    solve(
        Rotation::identity(),
        j.trace().value(),
        |omega| residual(&j, omega, h_n),
        |omega| tangent(&j, omega),
    )
}

fn sample() -> (Matrix3<f64>, Vector3<f64>) {
    let j = Matrix3::from_diagonal(&Vector3::new(0.5, 1.5, 2.0));
    (j, Vector3::new(0.7, -0.4, 0.9))
}

#[test]
fn finds_the_principal_solution() {
    let mut random = Random(31);
    for case in 0..200 {
        let j = random.poinsot(case);
        let body = Poinsot::new(j).expect("a body");
        let direction = random.vector();
        let reach = clebsch::solvers::moser_veselov::reach(&body, &direction);
        let h_n = direction * (0.5 / reach);
        let solved = moser_veselov(&j, &h_n).expect("half the bound converges");
        let closed = forced(&body, &h_n).expect("solvable");
        assert!(
            (solved.element.matrix() - closed.matrix()).norm() < 1e-14,
            "case {case}"
        );
        assert!(solved.iterations <= 10);
    }
}

#[test]
fn works_on_every_scalar() {
    let (j, h_n) = sample();
    let plain = moser_veselov(&j, &h_n)
        .expect("converges")
        .element
        .quaternion();

    let lanes = lift::<Lanes<4>>(&h_n).map(|x| x * Lanes([1.0, 0.1, 1e-3, 0.0]));
    let wide = moser_veselov(&j, &lanes)
        .expect("converges")
        .element
        .quaternion();
    for k in 0..4 {
        assert!((wide[k].0[0] - plain[k]).abs() < 1e-15);
        assert!((wide[k].0[3] - if k == 0 { 1.0 } else { 0.0 }).abs() < 1e-15);
    }

    let fine = moser_veselov(&j, &lift::<DoubleDouble>(&h_n))
        .expect("converges")
        .element;
    let left = residual(&lift_matrix(&j), &fine, &lift::<DoubleDouble>(&h_n));
    assert!(left.map(|x| x.magnitude()).amax() < 1e-30);

    let seeded = Vector3::from_fn(|i, _| Dual::<3>::variable(h_n[i], i));
    let dual = moser_veselov(&j, &seeded)
        .expect("converges")
        .element
        .quaternion();
    let body = Poinsot::new(lift_matrix::<Dual<3>>(&j)).expect("a body");
    let closed = forced(&body, &seeded).expect("solvable").quaternion();
    for (a, b) in dual.iter().zip(closed) {
        assert!((a.real - b.real).abs() < 1e-15);
        for (x, y) in a.dual.iter().zip(b.dual) {
            assert!((x - y).abs() < 1e-14);
        }
    }
}

#[test]
fn two_bodies_are_solved_together() {
    let (j, h_n) = sample();
    let other = Vector3::new(-0.2, 0.3, 0.1);
    // A coupling that mixes the two residuals.
    let mix = 0.3;
    let solved: Solved<[Rotation; 2]> = solve(
        Group::<f64>::identity(),
        j.trace(),
        |[a, b]: &[Rotation; 2]| {
            let (r, s) = (residual(&j, a, &h_n), residual(&j, b, &other));
            SVector::<f64, 6>::from_iterator(
                (r + s * mix).iter().chain((s - r * mix).iter()).copied(),
            )
        },
        |[a, b]| {
            let (s, t) = (tangent(&j, a), tangent(&j, b));
            let mut whole = SMatrix::<f64, 6, 6>::zeros();
            whole.fixed_view_mut::<3, 3>(0, 0).copy_from(&s);
            whole.fixed_view_mut::<3, 3>(0, 3).copy_from(&(t * mix));
            whole.fixed_view_mut::<3, 3>(3, 0).copy_from(&(s * -mix));
            whole.fixed_view_mut::<3, 3>(3, 3).copy_from(&t);
            whole
        },
    )
    .expect("converges");
    let body = Poinsot::new(j).expect("a body");
    for (found, h_n) in solved.element.iter().zip([h_n, other]) {
        let closed = forced(&body, &h_n).expect("solvable");
        assert!((found.matrix() - closed.matrix()).norm() < 1e-14);
    }
}

#[test]
fn failures_carry_numbers() {
    let (j, h_n) = sample();
    let e = moser_veselov(&j, &(h_n * 5.0)).expect_err("no solution");
    assert!(e.residual > e.tolerance, "{e}");
    let flat = solve(
        Rotation::identity(),
        1.0,
        |_: &Rotation| Vector3::new(1.0, 0.0, 0.0),
        |_| Matrix3::zeros(),
    );
    let flat = flat.expect_err("no tangent");
    assert_eq!(flat.failure, NewtonFailure::SingularTangent);
    assert_eq!((flat.iterations, flat.residual), (0, 1.0));
    let nan = moser_veselov(&j, &Vector3::new(0.0, f64::NAN, 0.0)).expect_err("NaN");
    assert_eq!((nan.failure, nan.iterations), (NewtonFailure::NotFinite, 0));
    assert_eq!(nan.worst.part, Part::Axis(1));
    // A constant residual never converges.
    let stuck = solve(
        Rotation::identity(),
        1.0,
        |_: &Rotation| Vector3::new(1e-4, 0.0, -1e-3),
        |_| Matrix3::identity(),
    );
    let stuck = stuck.expect_err("no solution");
    assert_eq!(
        (stuck.failure, stuck.iterations),
        (NewtonFailure::NotConverged, 50)
    );
    assert_eq!((stuck.worst.part, stuck.residual), (Part::Axis(2), 1e-3));
}

/// A residual that never falls below this number of rounding errors of its terms.
fn noisy(roundings: f64) -> Result<Solved<Rotation>, NewtonError> {
    let sign = core::cell::Cell::new(1.0);
    solve(
        Rotation::identity(),
        1.0,
        |_: &Rotation| {
            sign.set(-sign.get());
            Vector3::new(sign.get() * roundings * f64::EPSILON / 2.0, 0.0, 0.0)
        },
        |_| Matrix3::identity(),
    )
}

#[test]
fn what_stagnates_above_rounding_is_no_solution() {
    // Two evaluations differ by at most twice the rounding bound.
    for fine in [1.0, 10.0, 40.0] {
        assert!(noisy(fine).is_ok(), "{fine}");
    }
    for coarse in [100.0, 1e3, 1e5, 1e9] {
        let e = noisy(coarse).expect_err("noise is no root");
        assert_eq!(e.failure, NewtonFailure::NotConverged, "{coarse}");
    }
}
