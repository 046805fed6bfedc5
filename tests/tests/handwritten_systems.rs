//! Hand-written steppers of spatial forms, coupled bodies, SU(2), fields and n dimensions: against reference numbers,
//! against each other where two describe one motion, their conservation laws over 1e5 steps, and their order.
//! Takes nothing of the library under test.

use clebsch_tests::handwritten::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply, cross, dot,
};
use clebsch_tests::handwritten::body_in_field::{BodyInField, Field, QuadraticField, TwoFields};
use clebsch_tests::handwritten::body_n::{BodyN, Square, product, transposed};
use clebsch_tests::handwritten::cayley_klein::CayleyKlein;
use clebsch_tests::handwritten::coupled_bodies::{CoupledBodies, MOST_ITERATIONS, Pair, RESIDUAL};
use clebsch_tests::handwritten::coupled_fixed_point::FixedPoint;
use clebsch_tests::handwritten::free_body::FreeBody;
use clebsch_tests::handwritten::free_body_spatial::FreeBodySpatial;
use clebsch_tests::handwritten::heavy_top::HeavyTop;
use clebsch_tests::handwritten::heavy_top_spatial::{HeavyTopSpatial, SpatialTop};
use clebsch_tests::physics::cases::{diagonal, generic_top, lagrange_top};
use clebsch_tests::physics::measure::{matrices, vectors, worse};
use clebsch_tests::physics::order::orders;
use clebsch_tests::reference::{
    H, NODES, TOLERANCE, coupled_sym, quaternion, spatial, top_lagrange,
};

const LONG: u64 = 100_000;

fn multiplied(a: &Matrix, b: &Matrix) -> Matrix {
    product(a, b)
}

fn poinsot(moments: Vector) -> Vector {
    let half = 0.5 * (moments[0] + moments[1] + moments[2]);
    moments.map(|i| half - i)
}

fn spatial_body(h: f64) -> FreeBodySpatial {
    let [x, y, z] = spatial::QUATERNION_0;
    let w = (1.0 - x * x - y * y - z * z).sqrt();
    FreeBodySpatial::start(&spatial::J0, &Quaternion([w, x, y, z]), &spatial::M0, h)
        .expect("solvable")
}

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
    let seen = multiplied(&multiplied(&r, &j), &transposed(&r));
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

fn spatial_top(h: f64) -> HeavyTopSpatial {
    let start = lagrange_top();
    let r = start.attitude.matrix();
    let seen = multiplied(&multiplied(&r, &start.top.poinsot), &transposed(&r));
    let top = SpatialTop {
        weight: 1.0,
        up: start.top.up,
        poinsot: seen,
        arm: apply(&r, &start.top.weight),
    };
    HeavyTopSpatial::start(&top, &start.attitude, &apply(&r, &start.body_momentum), h)
        .expect("solvable")
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

fn reference_pair() -> (Pair, [Quaternion; 2], [Vector; 2]) {
    let mut j = diagonal(poinsot(coupled_sym::MOMENTS));
    for (r, row) in j.iter_mut().enumerate() {
        for (c, x) in row.iter_mut().enumerate() {
            *x += coupled_sym::EPS * coupled_sym::ARM[r] * coupled_sym::ARM[c];
        }
    }
    let pair = Pair {
        poinsots: [j; 2],
        arms: [coupled_sym::ARM; 2],
        eps: coupled_sym::EPS,
    };
    let second = Quaternion::from_matrix(&coupled_sym::ATTITUDE_0);
    (pair, [Quaternion::IDENTITY, second], [coupled_sym::M0; 2])
}

/// Two different bodies with arms off their axes.
fn generic_pair() -> (Pair, [Quaternion; 2], [Vector; 2]) {
    let pair = Pair {
        poinsots: [
            [[0.9, 0.1, -0.15], [0.1, 0.6, 0.05], [-0.15, 0.05, 1.2]],
            [[0.7, -0.05, 0.1], [-0.05, 1.1, 0.2], [0.1, 0.2, 0.8]],
        ],
        arms: [[0.4, -0.3, 0.8], [-0.2, 0.7, 0.5]],
        eps: 0.4,
    };
    let q = [
        Quaternion([0.5, 0.1, -0.7, 0.5]).normalised(),
        Quaternion([0.3, -0.6, 0.2, 0.7]).normalised(),
    ];
    (pair, q, [[0.7, -0.4, 0.9], [-0.3, 0.8, 0.2]])
}

fn relative(pair: &CoupledBodies) -> Matrix {
    let [a, b] = pair.attitudes();
    a.conjugate().times(&b).matrix()
}

fn total(pair: &CoupledBodies) -> Vector {
    let [a, b] = pair.spatial_momenta();
    add_scaled(&a, 1.0, &b)
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
            high = high.max(pair.energy() - coupled_sym::ENERGY_0);
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
            residual = residual.max(pair.residual());
        }
        println!("{most} iterations at most, {later} once on its way; residual {residual:.1e}");
        assert!(most <= MOST_ITERATIONS && later <= 2 && residual <= RESIDUAL);
    }
}

/// The contraction that theory gives for the sweep over both bodies: the largest eigenvalue of
/// I1^-1 B I2^-1 B^T with B = -eps hat(d1)^T Lambda hat(d2), by the power method.
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
        // The inverse of a symmetric matrix has the cofactors as rows.
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
            // Rotations of a few percent change the rate by as much.
            assert!((found.rate() / theory - 1.0).abs() < 2.0 * h + 0.02);
            // Both solvers find the same step.
            let mut pair = CoupledBodies::start(&data, &q, &mu, h).expect("solvable");
            pair.step().expect("solvable");
            for i in 0..2 {
                let turn = q[i].conjugate().times(&pair.attitudes()[i]).matrix();
                assert!(matrices(&turn, &found.turns[i]) < 1e-14);
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
    // Another c is another integrator.
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

/// Largest drift of components over `steps`, each relative to its scale.
fn drift<S>(
    motion: &mut S,
    steps: u64,
    step: impl Fn(&mut S),
    observe: impl Fn(&S) -> Vec<f64>,
    scale: f64,
) -> f64 {
    let start = observe(motion);
    let mut worst = 0.0;
    for _ in 0..steps {
        step(motion);
        for (now, then) in observe(motion).into_iter().zip(&start) {
            worst = worse(worst, (now - then).abs() / scale);
        }
    }
    worst
}

#[test]
fn conserved_over_a_hundred_thousand_steps() {
    let spatial = drift(
        &mut spatial_body(H),
        LONG,
        FreeBodySpatial::step,
        |b| {
            let j = b.poinsot();
            let trace = j[0][0] + j[1][1] + j[2][2];
            vec![b.energy(), trace, dot(&j[0], &cross(&j[1], &j[2]))]
        },
        1.0,
    );
    let top = drift(
        &mut spatial_top(H),
        LONG,
        |t| t.step().expect("solvable"),
        |t| {
            let (j, chi) = (t.poinsot(), t.arm());
            let m = t.spatial_momentum();
            vec![m[2], dot(&chi, &chi), dot(&chi, &apply(&j, &chi))]
        },
        1.0,
    );
    let (data, q, mu) = generic_pair();
    let pair = drift(
        &mut CoupledBodies::start(&data, &q, &mu, H).expect("solvable"),
        LONG,
        |p| p.step().expect("solvable"),
        |p| {
            let [one, two] = p.body_momenta();
            let seen = add_scaled(&one, 1.0, &apply(&relative(p), &two));
            let m = total(p);
            vec![dot(&seen, &seen), m[0], m[1], m[2]]
        },
        2.0,
    );
    let (data, q, mu) = reference_pair();
    let axes = drift(
        &mut CoupledBodies::start(&data, &q, &mu, H).expect("solvable"),
        LONG,
        |p| p.step().expect("solvable"),
        |p| p.body_momenta().map(|m| m[2]).to_vec(),
        1.0,
    );
    let family = drift(
        &mut CayleyKlein::start(
            &[3.5, 2.5, 2.0],
            1.0,
            &Quaternion::IDENTITY,
            &[-0.5, 0.0, 1.0],
            H,
        )
        .expect("solvable"),
        LONG,
        |b| b.step().expect("solvable"),
        |b| {
            let mu = b.body_momentum();
            let m = apply(&b.quaternion().matrix(), &mu);
            vec![
                dot(&mu, &mu),
                m[0],
                m[1],
                m[2],
                b.quaternion().norm_squared(),
            ]
        },
        1.0,
    );
    let mut quadratic = quadratic_body(H);
    let axis = quadratic_field().axis;
    let field = drift(
        &mut quadratic,
        LONG,
        |b| b.step().expect("solvable"),
        |b| {
            vec![
                dot(&b.spatial_momentum(), &axis),
                b.attitude().norm_squared(),
            ]
        },
        1.0,
    );
    println!(
        "spatial {spatial:.1e}, top {top:.1e}, pair {pair:.1e}, third components {axes:.1e}, SU(2) {family:.1e}, field {field:.1e}"
    );
    for (name, off, bound) in [
        ("spatial body", spatial, 1e-14),
        ("spatial top", top, 1e-13),
        ("pair", pair, 1e-13),
        // Kept by symmetry, not by the form of the stepper: rounding adds up like a random walk.
        ("third components of a symmetric pair", axes, 1e-12),
        ("SU(2)", family, 1e-14),
        ("quadratic field", field, 1e-13),
    ] {
        assert!(off < bound, "{name}: {off:e}");
    }
}

/// det(M + lambda J^2), Manakov's integrals, at some lambda, over the product of the lengths that the rows have on
/// average (|M| is kept, too); a step with the wrong J^2 loses them.
fn manakov<const N: usize>(m: &Square<N>, j: &[f64; N], lambda: f64) -> f64 {
    let mut a = *m;
    for (i, row) in a.iter_mut().enumerate() {
        row[i] += lambda * j[i] * j[i];
    }
    let square: f64 = m.iter().flatten().map(|x| x * x).sum::<f64>() / N as f64;
    let lengths = j.map(|j| ((lambda * j * j).powi(2) + square).sqrt());
    let mut det = 1.0 / lengths.iter().product::<f64>();
    for c in 0..N {
        let pivot = (c..N)
            .max_by(|p, q| a[*p][c].abs().total_cmp(&a[*q][c].abs()))
            .unwrap_or(c);
        if pivot != c {
            a.swap(c, pivot);
            det = -det;
        }
        det *= a[c][c];
        for r in c + 1..N {
            let factor = a[r][c] / a[c][c];
            let above = a[c];
            for (x, y) in a[r].iter_mut().zip(above) {
                *x -= factor * y;
            }
        }
    }
    det
}

fn body_n<const N: usize>(h: f64) -> ([f64; N], BodyN<N>) {
    let mut j = [0.0; N];
    let mut mu = [[0.0; N]; N];
    for a in 0..N {
        j[a] = 0.5 + 0.25 * a as f64;
        for b in 0..a {
            let m = 0.4 * (1.3 * a as f64 + 2.1 * b as f64).cos();
            mu[a][b] = m;
            mu[b][a] = -m;
        }
    }
    let start = clebsch_tests::handwritten::body_n::identity();
    (j, BodyN::start(&j, &start, &mu, h).expect("solvable"))
}

fn manakov_drift<const N: usize>(steps: u64, wrong: f64) -> f64 {
    let (j, mut body) = body_n::<N>(H);
    let j = j.map(|x| x * x * (1.0 + wrong * x)).map(f64::sqrt);
    let observe = move |b: &BodyN<N>| -> Vec<f64> {
        let m = b.body_momentum();
        let mut list: Vec<f64> = [0.1, 0.4, 0.9].map(|l| manakov(&m, &j, l)).to_vec();
        list.push(b.energy());
        list
    };
    drift(
        &mut body,
        steps,
        |b| b.step().expect("solvable"),
        observe,
        1.0,
    )
}

#[test]
fn n_dimensions_keep_energy_and_manakov_integrals() {
    let four = manakov_drift::<4>(LONG, 0.0);
    let eight = manakov_drift::<8>(LONG / 10, 0.0);
    println!("SO(4) {four:.1e}, SO(8) {eight:.1e}");
    // Momenta come from an orthonormal attitude, whose rounding wanders like the root of the number of steps.
    assert!(four < 1e-12 && eight < 1e-12, "{four:e} {eight:e}");
    let wrong = manakov_drift::<4>(1000, 0.01);
    assert!(wrong > 1e-6, "{wrong:e}");
}

fn quadratic_field() -> QuadraticField {
    QuadraticField {
        stiffness: [[1.0, 0.3, -0.2], [0.3, -0.5, 0.4], [-0.2, 0.4, 0.7]],
        axis: [0.36, 0.48, 0.8],
    }
}

fn two_fields() -> TwoFields {
    TwoFields {
        weight: [0.3, -0.2, 0.9],
        dipole: [0.4, 0.5, -0.1],
        up: [0.0, 0.0, 1.0],
        field: [0.6, 0.2, 0.3],
    }
}

fn body_in<F: Field>(field: &F, h: f64) -> BodyInField<F> {
    let start = generic_top();
    let attitude = start.attitude.normalised();
    BodyInField::start(
        &start.top.poinsot,
        field,
        &attitude,
        &start.body_momentum,
        h,
    )
    .expect("solvable")
}

fn quadratic_body(h: f64) -> BodyInField<QuadraticField> {
    body_in(&quadratic_field(), h)
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

/// States at a fixed time for halved steps; orders from the differences of neighbours, with no need of a solution.
fn confirms_order_two(name: &str, state: impl Fn(f64, u64) -> Vec<f64>) {
    let time = 2.0;
    let states: Vec<Vec<f64>> = (0..6)
        .map(|k| state(time / f64::from(20 << k), 20 << k))
        .collect();
    let differences: Vec<f64> = states
        .windows(2)
        .map(|pair| {
            let off = pair[0].iter().zip(&pair[1]).map(|(a, b)| (a - b).abs());
            off.fold(0.0, worse)
        })
        .collect();
    let measured = orders(&differences);
    println!("{name}: {differences:?} {measured:?}");
    assert!(differences.iter().all(|d| *d > 1e-10), "{name}");
    for order in measured.iter().rev().take(2) {
        assert!((order - 2.0).abs() < 0.02, "{name}: {measured:?}");
    }
}

#[test]
fn orders_are_two() {
    confirms_order_two("spatial body", |h, steps| {
        let mut body = spatial_body(h);
        (0..steps).for_each(|_| body.step());
        body.poinsot().concat()
    });
    confirms_order_two("spatial top", |h, steps| {
        let mut top = spatial_top(h);
        (0..steps).for_each(|_| top.step().expect("solvable"));
        [top.arm(), top.spatial_momentum()].concat()
    });
    confirms_order_two("pair", |h, steps| {
        let (data, q, mu) = generic_pair();
        let mut pair = CoupledBodies::start(&data, &q, &mu, h).expect("solvable");
        (0..steps).for_each(|_| pair.step().expect("solvable"));
        [pair.body_momenta().concat(), relative(&pair).concat()].concat()
    });
    for c in [0.0, 1.0, -0.4] {
        confirms_order_two("SU(2)", |h, steps| {
            let q = Quaternion::IDENTITY;
            let mut body = CayleyKlein::start(&[3.5, 2.5, 2.0], c, &q, &[-0.5, 0.3, 1.0], h)
                .expect("solvable");
            (0..steps).for_each(|_| body.step().expect("solvable"));
            [body.quaternion().0.to_vec(), body.body_momentum().to_vec()].concat()
        });
    }
    confirms_order_two("quadratic field", |h, steps| {
        let mut body = quadratic_body(h);
        (0..steps).for_each(|_| body.step().expect("solvable"));
        [
            body.attitude().matrix().concat(),
            body.body_momentum().to_vec(),
        ]
        .concat()
    });
    confirms_order_two("two fields", |h, steps| {
        let mut body = body_in(&two_fields(), h);
        (0..steps).for_each(|_| body.step().expect("solvable"));
        [
            body.attitude().matrix().concat(),
            body.body_momentum().to_vec(),
        ]
        .concat()
    });
    confirms_order_two("SO(4)", |h, steps| {
        let (_, mut body) = body_n::<4>(h);
        (0..steps).for_each(|_| body.step().expect("solvable"));
        [body.attitude().concat(), body.body_momentum().concat()].concat()
    });
}
