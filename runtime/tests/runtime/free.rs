//! The free body: conservation over a million steps, reference numbers, errors.

use super::common::{Random, body};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::solvers::moser_veselov::{Free, forced, reach};
use clebsch::{BodyMomentum, Poinsot, Rotation, SpatialMomentum};

const H: f64 = 0.1;

/// Largest relative drift of energy, `|mu|^2` and spatial momentum over `steps` steps, sampled every `every` steps.
fn drift(body: &Poinsot, momentum: Vector3<f64>, steps: u64, every: u64) -> [f64; 3] {
    let inverse = body.inertia().try_inverse().expect("regular");
    let energy = |mu: &Vector3<f64>| 0.5 * mu.dot(&(inverse * mu));
    let mut attitude = Random(9).rotation();
    let momentum = SpatialMomentum(momentum);
    let mu = momentum.to_body(&attitude).0;
    let (energy_0, square_0) = (energy(&mu), mu.norm_squared());
    let mut free = Free::start(body, &attitude, &momentum, H).expect("slow enough");
    let mut worst = [0.0_f64; 3];
    for step in 1..=steps {
        free.step(&mut attitude).expect("a free body never stops");
        if step % every == 0 {
            let mu = free.body_momentum();
            let now = [
                energy(&mu.0) / energy_0 - 1.0,
                mu.0.norm_squared() / square_0 - 1.0,
                (mu.to_space(&attitude).0 - momentum.0).norm() / momentum.0.norm(),
            ];
            for (worst, now) in worst.iter_mut().zip(now) {
                *worst = worst.max(now.abs());
            }
        }
    }
    worst
}

#[test]
fn a_million_steps_keep_energy_and_momentum() {
    let straight = Vector3::zeros();
    let turned = Vector3::new(0.4, -0.9, 0.3);
    for (moments, momentum) in [
        ([2.0, 2.0, 1.0], Vector3::new(0.1, 0.0, 1.0)),
        ([3.5, 2.5, 2.0], Vector3::new(-0.5, 0.0, 1.0)),
        ([1.0, 2.0, 3.0], Vector3::new(-0.5, 0.0, 1.0)),
        ([1.0, 1.0, 1.0], Vector3::new(0.1, -0.2, 0.3)),
    ] {
        for axes in [straight, turned] {
            let worst = drift(&body(moments, axes), momentum, 1_000_000, 37);
            for (name, drift) in ["energy", "|mu|^2", "spatial momentum"].iter().zip(worst) {
                // 64 steps of rounding without projection, measured below 5e-15.
                assert!(drift < 1e-14, "{moments:?} {axes}: {name} {drift:e}");
            }
        }
    }
}

#[test]
fn close_to_the_bound_nothing_is_amplified() {
    let mut random = Random(21);
    for case in 0..40 {
        let body = Poinsot::new(random.poinsot(case)).expect("a body");
        let direction = random.vector();
        // The initial attitude of `drift`.
        let seen = SpatialMomentum(direction).to_body(&Random(9).rotation()).0;
        // At the bound two roots meet, and the motion amplifies the rounding of 64 steps more.
        for (share, allowed) in [(0.5, 2e-14), (0.9, 4e-14), (0.99, 1e-13)] {
            let momentum = direction * (share / reach(&body, &(seen * H)));
            let worst = drift(&body, momentum, 20_000, 7);
            for (name, drift) in ["energy", "|mu|^2", "spatial momentum"].iter().zip(worst) {
                assert!(drift < allowed, "case {case}, {share}: {name} {drift:e}");
            }
        }
    }
}

#[test]
fn a_replaced_state_is_followed() {
    let body = body([3.5, 2.5, 2.0], Vector3::new(0.4, -0.9, 0.3));
    let start = Random(5).rotation();
    let momentum = SpatialMomentum(Vector3::new(-0.5, 0.2, 1.0));
    let other = SpatialMomentum(Vector3::new(0.3, 0.1, -0.4));
    let run = |free: &mut Free, momentum: &SpatialMomentum, steps: u32| {
        let mut attitude = start;
        for _ in 0..steps {
            free.follow(&mut attitude, momentum).expect("slow enough");
        }
        attitude
    };
    let mut free = Free::start(&body, &start, &momentum, H).expect("slow enough");
    let first = run(&mut free, &momentum, 100);
    // Back at the start, with the stored momentum or another one.
    assert_eq!(run(&mut free, &momentum, 100), first);
    let mut fresh = Free::start(&body, &start, &other, H).expect("slow enough");
    assert_eq!(run(&mut free, &other, 100), run(&mut fresh, &other, 100));
    // A momentum that is too large is an error, and the state stays unchanged.
    let (before, mut attitude) = (free, start);
    let error = free.follow(&mut attitude, &SpatialMomentum(momentum.0 * 1e3));
    assert!(error.expect_err("too fast").ratio > 1.0);
    assert_eq!((free, attitude), (before, start));
}

#[test]
fn near_a_principal_axis_nothing_is_amplified() {
    for tilt in [0.0, 1e-12, 1e-8, 1e-4, 1e-3, 1e-2] {
        let body = body([3.5, 2.5, 2.0], Vector3::zeros());
        let mut attitude = Rotation::identity();
        let momentum = SpatialMomentum(Vector3::new(0.0, tilt, 1.0));
        let mut free = Free::start(&body, &attitude, &momentum, H).expect("slow enough");
        for _ in 0..100_000 {
            free.step(&mut attitude).expect("a free body never stops");
        }
        let mu = free.body_momentum();
        let error = (mu.to_space(&attitude).0 - momentum.0).norm();
        assert!(error < 1e-14, "tilt {tilt:e}: {error:e}");
        assert!((mu.0.norm_squared() / momentum.0.norm_squared() - 1.0).abs() < 1e-14);
    }
}

#[test]
fn a_body_at_rest_stays_at_rest() {
    let body = body([3.5, 2.5, 2.0], Vector3::zeros());
    let start = Random(3).rotation();
    let mut attitude = start;
    let rest = SpatialMomentum(Vector3::zeros());
    let mut free = Free::start(&body, &attitude, &rest, H).expect("slow enough");
    for _ in 0..1000 {
        free.step(&mut attitude).expect("a free body never stops");
    }
    assert_eq!(free.body_momentum(), BodyMomentum(Vector3::zeros()));
    assert!((attitude.matrix() - start.matrix()).norm() < 1e-15);
}

#[test]
fn equals_the_forced_solver_without_a_force() {
    let mut random = Random(4);
    for case in 0..200 {
        let body = Poinsot::new(random.poinsot(case)).expect("a body");
        let mut attitude = random.rotation();
        let momentum = SpatialMomentum(random.vector() * (0.2 * body.inertia().trace()));
        let Ok(mut free) = Free::start(&body, &attitude, &momentum, H) else {
            continue;
        };
        let mut other = attitude;
        for _ in 0..10 {
            free.step(&mut attitude).expect("a free body never stops");
            let mu = momentum.to_body(&other).0;
            other = other * forced(&body, &(mu * H)).expect("as solvable as the free body");
            assert!(
                (attitude.matrix() - other.matrix()).norm() < 2e-14,
                "case {case}"
            );
        }
    }
}

/// Numbers from tests/reference/generate.py in the repository: momentum and attitude after 1 and 10 steps, moments (2, 2, 1),
/// momentum (0.1, 0, 1), h = 0.1, initial attitude the identity.
#[test]
#[allow(clippy::excessive_precision, reason = "the digits as computed")]
fn reference_numbers_of_the_symmetric_top() {
    let body = body([2.0, 2.0, 1.0], Vector3::zeros());
    let mut attitude = Rotation::identity();
    let momentum = SpatialMomentum(Vector3::new(0.1, 0.0, 1.0));
    let mut free = Free::start(&body, &attitude, &momentum, H).expect("slow enough");
    #[rustfmt::skip]
    let expected = [
        (1, [0.099_874_448_350_521_467_3, -0.005_009_447_741_919_238_73, 1.0], Matrix3::new(
            0.994_987_397_698_775_244, -0.100_000_313_682_083_488, 0.000_125_236_193_547_980_968,
            0.099_999_686_317_916_512_3, 0.994_974_889_803_031_12, -0.005_003_138_791_236_963_32,
            0.000_375_708_580_643_942_905, 0.004_990_583_626_289_110_05, 0.999_987_476_380_645_202,
        )),
        (10, [0.087_702_846_707_984_317_6, -0.048_043_841_221_490_651_6, 1.0], Matrix3::new(
            0.539_008_782_006_152_771, -0.842_210_851_637_003_224, 0.012_264_350_986_392_444_8,
            0.841_621_625_105_528_353, 0.537_933_163_511_620_278, -0.047_968_236_877_228_345_5,
            0.033_801_968_507_369_040_5, 0.036_177_243_942_209_670_7, 0.998_773_564_901_360_756,
        )),
    ];
    let mut node = 0;
    for (at, momentum, matrix) in expected {
        while node < at {
            free.step(&mut attitude).expect("a free body never stops");
            node += 1;
        }
        let error = (free.body_momentum().0 - Vector3::from(momentum)).norm();
        assert!(error < 1e-15, "node {at}: {error:e}");
        assert!((attitude.matrix() - matrix).norm() < 3e-15);
    }
}

#[test]
fn a_step_back_undoes_a_step() {
    let body = body([3.5, 2.5, 2.0], Vector3::new(0.2, 0.1, 0.5));
    let start = Random(5).rotation();
    let momentum = SpatialMomentum(Vector3::new(1.0, -2.0, 0.5));
    let mut attitude = start;
    let mut there = Free::start(&body, &attitude, &momentum, H).expect("slow enough");
    for _ in 0..50 {
        there.step(&mut attitude).expect("a free body never stops");
    }
    let mut back = Free::start(&body, &attitude, &momentum, -H).expect("slow enough");
    for _ in 0..50 {
        back.step(&mut attitude).expect("a free body never stops");
    }
    assert!((attitude.matrix() - start.matrix()).norm() < 2e-14);
}

#[test]
fn the_step_offered_instead_can_be_made_and_hardly_more() {
    let mut random = Random(6);
    for case in 0..200 {
        let body = Poinsot::new(random.poinsot(case)).expect("a body");
        let attitude = random.rotation();
        let momentum = SpatialMomentum(random.vector() * 100.0);
        let error = Free::start(&body, &attitude, &momentum, 10.0).expect_err("far too long");
        assert_eq!(error.h, Some(10.0));
        let largest = error.largest_step.expect("linear");
        assert!(Free::start(&body, &attitude, &momentum, largest).is_ok());
        assert!(Free::start(&body, &attitude, &momentum, largest * 1.0001).is_err());
        let said = error.to_string();
        let offered = said.split_once("to at most ").expect("offered").1;
        let offered: f64 = offered.parse().expect("a number");
        assert!(
            offered <= largest && offered > largest * 0.999_998,
            "{said}"
        );
        assert!(Free::start(&body, &attitude, &momentum, offered).is_ok());
    }
    // Exactly at the bound: moments (2, 2, 1), h m_3 = I_3.
    let body = body([2.0, 2.0, 1.0], Vector3::zeros());
    let momentum = SpatialMomentum(Vector3::new(-0.5, 0.0, 1.0));
    assert!(Free::start(&body, &Rotation::identity(), &momentum, 1.0).is_err());
}
