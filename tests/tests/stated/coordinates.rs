//! Space described by scalar coordinates and shorter vectors: clebsch finds its rotations, and the steps conserve
//! their momenta.

use clebsch::nalgebra::{Vector1, Vector2, Vector3};
use clebsch::{Additive, FieldMomentum};

clebsch::model! {
    /// A particle about a centre, by its coordinates, two of them together.
    model Coordinates {
        param m, k: Real;
        field X: Vec<2>;
        field z: Real;
        let V = next(X) - X;
        lagrangian = m*(dot(V, V) + (next(z) - z)^2)/(2*h) + h*m*k/sqrt(dot(X, X) + z^2);
    }
}

#[test]
fn coordinates_keep_their_angular_momentum() {
    let model = Coordinates::new(CoordinatesParameters { m: 1.7, k: 1.3 }).expect("parameters");
    let initial = CoordinatesInitial {
        X: Additive::new(Vector2::new(0.9, -0.2)),
        momentum_X: FieldMomentum(Vector2::new(0.3, 1.6)),
        z: Additive::new(Vector1::new(0.4)),
        momentum_z: FieldMomentum(Vector1::new(-0.5)),
    };
    let (mut state, mut work) = model.start(initial, 0.01).expect("start");
    let told = |s: &CoordinatesState| {
        let turning = model.momentum_X_angular(s);
        Vector3::new(
            -model.momentum_angular_X2_z(s),
            model.momentum_angular_X1_z(s),
            turning[(1, 0)],
        )
    };
    let by_hand = |s: &CoordinatesState| {
        let (x, p) = (s.X().matrix(), s.momentum_X().0);
        let (z, q) = (s.z().matrix()[0], s.momentum_z().0[0]);
        Vector3::new(x.x, x.y, z).cross(&Vector3::new(p.x, p.y, q))
    };
    let first = by_hand(&state);
    for _ in 0..2_000 {
        // Each sign follows from the plane of the rotation. The reported moment equals the hand-written one, and a step conserves
        // it to rounding.
        let (told, now) = (told(&state), by_hand(&state));
        assert!((told.abs() - now.abs()).norm() < 1e-14, "{told} {now}");
        assert!((now - first).norm() < 1e-13, "{}", now - first);
        model.step(&mut state, &mut work).expect("step");
    }
}
