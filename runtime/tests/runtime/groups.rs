//! Group laws, checked by the same code for every group, and the conventions of SO(3).

use super::common::{Random, dd, largest, lift};
use clebsch::linalg::hat;
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{
    BodyMomentum, DoubleDouble, Dual, Group, Lanes, NotARotation, Orthogonal, Real, Rotation,
    SpatialMomentum,
};

/// Nine entries, each with about four rounding errors of numbers of order 1, in the Frobenius norm.
const ROUNDING: f64 = 4e-15;

/// Checks associativity, the neutral element, inverses and membership, with `apart` as the distance.
fn conforms<G: Group<f64> + PartialEq>(mut pick: impl FnMut() -> G, apart: impl Fn(&G, &G) -> f64) {
    for _ in 0..200 {
        let (a, b, c) = (pick(), pick(), pick());
        let one = G::identity();
        assert!(apart(&a.compose(&b).compose(&c), &a.compose(&b.compose(&c))) < ROUNDING);
        assert!(apart(&a.compose(&one), &a) < ROUNDING);
        assert!(apart(&one.compose(&a), &a) < ROUNDING);
        assert!(apart(&a.compose(&a.inverse()), &one) < ROUNDING);
        assert!(apart(&a.inverse().compose(&a), &one) < ROUNDING);
        assert!(apart(&a.retract(&vec![0.0; G::DIMENSION]), &a) < ROUNDING);
        assert!(apart(&a.retract(&[]), &a) < ROUNDING);
        // The retraction acts on the right.
        let xi: Vec<f64> = (0..G::DIMENSION).map(|i| 0.1 + 0.05 * i as f64).collect();
        let moved = a.compose(&one.retract(&xi));
        assert!(apart(&a.retract(&xi), &moved) < ROUNDING);
        // `retract_from_left` acts on the left, and equals the exponential to first order.
        assert!(apart(&a.retract_from_left(&[]), &a) < ROUNDING);
        let little: Vec<f64> = xi.iter().map(|x| 1e-6 * x).collect();
        let moved_from_left = one.retract(&little).compose(&a);
        assert!(apart(&a.retract_from_left(&little), &moved_from_left) < 1e-10);
        assert!(a.compose(&b).distance_from_group() < ROUNDING);
        assert!(moved.distance_from_group() < ROUNDING);
    }
}

fn apart(a: &Rotation, b: &Rotation) -> f64 {
    (a.matrix() - b.matrix()).norm()
}

#[test]
fn rotations_and_their_products_are_groups() {
    let mut random = Random(21);
    conforms(|| random.rotation(), apart);
    conforms(
        || [random.rotation(), random.rotation()],
        |a, b| apart(&a[0], &b[0]) + apart(&a[1], &b[1]),
    );
    let mut random = Random(22);
    conforms(
        || [random.rotation(), random.rotation(), random.rotation()],
        |a, b| (0..3).map(|i| apart(&a[i], &b[i])).sum(),
    );
    assert_eq!(<[Rotation; 3] as Group<f64>>::DIMENSION, 9);
}

#[test]
fn retraction_and_exponential_start_as_the_identity_plus_hat() {
    let mut random = Random(23);
    let xi = random.vector() * 1e-4;
    let one = Matrix3::identity();
    for moved in [
        Rotation::identity().retract(xi.as_slice()),
        Rotation::exp(&xi),
    ] {
        let second = one + hat(&xi) + hat(&xi) * hat(&xi) * 0.5;
        // The remaining error is of third order.
        assert!((moved.matrix() - second).norm() < 1e-12);
    }
}

#[test]
fn exponential_turns_by_the_length_of_its_argument() {
    for angle in [0.0, 1e-9, 1e-3, 0.19, 0.21, 1.0, 3.0, 6.0] {
        let matrix = Rotation::exp(&Vector3::new(0.0, 0.0, angle)).matrix();
        let (sin, cos) = f64::sin_cos(angle);
        let expected = Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
        assert!((matrix - expected).norm() < ROUNDING, "{angle}");
    }
    // Lanes with and without rotation side by side; derivatives at zero; 30 digits.
    let lanes = Vector3::new(Lanes([0.0; 2]), Lanes([0.0, 2.0]), Lanes([0.0; 2]));
    let q = Rotation::exp(&lanes).quaternion();
    assert!((q[0].0[0] - 1.0).abs() + (q[0].0[1] - 1.0_f64.cos()).abs() < ROUNDING);
    let still = Vector3::from_fn(|i, _| Dual::<3>::variable(0.0, i));
    assert_eq!(Rotation::exp(&still).quaternion()[2].dual, [0.0, 0.5, 0.0]);
    let half = Rotation::exp(&lift::<DoubleDouble>(&Vector3::new(1.25, 0.0, 0.0)));
    let twice = half * half;
    let whole = Rotation::exp(&lift::<DoubleDouble>(&Vector3::new(2.5, 0.0, 0.0)));
    let difference = (twice.matrix() - whole.matrix()).map(|x| x.magnitude());
    assert!(difference.amax() < 1e-30);
}

#[test]
fn matrix_quaternion_and_action_agree() {
    let mut random = Random(24);
    for _ in 0..500 {
        let (r, v) = (random.rotation(), random.vector());
        let m = r.matrix();
        assert!((m * v - r.rotate(&v)).norm() < ROUNDING);
        assert!((m.transpose() * v - r.inverse_rotate(&v)).norm() < ROUNDING);
        assert!((m.transpose() * m - Matrix3::identity()).norm() < ROUNDING);
        assert!((m.determinant() - 1.0).abs() < ROUNDING);
        assert!(apart(&Rotation::from_matrix(&m).expect("a rotation"), &r) < ROUNDING);
        let q = Rotation::from_quaternion(r.quaternion()).expect("a rotation");
        assert!(apart(&q, &r) < ROUNDING);
        let mu = BodyMomentum(v);
        assert!((mu.to_space(&r).to_body(&r).0 - v).norm() < ROUNDING);
        let m = SpatialMomentum(v);
        assert!((m.to_body(&r).to_space(&r).0 - v).norm() < ROUNDING);
    }
}

#[test]
fn half_turns_are_read_from_matrices_too_in_lanes_of_different_axes() {
    let diagonals = [
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    let mut wide = Matrix3::from_element(Lanes([0.0; 4]));
    for (lane, diagonal) in diagonals.iter().enumerate() {
        for i in 0..3 {
            wide[(i, i)].0[lane] = diagonal[i];
        }
    }
    let q = Rotation::from_matrix(&wide)
        .expect("rotations")
        .quaternion();
    for lane in 0..4 {
        for (k, component) in q.iter().enumerate() {
            assert_eq!(component.0[lane], if k == lane { 1.0 } else { 0.0 });
        }
    }
}

#[test]
fn long_products_stay_unit() {
    let mut random = Random(25);
    let (small, mut left, mut right) = (random.rotation(), random.rotation(), random.rotation());
    for _ in 0..100_000 {
        left = small * left;
        right = right * small;
    }
    assert!(left.distance_from_group() < ROUNDING);
    assert!(right.distance_from_group() < ROUNDING);
}

#[test]
fn what_is_no_rotation_is_refused() {
    let mut random = Random(26);
    let m = random.rotation().matrix();
    assert_eq!(Rotation::from_matrix(&-m), Err(NotARotation::Reflection));
    assert!(matches!(
        Rotation::from_matrix(&(m * 1.000_001)),
        Err(NotARotation::NotOrthogonal { defect }) if (defect - 2e-6).abs() < 1e-11
    ));
    assert_eq!(
        Rotation::from_matrix(&(m * f64::NAN)),
        Err(NotARotation::NotFinite)
    );
    assert!(Rotation::from_quaternion([1.0, 1e-3, 0.0, 0.0]).is_err());
    assert!(Rotation::from_quaternion([f64::INFINITY, 0.0, 0.0, 0.0]).is_err());
    // A matrix with ten digits is accepted and orthonormalised.
    let typed = m.map(|x| (x * 1e10).round() * 1e-10);
    let read = Rotation::from_matrix(&typed).expect("ten digits");
    assert!(read.distance_from_group() < ROUNDING);
    assert!((read.matrix() - m).norm() < 1e-9);
}

#[test]
fn derivatives_pass_through_rotations() {
    let v = Vector3::new(0.3, -0.8, 0.5);
    let xi = Vector3::from_fn(|i, _| Dual::<3>::variable(0.0, i));
    let turned = Rotation::exp(&xi).rotate(&lift(&v));
    for seed in 0..3 {
        let expected = Vector3::ith(seed, 1.0).cross(&v);
        let derivative = turned.map(|x| x.dual[seed]);
        assert!((derivative - expected).norm() < ROUNDING);
    }
    let one = dd(1.0);
    assert!(largest(&Rotation::exp(&Vector3::new(one, one, one)).rotate(&lift(&v))) < 1.0);
    assert_eq!(one.value(), 1.0);
}

#[test]
fn an_element_that_is_no_number_is_far_from_its_group() {
    let own = Orthogonal::<4>::identity();
    let lost = own.retract(&[f64::NAN; 6]);
    assert!(Group::<f64>::distance_from_group(&lost).is_nan());
    for place in 0..2 {
        let mut pair = [own, own];
        pair[place] = lost;
        assert!(Group::<f64>::distance_from_group(&pair).is_nan(), "{place}");
    }
    assert!(Group::<f64>::distance_from_group(&(lost, own)).is_nan());
    assert!(Group::<f64>::distance_from_group(&(own, lost)).is_nan());
    // Finite entries whose products overflow.
    let overflowing =
        Matrix3::from_row_slice(&[1e200, -1e200, 0.0, 1e200, 1e200, 0.0, 0.0, 0.0, 1.0]);
    assert!(Rotation::from_matrix(&overflowing).is_err());
    assert!(Orthogonal::<3>::from_matrix(&overflowing).is_err());
}

/// Messages count from 1, like files and plots; the fields of errors are zero-based indices.
#[test]
fn messages_count_from_one() {
    use clebsch::Problem;
    use clebsch::groups::Part;
    for (said, words) in [
        (Part::axis(0).to_string(), "component 1"),
        (Part::axis(usize::MAX).to_string(), "component 256"),
        (Part::of_motion(2).to_string(), "angular component 3"),
        (Part::of_motion(3).to_string(), "linear component 1"),
        (Part::plane(0, 3, 4).to_string(), "plane (1, 4)"),
        (Part::entry(5, 3).to_string(), "entry (2, 3)"),
        (
            Problem::NotFinite {
                index: 0,
                value: f64::INFINITY,
            }
            .to_string(),
            "component 1 is inf",
        ),
        (
            Problem::EntryNotFinite {
                row: 0,
                column: 2,
                value: f64::NAN,
            }
            .to_string(),
            "entry (1, 3) is NaN",
        ),
        (
            Problem::NotSymmetric {
                row: 0,
                column: 1,
                upper: 2.0,
                lower: 3.0,
            }
            .to_string(),
            "not symmetric: entry (1, 2) is 2 but (2, 1) is 3",
        ),
        (
            Problem::NotSkew {
                row: 1,
                column: 1,
                upper: 2.0,
                lower: 2.0,
            }
            .to_string(),
            "not skew: entry (2, 2) is 2, not 0",
        ),
        (
            Problem::NotDiagonal {
                row: 2,
                column: 0,
                value: 1.0,
            }
            .to_string(),
            "not diagonal: entry (3, 1) is 1",
        ),
    ] {
        assert_eq!(said, words);
    }
}
