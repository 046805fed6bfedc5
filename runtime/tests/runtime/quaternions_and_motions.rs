//! SU(2) and SE(3): the laws of their matrices, of the coordinates of their Lie algebras and of their action on covectors.

use super::common::Random;
use clebsch::linalg::{
    hat, pure_quaternion, quaternion_imaginary, quaternion_real, quaternion_rotation,
};
use clebsch::nalgebra::{Matrix3, Matrix4, SVector, Vector3};
use clebsch::{Coadjoint, Group, NotARigidMotion, RigidMotion, UnitQuaternion};

/// Sixteen entries, each with about four rounding errors of numbers of order 1, in the Frobenius norm.
const ROUNDING: f64 = 8e-15;

fn quaternion(random: &mut Random) -> UnitQuaternion {
    UnitQuaternion::from_components(random.rotation().quaternion()).expect("unit")
}

fn motion(random: &mut Random) -> RigidMotion {
    RigidMotion {
        rotation: random.rotation(),
        translation: random.vector(),
    }
}

/// Checks associativity, the neutral element, inverses and the retraction, on matrices.
fn conforms<G: Group<f64>>(mut pick: impl FnMut() -> G, matrix: impl Fn(&G) -> Matrix4<f64>) {
    let apart = |a: &G, b: &G| (matrix(a) - matrix(b)).norm();
    for _ in 0..200 {
        let (a, b, c) = (pick(), pick(), pick());
        let one = G::identity();
        let product = a.compose(&b);
        assert!((matrix(&product) - matrix(&a) * matrix(&b)).norm() < ROUNDING);
        assert!(apart(&product.compose(&c), &a.compose(&b.compose(&c))) < ROUNDING);
        assert!(apart(&a.compose(&one), &a) < ROUNDING);
        assert!(apart(&a.compose(&a.inverse()), &one) < ROUNDING);
        assert!(apart(&a.inverse().compose(&a), &one) < ROUNDING);
        assert!(apart(&a.retract(&[]), &a) < ROUNDING);
        let xi: Vec<f64> = (0..G::DIMENSION).map(|i| 0.1 + 0.05 * i as f64).collect();
        let moved = a.compose(&one.retract(&xi));
        assert!(apart(&a.retract(&xi), &moved) < ROUNDING);
        assert!(product.distance_from_group() < ROUNDING);
    }
}

#[test]
fn both_are_groups() {
    let mut random = Random(31);
    conforms(|| quaternion(&mut random), UnitQuaternion::matrix);
    let mut random = Random(32);
    conforms(|| motion(&mut random), RigidMotion::matrix);
}

#[test]
fn coordinates_are_angular_and_linear_velocities() {
    let mut random = Random(33);
    let one = Matrix4::identity();
    for _ in 0..20 {
        // A quaternion rotates space by twice its own angle, so coordinates are angular velocities.
        let w = random.vector() * 1e-5;
        let moved = UnitQuaternion::identity().retract(w.as_slice());
        let first = one + pure_quaternion(&w) * 0.5;
        assert!((moved.matrix() - first).norm() < 1e-9);
        let turned = Matrix3::identity() + hat(&w);
        assert!((moved.rotation().matrix() - turned).norm() < 1e-9);
        let v = random.vector() * 1e-5;
        let xi = [w.x, w.y, w.z, v.x, v.y, v.z];
        let mut first = one;
        first.fixed_view_mut::<3, 3>(0, 0).copy_from(&turned);
        first.fixed_view_mut::<3, 1>(0, 3).copy_from(&v);
        let moved = RigidMotion::identity().retract(&xi);
        assert!((moved.matrix() - first).norm() < 1e-9);
    }
}

#[test]
fn quaternions_read_from_matrices_what_they_are() {
    let mut random = Random(34);
    for _ in 0..200 {
        let q = quaternion(&mut random);
        let [w, x, y, z] = q.components();
        let m = q.matrix();
        assert!((quaternion_real(&m) - w).abs() < ROUNDING);
        assert!((quaternion_imaginary(&m) - Vector3::new(x, y, z)).norm() < ROUNDING);
        assert!((quaternion_rotation(&m) - q.rotation().matrix()).norm() < ROUNDING);
        // The rotation is the conjugation. The opposite quaternion gives the same rotation but is a different element.
        let v = random.vector();
        let conjugated = quaternion_imaginary(&(m * pure_quaternion(&v) * m.transpose()));
        assert!((conjugated - q.rotation().rotate(&v)).norm() < ROUNDING);
        let opposite = UnitQuaternion::from_components([-w, -x, -y, -z]).expect("unit");
        let difference = opposite.rotation().matrix() - q.rotation().matrix();
        assert!(difference.norm() < ROUNDING);
        assert_ne!(opposite, q);
    }
    assert!(UnitQuaternion::from_components([1.0, 0.1, 0.0, 0.0]).is_err());
}

#[test]
fn covectors_keep_their_pairing() {
    let mut random = Random(35);
    let algebra = |x: &SVector<f64, 6>| {
        let mut m = Matrix4::zeros();
        m.fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&hat(&Vector3::new(x[0], x[1], x[2])));
        m.fixed_view_mut::<3, 1>(0, 3)
            .copy_from(&Vector3::new(x[3], x[4], x[5]));
        m
    };
    let coordinates =
        |m: &Matrix4<f64>| SVector::<f64, 6>::from([m.m32, m.m13, m.m21, m.m14, m.m24, m.m34]);
    for _ in 0..200 {
        let g = motion(&mut random);
        let (a, b, c, d) = (
            random.vector(),
            random.vector(),
            random.vector(),
            random.vector(),
        );
        let xi = SVector::<f64, 6>::from([a.x, a.y, a.z, b.x, b.y, b.z]);
        let mu = SVector::<f64, 6>::from([c.x, c.y, c.z, d.x, d.y, d.z]);
        // <m, g X g^-1> = <mu, X>
        let carried = coordinates(&(g.matrix() * algebra(&xi) * g.inverse().matrix()));
        let m = g.covector_to_space(&mu);
        assert!((m.dot(&carried) - mu.dot(&xi)).abs() < 10.0 * ROUNDING);
        assert!((g.covector_to_body(&m) - mu).norm() < ROUNDING);
    }
}

#[test]
fn what_is_no_motion_is_refused() {
    let mut random = Random(36);
    let m = motion(&mut random).matrix();
    let read = RigidMotion::from_matrix(&m).expect("a motion");
    assert!((read.matrix() - m).norm() < ROUNDING);
    assert!(matches!(
        RigidMotion::from_matrix(&m.transpose()),
        Err(NotARigidMotion::LastRow { .. })
    ));
    let mut sheared = m;
    sheared.m12 += 1e-6;
    assert!(matches!(
        RigidMotion::from_matrix(&sheared),
        Err(NotARigidMotion::Rotation(_))
    ));
    let mut far = m;
    far.m14 = f64::INFINITY;
    assert!(RigidMotion::from_matrix(&far).is_err());
}
