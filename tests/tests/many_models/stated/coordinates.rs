//! Space described by scalar coordinates and shorter vectors: clebsch finds its rotations, and the steps conserve
//! their momenta.

use super::text_model::{Motion, TextModel, given};
use clebsch::nalgebra::Vector3;

/// A particle about a centre, by its coordinates, two of them together.
const COORDINATES: &str = "model Coordinates {
    param m, k: Real;
    field X: Vec<2>;
    field z: Real;
    let V = next(X) - X;
    lagrangian = m*(dot(V, V) + (next(z) - z)^2)/(2*h) + h*m*k/sqrt(dot(X, X) + z^2);
}";

#[test]
fn coordinates_keep_their_angular_momentum() {
    let given = given! {
        m: 1.7, k: 1.3, X: [0.9, -0.2], momentum_X: [0.3, 1.6], z: 0.4, momentum_z: -0.5,
    };
    let mut motion = TextModel::read(COORDINATES)
        .start(0.01, &given)
        .expect("start");
    let told = |m: &Motion| {
        let [one, two] = ["X1", "X2"].map(|x| m.invariant(&format!("momentum_angular_{x}_z"))[0]);
        Vector3::new(-two, one, m.invariant("momentum_X_angular")[2])
    };
    let by_hand = |m: &Motion| {
        let [x, p] = ["X", "momentum_X"].map(|name| m.vector::<2>(name));
        let [z, q] = ["z", "momentum_z"].map(|name| m.number(name));
        Vector3::new(x.x, x.y, z).cross(&Vector3::new(p.x, p.y, q))
    };
    let first = by_hand(&motion);
    for _ in 0..2_000 {
        // Each sign follows from the plane of the rotation. The reported moment equals the hand-written one, and a step conserves
        // it to rounding.
        let (told, now) = (told(&motion), by_hand(&motion));
        assert!((told.abs() - now.abs()).norm() < 1e-14, "{told} {now}");
        assert!((now - first).norm() < 1e-13, "{}", now - first);
        motion.steps(1);
    }
}
