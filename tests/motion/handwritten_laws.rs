//! Hand-written steppers of spatial forms, coupled bodies, SU(2), fields and n dimensions: conservation over 1e5 steps, and order
//! of accuracy. This file uses nothing of the library under test.

use clebsch_oracle::handwritten::attitude::{Quaternion, add_scaled, apply, cross, dot};
use clebsch_oracle::handwritten::body_n::{BodyN, Square};
use clebsch_oracle::handwritten::cayley_klein::CayleyKlein;
use clebsch_oracle::handwritten::coupled_bodies::CoupledBodies;
use clebsch_oracle::handwritten::free_body_spatial::FreeBodySpatial;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::order::orders;
use clebsch_oracle::physics::systems::{
    body_in, body_n, generic_pair, quadratic_body, quadratic_field, reference_pair, relative,
    spatial_body, spatial_top, submerged_body, total, two_fields,
};
use clebsch_oracle::reference::H;

const LONG: u64 = 100_000;

/// Largest drift of each component over `steps`, relative to its scale.
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
    // A heavy body conserves the horizontal momentum and the angular momentum about the vertical.
    let fluid = drift(
        &mut submerged_body(0.01, H),
        LONG / 10,
        |b| b.step().expect("solvable"),
        |b| {
            // Computed from body quantities, because the stepper stores the spatial values that the test checks.
            let (r, mu) = (b.attitude().matrix(), b.body_momentum());
            let (p, l) = (apply(&r, &mu.linear), apply(&r, &mu.angular));
            vec![
                p[0],
                p[1],
                add_scaled(&l, 1.0, &cross(&b.position(), &p))[2],
            ]
        },
        1.0,
    );
    let floating = drift(
        &mut submerged_body(0.0, H),
        LONG,
        |b| b.step().expect("solvable"),
        |b| {
            let mu = b.body_momentum();
            vec![dot(&mu.linear, &mu.linear), dot(&mu.linear, &mu.angular)]
        },
        1.0,
    );
    println!(
        "fluid {fluid:.1e}, floating {floating:.1e}, spatial {spatial:.1e}, top {top:.1e}, pair {pair:.1e}, third components {axes:.1e}, SU(2) {family:.1e}, field {field:.1e}"
    );
    for (name, off, bound) in [
        ("spatial body", spatial, 1e-14),
        ("spatial top", top, 1e-13),
        ("pair", pair, 1e-13),
        // Conserved by symmetry and not by the form of the stepper: rounding adds up like a random walk.
        ("third components of a symmetric pair", axes, 1e-12),
        ("SU(2)", family, 1e-14),
        ("quadratic field", field, 1e-13),
        // The body travels: x reaches thousands, and the rounding error of x times the linear momentum grows with it.
        ("heavy body in a fluid", fluid, 1e-11),
        ("floating body", floating, 1e-11),
    ] {
        assert!(off < bound, "{name}: {off:e}");
    }
}

/// Manakov's integrals det(M + lambda J^2) at some lambda, divided by the product of the mean row lengths (|M| is also conserved).
/// A step with the wrong J^2 does not conserve them.
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
    // Momenta come from an orthonormal attitude, whose rounding error grows like the square root of the number of steps.
    assert!(four < 1e-12 && eight < 1e-12, "{four:e} {eight:e}");
    let wrong = manakov_drift::<4>(1000, 0.01);
    assert!(wrong > 1e-6, "{wrong:e}");
}

/// Checks order two from states at a fixed time under step halving, by differences of neighbours and without an exact solution.
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
    for weight in [0.0, 0.3] {
        confirms_order_two("fluid", |h, steps| {
            let mut body = submerged_body(weight, h);
            (0..steps).for_each(|_| body.step().expect("solvable"));
            let m = body.body_momentum();
            [
                body.attitude().matrix().concat(),
                body.position().to_vec(),
                m.angular.to_vec(),
                m.linear.to_vec(),
            ]
            .concat()
        });
    }
    confirms_order_two("SO(4)", |h, steps| {
        let (_, mut body) = body_n::<4>(h);
        (0..steps).for_each(|_| body.step().expect("solvable"));
        [body.attitude().concat(), body.body_momentum().concat()].concat()
    });
}
