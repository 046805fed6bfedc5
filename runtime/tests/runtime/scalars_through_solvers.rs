//! The solvers with every scalar: lanes equal single runs, duals equal difference quotients in double-double, and double-double
//! solves to its own precision.

use super::common::{Random, dd, lift, lift_matrix, residual};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::solvers::moser_veselov::{Free, forced, reach};
use clebsch::{DoubleDouble, Dual, Lanes, Poinsot, Real, Rotation, SpatialMomentum};

/// A solvable case: Poinsot matrix and `h N` at the given fraction of the bound.
fn case_at(random: &mut Random, case: u64, fraction: f64) -> (Matrix3<f64>, Vector3<f64>) {
    let j = random.poinsot(case);
    let direction = random.vector();
    let body = Poinsot::new(j).expect("a body");
    // The validated matrix is exactly symmetric, as double-double requires.
    (
        *body.matrix(),
        direction * (fraction / reach(&body, &direction)),
    )
}

fn gather<const N: usize, const K: usize>(members: &[[f64; K]; N]) -> [Lanes<N>; K] {
    std::array::from_fn(|k| Lanes(std::array::from_fn(|n| members[n][k])))
}

fn entries(j: &Matrix3<f64>) -> [f64; 9] {
    std::array::from_fn(|k| j.as_slice()[k])
}

#[test]
fn lanes_agree_with_single_runs() {
    let mut random = Random(11);
    for group in 0..200 {
        // All lanes are diagonal or none, because they share a branch; step sizes from tiny to near the bound side by side.
        let fractions =
            std::array::from_fn(|n| [0.01, 0.3, 0.95, 0.999_999][(n + group as usize) % 4]);
        let cases: [(Matrix3<f64>, Vector3<f64>); 4] =
            fractions.map(|fraction| case_at(&mut random, group % 2 + 2, fraction));
        let j = Matrix3::from_column_slice(&gather(&cases.map(|(j, _)| entries(&j))));
        let h_n = Vector3::from(gather(&cases.map(|(_, n)| [n[0], n[1], n[2]])));
        let body = Poinsot::new(j).expect("bodies");
        let together = forced(&body, &h_n).expect("solvable").quaternion();
        for (n, (j, h_n)) in cases.iter().enumerate() {
            let single = Poinsot::new(*j).expect("a body");
            let alone = forced(&single, h_n).expect("solvable").quaternion();
            for (a, b) in together.iter().zip(alone) {
                // Lanes share the scale of the units and the method of the slowest lane. Towards the double root at the bound, the
                // root (not the residual) loses digits.
                let allowed = 4e-15 / (1.0 - fractions[n]).sqrt();
                assert!((a.0[n] - b).abs() < allowed, "group {group}, lane {n}");
            }
            let omega = Rotation::from_quaternion(together.map(|x| x.0[n])).expect("unit");
            let scale = single.inertia().trace();
            assert!(
                residual(j, &omega, h_n) < 4e-15 * scale,
                "group {group}, lane {n}"
            );
        }
    }
}

#[test]
fn lanes_of_one_body_are_bit_equal_to_single_runs() {
    let mut random = Random(12);
    for case in 0..50 {
        let j = random.poinsot(case);
        let body = Poinsot::new(j).expect("a body");
        let momenta: [Vector3<f64>; 8] = std::array::from_fn(|_| {
            let direction = random.vector();
            // Moderate step sizes, which one iteration solves in every lane.
            direction * (0.03 / reach(&body, &direction))
        });
        let wide = Poinsot::new(lift_matrix::<Lanes<8>>(&j)).expect("bodies");
        let momentum = SpatialMomentum(Vector3::from(gather(&momenta.map(|m| [m[0], m[1], m[2]]))));
        let mut attitude = Rotation::identity();
        let mut free = Free::start(&wide, &attitude, &momentum, Lanes([1.0; 8])).expect("slow");
        for _ in 0..100 {
            free.step(&mut attitude).expect("a free body never stops");
        }
        for (lane, m) in momenta.iter().enumerate() {
            let mut alone = Rotation::identity();
            let mut single = Free::start(&body, &alone, &SpatialMomentum(*m), 1.0).expect("slow");
            for _ in 0..100 {
                single.step(&mut alone).expect("a free body never stops");
            }
            assert_eq!(attitude.quaternion().map(|x| x.0[lane]), alone.quaternion());
            assert_eq!(
                free.body_momentum().0.map(|x| x.0[lane]),
                single.body_momentum().0
            );
        }
    }
}

#[test]
fn one_unsolvable_lane_refuses_all_and_is_named() {
    let j = Matrix3::from_diagonal(&Vector3::new(0.5, 1.5, 2.0));
    let body = Poinsot::new(lift_matrix::<Lanes<4>>(&j)).expect("bodies");
    let mut h_n = lift::<Lanes<4>>(&Vector3::new(0.1, 0.1, 0.1));
    assert!(forced(&body, &h_n).is_ok());
    h_n[1].0[2] = 7.0;
    let error = forced(&body, &h_n).expect_err("lane 2 turns too far");
    let alone = Poinsot::new(j).expect("a body");
    assert_eq!(error.ratio, reach(&alone, &Vector3::new(0.1, 7.0, 0.1)));
    assert_eq!(error.component, 1);
    h_n[1].0[2] = f64::NAN;
    assert!(forced(&body, &h_n).expect_err("NaN").ratio.is_nan());
}

#[test]
fn double_double_solves_to_its_own_precision() {
    let mut random = Random(13);
    for case in 0..200 {
        let (j, h_n) = case_at(
            &mut random,
            case,
            [0.01, 0.3, 0.9, 0.9999][case as usize % 4],
        );
        let (j, h_n) = (lift_matrix::<DoubleDouble>(&j), lift(&h_n));
        let body = Poinsot::new(j).expect("a body");
        let omega = forced(&body, &h_n).expect("solvable");
        let error = residual(&j, &omega, &h_n);
        assert!(error < 1e-29, "case {case}: {error:e}");
    }
}

/// Derivatives of the quaternion with respect to `h N` (0..3) and to symmetric variations of the diagonal of `J` (3..6), against
/// central differences in double-double.
#[test]
fn dual_derivatives_of_the_forced_solver() {
    let mut random = Random(14);
    for case in 0..200 {
        let fraction = [0.01, 0.3, 0.9, 0.99][case as usize % 4];
        let (j, h_n) = case_at(&mut random, case | 1, fraction);
        let mut dual_j = lift_matrix::<Dual<6>>(&j);
        let mut dual_n = lift::<Dual<6>>(&h_n);
        for i in 0..3 {
            dual_n[i] = Dual::variable(h_n[i], i);
            dual_j[(i, i)] = Dual::variable(j[(i, i)], 3 + i);
        }
        let body = Poinsot::new(dual_j).expect("a body");
        let dual = forced(&body, &dual_n).expect("solvable").quaternion();
        for seed in 0..6 {
            let step = dd(1e-10);
            let moved = |direction: DoubleDouble| {
                let mut j = lift_matrix::<DoubleDouble>(&j);
                let mut n = lift::<DoubleDouble>(&h_n);
                if seed < 3 {
                    n[seed] += direction * step;
                } else {
                    j[(seed - 3, seed - 3)] += direction * step;
                }
                let body = Poinsot::new(j).expect("a body");
                forced(&body, &n).expect("solvable").quaternion()
            };
            let (plus, minus) = (moved(dd(1.0)), moved(dd(-1.0)));
            for k in 0..4 {
                let quotient = ((plus[k] - minus[k]) / (step + step)).value();
                let error = (dual[k].dual[seed] - quotient).abs();
                // Near the bound, derivatives grow as 1/sqrt(1 - fraction) and their errors as its cube. The eigenvalues of J, down
                // to 1e-3 here, also divide.
                let allowed = 1e-14 / (1.0 - fraction).powf(1.5) * (1.0 + quotient.abs()).powi(2);
                assert!(
                    error < allowed,
                    "case {case}, seed {seed}: {error:e} of {quotient:e}"
                );
            }
        }
    }
}

#[test]
fn dual_derivatives_of_a_free_trajectory_across_a_projection() {
    let j = Matrix3::from_diagonal(&Vector3::new(0.5, 1.5, 2.0));
    let m = Vector3::new(-0.5, 0.3, 1.0);
    fn run<T: Real>(j: Matrix3<T>, m: Vector3<T>) -> [T; 7] {
        let body = Poinsot::new(j).expect("a body");
        let mut attitude = Rotation::identity();
        let momentum = SpatialMomentum(m);
        let mut free = Free::start(&body, &attitude, &momentum, T::from_f64(0.1)).expect("slow");
        for _ in 0..70 {
            free.step(&mut attitude).expect("a free body never stops");
        }
        let ([w, x, y, z], mu) = (attitude.quaternion(), free.body_momentum().0);
        [w, x, y, z, mu[0], mu[1], mu[2]]
    }
    let dual_m = Vector3::from_fn(|i, _| Dual::<3>::variable(m[i], i));
    let dual = run(lift_matrix(&j), dual_m);
    for seed in 0..3 {
        let step = dd(1e-10);
        let moved = |direction: DoubleDouble| {
            let mut m = lift::<DoubleDouble>(&m);
            m[seed] += direction * step;
            run(lift_matrix(&j), m)
        };
        let (plus, minus) = (moved(dd(1.0)), moved(dd(-1.0)));
        for k in 0..7 {
            let quotient = ((plus[k] - minus[k]) / (step + step)).value();
            // Rounding error of 70 steps, whose derivatives grow linearly in time.
            assert!((dual[k].dual[seed] - quotient).abs() < 2e-13, "{k} {seed}");
        }
    }
}

#[test]
fn derivatives_at_rest_are_those_of_the_linear_problem() {
    // Omega = 1 + hat(I^-1 h N) + ..., so the vector part of the quaternion is I^-1 h N / 2.
    let j = Matrix3::from_diagonal(&Vector3::new(0.5, 1.5, 2.0));
    let h_n = Vector3::from_fn(|i, _| Dual::<3>::variable(0.0, i));
    let body = Poinsot::new(lift_matrix::<Dual<3>>(&j)).expect("a body");
    let q = forced(&body, &h_n).expect("solvable").quaternion();
    for (i, moment) in [3.5, 2.5, 2.0].into_iter().enumerate() {
        for seed in 0..3 {
            let expected = if seed == i { 0.5 / moment } else { 0.0 };
            assert!((q[i + 1].dual[seed] - expected).abs() < 1e-16);
        }
    }
}

#[test]
fn many_steps_at_once_are_the_same_steps() {
    let mut random = Random(23);
    let counts = [1, 70, 63, 64, 200];
    for case in 0..8 {
        let (j, m) = case_at(&mut random, case, 0.4);
        let body = Poinsot::new(j).expect("bodies");
        let momentum = SpatialMomentum(m);
        let start = random.rotation();
        let mut single = Free::start(&body, &start, &momentum, 1.0).expect("slow enough");
        let (mut batch, mut whole) = (single, single);
        let (mut one, mut many, mut once) = (start, start, start);
        // Across several projections, in portions of different lengths.
        let mut done = 0;
        for count in counts {
            for _ in 0..count {
                single.step(&mut one).expect("free");
            }
            batch
                .follow_many(&mut many, &momentum, count)
                .expect("free");
            // Two computations of the same numbers: each step differs by a few rounding errors, which add up.
            done += count;
            let bound = 8.0 * f64::EPSILON * done as f64;
            let apart = distance(&one, &many);
            assert!(apart <= bound, "case {case}, {done}: {apart:e}");
            let apart = (single.body_momentum().0 - batch.body_momentum().0).norm();
            assert!(apart <= bound * m.norm(), "case {case}, {done}: {apart:e}");
            // The spatial momentum is constant, whatever the angle about it.
            let seen = batch.body_momentum().to_space(&many);
            let apart = (seen.0 - m).norm();
            assert!(
                apart <= 16.0 * f64::EPSILON * m.norm(),
                "case {case}, {done}: {apart:e}"
            );
        }
        // In a single call, the result is bitwise identical.
        whole
            .follow_many(&mut once, &momentum, counts.iter().sum())
            .expect("free");
        assert_eq!(once.quaternion(), many.quaternion(), "case {case}");
        assert_eq!(whole, batch);
        // The batch also follows single steps in between.
        for _ in 0..5 {
            batch.step(&mut many).expect("free");
        }
        batch.follow_many(&mut many, &momentum, 5).expect("free");
        whole.follow_many(&mut once, &momentum, 10).expect("free");
        let apart = distance(&once, &many);
        assert!(
            apart <= 8.0 * f64::EPSILON * (done + 10) as f64,
            "case {case}: {apart:e}"
        );
    }
}

/// The largest difference of two quaternions, up to sign.
fn distance(a: &Rotation, b: &Rotation) -> f64 {
    let (a, b) = (a.quaternion(), b.quaternion());
    let worst = |sign: f64| {
        let gaps = a.iter().zip(&b).map(|(x, y)| (x - sign * y).abs());
        gaps.fold(0.0, clebsch::scalar::larger)
    };
    worst(1.0).min(worst(-1.0))
}
