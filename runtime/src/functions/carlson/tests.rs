//! The integral against its definition, by quadrature, and against closed forms of spheroids.

use super::{carlson_rf, carlson_rf_of_invariants};
use crate::Dual;
use nalgebra::{Matrix3, SMatrix, Vector3};

/// ½ ∫ ds / √((x+s)(y+s)(z+s)), by the double exponential rule in log s.
fn quadrature(f: impl Fn(f64) -> f64) -> f64 {
    let step = 1.0 / 64.0;
    let all = (-400..=400).map(|k| {
        let t = step * f64::from(k);
        let s = (1.5 * t.sinh()).exp();
        0.5 * f(s) * s * 1.5 * t.cosh() * step
    });
    all.filter(|x| x.is_finite()).sum()
}

fn turned(axes: [f64; 3]) -> (Matrix3<f64>, Matrix3<f64>) {
    let axis = Vector3::new(0.3, -0.8, 0.5);
    let turn = nalgebra::Rotation3::new(axis).into_inner();
    let shape = turn * Matrix3::from_diagonal(&Vector3::from(axes)) * turn.transpose();
    (turn, (shape + shape.transpose()) * 0.5)
}

const SHAPES: [[f64; 3]; 6] = [
    [1.0, 1.0, 1.0],
    [1.0, 1.0, 2.5],
    [3.0, 0.2, 0.2],
    [1.0, 2.0, 3.0],
    [1e-3, 1.0, 40.0],
    [1.0, 1.0 + 1e-7, 1.0 - 1e-7],
];

#[test]
fn values_and_gradients_are_those_of_the_definition() {
    for axes in SHAPES {
        let (turn, b) = turned(axes);
        let root = |s: f64| axes.iter().map(|x| x + s).product::<f64>().sqrt();
        let wanted = quadrature(|s| 1.0 / root(s));
        let found = carlson_rf.value(&b);
        // Quadrature and duplication each round a few hundred sums whose terms have one sign.
        assert!(
            (found / wanted - 1.0).abs() < 1e-13,
            "{axes:?}: {found} {wanted}"
        );
        let gradient = Matrix3::from_diagonal(&Vector3::from(
            axes.map(|x| -0.5 * quadrature(|s| 1.0 / (root(s) * (x + s)))),
        ));
        let gradient = turn * gradient * turn.transpose();
        let found = carlson_rf.pull_back_1(&b, &1.0);
        let off = (found - gradient).norm() / gradient.norm();
        // Cofactors and trace cancel to the ratio of the axes.
        assert!(off < 1e-12, "{axes:?}: {off}");
    }
}

#[test]
fn derivatives_pass_through() {
    let (_, b) = turned([1.0, 2.0, 3.0]);
    let along = Matrix3::new(0.1, 0.3, -0.2, 0.3, 0.5, 0.4, -0.2, 0.4, -0.6);
    let dual: SMatrix<Dual<1>, 3, 3> = SMatrix::from_fn(|i, j| {
        let mut x = Dual::<1>::variable(0.0, 0);
        x = x * Dual::constant(along[(i, j)]) + Dual::constant(b[(i, j)]);
        x
    });
    let value = carlson_rf.value(&dual);
    let gradient = carlson_rf.pull_back_1(&b, &1.0);
    let wanted = (gradient.transpose() * along).trace();
    assert!((value.dual[0] - wanted).abs() < 1e-14);
    assert!(carlson_rf.value(&(-b)).is_nan());
}

#[test]
fn second_derivatives_are_those_of_the_definition() {
    for axes in SHAPES {
        let (turn, b) = turned(axes);
        let root = |s: f64| axes.iter().map(|x| x + s).product::<f64>().sqrt();
        let entry = |i: usize, j: usize| {
            let weight = if i == j { 0.75 } else { 0.25 };
            weight * quadrature(|s| 1.0 / (root(s) * (axes[i] + s) * (axes[j] + s)))
        };
        // The change of the gradient along a change of each axis by its own size.
        let change = Vector3::from([0.3 * axes[0], -0.2 * axes[1], 0.9 * axes[2]]);
        let wanted = Matrix3::from_fn(entry) * change;
        let wanted = turn * Matrix3::from_diagonal(&wanted) * turn.transpose();
        let along = turn * Matrix3::from_diagonal(&change) * turn.transpose();
        let found = carlson_rf.pull_back_1_along_1(&b, &along, &1.0);
        let off = (found - wanted).norm() / wanted.norm();
        // Cofactors and trace cancel to the square of the ratio of the axes.
        let ratio = axes.iter().fold(0.0, |a: f64, x| a.max(*x))
            / axes.iter().fold(f64::INFINITY, |a, x| a.min(*x));
        assert!(off < 1e-13 * (10.0 + ratio), "{axes:?}: {off:e}");
    }
}

/// The quotient of differences of gradients has three digits less than half of them.
#[test]
fn second_derivatives_along_any_direction_are_limits_of_quotients() {
    let (_, b) = turned([1.0, 2.0, 3.0]);
    let along = Matrix3::new(0.1, 0.3, -0.2, 0.3, 0.5, 0.4, -0.2, 0.4, -0.6);
    let at = |step: f64| carlson_rf.pull_back_1(&(b + along * step), &0.7);
    let wanted = (at(1e-4) - at(-1e-4)) / 2e-4;
    let found = carlson_rf.pull_back_1_along_1(&b, &along, &0.7);
    assert!((found - wanted).norm() < 1e-8, "{found} {wanted}");
    let value = |step: f64| carlson_rf.value(&(b + along * step));
    let wanted = (value(1e-4) - value(-1e-4)) / 2e-4;
    assert!((carlson_rf.along_1(&b, &along) - wanted).abs() < 1e-8);

    let f = carlson_rf_of_invariants;
    let at = |x: [f64; 3]| {
        [
            f.pull_back_1(&x[0], &x[1], &x[2], &0.7),
            f.pull_back_2(&x[0], &x[1], &x[2], &0.7),
            f.pull_back_3(&x[0], &x[1], &x[2], &0.7),
        ]
    };
    let (x, y, z, d) = (6.0, 11.0, 6.0, 0.3);
    let found = [
        [
            f.pull_back_1_along_1(&x, &y, &z, &d, &0.7),
            f.pull_back_2_along_1(&x, &y, &z, &d, &0.7),
            f.pull_back_3_along_1(&x, &y, &z, &d, &0.7),
        ],
        [
            f.pull_back_1_along_2(&x, &y, &z, &d, &0.7),
            f.pull_back_2_along_2(&x, &y, &z, &d, &0.7),
            f.pull_back_3_along_2(&x, &y, &z, &d, &0.7),
        ],
        [
            f.pull_back_1_along_3(&x, &y, &z, &d, &0.7),
            f.pull_back_2_along_3(&x, &y, &z, &d, &0.7),
            f.pull_back_3_along_3(&x, &y, &z, &d, &0.7),
        ],
    ];
    for (of, found) in found.iter().enumerate() {
        let moved = |step: f64| {
            let mut all = [x, y, z];
            all[of] += step * d;
            at(all)
        };
        let (right, left) = (moved(1e-4), moved(-1e-4));
        for i in 0..3 {
            let wanted = (right[i] - left[i]) / 2e-4;
            assert!(
                (found[i] - wanted).abs() < 1e-8,
                "{of} {i}: {found:?} {wanted}"
            );
        }
    }
}
