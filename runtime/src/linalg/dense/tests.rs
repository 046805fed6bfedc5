//! Dense matrices of any size against static ones to the last bit, and inverses of badly scaled ones.

use super::Dense;
use crate::linalg;
use nalgebra::{SMatrix, SVector};

fn compare<const R: usize, const K: usize, const C: usize>() {
    let entry = |seed: usize| {
        move |i: usize, j: usize| ((7 * i + 13 * j + 29 * seed) as f64 * 0.731).sin() * 1.7
    };
    let a = SMatrix::<f64, R, K>::from_fn(entry(1));
    let b = SMatrix::<f64, K, C>::from_fn(entry(2));
    let c = SMatrix::<f64, R, K>::from_fn(entry(3));
    let (da, db, dc) = (Dense::of(&a), Dense::of(&b), Dense::of(&c));
    assert_eq!(da.times(&db), Dense::of(&(a * b)));
    assert_eq!(da.tr_mul(&dc), Dense::of(&a.tr_mul(&c)));
    assert_eq!(da.dot(&dc), a.dot(&c));
    assert_eq!(da.transpose(), Dense::of(&a.transpose()));
}

#[test]
fn products_agree_with_static_ones_to_the_last_bit() {
    compare::<1, 1, 1>();
    compare::<2, 2, 1>();
    compare::<2, 3, 4>();
    compare::<4, 4, 4>();
    compare::<5, 1, 1>();
    compare::<6, 6, 6>();
    compare::<8, 8, 8>();
    compare::<9, 2, 5>();
    compare::<28, 1, 3>();
}

fn systems<const N: usize>() {
    let entry = |seed: usize| {
        move |i: usize, j: usize| {
            ((5 * i + 11 * j + 17 * seed + i * j) as f64 * 0.613).sin()
                + if i == j { 0.4 } else { 0.0 }
        }
    };
    let a = SMatrix::<f64, N, N>::from_fn(entry(1));
    let b = SMatrix::<f64, N, 3>::from_fn(entry(2));
    let s = SMatrix::<f64, N, N>::from_fn(entry(3));
    let (da, db, ds) = (Dense::of(&a), Dense::of(&b), Dense::of(&s));
    let of = |x: Option<SMatrix<f64, N, N>>| x.map(|x| Dense::of(&x));
    assert_eq!(da.determinant(), linalg::determinant(&a));
    assert_eq!(da.inverse(), of(linalg::inverse(&a)));
    assert_eq!(da.small_inverse(), of(linalg::small_inverse(&a)));
    // For other sizes it is NaN, which never compares equal.
    let (adjugate, own) = (da.adjugate(), Dense::of(&linalg::adjugate(&a)));
    let same = adjugate == own;
    assert_eq!(same, N == 2 || N == 3);
    let many = linalg::solve_many(&a, &b).map(|x| Dense::of(&x));
    assert_eq!(da.solved(&db), many);
    let small = linalg::small_solve(&a, &b).map(|x| Dense::of(&x));
    assert_eq!(da.small_solve(&db), small);
    assert_eq!(da.product(&ds), Dense::of(&linalg::product(&a, &s)));
    let near = linalg::orthonormalised(&(SMatrix::identity() + a * 0.01));
    let one = Dense::identity(N, N).plus(&da.scaled(0.01));
    assert_eq!(one.orthonormalised(), Dense::of(&near));
    assert_eq!(da.less_identity(), Dense::of(&linalg::less_identity(&a)));
    let pencil = linalg::pencil_coefficients(&a, &s);
    assert_eq!(da.pencil_coefficients(&ds), Dense::of(&pencil));
    let skew = da.skew_coordinates();
    assert_eq!(skew, linalg::skew_coordinates(&a).collect::<Vec<_>>());
    let matrix = linalg::skew_from::<f64, N>(&skew);
    assert_eq!(Dense::skew_from(N, &skew), Dense::of(&matrix));
}

#[test]
fn systems_agree_with_static_ones_to_the_last_bit() {
    systems::<1>();
    systems::<2>();
    systems::<3>();
    systems::<4>();
    systems::<5>();
    systems::<8>();
    systems::<13>();
}

#[test]
fn large_systems_are_solved() {
    let n = 64;
    let entry = |i: usize, j: usize| ((7 * i + 3 * j) % 61) as f64 / 61.0;
    let a = Dense::from_fn(n, n, |i, j| entry(i, j) + if i == j { 9.0 } else { 0.0 });
    let b = Dense::from_fn(n, 1, |i, _| i as f64 - 30.0);
    for x in [a.solved(&b), a.leading_solved(&b, n)] {
        let left = a.times(&x.expect("regular")).minus(&b);
        assert!(left.squares().sqrt() < 1e-12);
    }
    assert!(Dense::<f64>::zeros(n, n).solved(&b).is_none());
}

/// Two bodies on a hinge: their rotations, positions and five constraint forces. The velocities are as exact for
/// masses of 1e-12 as for masses of 1, and equal bit for bit to the ones of static sizes.
#[test]
fn held_systems_do_not_depend_on_the_unit_of_mass() {
    let (p, q) = ([0.5, 0.2, 0.0], [-0.5, 0.2, 0.0]);
    let hat = |v: [f64; 3], i: usize, j: usize| {
        let [x, y, z] = v;
        [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]][i][j]
    };
    let one = |i: usize, j: usize| f64::from(u8::from(i == j));
    let masses = [3.5, 2.5, 3.0, 7.0, 5.0, 6.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0];
    // At rest: the rate of x + R p - y - S q, and the two rates that keep the axis.
    let rate = |k: usize, j: usize| match (k, j / 3) {
        (0..3, 0) => -hat(p, k, j),
        (0..3, 1) => hat(q, k, j - 3),
        (0..3, 2) => one(k, j - 6),
        (0..3, _) => -one(k, j - 9),
        (3, _) => one(j, 2) - one(j, 5),
        _ => one(j, 4) - one(j, 1),
    };
    let solved = |mass: f64| {
        let a = SMatrix::<f64, 17, 17>::from_fn(|i, j| match (i < 12, j < 12) {
            (true, true) => mass * masses[i] * one(i, j),
            (true, false) => rate(j - 12, i),
            (false, true) => rate(i - 12, j),
            (false, false) => 0.0,
        });
        let momentum = |i: usize| (1.7 * i as f64).sin();
        let b = SVector::<f64, 17>::from_fn(|i, _| if i < 12 { mass * momentum(i) } else { 0.0 });
        let fixed = crate::emitted::solve_leading_or_nan(&a, &b, 17);
        let any = Dense::of(&a).leading_solved(&Dense::of(&b), 17);
        assert_eq!(any.expect("regular").data, fixed.as_slice());
        fixed
    };
    let exact = solved(1.0);
    for mass in [1e-12, 1e-6, 1e6, 1e12] {
        let x = solved(mass);
        for i in 0..12 {
            // Some ten roundings of numbers of order 1, of a system of condition ten.
            let off = (x[i] - exact[i]).abs();
            assert!(off < 1e-14, "{mass}: {i} {off:e}");
        }
    }
}

#[test]
fn inverses_of_badly_scaled_matrices_have_all_their_digits() {
    // Rows and columns of 1e-12, 1 and 1e9 of a matrix that is well conditioned without them.
    let sizes = [1e-12, 1.0, 1e9];
    let plain = [[4.0, 1.0, -1.0], [2.0, 3.0, 0.5], [0.25, -1.0, 5.0]];
    let a = Dense::from_fn(3, 3, |i, j| sizes[i] * plain[i][j] * sizes[j]);
    let back = a.balanced_inverse().expect("invertible");
    let wanted = Dense::from_fn(3, 3, |i, j| plain[i][j])
        .inverse()
        .expect("invertible");
    for i in 0..3 {
        for j in 0..3 {
            let scaled = sizes[i] * back.at(i, j) * sizes[j];
            assert!((scaled - wanted.at(i, j)).abs() < 1e-14, "{i} {j}");
        }
    }
    let b = [1e-12, 2.0, -1e9];
    let x = a.balanced_solution(&b).expect("a solution");
    for (i, right) in b.iter().enumerate() {
        let left: f64 = (0..3).map(|j| a.at(i, j) * x[j]).sum();
        assert!((left / right - 1.0).abs() < 1e-14, "{i}");
    }
}

#[test]
fn sizes_fit_where_both_are_the_same() {
    let [a, b, c] = [(2, 3), (3, 2), (2, 3)].map(|(rows, cols)| Dense::<f64>::zeros(rows, cols));
    assert!(a.fits(&c) && !a.fits(&b));
}
