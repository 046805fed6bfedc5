//! Solvers of the Moser-Veselov equation for any left factor in two to eight dimensions: residuals up to the exact bound, errors
//! beyond it, agreement with each other, other scalars.

use super::common::Random;
use clebsch::groups::Part;
use clebsch::linalg::{hat, skew_from};
use clebsch::nalgebra::{Matrix3, Matrix4, SMatrix, Vector3, Vector4};
use clebsch::solvers::Method;
use clebsch::solvers::left_factor::{LeftFactor, LeftFactorError, Refusal, davenport};
use clebsch::{DoubleDouble, Dual, Group, Lanes, Orthogonal, Poinsot, Real, Rotation};

/// A residual with entries of size 2: eight products and their sum.
const ROUNDING: f64 = 1e-14;

fn skew<const N: usize>(random: &mut Random) -> SMatrix<f64, N, N> {
    let list: Vec<f64> = (0..N * N).map(|_| random.symmetric()).collect();
    skew_from(&list)
}

fn rotation<const N: usize>(random: &mut Random) -> Orthogonal<N> {
    let list: Vec<f64> = (0..N * N).map(|_| 2.0 * random.symmetric()).collect();
    Orthogonal::identity().retract(&list).retract(&list)
}

/// Diagonal, rotated symmetric and rotated nonsymmetric factors in turn, with eigenvalues in (0.2, 2.2).
fn matrix<const N: usize>(random: &mut Random, case: usize) -> SMatrix<f64, N, N> {
    let diagonal = SMatrix::from_diagonal(&clebsch::nalgebra::SVector::from_fn(|_, _| {
        0.2 + 2.0 * random.unit()
    }));
    match case % 3 {
        0 => diagonal,
        1 => {
            let u = rotation::<N>(random).matrix();
            let p = u * diagonal * u.transpose();
            (p + p.transpose()) * 0.5
        }
        _ => rotation::<N>(random).matrix() * diagonal * rotation::<N>(random).matrix(),
    }
}

fn residual<T: Real, const N: usize>(
    c: &SMatrix<T, N, N>,
    omega: &Orthogonal<N, T>,
    v: &SMatrix<T, N, N>,
) -> f64 {
    let a = omega.matrix() * c.transpose();
    let f = a - a.transpose() - v;
    f.iter()
        .map(|x| x.magnitude())
        .fold(0.0, clebsch::scalar::larger)
}

/// Random factors, and momenta at this fraction of the exact bound.
fn at_fraction<const N: usize>(
    fraction: f64,
    count: usize,
    mut check: impl FnMut(&LeftFactor<N>, &SMatrix<f64, N, N>),
) {
    let mut random = Random(40 + N as u64);
    for case in 0..count {
        let c = matrix::<N>(&mut random, case);
        let factor = LeftFactor::new(c).expect("positive");
        let v = skew::<N>(&mut random);
        check(&factor, &(v * (fraction / factor.reach(&v))));
    }
}

fn sizes(mut each: impl FnMut(usize)) {
    (2..=8).for_each(&mut each);
}

/// Calls a function generic over the size.
macro_rules! of_size {
    ($n:expr, $function:ident($($argument:expr),*)) => {
        match $n {
            2 => $function::<2>($($argument),*),
            3 => $function::<3>($($argument),*),
            4 => $function::<4>($($argument),*),
            5 => $function::<5>($($argument),*),
            6 => $function::<6>($($argument),*),
            7 => $function::<7>($($argument),*),
            _ => $function::<8>($($argument),*),
        }
    };
}

fn solves<const N: usize>(fraction: f64, allowed: f64) {
    at_fraction::<N>(fraction, 60, |factor, v| {
        let omega = factor
            .solve(v, Method::LieNewton)
            .unwrap_or_else(|e| panic!("n = {N}, {fraction} of the bound: {e}"));
        let found = residual(&factor.matrix(), &omega, v);
        assert!(found <= allowed, "n = {N}, {fraction}: {found:e}");
        assert!(omega.distance_from_group() < ROUNDING);
        let again = factor.solve(v, Method::LieNewton).expect("as before");
        assert_eq!(omega, again, "equal arguments, equal results");
    });
}

#[test]
fn lie_newton_solves_to_rounding_up_to_the_bound() {
    sizes(|n| {
        for fraction in [0.0, 1e-3, 0.05, 0.3, 0.6, 0.9, 0.95] {
            of_size!(n, solves(fraction, ROUNDING));
        }
        // At the bound the root is double, but the residual does not grow.
        for fraction in [0.999, 1.0 - 1e-6] {
            of_size!(n, solves(fraction, ROUNDING));
        }
    });
}

/// The iteration for the symmetric part works down to a hundredth; below that, only Newton's method.
#[test]
fn nearly_flat_factors_are_solved_to_rounding() {
    let mut random = Random(77);
    for smallest in [0.1, 0.0101, 0.0099, 1e-6, 0.0] {
        let diagonal = clebsch::nalgebra::SVector::from([1.0, 0.8, 0.6, smallest]);
        let factor = LeftFactor::new(SMatrix::<f64, 4, 4>::from_diagonal(&diagonal));
        let factor = factor.expect("at most one is zero");
        for fraction in [0.05, 0.3, 0.6, 0.95] {
            let v = skew::<4>(&mut random);
            let v = v * (fraction / factor.reach(&v));
            let omega = factor.solve(&v, Method::LieNewton).expect("solvable");
            let found = residual(&factor.matrix(), &omega, &v);
            assert!(found < ROUNDING, "{smallest}, {fraction}: {found:e}");
            assert!(omega.distance_from_group() < ROUNDING);
        }
    }
}

fn refuses<const N: usize>() {
    at_fraction::<N>(1.0 + 1e-6, 30, |factor, v| {
        for method in [Method::LieNewton, Method::Sign, Method::Schur] {
            let error = factor.solve(v, method).expect_err("beyond the bound");
            assert_eq!(error.refusal, Refusal::BeyondBound, "{error}");
            assert!((error.ratio - 1.0 - 1e-6).abs() < 1e-9, "{error}");
        }
        let h = 0.1;
        let ratio = |trial: f64| Some(factor.reach(&(v * (trial / h))));
        let error = factor.solve(v, Method::LieNewton).expect_err("beyond");
        let largest = error
            .with_searched_step(h, ratio)
            .largest_step
            .expect("searched");
        assert!((largest / h - 1.0 + 1e-6).abs() < 1e-9, "{largest}");
        // The suggested step size works.
        assert!(
            factor
                .solve(&(v * (largest / h)), Method::LieNewton)
                .is_ok()
        );
    });
}

#[test]
fn beyond_the_bound_every_solver_refuses_with_its_ratio() {
    sizes(|n| of_size!(n, refuses()));
}

/// The momentum in one plane of one lane is too large; the error names plane and lane.
#[test]
fn refusals_name_the_plane_and_the_lane() {
    let four = LeftFactor::new(SMatrix::<f64, 4, 4>::from_diagonal(
        &[0.5, 0.9, 0.7, 1.1].into(),
    ));
    let four = four.expect("a factor");
    for (i, j) in [(0, 1), (1, 3), (2, 3)] {
        let mut v = SMatrix::<f64, 4, 4>::repeat(0.01);
        v[(i, j)] = 3.0;
        v = v - v.transpose();
        for method in [Method::LieNewton, Method::Sign, Method::Schur] {
            let e = four.solve(&v, method).expect_err("too fast");
            assert_eq!(e.fastest, Part::Plane(i as u8, j as u8), "{e}");
            // Messages count from 1.
            let said = format!("plane ({}, {})", i + 1, j + 1);
            assert!(e.to_string().contains(&said), "{e}");
        }
    }
    let c = Matrix3::from_diagonal(&Vector3::new(0.5, 0.9, 0.7))
        * Rotation::exp(&Vector3::z()).matrix();
    let wide = |x: f64| Lanes([x; 4]);
    let mut v = Vector3::new(0.01, 0.02, 0.01).map(wide);
    v[1] = Lanes([0.1, 0.2, 9.0, 4.0]);
    let e = davenport(&c.map(wide), &v).expect_err("too fast");
    assert_eq!((e.fastest, e.lane), (Part::Axis(1), 2), "{e}");
    let prepared = LeftFactor::new(c.map(wide)).expect("a factor");
    let e = prepared
        .rotation(&v, Method::LieNewton)
        .expect_err("too fast");
    assert_eq!((e.fastest, e.lane), (Part::Axis(1), 2), "{e}");
    assert!(e.to_string().starts_with("lane 3: "), "{e}");
    // Within the bound the solver succeeds.
    assert!(davenport(&c.map(wide), &v.map(|x| x * wide(0.01))).is_ok());
}

fn agree<const N: usize>(fraction: f64, allowed: f64) {
    at_fraction::<N>(fraction, 40, |factor, v| {
        let omega = factor
            .solve(v, Method::LieNewton)
            .expect("solvable")
            .matrix();
        for method in Method::ALL {
            match factor.solve(v, method) {
                Ok(other) => {
                    let apart = (other.matrix() - omega).amax();
                    assert!(apart <= allowed, "n = {N}, {fraction}, {method}: {apart:e}");
                }
                Err(e) => {
                    let of_three = matches!(method, Method::Kappa | Method::Davenport);
                    let other_size = of_three && N != 3;
                    assert!(
                        other_size && e.refusal == Refusal::DoesNotApply,
                        "{N} {method} {e}"
                    );
                }
            }
        }
    });
}

#[test]
fn solvers_agree() {
    sizes(|n| {
        // The eigenvalue problems lose digits by the condition number of the invariant subspace, which grows towards the bound like
        // the inverse square root of the distance.
        of_size!(n, agree(0.05, 2e-13));
        of_size!(n, agree(0.3, 2e-13));
        of_size!(n, agree(0.9, 2e-12));
        of_size!(n, agree(0.999, 2e-10));
    });
}

#[test]
fn davenport_solves_any_factor_of_space() {
    for (fraction, count) in [
        (0.05, 400),
        (0.5, 400),
        (0.9, 400),
        (0.999, 100),
        (1.0 - 1e-6, 50),
    ] {
        at_fraction::<3>(fraction, count, |factor, v| {
            let c = factor.matrix();
            let vector = Vector3::new(v[(2, 1)], v[(0, 2)], v[(1, 0)]);
            let omega = davenport(&c, &vector).unwrap_or_else(|e| panic!("{fraction}: {e}"));
            let a = omega.matrix() * c.transpose();
            assert!((a - a.transpose() - v).amax() < ROUNDING);
        });
    }
    at_fraction::<3>(1.0 + 1e-6, 50, |factor, v| {
        let vector = Vector3::new(v[(2, 1)], v[(0, 2)], v[(1, 0)]);
        let error = davenport(&factor.matrix(), &vector).expect_err("beyond");
        assert!((error.ratio - 1.0 - 1e-6).abs() < 1e-9, "{error}");
    });
}

#[test]
fn the_bound_is_that_of_space_where_both_are_known() {
    let mut random = Random(51);
    for case in 0..200 {
        let j = random.poinsot(case);
        let Ok(body) = Poinsot::new(j) else { continue };
        let factor = LeftFactor::new(j).expect("a body");
        let v = random.vector();
        let (one, other) = (
            factor.reach(&hat(&v)),
            clebsch::solvers::moser_veselov::reach(&body, &v),
        );
        assert!((one / other - 1.0).abs() < 1e-9, "{one} {other}");
    }
}

#[test]
fn a_single_plane_turns_by_the_arc_sine() {
    // Rotation in one plane: (c1 + c2) sin(theta) = v.
    let c = SMatrix::<f64, 5, 5>::from_diagonal(&[0.4, 1.1, 0.7, 1.9, 1.3].into());
    let factor = LeftFactor::new(c).expect("positive");
    let mut v = SMatrix::<f64, 5, 5>::zeros();
    (v[(1, 3)], v[(3, 1)]) = (-2.7, 2.7);
    let theta = (2.7_f64 / 3.0).asin();
    for method in [Method::LieNewton, Method::Sign, Method::Schur] {
        let omega = factor.solve(&v, method).expect("0.9 of the bound").matrix();
        assert!((omega[(3, 1)] - theta.sin()).abs() < 1e-13, "{method}");
        assert!((omega[(1, 1)] - theta.cos()).abs() < 1e-13, "{method}");
    }
    assert!((factor.reach(&v) - 0.9).abs() < 1e-12);
}

#[test]
fn what_is_no_left_factor_is_refused() {
    let mut c = SMatrix::<f64, 4, 4>::from_diagonal(&[1.0, 2.0, 3.0, -4.0].into());
    assert!(matches!(
        LeftFactor::new(c),
        Err(LeftFactorError::NotPositive { smallest, .. }) if smallest == -4.0
    ));
    c[(0, 1)] = 0.5;
    assert!(matches!(
        LeftFactor::new(c),
        Err(LeftFactorError::Reflected { determinant }) if determinant < 0.0
    ));
    c[(0, 1)] = f64::NAN;
    assert_eq!(LeftFactor::new(c), Err(LeftFactorError::NotFinite));
    let flat = SMatrix::<f64, 4, 4>::from_diagonal(&[1.0, 2.0, 3.0, 0.0].into());
    let factor = LeftFactor::new(flat).expect("a flat body");
    let v = skew::<4>(&mut Random(7));
    let v = v * (0.5 / factor.reach(&v));
    let omega = factor
        .solve(&v, Method::LieNewton)
        .expect("within the bound");
    assert!(residual(&flat, &omega, &v) < ROUNDING);
    // The factor is singular.
    let error = factor.solve(&v, Method::Sign).expect_err("singular");
    assert_eq!(error.refusal, Refusal::DoesNotApply);
    let flatter = SMatrix::<f64, 4, 4>::from_diagonal(&[1.0, 2.0, 0.0, 0.0].into());
    assert!(LeftFactor::new(flatter).is_err());
    let error = factor
        .solve(&(v * f64::NAN), Method::LieNewton)
        .expect_err("NaN");
    assert_eq!(error.refusal, Refusal::NotFinite);
}

#[test]
fn other_scalars() {
    let mut random = Random(61);
    for case in 0..20 {
        let c = matrix::<4>(&mut random, case);
        let plain = LeftFactor::new(c).expect("positive");
        let v = skew::<4>(&mut random);
        let v = v * (0.4 / plain.reach(&v));
        let omega = plain
            .solve(&v, Method::LieNewton)
            .expect("solvable")
            .matrix();
        // Thirty digits.
        let wide = LeftFactor::new(c.map(DoubleDouble::from)).expect("positive");
        for method in [Method::LieNewton, Method::Sign] {
            let fine = wide
                .solve(&v.map(DoubleDouble::from), method)
                .expect("solvable");
            let left = residual(&wide.matrix(), &fine, &v.map(DoubleDouble::from));
            assert!(left < 1e-27, "{method} {left:e}");
        }
        // Lanes with different multiples of the momentum.
        let lanes = LeftFactor::new(c.map(|x| Lanes([x; 3]))).expect("positive");
        let momenta = v.map(|x| Lanes([x, 0.5 * x, -x]));
        let three = lanes
            .solve(&momenta, Method::LieNewton)
            .expect("solvable")
            .matrix();
        assert!((three.map(|x| x.0[0]) - omega).amax() < ROUNDING);
        assert!(
            residual(
                &lanes.matrix(),
                &Orthogonal::from_matrix(&three).unwrap(),
                &momenta
            ) < ROUNDING
        );
        // Derivatives along a variation of momentum and factor, against central differences.
        let (dv, dc) = (skew::<4>(&mut random), skew::<4>(&mut random) * 0.3);
        let dual = |x: f64, dx: f64| Dual::<1> {
            real: x,
            dual: [dx],
        };
        let moving = LeftFactor::new(c.zip_map(&dc, dual)).expect("positive");
        let turned = moving
            .solve(&v.zip_map(&dv, dual), Method::LieNewton)
            .expect("solvable");
        let derivative = turned.matrix().map(|x| x.dual[0]);
        let at = |t: f64| {
            let factor = LeftFactor::new(c + dc * t).expect("positive");
            factor
                .solve(&(v + dv * t), Method::LieNewton)
                .expect("solvable")
                .matrix()
        };
        let t = 1e-5;
        let difference = (at(t) - at(-t)) / (2.0 * t);
        // Differences have an error of t^2 plus rounding over t.
        assert!((derivative - difference).amax() < 1e-8);
    }
}

#[test]
fn derivatives_pass_through_davenport() {
    let mut random = Random(62);
    for case in 0..20 {
        let c = matrix::<3>(&mut random, case);
        let (v, dv) = (random.vector() * 0.1, random.vector());
        let dual = |x: f64, dx: f64| Dual::<1> {
            real: x,
            dual: [dx],
        };
        let turned = davenport(&c.map(|x| dual(x, 0.0)), &v.zip_map(&dv, dual)).expect("solvable");
        let derivative = turned.matrix().map(|x| x.dual[0]);
        let at = |t: f64| davenport(&c, &(v + dv * t)).expect("solvable").matrix();
        let difference = (at(1e-5) - at(-1e-5)) / 2e-5;
        assert!((derivative - difference).amax() < 1e-8);
    }
}

#[test]
fn a_turned_body_is_solved_by_vectors_too() {
    let mut random = Random(63);
    let c: Matrix3<f64> = matrix::<3>(&mut random, 2);
    let factor = LeftFactor::new(c).expect("positive");
    let v = Vector3::new(0.1, -0.2, 0.15);
    let by_quartic: Rotation = factor.rotation(&v, Method::Kappa).expect("solvable");
    for method in Method::ALL {
        let other = factor.rotation(&v, method).expect("solvable");
        assert!(
            (other.matrix() - by_quartic.matrix()).amax() < 1e-13,
            "{method}"
        );
    }
}

/// Checks that bodies solved side by side rotate like each body alone, bit for bit, or fail alike.
fn side_by_side<T: Real>(factor: &LeftFactor<3, T>, momenta: &[Vector3<T>; 5], method: Method) {
    let each = momenta.map(|v| factor.rotation(&v, method));
    let refused = each.iter().find_map(|one| one.err());
    match (factor.rotations(momenta, method), refused) {
        (Ok(all), None) => assert_eq!(all.map(Ok), each, "{method}"),
        (Err(e), Some(first)) => assert_eq!(format!("{e:?}"), format!("{first:?}"), "{method}"),
        (together, _) => panic!("{method}: {together:?} for {each:?}"),
    }
}

#[test]
fn bodies_that_are_alike_turn_as_each_by_itself() {
    let mut random = Random(64);
    for case in 0..60 {
        let c: Matrix3<f64> = matrix::<3>(&mut random, case);
        let factor = LeftFactor::new(c).expect("positive");
        let lanes = LeftFactor::new(c.map(Lanes::<2>::from_f64)).expect("positive");
        // From momenta that one iteration solves to momenta without a solution.
        for size in [1e-3, 0.1, 0.5, 1.0, 4.0] {
            let momenta = [(); 5].map(|()| Vector3::from_fn(|_, _| size * random.symmetric()));
            for method in Method::ALL {
                side_by_side(&factor, &momenta, method);
            }
            let momenta = momenta.map(|v| v.map(Lanes::<2>::from_f64));
            side_by_side(&lanes, &momenta, Method::Kappa);
        }
    }
}

#[test]
fn methods_have_names() {
    for method in Method::ALL {
        assert_eq!(method.name().parse(), Ok(method));
    }
    let error = "newton".parse::<Method>().expect_err("no such name");
    assert_eq!(
        error.to_string(),
        "no such solver; the solvers are kappa, lie-newton, davenport, sign, schur"
    );
}

#[test]
fn planes_without_mass_are_refused_with_the_reason() {
    let mut random = Random(33);
    for case in 0..200 {
        let size = 10_f64.powf(6.0 * random.symmetric());
        let masses: [Vector4<f64>; 3] =
            [(); 3].map(|()| Vector4::from_fn(|_, _| random.symmetric()) * size);
        let moments = |count: usize| -> Matrix4<f64> {
            let list = masses.iter().take(count);
            list.map(|a| a * a.transpose()).sum()
        };
        // Two masses leave a plane without inertia; three leave a line, which rotates with the others.
        let error = LeftFactor::new(moments(2)).expect_err("no inertia in a plane");
        assert!(
            matches!(error, LeftFactorError::NotPositive { .. }),
            "case {case}: {error}"
        );
        let said = error.in_field("a aᵀ + b bᵀ").to_string();
        let words = "a rotation in a plane without second moments has no inertia";
        assert!(said.contains(words), "{said}");
        assert!(LeftFactor::new(moments(3)).is_ok(), "case {case}");
    }
}
