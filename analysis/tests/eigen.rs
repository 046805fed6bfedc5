//! Eigenvalues of matrices on which the real QR iteration is known to stall, and of symplectic matrices.

use crate::systems::Numbers;
use clebsch_analysis::{Eigen, EigenError, Invalid, eigen, pairing_defect};
use nalgebra::{Complex, DMatrix};

/// The largest norm of A v - lambda v.
fn defect(a: &DMatrix<f64>, of: &Eigen) -> f64 {
    let a = a.map(|x| Complex::new(x, 0.0));
    let each = |(i, &value): (usize, &Complex<f64>)| {
        (&a * of.vectors.column(i) - of.vectors.column(i) * value).norm()
    };
    of.values
        .iter()
        .enumerate()
        .map(each)
        .fold(0.0, |most: f64, x| if x.is_nan() { x } else { most.max(x) })
}

/// The distance of -lambda, or of its conjugate, to the nearest eigenvalue, at most over the eigenvalues.
fn asymmetry(values: &[Complex<f64>]) -> f64 {
    let nearest = |a: &Complex<f64>| {
        values
            .iter()
            .map(|b| (a + b).norm())
            .fold(f64::INFINITY, f64::min)
    };
    values
        .iter()
        .map(nearest)
        .fold(0.0, |most: f64, x| if x.is_nan() { x } else { most.max(x) })
}

/// J S for a symmetric S.
fn hamiltonian(s: &DMatrix<f64>) -> DMatrix<f64> {
    let d = s.nrows() / 2;
    let mut a = DMatrix::zeros(2 * d, 2 * d);
    a.rows_mut(0, d).copy_from(&s.rows(d, d));
    a.rows_mut(d, d).copy_from(&-s.rows(0, d));
    a
}

#[test]
fn hamiltonian_matrices() {
    let mut numbers = Numbers(7);
    for d in [1, 2, 3, 5, 10, 30] {
        let a = hamiltonian(&numbers.symmetric(2 * d));
        let found = eigen(&a).unwrap();
        // A backward stable method has an error of a few n roundings of the norm, here n = 2 d and norm = 2 n.
        let n = 2.0 * d as f64;
        assert!(
            defect(&a, &found) < 10.0 * n * n * f64::EPSILON,
            "{d}: {}",
            defect(&a, &found)
        );
        assert!(
            asymmetry(&found.values) < 1e-10,
            "{d}: {}",
            asymmetry(&found.values)
        );
        let conjugate = |x: &Complex<f64>| found.values.contains(&x.conj());
        assert!(found.values.iter().all(conjugate));
    }
}

#[test]
fn two_hundred_rows() {
    let a = hamiltonian(&Numbers(3).symmetric(200));
    let found = eigen(&a).unwrap();
    assert!(defect(&a, &found) < 1e-9, "{}", defect(&a, &found));
}

#[test]
fn oscillators_and_free_motion() {
    // A chain of free masses has two defective zeros; the diagonal of this matrix is zero.
    let d = 20;
    let mut a = DMatrix::zeros(2 * d, 2 * d);
    for i in 0..d {
        a[(i, d + i)] = 1.0;
        let j = (i + 1) % d;
        a[(d + i, i)] -= 2.0;
        a[(d + i, j)] += 1.0;
        a[(d + j, i)] += 1.0;
    }
    let found = eigen(&a).unwrap();
    for k in 0..d {
        let omega = 2.0 * (std::f64::consts::PI * k as f64 / d as f64).sin();
        let distance = |x: &Complex<f64>| (x - Complex::new(0.0, omega)).norm();
        let (at, nearest) = found
            .values
            .iter()
            .map(distance)
            .enumerate()
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap();
        // The pair at zero is defective: the square root of 40 roundings is 1e-7. The others are semisimple.
        let bound = if k == 0 { 1e-6 } else { 1e-12 };
        assert!(nearest < bound, "{k}: {nearest}");
        assert!(
            nearest <= 10.0 * found.errors[at] + 1e-15,
            "{k}: {nearest} {}",
            found.errors[at]
        );
    }
}

#[test]
fn matrices_that_stall() {
    let shift = DMatrix::from_fn(6, 6, |i, j| if (i + 1) % 6 == j { 1.0 } else { 0.0 });
    let roots = eigen(&shift).unwrap();
    assert!(
        roots.values.iter().all(|x| (x.norm() - 1.0).abs() < 1e-14),
        "{:?}",
        roots.values
    );
    let nilpotent = DMatrix::from_fn(4, 4, |i, j| if i + 1 == j { 1.0 } else { 0.0 });
    // A block of four: the fourth root of the rounding is 1e-4.
    assert!(
        eigen(&nilpotent)
            .unwrap()
            .values
            .iter()
            .all(|x| x.norm() < 1e-3)
    );
    assert!(
        eigen(&DMatrix::zeros(3, 3))
            .unwrap()
            .values
            .iter()
            .all(|x| x.norm() == 0.0)
    );
    assert!(eigen(&DMatrix::zeros(0, 0)).unwrap().values.is_empty());
    assert_eq!(
        eigen(&DMatrix::from_element(1, 1, -2.0)).unwrap().values,
        [Complex::new(-2.0, 0.0)]
    );
    let turn = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -1.0, 0.0]);
    let found = eigen(&turn).unwrap();
    assert!(
        (found.values[0] - Complex::i()).norm() < 1e-15
            && found.values[1] == found.values[0].conj()
    );
}

#[test]
fn units_do_not_matter() {
    // An oscillator of frequency 3 with a mass of 1e-40, and very large or small matrices.
    let a = DMatrix::from_row_slice(2, 2, &[0.0, 1e40, -9e-40, 0.0]);
    assert!((eigen(&a).unwrap().values[0] - Complex::new(0.0, 3.0)).norm() < 1e-14);
    for scale in [1e-200_f64, 1e200] {
        let a = scale * Numbers(5).matrix(4, 4);
        let found = eigen(&a).unwrap();
        let trace: Complex<f64> = found.values.iter().sum();
        assert!((trace - a.trace()).norm() < 1e-14 * scale);
    }
}

#[test]
fn defective_eigenvalues_report_their_error() {
    let mut numbers = Numbers(11);
    let turn = numbers.matrix(4, 4).qr().q();
    let mut jordan = DMatrix::from_diagonal(&vec![1.0, 1.0, 2.0, 0.5].into());
    jordan[(0, 1)] = 1.0;
    let found = eigen(&(&turn * jordan * turn.transpose())).unwrap();
    for (value, error) in found.values.iter().zip(&found.errors) {
        let truth = [2.0, 1.0, 0.5]
            .into_iter()
            .map(|x| (value - x).norm())
            .fold(f64::INFINITY, f64::min);
        assert!(truth <= *error, "{value}: {truth} {error}");
        // The square root of the rounding for the block, and a few roundings for the others.
        let block = (value - 1.0).norm() < 0.1;
        assert!(
            if block {
                *error > 1e-9 && *error < 1e-6
            } else {
                *error < 1e-13
            },
            "{value}: {error}"
        );
    }
    // The errors of the two defective ones cancel in their product.
    assert!(
        pairing_defect(&found.values) < 1e-13,
        "{}",
        pairing_defect(&found.values)
    );
}

#[test]
fn a_map_that_is_not_symplectic_has_a_pairing_defect() {
    let a = DMatrix::from_diagonal(&vec![2.0, 0.51].into());
    assert!((pairing_defect(&eigen(&a).unwrap().values) - 0.02).abs() < 1e-12);
}

#[test]
fn refused_matrices() {
    let nan = DMatrix::from_element(2, 2, f64::NAN);
    assert!(matches!(
        eigen(&nan),
        Err(EigenError::Invalid(Invalid::NotFinite { .. }))
    ));
    assert!(matches!(
        eigen(&DMatrix::zeros(2, 3)),
        Err(EigenError::Invalid(Invalid::Shape { .. }))
    ));
}
