//! Hand-written steppers of spatial forms, coupled bodies, SU(2), fields and n dimensions: against reference numbers, against each
//! other if two describe one motion, and Newton's method against the fixed-point iteration of the thesis. This file uses nothing of
//! the library under test.

use clebsch_oracle::handwritten::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply, cross, dot,
};
use clebsch_oracle::handwritten::body_in_field::TwoFields;
use clebsch_oracle::handwritten::body_n::{product, transposed};
use clebsch_oracle::handwritten::cayley_klein::CayleyKlein;
use clebsch_oracle::handwritten::coupled_bodies::{CoupledBodies, MOST_ITERATIONS, Pair, RESIDUAL};
use clebsch_oracle::handwritten::coupled_fixed_point::FixedPoint;
use clebsch_oracle::handwritten::free_body::FreeBody;
use clebsch_oracle::handwritten::heavy_top::HeavyTop;
use clebsch_oracle::physics::cases::{diagonal, generic_top, lagrange_top};
use clebsch_oracle::physics::measure::{matrices, vectors, worse};
use clebsch_oracle::physics::systems::{
    body_in, generic_pair, poinsot, reference_pair, relative, spatial_body, spatial_top, total,
};
use clebsch_oracle::reference::{
    H, NODES, TOLERANCE, coupled_sym, quaternion, spatial, top_lagrange,
};

#[test]
fn spatial_reference() {
    let mut body = spatial_body(H);
    let (mut node, mut before) = (0, body.attitude());
    for (place, target) in NODES.into_iter().enumerate() {
        while node < target {
            before = body.attitude();
            body.step();
            node += 1;
        }
        let omega = body.attitude().times(&before.conjugate()).matrix();
        let off = [
            matrices(&body.poinsot(), &spatial::POINSOT[place]),
            matrices(&body.attitude().matrix(), &spatial::ATTITUDE[place]),
            matrices(&omega, &spatial::OMEGA[place]),
        ];
        println!("{target}: {off:?}");
        assert!(off.into_iter().fold(0.0, worse) < TOLERANCE, "{off:?}");
    }
    let r = Quaternion([0.86_f64.sqrt(), 0.1, -0.3, 0.2]).matrix();
    assert!(vectors(&apply(&r, &spatial::BODY_M0), &spatial::M0) < 1e-15);
    let j = diagonal(poinsot(spatial::MOMENTS));
    let seen = product(&product(&r, &j), &transposed(&r));
    assert!(matrices(&seen, &spatial::J0) < 1e-14);
    let [trace, square, determinant] = spatial::INVARIANTS;
    let j = body.poinsot();
    let found = [
        j[0][0] + j[1][1] + j[2][2],
        (0..9).map(|n| j[n / 3][n % 3] * j[n / 3][n % 3]).sum(),
        dot(&j[0], &cross(&j[1], &j[2])),
    ];
    assert!(vectors(&found, &[trace, square, determinant]) < 1e-13);
}

#[test]
fn spatial_top_reference() {
    let mut top = spatial_top(H);
    let mut node = 0;
    for (place, target) in NODES.into_iter().enumerate() {
        while node < target {
            top.step().expect("solvable");
            node += 1;
        }
        let off = [
            vectors(
                &top.spatial_momentum(),
                &top_lagrange::SPATIAL_MOMENTUM[place],
            ),
            vectors(&top.arm(), &top_lagrange::SPATIAL_ARM[place]),
            matrices(&top.attitude().matrix(), &top_lagrange::ATTITUDE[place]),
        ];
        println!("{target}: {off:?}");
        assert!(off.into_iter().fold(0.0, worse) < TOLERANCE, "{off:?}");
    }
}

#[test]
fn coupled_reference() {
    let (data, q, mu) = reference_pair();
    let mut pair = CoupledBodies::start(&data, &q, &mu, H).expect("solvable");
    assert!((pair.energy() - coupled_sym::ENERGY_0).abs() < 1e-15);
    let (mut node, mut low, mut high) = (0, 0.0_f64, 0.0_f64);
    for (place, target) in NODES.into_iter().enumerate() {
        while node < target {
            pair.step().expect("solvable");
            node += 1;
            low = low.min(pair.energy() - coupled_sym::ENERGY_0);
            high = worse(high, pair.energy() - coupled_sym::ENERGY_0);
        }
        let [one, two] = pair.body_momenta();
        let seen = add_scaled(&one, 1.0, &apply(&relative(&pair), &two));
        let off = [
            vectors(&one, &coupled_sym::FIRST_MOMENTUM[place]),
            vectors(&two, &coupled_sym::SECOND_MOMENTUM[place]),
            matrices(&relative(&pair), &coupled_sym::RELATIVE_ATTITUDE[place]),
            matrices(
                &pair.attitudes()[0].matrix(),
                &coupled_sym::FIRST_ATTITUDE[place],
            ),
            (dot(&seen, &seen) - coupled_sym::CASIMIR).abs(),
            vectors(&total(&pair), &coupled_sym::TOTAL_MOMENTUM),
        ];
        println!("{target}: {off:?}");
        assert!(
            off.into_iter().fold(0.0, worse) < coupled_sym::TOLERANCE,
            "{off:?}"
        );
    }
    let [least, largest] = coupled_sym::ENERGY_DEVIATION;
    let off = worse((low - least).abs(), (high - largest).abs());
    assert!(off < 1e-13, "{low:e} {high:e}");
}

#[test]
fn coupled_newton_needs_few_iterations() {
    for (data, q, mu) in [reference_pair(), generic_pair()] {
        let mut pair = CoupledBodies::start(&data, &q, &mu, H).expect("solvable");
        let (mut most, mut later, mut residual) = (0, 0, 0.0_f64);
        for step in 0..1000 {
            pair.step().expect("solvable");
            most = most.max(pair.iterations());
            if step >= 4 {
                later = later.max(pair.iterations());
            }
            residual = worse(residual, pair.residual());
        }
        println!("{most} iterations at most, {later} once on its way; residual {residual:.1e}");
        assert!(most <= MOST_ITERATIONS && later <= 2 && residual <= RESIDUAL);
    }
}

/// The theoretical contraction rate of a sweep over both bodies: the largest eigenvalue of I1^-1 B I2^-1 B^T with B = -eps
/// hat(d1)^T Lambda hat(d2), by power iteration.
fn theoretical_rate(data: &Pair, r: &Matrix) -> f64 {
    let inertia = |j: &Matrix| {
        let trace = j[0][0] + j[1][1] + j[2][2];
        [0, 1, 2].map(|a| [0, 1, 2].map(|b| if a == b { trace - j[a][b] } else { -j[a][b] }))
    };
    let solve = |m: &Matrix, v: &Vector| {
        let rows = [
            cross(&m[1], &m[2]),
            cross(&m[2], &m[0]),
            cross(&m[0], &m[1]),
        ];
        let det = dot(&m[0], &rows[0]);
        // The rows of the inverse of a symmetric matrix are its cofactors over the determinant.
        apply(&rows, v).map(|x| x / det)
    };
    let [one, two] = data.poinsots.map(|j| inertia(&j));
    let (d1, d2) = (data.arms[0], data.arms[1]);
    // B x = eps d1 x R (d2 x x), B^T x = eps d2 x R^T (d1 x x).
    let mut v = [0.3, 0.5, 0.8];
    let mut rate = 0.0;
    for _ in 0..200 {
        let w = cross(&d2, &apply(&transposed(r), &cross(&d1, &v))).map(|x| data.eps * x);
        let w = solve(&two, &w);
        let w = cross(&d1, &apply(r, &cross(&d2, &w))).map(|x| data.eps * x);
        let w = solve(&one, &w);
        rate = dot(&w, &w).sqrt();
        v = w.map(|x| x / rate);
    }
    rate
}

#[test]
fn the_fixed_point_contracts_at_a_rate_without_h() {
    for (data, q, mu) in [reference_pair(), generic_pair()] {
        let r = q[0].conjugate().times(&q[1]).matrix();
        let theory = theoretical_rate(&data, &r);
        for h in [0.1, 0.01, 0.001] {
            let found = FixedPoint::solve(&data, &q, &mu, h).expect("solvable");
            println!(
                "h = {h}: rate {:.4}, theory {theory:.4}, {} sweeps",
                found.rate(),
                found.changes.len()
            );
            // Rotations of a few percent change the rate by a few percent.
            assert!((found.rate() / theory - 1.0).abs() < 2.0 * h + 0.02);
            // Both solvers find the same step.
            let mut pair = CoupledBodies::start(&data, &q, &mu, h).expect("solvable");
            pair.step().expect("solvable");
            for ((before, after), wanted) in q.iter().zip(pair.attitudes()).zip(&found.turns) {
                let turn = before.conjugate().times(&after).matrix();
                assert!(matrices(&turn, wanted) < 1e-14);
            }
        }
    }
}

#[test]
fn quaternion_reference() {
    for (c, quaternions, momenta) in [
        (0.0, quaternion::QUATERNION_C0, quaternion::MOMENTUM_C0),
        (1.0, quaternion::QUATERNION_C1, quaternion::MOMENTUM_C1),
    ] {
        let mut body = CayleyKlein::start(
            &quaternion::MOMENTS,
            c,
            &Quaternion::IDENTITY,
            &quaternion::M0,
            H,
        )
        .expect("solvable");
        let mut node = 0;
        for (place, target) in NODES.into_iter().enumerate() {
            while node < target {
                body.step().expect("solvable");
                node += 1;
            }
            let q = body.quaternion().0;
            let off = (0..4).fold(
                vectors(&body.body_momentum(), &momenta[place]),
                |worst, i| worse(worst, (q[i] - quaternions[place][i]).abs()),
            );
            println!("c = {c}, {target}: {off:.1e}");
            assert!(off < TOLERANCE, "c = {c}, {target}: {off:e}");
        }
    }
}

#[test]
fn su2_without_c_is_so3() {
    let moments = [3.5, 2.5, 2.0];
    let mu = [-0.5, 0.2, 1.0];
    let q = Quaternion([0.5, 0.1, -0.7, 0.5]);
    let mut family = CayleyKlein::start(&moments, 0.0, &q, &mu, H).expect("solvable");
    let j = diagonal(poinsot(moments));
    let mut body = FreeBody::start(&j, &q, &mu, H).expect("solvable");
    let mut other = CayleyKlein::start(&moments, 1.0, &q, &mu, H).expect("solvable");
    let mut worst = 0.0;
    for _ in 0..1000 {
        family.step().expect("solvable");
        other.step().expect("solvable");
        body.step();
        let off = matrices(&family.quaternion().matrix(), &body.attitude().matrix());
        worst = worse(worst, off);
    }
    println!("{worst:.1e}");
    assert!(worst < 1e-12, "{worst:e}");
    // A different c gives a different integrator.
    let off = matrices(&other.quaternion().matrix(), &body.attitude().matrix());
    assert!(off > 1e-6, "{off:e}");
}

#[test]
fn body_is_space() {
    let mut seen = spatial_body(H);
    let j = diagonal(poinsot(spatial::MOMENTS));
    let mut body = FreeBody::start(&j, &seen.attitude(), &spatial::BODY_M0, H).expect("solvable");
    let mut top_seen = spatial_top(H);
    let start = lagrange_top();
    let mut top =
        HeavyTop::start(&start.top, &start.attitude, &start.body_momentum, H).expect("solvable");
    for _ in 0..800 {
        seen.step();
        body.step();
        top_seen.step().expect("solvable");
        top.step().expect("solvable");
    }
    let off = matrices(&seen.attitude().matrix(), &body.attitude().matrix());
    assert!(off < 1e-12, "{off:e}");
    let off = matrices(&top_seen.attitude().matrix(), &top.attitude().matrix());
    assert!(off < 1e-11, "{off:e}");
}

#[test]
fn one_field_of_two_is_the_heavy_top() {
    let start = generic_top();
    let attitude = start.attitude.normalised();
    let fields = TwoFields {
        weight: start.top.weight,
        dipole: [0.0; 3],
        up: start.top.up,
        field: [0.3, 0.4, 0.5],
    };
    let mut body = body_in(&fields, H);
    let mut top =
        HeavyTop::start(&start.top, &attitude, &start.body_momentum, H).expect("solvable");
    for _ in 0..100 {
        body.step().expect("solvable");
        top.step().expect("solvable");
    }
    let off = matrices(&body.attitude().matrix(), &top.attitude().matrix());
    assert!(off < 1e-12, "{off:e}");
    assert!((body.energy() - top.energy()).abs() < 1e-12);
}
