//! Steps written by hand, in plain double arithmetic, hold whatever the size of their numbers, and errors of a hundred
//! roundings are detected.

use clebsch_check::{Judge, Part, Setup, Stated, UNIT, Verdict};
use clebsch_core::pipeline::parse_source;
use std::sync::Arc;

type Square = [[f64; 3]; 3];

fn judge(
    text: &str,
    h: f64,
    parameters: &[(&str, usize, &[f64])],
    observed: &[(&str, usize)],
) -> Judge {
    let model = parse_source(text).unwrap_or_else(|e| panic!("{}", e.render(text, "model")));
    let given = parameters
        .iter()
        .map(|(name, n, all)| ((*name, *n, *n), *all));
    let observed = observed.iter().map(|(name, n)| (*name, *n, *n));
    let stated = Arc::new(Stated::read(&model, &[]).expect("it can be read"));
    Judge::new(stated, Setup::new(h, given, observed)).expect("it can be judged")
}

fn worst(judge: &Judge, before: &[f64], after: &[f64]) -> Part {
    let parts = judge.parts(1, before, after).expect("judged");
    let larger = |a: &Part, b: &Part| a.ratio().total_cmp(&b.ratio());
    parts.into_iter().max_by(larger).expect("equations")
}

/// In long steps of a stiff spring, the midpoint is much smaller than both ends. The rounding of the ends is then larger
/// than the rounding of the force.
#[test]
fn long_steps_of_a_stiff_spring_hold() {
    let text = "model Spring {
        param m, k: Real;
        field y: Real;
        let Y = (next(y) + y)/2;
        lagrangian = m*(next(y) - y)^2/(2*h) - h*k*Y^2/2;
    }";
    for k in [1.0, 37.0, 400.0, 1.3e4, 1.7e8] {
        for angle in [0.1, 1.0, 9.7, 20.0, 97.0] {
            let m = 1.37;
            let h = angle * f64::sqrt(m / k);
            let judge = judge(
                text,
                h,
                &[("m", 1, &[m]), ("k", 1, &[k])],
                &[("y", 1), ("momentum_y", 1)],
            );
            let (mut y, mut p) = (0.83, 0.31 * f64::sqrt(k * m));
            for _ in 0..300 {
                let change = (p - 0.5 * h * k * y) / (m / h + 0.25 * h * k);
                let next = y + change;
                let p_next = p + (-(h * k * y) - 0.5 * h * k * change);
                let found = worst(&judge, &[y, p], &[next, p_next]);
                assert!(found.ratio() <= 1.0, "k {k}, h*omega {angle}: {found:?}");
                // The sizes of all terms, with the two positions apart.
                let size = (m / h + 0.25 * h * k) * (y.abs() + next.abs()) + p.abs();
                let off = p_next + 100.0 * UNIT * size;
                let found = worst(&judge, &[y, p], &[next, off]);
                assert!(found.ratio() > 1.0, "k {k}, h*omega {angle}: {found:?}");
                (y, p) = (next, p_next);
            }
        }
    }
}

fn product(a: &Square, b: &Square) -> Square {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn transposed(a: &Square) -> Square {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

fn inverse(a: &Square) -> Square {
    let minor = |i: usize, j: usize| {
        let (p, q) = ((i + 1) % 3, (i + 2) % 3);
        let (r, s) = ((j + 1) % 3, (j + 2) % 3);
        a[p][r] * a[q][s] - a[p][s] * a[q][r]
    };
    let det: f64 = (0..3).map(|j| a[0][j] * minor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| minor(j, i) / det))
}

fn sizes(a: &Square) -> Square {
    a.map(|row| row.map(f64::abs))
}

/// The state of a free linear body: its map, and its momentum in the body.
fn state(q: &Square, space: &Square) -> Vec<f64> {
    let body = product(&transposed(q), &product(space, &transposed(&inverse(q))));
    q.iter().chain(&body).flatten().copied().collect()
}

/// The momentum in the body is a product with the map and its inverse: its small entries have the rounding of the
/// large ones.
#[test]
fn momenta_of_linear_maps_with_entries_of_every_size_hold() {
    let text = "model Free {
        param J: Sym<3>;
        group Q: GL<3> velocity G;
        constraint next(Q) = Q*G;
        lagrangian = tr((next(Q) - Q)*J*(next(Q) - Q)^T)/(2*h);
    }";
    let inertia = [1.3, 0.0, 0.0, 0.0, 0.7, 0.0, 0.0, 0.0, 2.9];
    let mut random = 1_u64;
    let mut between = move |from: f64, to: f64| {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        #[allow(clippy::cast_precision_loss)]
        let share = (random >> 11) as f64 / (1_u64 << 53) as f64;
        from + share * (to - from)
    };
    for _ in 0..40 {
        let mut q: Square = std::array::from_fn(|i| {
            std::array::from_fn(|j| f64::from(u8::from(i == j)) + between(-0.9, 0.9))
        });
        let mut space: Square = {
            let body: Square = std::array::from_fn(|_| {
                std::array::from_fn(|_| between(-1.0, 1.0) * f64::powf(10.0, between(-7.0, 4.0)))
            });
            product(&transposed(&inverse(&q)), &product(&body, &transposed(&q)))
        };
        let rates = product(&space, &transposed(&inverse(&q)));
        let fastest = rates
            .iter()
            .flatten()
            .fold(0.0, |most: f64, x| most.max(x.abs()));
        let h = 0.1 / fastest;
        let judge = judge(
            text,
            h,
            &[("J", 3, &inertia)],
            &[("Q", 3), ("body_momentum", 3)],
        );
        for _ in 0..20 {
            let seen = product(&space, &transposed(&inverse(&q)));
            let change: Square =
                std::array::from_fn(|i| std::array::from_fn(|j| h * seen[i][j] / inertia[4 * j]));
            let moved: Square =
                std::array::from_fn(|i| std::array::from_fn(|j| q[i][j] + change[i][j]));
            let weighted: Square =
                std::array::from_fn(|i| std::array::from_fn(|j| change[i][j] * inertia[4 * j]));
            let added = product(&weighted, &transposed(&change));
            let brought: Square =
                std::array::from_fn(|i| std::array::from_fn(|j| space[i][j] + added[i][j] / h));
            let (before, mut after) = (state(&q, &space), state(&moved, &brought));
            let found = worst(&judge, &before, &after);
            assert!(found.ratio() <= 1.0, "{found:?}");
            // The sizes of all products in an entry of its equation, with the two maps apart.
            let (left, right) = (
                sizes(&transposed(&moved)),
                sizes(&transposed(&inverse(&moved))),
            );
            // The rounding of an inverse is a product with the matrix and the inverse again.
            let right = product(&right, &product(&left, &right));
            let stored: Square = std::array::from_fn(|i| {
                std::array::from_fn(|j| (q[i][j].abs() + moved[i][j].abs()) * inertia[4 * j] / h)
            });
            let kinetic = product(&left, &stored);
            let size = product(&left, &product(&sizes(&brought), &right));
            let (i, j) = (1, 2);
            after[9 + 3 * i + j] += 100.0 * UNIT * (size[i][j] + kinetic[i][j]);
            let found = worst(&judge, &before, &after);
            assert!(found.ratio() > 1.0, "{found:?}");
            (q, space) = (moved, brought);
        }
    }
}

/// A free particle from the origin: all products and sums are exact. The check detects a change of the state, so it has
/// measured the steps.
#[test]
fn steps_with_exact_arithmetic_hold() {
    let text = "model Free {
        param m: Real;
        field x: Real;
        lagrangian = m*(next(x) - x)^2/(2*h);
    }";
    let (m, h, p) = (2.0, 0.25, 1.0 / 3.0);
    let judge = judge(text, h, &[("m", 1, &[m])], &[("x", 1), ("momentum", 1)]);
    let mut verdict = Verdict::default();
    for step in 1..=20_u32 {
        let at = |node: u32| [f64::from(node) * (h * p / m), p];
        let judged = judge.step(step.into(), &at(step - 1), &at(step));
        verdict.take(step.into(), judged);
    }
    assert!(verdict.holds(), "{verdict}");
}

/// A weight at rest at zero, which a large force balances: no number moves, and every residual is exactly zero. A small
/// change would hide in the rounding of the forces.
#[test]
fn large_forces_that_balance_at_rest_hold() {
    let text = "model Balanced {
        param m, g, F: Real;
        field z: Real;
        lagrangian = m*(next(z) - z)^2/(2*h) - h*m*g*z + h*F*z;
    }";
    let parameters = [
        ("m", 1, &[2.0][..]),
        ("g", 1, &[9.81][..]),
        ("F", 1, &[19.62][..]),
    ];
    let judge = judge(text, 3600.0, &parameters, &[("z", 1), ("momentum", 1)]);
    let mut verdict = Verdict::default();
    for step in 1..=20 {
        verdict.take(step, judge.step(step, &[0.0, 0.0], &[0.0, 0.0]));
    }
    assert!(verdict.holds(), "{verdict}");
}
