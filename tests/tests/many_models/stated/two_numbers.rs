//! Positions and their momenta are stored in two numbers each, and momenta of a rigid motion about its own origin. Small bodies far
//! from the origin keep their spin, and small steps accumulate no rounding. Compared with double-double arithmetic and with
//! invariants.

use super::text_model::{Motion, TextModel, given};
use clebsch::nalgebra::{Matrix3, SVector, Vector2, Vector3};
use clebsch::{
    BodyImpulse, BodyPlaneImpulse, DoubleDouble, PlaneMotion, Real, RigidMotion, Rotation,
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

/// Three points that attract each other.
const THREE_POINTS: &str = "model ThreePoints {
    param a, b, c, g: Real;
    field X, Y, Z: Vec<3>;
    let u = next(X) - X;
    let v = next(Y) - Y;
    let w = next(Z) - Z;
    lagrangian = (a*dot(u, u) + b*dot(v, v) + c*dot(w, w))/(2*h)
        + h*g*(a*b/sqrt(dot(X - Y, X - Y)) + a*c/sqrt(dot(X - Z, X - Z)) + b*c/sqrt(dot(Y - Z, Y - Z)));
}";

const STEPS: usize = 2_000;

/// The results of a run: the spin in the body frame, and the linear momentum; from the text, and in double-double arithmetic.
type Momenta = [(Vec<f64>, Vec<DoubleDouble>); 2];

type Exact = DoubleDouble;

fn exact(x: f64) -> Exact {
    Exact::from_f64(x)
}

/// The spin, the first `turns` numbers of the momentum in the body frame, and the linear momentum in space.
fn momenta(motion: &mut Motion, turns: usize, exact: [&[Exact]; 2]) -> Momenta {
    motion.steps(STEPS);
    let (body, space) = (
        motion.numbers("body_momentum"),
        motion.numbers("spatial_momentum"),
    );
    [
        (body[..turns].to_vec(), exact[0][..turns].to_vec()),
        (space[turns..].to_vec(), exact[1][turns..].to_vec()),
    ]
}

/// A body of this size, at this distance from the origin, after [`STEPS`] steps of `h`. Masses scale with the volume, so that
/// accelerations do not depend on the size.
fn in_space(size: f64, far: f64, h: f64) -> Momenta {
    let mass = size * size * size;
    let second = Matrix3::from_diagonal(&Vector3::new(1.0, 0.7, 0.4)) * (mass * size * size);
    let place = Vector3::new(0.6, -0.5, 0.4) * far;
    let (k, a) = (mass * 20.0, Vector3::new(0.3, 0.2, -0.5) * size);
    let o = place + Vector3::new(0.1, 0.2, 0.3);
    let inertia = Matrix3::identity() * second.trace() - second;
    let spin = inertia * Vector3::new(0.3, 1.0, -0.4);
    let linear = Vector3::new(0.3, -0.2, 0.5) * mass;
    let momentum = [spin.x, spin.y, spin.z, linear.x, linear.y, linear.z];
    let start = RigidMotion {
        rotation: Rotation::identity(),
        translation: place,
    };
    let given = given! { J: second, m: mass, k: k, a: a, o: o, G: start, body_momentum: momentum };
    let mut motion = TextModel::read(Tethered::<Exact>::SOURCE)
        .start(h, &given)
        .expect("start");

    let model = Tethered::new(TetheredParameters {
        J: second.map(exact),
        m: exact(mass),
        k: exact(k),
        a: a.map(exact),
        o: o.map(exact),
    });
    let model = model.expect("parameters");
    let initial = TetheredInitial {
        G: RigidMotion {
            rotation: Rotation::identity(),
            translation: place.map(exact),
        },
        body_momentum: BodyImpulse(SVector::from(momentum).map(exact)),
    };
    let (mut state, mut work) = model.start(initial, exact(h)).expect("start");
    for _ in 0..STEPS {
        model.step(&mut state, &mut work).expect("step");
    }
    let (body, space) = (state.body_momentum().0, state.spatial_momentum().0);
    momenta(&mut motion, 3, [body.as_slice(), space.as_slice()])
}

/// The same in the plane.
fn in_plane(size: f64, far: f64, h: f64) -> Momenta {
    let mass = size * size;
    let place = Vector2::new(0.6, -0.5) * far;
    let (moment, k, a) = (
        mass * size * size,
        mass * 20.0,
        Vector2::new(0.3, -0.5) * size,
    );
    let o = place + Vector2::new(0.1, 0.2);
    let momentum = [0.7 * moment, 0.3 * mass, -0.2 * mass];
    let given = given! {
        I: moment, m: mass, k: k, a: a, o: o, G: PlaneMotion::new(0.0, place), body_momentum: momentum,
    };
    let text = TetheredInPlane::<Exact>::SOURCE;
    let mut motion = TextModel::read(text).start(h, &given).expect("start");

    let model = TetheredInPlane::new(TetheredInPlaneParameters {
        I: exact(moment),
        m: exact(mass),
        k: exact(k),
        a: a.map(exact),
        o: o.map(exact),
    });
    let model = model.expect("parameters");
    let initial = TetheredInPlaneInitial {
        G: PlaneMotion::new(exact(0.0), place.map(exact)),
        body_momentum: BodyPlaneImpulse(SVector::from(momentum).map(exact)),
    };
    let (mut state, mut work) = model.start(initial, exact(h)).expect("start");
    for _ in 0..STEPS {
        model.step(&mut state, &mut work).expect("step");
    }
    let (body, space) = (state.body_momentum().0, state.spatial_momentum().0);
    momenta(&mut motion, 1, [body.as_slice(), space.as_slice()])
}

/// The largest deviation from the double-double results, relative to their size.
fn gap((found, exact): &(Vec<f64>, Vec<Exact>)) -> f64 {
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
                for found in [in_space(size, far, h), in_plane(size, far, h)] {
                    // The rounding error of the attitude acts as a torque. For the smallest body it changes the spin by a relative
                    // 4e3 per unit time. A moment about the origin would also lose 1e-16 |x| / size^2, at worst 1e-7.
                    let gathered = f64::EPSILON * (1.0 + 4e3 * STEPS as f64 * h);
                    let [spin, linear] = found.each_ref().map(gap);
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
    let given = given! {
        a: 1.0, b: 0.7, c: 0.3, g: 1e-3,
        X: [100.0, 10.0, 30.0], Y: [-80.0, 40.0, -70.0], Z: [30.0, -170.0, 60.0],
        momentum_X: [0.13, 0.44, -0.2], momentum_Y: [-0.3, -0.31, 0.41], momentum_Z: [0.21, 0.05, -0.11],
    };
    let told = |motion: &Motion| {
        let parts = ["X", "Y", "Z"].map(|name| {
            let momentum = motion.vector::<3>(&format!("momentum_{name}"));
            (motion.vector::<3>(name), momentum)
        });
        let linear = parts.iter().map(|(_, p)| p).sum::<Vector3<f64>>();
        let angular = parts.iter().map(|(x, p)| x.cross(p));
        (linear, angular.sum::<Vector3<f64>>(), motion.energy())
    };
    for h in [1e-6, 1e-8] {
        let mut motion = TextModel::read(THREE_POINTS)
            .start(h, &given)
            .expect("start");
        let before = told(&motion);
        motion.steps(100_000);
        let after = told(&motion);
        // Rounding of the sums themselves. With one number per value, the drifts are 7e-12, 1e-9 and 5e-12.
        let linear = (after.0 - before.0).norm();
        let angular = (after.1 - before.1).norm() / before.1.norm();
        let energy = ((after.2 - before.2) / before.2).abs();
        let all = [linear, angular, energy];
        assert!(all.iter().all(|x| *x < 2e-15), "h = {h}: {all:?}");
    }
}
