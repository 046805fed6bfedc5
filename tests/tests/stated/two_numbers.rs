//! Positions and their momenta are stored in two numbers each, and momenta of a rigid motion about its own origin. Small bodies far
//! from the origin keep their spin, and small steps accumulate no rounding. Compared with double-double arithmetic and with
//! invariants.

use clebsch::nalgebra::{Matrix3, SVector, Vector2, Vector3};
use clebsch::{
    Additive, BodyImpulse, BodyPlaneImpulse, DoubleDouble, FieldMomentum, PlaneMotion, Real,
    RigidMotion, Rotation,
};

clebsch::model! {
    /// A body on a spring that is fastened away from its centre.
    model Tethered {
        param J: Sym<3>;
        param m, k: Real;
        param a, o: Vec<3>;
        group G: SE<3> velocity V;
        constraint next(G) = G*V;
        let y = pos(G) + rot(G)*a - o;
        lagrangian = -tr(J*rot(V))/h + m*dot(pos(V), pos(V))/(2*h) - h*k/2*dot(y, y);
    }
}

clebsch::model! {
    /// The same in the plane.
    model TetheredInPlane {
        param I, m, k: Real;
        param a, o: Vec<2>;
        group G: SE<2> velocity V;
        constraint next(G) = G*V;
        let y = pos(G) + rot(G)*a - o;
        lagrangian = -I*tr(rot(V))/(2*h) + m*dot(pos(V), pos(V))/(2*h) - h*k/2*dot(y, y);
    }
}

clebsch::model! {
    /// Three points that attract each other.
    model ThreePoints {
        param a, b, c, g: Real;
        field X, Y, Z: Vec<3>;
        let u = next(X) - X;
        let v = next(Y) - Y;
        let w = next(Z) - Z;
        lagrangian = (a*dot(u, u) + b*dot(v, v) + c*dot(w, w))/(2*h)
            + h*g*(a*b/sqrt(dot(X - Y, X - Y)) + a*c/sqrt(dot(X - Z, X - Z)) + b*c/sqrt(dot(Y - Z, Y - Z)));
    }
}

const STEPS: usize = 2_000;

/// The results of a run: the spin in the body frame, and the linear momentum.
type Momenta<T> = [Vec<T>; 2];

/// A body of this size, at this distance from the origin, after [`STEPS`] steps of `h`. Masses scale with the volume, so that
/// accelerations do not depend on the size.
fn in_space<T: Real>(size: f64, far: f64, h: f64) -> Momenta<T> {
    let number = T::from_f64;
    let mass = size * size * size;
    let second = Matrix3::from_diagonal(&Vector3::new(1.0, 0.7, 0.4)) * (mass * size * size);
    let place = Vector3::new(0.6, -0.5, 0.4) * far;
    let model = Tethered::<T>::new(TetheredParameters {
        J: second.map(number),
        m: number(mass),
        k: number(mass * 20.0),
        a: (Vector3::new(0.3, 0.2, -0.5) * size).map(number),
        o: (place + Vector3::new(0.1, 0.2, 0.3)).map(number),
    })
    .expect("parameters");
    let inertia = Matrix3::identity() * second.trace() - second;
    let spin = inertia * Vector3::new(0.3, 1.0, -0.4);
    let linear = Vector3::new(0.3, -0.2, 0.5) * mass;
    let given = [spin.x, spin.y, spin.z, linear.x, linear.y, linear.z];
    let initial = TetheredInitial {
        G: RigidMotion {
            rotation: Rotation::<T>::identity(),
            translation: place.map(number),
        },
        body_momentum: BodyImpulse(SVector::from(given).map(number)),
    };
    let (mut state, mut work) = model.start(initial, number(h)).expect("start");
    for _ in 0..STEPS {
        model.step(&mut state, &mut work).expect("step");
    }
    let (body, space) = (state.body_momentum().0, state.spatial_momentum().0);
    [
        body.as_slice()[..3].to_vec(),
        space.as_slice()[3..].to_vec(),
    ]
}

/// The same in the plane.
fn in_plane<T: Real>(size: f64, far: f64, h: f64) -> Momenta<T> {
    let number = T::from_f64;
    let mass = size * size;
    let place = Vector2::new(0.6, -0.5) * far;
    let model = TetheredInPlane::<T>::new(TetheredInPlaneParameters {
        I: number(mass * size * size),
        m: number(mass),
        k: number(mass * 20.0),
        a: (Vector2::new(0.3, -0.5) * size).map(number),
        o: (place + Vector2::new(0.1, 0.2)).map(number),
    })
    .expect("parameters");
    let given = [0.7 * mass * size * size, 0.3 * mass, -0.2 * mass];
    let initial = TetheredInPlaneInitial {
        G: PlaneMotion::new(T::zero(), place.map(number)),
        body_momentum: BodyPlaneImpulse(SVector::from(given).map(number)),
    };
    let (mut state, mut work) = model.start(initial, number(h)).expect("start");
    for _ in 0..STEPS {
        model.step(&mut state, &mut work).expect("step");
    }
    let (body, space) = (state.body_momentum().0, state.spatial_momentum().0);
    [
        body.as_slice()[..1].to_vec(),
        space.as_slice()[1..].to_vec(),
    ]
}

/// The largest deviation from the double-double results, relative to their size.
fn gap(found: &[f64], exact: &[DoubleDouble]) -> f64 {
    let off = found.iter().zip(exact);
    let off = off.fold(0.0, |sum: f64, (x, y)| {
        sum.hypot((DoubleDouble::from_f64(*x) - *y).magnitude())
    });
    off / found.iter().fold(0.0, |sum: f64, x| sum.hypot(*x))
}

#[test]
fn spin_of_a_small_body_far_away_is_kept() {
    for size in [1.0, 1e-2, 1e-3] {
        for far in [0.0, 1.0, 1e3] {
            for h in [1e-4, 1e-6] {
                let space = [in_space::<f64>(size, far, h), in_plane::<f64>(size, far, h)];
                let exact = [
                    in_space::<DoubleDouble>(size, far, h),
                    in_plane::<DoubleDouble>(size, far, h),
                ];
                for (found, exact) in space.iter().zip(&exact) {
                    // The rounding error of the attitude acts as a torque. For the smallest body it changes the spin by a relative
                    // 4e3 per unit time. A moment about the origin would also lose 1e-16 |x| / size^2, at worst 1e-7.
                    let gathered = f64::EPSILON * (1.0 + 4e3 * STEPS as f64 * h);
                    let [spin, linear] = [0, 1].map(|k| gap(&found[k], &exact[k]));
                    let case = format!("size {size}, {far} away, h = {h}");
                    assert!(
                        spin < 16.0 * f64::EPSILON + gathered,
                        "{case}: spin {spin:e}"
                    );
                    assert!(
                        linear < 16.0 * f64::EPSILON,
                        "{case}: linear momentum {linear:e}"
                    );
                }
            }
        }
    }
}

#[test]
fn small_steps_gather_no_rounding() {
    let point = |x: f64, y: f64, z: f64| Additive::new(Vector3::new(x, y, z) * 100.0);
    let momentum = |x: f64, y: f64, z: f64| FieldMomentum(Vector3::new(x, y, z));
    let model = ThreePoints::new(ThreePointsParameters {
        a: 1.0,
        b: 0.7,
        c: 0.3,
        g: 1e-3,
    })
    .expect("parameters");
    let initial = ThreePointsInitial {
        X: point(1.0, 0.1, 0.3),
        Y: point(-0.8, 0.4, -0.7),
        Z: point(0.3, -1.7, 0.6),
        momentum_X: momentum(0.13, 0.44, -0.2),
        momentum_Y: momentum(-0.3, -0.31, 0.41),
        momentum_Z: momentum(0.21, 0.05, -0.11),
    };
    let told = |state: &ThreePointsState| {
        let parts = [
            (state.X(), state.momentum_X()),
            (state.Y(), state.momentum_Y()),
            (state.Z(), state.momentum_Z()),
        ];
        let linear = parts.iter().map(|(_, p)| p.0).sum::<Vector3<f64>>();
        let angular = parts.iter().map(|(x, p)| x.matrix().cross(&p.0));
        (linear, angular.sum::<Vector3<f64>>(), model.energy(state))
    };
    for h in [1e-6, 1e-8] {
        let (mut state, mut work) = model.start(initial, h).expect("start");
        let before = told(&state);
        for _ in 0..100_000 {
            model.step(&mut state, &mut work).expect("step");
        }
        let after = told(&state);
        // Rounding of the sums themselves. With one number per value, the drifts are 7e-12, 1e-9 and 5e-12.
        let linear = (after.0 - before.0).norm();
        let angular = (after.1 - before.1).norm() / before.1.norm();
        let energy = ((after.2 - before.2) / before.2).abs();
        let all = [linear, angular, energy];
        assert!(all.iter().all(|x| *x < 2e-15), "h = {h}: {all:?}");
    }
}
