//! The orders of the free body's steps, measured by step halving against the Taylor series of the exact motion in double-double;
//! and the properties that a high-order step conserves or not.

use super::common::body;
use clebsch::nalgebra::{Matrix3, SMatrix, Vector3};
use clebsch::solvers::moser_veselov::{Free, Order};
use clebsch::{DoubleDouble, Dual, Poinsot, Real, Rotation, SpatialMomentum};

type Quad = DoubleDouble;

/// Number of terms of the series.
const TERMS: usize = 28;

/// Body momentum and attitude.
#[derive(Clone, Copy)]
struct Motion {
    momentum: Vector3<Quad>,
    quaternion: [Quad; 4],
}

fn quad(x: f64) -> Quad {
    Quad::from_f64(x)
}

/// `sum_j a_j b_(k-j)`.
fn convolved(a: &[Quad], b: &[Quad], k: usize) -> Quad {
    (0..=k).fold(quad(0.0), |sum, j| sum + a[j] * b[k - j])
}

/// One step of `mu' = mu x w`, `q' = q (0, w) / 2`, `w = I^-1 mu` by its Taylor series.
fn taylor(inverse: &Matrix3<Quad>, start: Motion, h: f64) -> Motion {
    let zero = [quad(0.0); TERMS + 1];
    let (mut m, mut w, mut q) = ([zero; 3], [zero; 3], [zero; 4]);
    for (row, x) in m.iter_mut().zip(&start.momentum) {
        row[0] = *x;
    }
    for (row, x) in q.iter_mut().zip(start.quaternion) {
        row[0] = x;
    }
    for k in 0..TERMS {
        let here = inverse * Vector3::new(m[0][k], m[1][k], m[2][k]);
        for i in 0..3 {
            w[i][k] = here[i];
        }
        let over = quad(1.0) / quad((k + 1) as f64);
        for i in 0..3 {
            let (j, l) = ((i + 1) % 3, (i + 2) % 3);
            m[i][k + 1] = (convolved(&m[j], &w[l], k) - convolved(&m[l], &w[j], k)) * over;
        }
        let half = over * quad(0.5);
        let p = |a: usize, b: usize| convolved(&q[a], &w[b], k);
        let change = [
            -p(1, 0) - p(2, 1) - p(3, 2),
            p(0, 0) + p(2, 2) - p(3, 1),
            p(0, 1) + p(3, 0) - p(1, 2),
            p(0, 2) + p(1, 1) - p(2, 0),
        ];
        for i in 0..4 {
            q[i][k + 1] = change[i] * half;
        }
    }
    let h = quad(h);
    let sum = |a: &[Quad]| a.iter().rev().fold(quad(0.0), |s, x| s * h + *x);
    Motion {
        momentum: Vector3::new(sum(&m[0]), sum(&m[1]), sum(&m[2])),
        quaternion: [sum(&q[0]), sum(&q[1]), sum(&q[2]), sum(&q[3])],
    }
}

/// The larger of the errors of momentum and attitude after `time`, with `steps` steps.
fn error(body: &Poinsot<Quad>, mu: Vector3<f64>, time: f64, steps: u32, order: Order) -> f64 {
    let inverse = clebsch::linalg::inverse(&body.inertia()).expect("regular");
    let mut exact = Motion {
        momentum: mu.map(quad),
        quaternion: [1.0, 0.0, 0.0, 0.0].map(quad),
    };
    // A power of two, so that the nodes are exact.
    for _ in 0..32 {
        exact = taylor(&inverse, exact, time / 32.0);
    }
    let mut attitude = Rotation::identity();
    let momentum = SpatialMomentum(mu.map(quad));
    let h = quad(time) / quad(f64::from(steps));
    let mut free = Free::start_of_order(body, &attitude, &momentum, h, order).expect("slow");
    for _ in 0..steps {
        free.step(&mut attitude).expect("free");
    }
    let off = (free.body_momentum().0 - exact.momentum).map(|x| x.magnitude());
    let q = attitude.quaternion();
    let apart = |sign: f64| {
        let pairs = q.iter().zip(exact.quaternion);
        pairs.fold(0.0_f64, |m, (a, b)| {
            m.max((*a - b * quad(sign)).magnitude())
        })
    };
    off.amax().max(apart(1.0).min(apart(-1.0)))
}

fn lifted(moments: [f64; 3], axes: Vector3<f64>) -> Poinsot<Quad> {
    Poinsot::new(body(moments, axes).matrix().map(quad)).expect("a body")
}

#[test]
fn every_order_is_measured() {
    let (straight, turned) = (Vector3::zeros(), Vector3::new(0.4, -0.9, 0.3));
    for (moments, axes, mu) in [
        ([3.5, 2.5, 2.0], straight, Vector3::new(-0.5, 0.0, 1.0)),
        ([3.5, 2.5, 2.0], turned, Vector3::new(-0.5, 0.2, 1.0)),
        ([1.0, 2.0, 3.0], straight, Vector3::new(-0.5, 0.1, 1.0)),
        ([2.0, 2.0, 1.0], straight, Vector3::new(-0.5, 0.0, 1.0)),
    ] {
        let body = lifted(moments, axes);
        for order in Order::ALL {
            let [coarse, fine] = [64, 128].map(|steps| error(&body, mu, 8.0, steps, order));
            let measured = (coarse / fine).log2();
            println!("{moments:?} order {order}: {measured:.3} ({coarse:.1e}, {fine:.1e})");
            // Far above the 1e-30 of the arithmetic, and close to the limit of small steps.
            assert!(fine > 1e-26, "{fine:e}");
            let nominal = f64::from(order.number());
            assert!((measured - nominal).abs() < 0.15, "{order}: {measured}");
        }
    }
}

/// The symplectic defect of a step: the largest entry of `D^T W' D - W`, with the canonical form `W` on attitudes and momenta, both
/// in the body frame.
fn symplectic_defect(h: f64, order: Order, compensated: bool) -> f64 {
    type D6 = Dual<6>;
    let body = body([3.5, 2.5, 2.0], Vector3::new(0.4, -0.9, 0.3));
    let lifted = Poinsot::new(body.matrix().map(D6::from_f64)).expect("a body");
    let seed = |x: f64, i: usize| {
        let mut seeded = D6::from_f64(x);
        seeded.dual[i] = 1.0;
        seeded
    };
    let mu = Vector3::new(-0.5, 0.2, 1.0);
    let start = Rotation::exp(&Vector3::new(0.3, -0.2, 0.5).map(D6::from_f64));
    let turn = Rotation::exp(&Vector3::from_fn(|i, _| seed(0.0, i)));
    let mut attitude = start * turn;
    let momentum = SpatialMomentum(attitude.rotate(&Vector3::from_fn(|i, _| seed(mu[i], 3 + i))));
    let mut free =
        Free::start_of_order(&lifted, &attitude, &momentum, D6::from_f64(h), order).expect("slow");
    if compensated {
        free = free.compensated();
    }
    free.step(&mut attitude).expect("free");
    let there = attitude.matrix();
    let relative = there.map(|x| D6::from_f64(x.value())).transpose() * there;
    let turned = clebsch::linalg::vee(&relative);
    let moved = free.body_momentum().0;
    let derivative = SMatrix::<f64, 6, 6>::from_fn(|i, j| match i {
        0..3 => turned[i].dual[j],
        _ => moved[i - 3].dual[j],
    });
    let form = |mu: &Vector3<f64>| {
        let mut form = SMatrix::<f64, 6, 6>::zeros();
        form.fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&-clebsch::linalg::hat(mu));
        form.fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&Matrix3::identity());
        form.fixed_view_mut::<3, 3>(3, 0)
            .copy_from(&-Matrix3::identity());
        form
    };
    let arrived = moved.map(|x| x.value());
    (derivative.transpose() * form(&arrived) * derivative - form(&mu)).amax()
}

#[test]
fn only_order_two_is_symplectic_and_the_defect_is_that_of_the_order() {
    // A few rounding errors in each of several tens of operations.
    assert!(symplectic_defect(0.4, Order::Two, false) < 1e-14);
    for order in [Order::Four, Order::Six, Order::Eight] {
        let [coarse, fine] = [0.8, 0.4].map(|h| symplectic_defect(h, order, false));
        let measured = (coarse / fine).log2();
        println!("order {order}: {coarse:.1e}, {fine:.1e}, exponent {measured:.2}");
        assert!(fine > 1e-13, "order {order} passes: {fine:e}");
        let expected = f64::from(order.number()) + 1.0;
        assert!((measured - expected).abs() < 1.0, "{order}: {measured}");
    }
    for h in [0.4, 0.2, 0.1] {
        println!(
            "order 10, h = {h}: {:.1e}",
            symplectic_defect(h, Order::Ten, false)
        );
    }
    // At a moderate step size, order ten has only rounding error.
    assert!(symplectic_defect(0.1, Order::Ten, false) < 1e-14);
}

#[test]
fn compensation_leaves_the_defect_of_order_ten() {
    for order in [Order::Four, Order::Six, Order::Eight] {
        let [coarse, fine] = [0.8, 0.4].map(|h| symplectic_defect(h, order, true));
        let plain = symplectic_defect(0.8, order, false);
        let measured = (coarse / fine).log2();
        println!(
            "order {order}: {coarse:.1e} (without {plain:.1e}), {fine:.1e}, exponent {measured:.2}"
        );
        assert!(fine > 1e-15 || coarse < 1e-12, "order {order}: {coarse:e}");
        assert!(measured > 9.5, "{order}: {measured}");
        assert!(coarse < 0.1 * plain, "{order}: {coarse:e} of {plain:e}");
        assert!(symplectic_defect(0.1, order, true) < 1e-14);
    }
    // At order two, compensation changes nothing.
    assert!(symplectic_defect(0.4, Order::Two, true) < 1e-14);
}

#[test]
fn a_compensated_step_has_its_order_and_can_be_undone() {
    let mu = Vector3::new(-0.5, 0.2, 1.0);
    let body = body([3.5, 2.5, 2.0], Vector3::new(0.4, -0.9, 0.3));
    let momentum = SpatialMomentum(mu);
    for order in [Order::Four, Order::Six, Order::Eight, Order::Ten] {
        let end = |count: u32, compensated: bool| {
            let h = 4.0 / f64::from(count);
            let mut attitude = Rotation::identity();
            let free = Free::start_of_order(&body, &attitude, &momentum, h, order).expect("slow");
            let mut free = if compensated {
                free.compensated()
            } else {
                free
            };
            for _ in 0..count {
                free.step(&mut attitude).expect("free");
            }
            (attitude, free)
        };
        // The accumulated compensating rotations decrease like the error.
        let apart = |count: u32| {
            let ((a, _), (b, _)) = (end(count, false), end(count, true));
            (a.matrix() - b.matrix()).amax()
        };
        let (coarse, fine) = (apart(4), apart(8));
        let measured = (coarse / fine).log2();
        println!("order {order}: {coarse:.1e}, {fine:.1e}, {measured:.2}");
        if order < Order::Ten {
            assert!(
                (measured - f64::from(order.number())).abs() < 0.4,
                "{order}"
            );
        } else {
            assert_eq!(coarse, 0.0, "nothing is known to be missing");
        }
        let (mut attitude, there) = end(40, true);
        let spatial = there.body_momentum().to_space(&attitude);
        assert!(
            (spatial.0 - mu).amax() < 1e-14,
            "the turn is about the momentum"
        );
        let back = Free::start_of_order(&body, &attitude, &momentum, -0.1, order).expect("slow");
        let mut back = back.compensated();
        for _ in 0..40 {
            back.step(&mut attitude).expect("free");
        }
        assert!((attitude.matrix() - Matrix3::identity()).amax() < 1e-13);
    }
}

#[test]
fn refusals_name_a_step_that_works() {
    let body = body([2.0, 2.0, 1.0], Vector3::zeros());
    let attitude = Rotation::identity();
    let momentum = SpatialMomentum(Vector3::new(-0.5, 0.0, 1.0));
    for order in Order::ALL {
        let start = |h: f64| Free::start_of_order(&body, &attitude, &momentum, h, order);
        let error = start(20.0).expect_err("too long");
        let largest = error.largest_step.expect("searched");
        println!("order {order}: {error}");
        assert!(error.ratio > 1.0, "{error:?}");
        assert_eq!(error.order, order);
        assert!(start(largest).is_ok(), "order {order}: {largest}");
        assert!(
            start(largest * (1.0 + 1e-6)).is_err(),
            "order {order}: {largest}"
        );
    }
    // The plain step fails at exactly 1; higher orders continue, because their modified moments differ.
    let start = |order| Free::start_of_order(&body, &attitude, &momentum, 1.0, order);
    assert!(start(Order::Two).is_err());
    assert!(Order::ALL[1..].iter().all(|order| start(*order).is_ok()));
}

#[test]
fn a_million_steps_of_every_order_keep_what_is_kept() {
    for order in Order::ALL {
        let body = body([1.0, 2.0, 3.0], Vector3::new(0.4, -0.9, 0.3));
        let inverse = body.inertia().try_inverse().expect("regular");
        let mut attitude = Rotation::identity();
        let momentum = SpatialMomentum(Vector3::new(-0.5, 0.1, 1.0));
        let energy = |mu: Vector3<f64>| mu.dot(&(inverse * mu));
        let (square, start) = (momentum.0.norm_squared(), energy(momentum.0));
        let mut free = Free::start_of_order(&body, &attitude, &momentum, 0.1, order).expect("slow");
        let mut worst = 0.0_f64;
        for step in 1..=1_000_000_u64 {
            free.step(&mut attitude).expect("free");
            if step % 37 == 0 {
                let mu = free.body_momentum();
                let off = (mu.to_space(&attitude).0 - momentum.0).norm() / momentum.0.norm();
                worst = worst
                    .max((energy(mu.0) / start - 1.0).abs())
                    .max((mu.0.norm_squared() / square - 1.0).abs())
                    .max(off);
            }
        }
        println!("order {order}: {worst:.1e}");
        // As at order two: 64 steps of rounding without projection.
        assert!(worst < 1e-14, "order {order}: {worst:e}");
    }
}
