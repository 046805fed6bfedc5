//! Velocities of one site by Newton's method from zero velocity: roots in closed form, the root connected to zero among several,
//! folds, derivatives, and the same for sizes known only when a model is read.

use clebsch::line::{NoRoot, field, root_of};
use clebsch::nalgebra::{Matrix1, Matrix2, SMatrix, SVector, Vector1, Vector2};
use clebsch::{Dual, Real};

/// The root for momenta given with their derivative.
fn root<T: Real, const N: usize>(
    known: &SVector<T, N>,
    whole: impl Fn(&SVector<T, N>) -> (SVector<T, N>, SMatrix<T, N, N>),
) -> Result<SVector<T, N>, NoRoot> {
    clebsch::line::root(known, [field(N)], |v| whole(v).0, &whole)
}

/// `m v + b v^3`, whose only real root is Cardano's.
fn cubic<T: Real>(m: T, b: T) -> impl Fn(&SVector<T, 1>) -> (SVector<T, 1>, Matrix1<T>) {
    move |v| {
        let v = v[0];
        (
            Vector1::new(m * v + b * v * v * v),
            Matrix1::new(m + T::from_f64(3.0) * b * v * v),
        )
    }
}

#[test]
fn the_root_of_a_cubic_is_cardanos() {
    for p in [-1e3, -1.0, -1e-9, 0.0, 1e-200, 0.3, 7.0, 1e6] {
        for b in [1e-3, 0.5, 40.0] {
            let (third, half) = (1.0 / (3.0 * b), p / (2.0 * b));
            let s: f64 = third.sqrt();
            // 2 s sinh(asinh(half / s^3) / 3)
            let exact = 2.0 * s * ((half / (s * s * s)).asinh() / 3.0).sinh();
            let found = root(&Vector1::new(p), cubic(1.0, b)).expect("a root")[0];
            // Cardano's formula with two library functions, each accurate to a few rounding errors.
            assert!(
                (found - exact).abs() <= 1e-14 * exact.abs(),
                "{p} {b}: {found} for {exact}"
            );
        }
    }
}

#[test]
fn beyond_a_fold_there_is_none_though_other_roots_exist() {
    // v - v^3 increases to 2/sqrt(27) at 1/sqrt(3); for larger momenta only a distant root exists.
    let fold = 2.0 / 27.0_f64.sqrt();
    let near = root(&Vector1::new(0.999 * fold), cubic(1.0, -1.0)).expect("before the fold")[0];
    assert!(near > 0.0 && near < 1.0 / 3.0_f64.sqrt());
    assert!((near - near.powi(3) - 0.999 * fold).abs() < 1e-15);
    for beyond in [1.001, 1.5, 10.0] {
        let told = root(&Vector1::new(beyond * fold), cubic(1.0, -1.0)).expect_err("a fold");
        assert!(
            (told.share - 1.0 / beyond).abs() < 1e-3,
            "{told} at {beyond}"
        );
    }
}

#[test]
fn derivatives_of_the_root_are_exact() {
    let p = Dual::<1>::variable(0.7, 0);
    let (m, b) = (Dual::constant(1.2), Dual::constant(0.9));
    let found = root(&Vector1::new(p), cubic(m, b)).expect("a root")[0];
    let v = found.real;
    assert!((found.dual[0] * (1.2 + 2.7 * v * v) - 1.0).abs() < 1e-15);
}

#[test]
fn sizes_known_later_give_the_same_bits() {
    let momenta = |v: &Vector2<f64>| {
        let (x, y) = (v[0], v[1]);
        let p = Vector2::new(x * (1.0 + y * y) + 3.0 * y, 40.0 * y + x.sin() - 3.0 * x);
        (
            p,
            Matrix2::new(1.0 + y * y, 2.0 * x * y + 3.0, x.cos() - 3.0, 40.0),
        )
    };
    for known in [
        Vector2::new(0.3, -2.0),
        Vector2::new(-20.0, 90.0),
        Vector2::new(0.0, 1e-12),
    ] {
        let one = root(&known, momenta);
        let other = root_of(known.as_slice(), &[field(2)], |v, p, a| {
            let (found, derivative) = momenta(&Vector2::from_column_slice(v));
            p.copy_from_slice(found.as_slice());
            if let Some(a) = a {
                a.copy_from_slice(derivative.as_slice());
            }
        });
        assert_eq!(one.map(|v| v.as_slice().to_vec()), other);
        let v = one.expect("a root");
        let off = momenta(&v).0 - known;
        assert!(off.norm() <= 1e-14 * known.norm(), "{off}");
    }
}

#[test]
fn what_is_not_finite_is_refused() {
    assert!(root(&Vector1::new(f64::NAN), cubic(1.0, 1.0)).is_err());
    assert!(root(&Vector1::new(1.0), cubic(f64::NAN, 1.0)).is_err());
    assert!(root(&Vector1::new(1.0), cubic(0.0, 0.0)).is_err());
}
