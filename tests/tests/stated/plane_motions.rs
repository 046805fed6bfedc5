//! Steppers on SE(2). The action is stationary at every node of a run, on both sides, with potentials and a term linear in the
//! velocity. Momenta are conserved for any step size, the order is two, and a free body rotates uniformly and moves along a
//! straight line.

use clebsch::nalgebra::{Matrix2, Matrix3, SVector, Vector2, Vector3};
use clebsch::{BodyPlaneImpulse, PlaneMotion, SpatialPlaneImpulse};
use clebsch_oracle::oracle::action::plane::{PlaneSum, plane_twists};
use clebsch_oracle::oracle::action::{Side, stationarity};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

clebsch::model! {
    /// Terms of the oracle in the body frame: second moments about its origin, a potential, and a term linear in the
    /// velocity.
    model BodySum {
        param a5, a14, a15, a19: Real;
        param A: Mat<2>;
        param K, Q: Sym<3>;
        param u, z: Vec<2>;
        param P0: Vec<3>;
        group G: SE<2> velocity V;
        advected Γ: Vec<2> = rot(G)^T*z;
        advected P: Vec<3> = G^T*P0;
        constraint next(G) = G*V;
        constraint next(Γ) = rot(V)^T*Γ;
        constraint next(P) = V^T*P;
        lagrangian = tr((V - Id)*Q*(V - Id)^T)/(2*h) + a5*dot(pos(V^-1), A*u) + a14*dot(P, K*P)
            + a15*dot(Γ, u) + a19*exp(-dot(pos(G), pos(G)))*dot(Γ, A*Γ);
    }
}

clebsch::model! {
    /// The same terms on the spatial side.
    model SpaceSum {
        param a5, a14, a15, a19: Real;
        param A: Mat<2>;
        param K, Q: Sym<3>;
        param u, z: Vec<2>;
        param P0: Vec<3>;
        group G: SE<2> velocity V;
        advected Γ: Vec<2> = rot(G)*z;
        advected P: Vec<3> = (G^-1)^T*P0;
        constraint next(G) = V*G;
        constraint next(Γ) = rot(V)*Γ;
        constraint next(P) = (V^-1)^T*P;
        lagrangian = tr((V - Id)*Q*(V - Id)^T)/(2*h) + a5*dot(pos(V^-1), A*u) + a14*dot(P, K*P)
            + a15*dot(Γ, u) + a19*exp(-dot(pos(G), pos(G)))*dot(Γ, A*Γ);
    }
}

clebsch::model! {
    /// A body in the plane whose weight has a lever arm, stated by positions.
    model Sledge {
        param J: Sym<2>;                    // second moments about the body's origin
        param m: Real;
        param a, w: Vec<2>;                 // arm of the weight, the weight
        group G: SE<2> velocity V;
        constraint next(G) = G*V;
        let y = pos(next(G)) - pos(G);
        lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) - h*dot(w, pos(G) + rot(G)*a);
    }
}

clebsch::model! {
    /// A free body: its origin is its centre of mass.
    model Disc {
        param J: Sym<2>;
        param m: Real;
        group G: SE<2> velocity V;
        constraint next(G) = G*V;
        let y = pos(next(G)) - pos(G);
        lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h);
    }
}

clebsch::model! {
    /// A free body by its second moments about an origin that is not its centre of mass, in space.
    model Plate {
        group G: SE<2> velocity V;
        advected S: Sym<3>;
        constraint next(G) = V*G;
        constraint next(S) = V*S*V^T;
        lagrangian = tr((V - Id)*S*(V - Id)^T)/(2*h);
    }
}

/// Steps of the runs that vary the action.
const STEPS: usize = 200;

fn matrix<const N: usize>(a: &Square<f64, N>) -> clebsch::nalgebra::SMatrix<f64, N, N> {
    clebsch::nalgebra::SMatrix::from_fn(|i, j| a.0[i][j])
}

fn square(a: &Matrix3<f64>) -> [Square<f64, 3>; 1] {
    [Square(from_fn(|i| from_fn(|j| a[(i, j)])))]
}

/// The largest derivative of the action at a node, relative to its terms.
fn worst_of(action: &PlaneSum, nodes: &[Matrix3<f64>]) -> f64 {
    let along = nodes.windows(3).map(|w| {
        let nodes = [square(&w[0]), square(&w[1]), square(&w[2])];
        let found = stationarity(action, &nodes, &plane_twists());
        let largest = found.derivative.iter().fold(0.0, |m, x| worse(m, x.abs()));
        largest / found.scale
    });
    along.fold(0.0, worse)
}

macro_rules! run_of {
    ($model:ident, $parameters:ident, $initial:ident, $momentum:ident, $kept:ident, $action:expr, $source:expr) => {{
        let action = $action;
        let [a5, a14, a15, a19] = action.weights;
        let model = $model::new($parameters {
            a5,
            a14,
            a15,
            a19,
            A: matrix(&action.general),
            K: matrix(&action.three),
            Q: matrix(&action.moments),
            u: Vector2::from(action.lever),
            z: Vector2::from(action.vertical),
            P0: Vector3::from(action.line),
        })
        .unwrap();
        let initial = $initial {
            G: PlaneMotion::new($source.between(-3.0, 3.0), Vector2::from($source.vector())),
            $kept: $momentum(Vector3::from($source.vector::<3>())),
        };
        let (mut state, mut work) = model.start(initial, action.h).unwrap();
        let mut nodes = vec![state.G().matrix()];
        for _ in 0..STEPS {
            model.step(&mut state, &mut work).unwrap();
            nodes.push(state.G().matrix());
        }
        nodes
    }};
}

#[test]
fn the_action_is_stationary_at_every_node() {
    let mut source = Source::seeded(81);
    for _ in 0..10 {
        let body = PlaneSum::random(&mut source, Side::Body, 0.05);
        let nodes = run_of!(
            BodySum,
            BodySumParameters,
            BodySumInitial,
            BodyPlaneImpulse,
            body_momentum,
            &body,
            &mut source
        );
        let found = worst_of(&body, &nodes);
        assert!(found < 1e-12, "body: {found:e}");
        let space = PlaneSum::random(&mut source, Side::Space, 0.05);
        let nodes = run_of!(
            SpaceSum,
            SpaceSumParameters,
            SpaceSumInitial,
            SpatialPlaneImpulse,
            spatial_momentum,
            &space,
            &mut source
        );
        let found = worst_of(&space, &nodes);
        assert!(found < 1e-12, "space: {found:e}");
        // A statement that differs from the oracle's fails.
        let mut other = space.clone();
        other.weights[0] *= 1.01;
        assert!(worst_of(&other, &nodes) > 1e-9);
    }
}

fn second_moments() -> Matrix2<f64> {
    Matrix2::new(0.7, 0.1, 0.1, 0.4)
}

fn disc() -> Disc {
    Disc::new(DiscParameters {
        J: second_moments(),
        m: 2.0,
    })
    .unwrap()
}

fn start() -> (PlaneMotion, SVector<f64, 3>) {
    let motion = PlaneMotion::new(0.3, Vector2::new(1.5, -0.5));
    (motion, Vector3::new(0.8, 0.6, -1.1))
}

#[test]
fn a_free_body_turns_uniformly_and_goes_straight() {
    let (motion, momentum) = start();
    let model = disc();
    let (moment, linear) = (momentum.x, Vector2::new(momentum.y, momentum.z));
    let linear = motion.rotation.matrix() * linear;
    let mut errors = Vec::new();
    for h in [0.1, 0.05, 0.025] {
        let initial = DiscInitial {
            G: motion,
            body_momentum: BodyPlaneImpulse(momentum),
        };
        let (mut state, mut work) = model.start(initial, h).unwrap();
        let steps = (10.0_f64 / h).round() as usize;
        for _ in 0..steps {
            model.step(&mut state, &mut work).unwrap();
        }
        let n = steps as f64;
        let place = motion.translation + linear * (n * h / 2.0);
        let gap = (state.G().translation - place).norm() / place.norm();
        assert!(gap < 1e-13, "straight: {gap:e}");
        // A step rotates by the angle with sine h L / tr J, to rounding; the continuous motion rotates by h L / tr J.
        let turn = |angle: f64| PlaneMotion::new(0.3 + angle, place).rotation.matrix();
        let own = n * (h * moment / second_moments().trace()).asin();
        let gap = (state.G().rotation.matrix() - turn(own)).norm();
        assert!(gap < 1e-12, "uniform: {gap:e}");
        let exact = turn(n * h * moment / second_moments().trace());
        errors.push((state.G().rotation.matrix() - exact).norm());
    }
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "order {order}");
    }
}

#[test]
fn momenta_of_free_bodies_keep_for_any_step() {
    let (motion, momentum) = start();
    let model = disc();
    let plate = Plate::new(PlateParameters {
        scalar: std::marker::PhantomData,
    })
    .unwrap();
    // A mass of two with its centre at body coordinates (0.2, -0.1), in the spatial frame.
    let arm = Vector3::new(0.2, -0.1, 1.0);
    let mut own: Matrix3<f64> = 2.0 * arm * arm.transpose();
    own[(0, 0)] += 0.7;
    own[(1, 1)] += 0.4;
    let g = motion.matrix();
    let moments = g * own * g.transpose();
    let moments = (moments + moments.transpose()) / 2.0;
    for h in (1..=8).map(|n| 10.0_f64.powi(-n)) {
        let initial = DiscInitial {
            G: motion,
            body_momentum: BodyPlaneImpulse(momentum),
        };
        let (mut state, mut work) = model.start(initial, h).unwrap();
        let first = state.spatial_momentum().0;
        let initial = PlateInitial {
            G: motion,
            spatial_momentum: SpatialPlaneImpulse(first),
            S: moments,
        };
        let (mut other, mut spare) = plate.start(initial, h).unwrap();
        let mut scale = first.norm();
        for step in 0..1000 {
            model.step(&mut state, &mut work).unwrap();
            if step < 100 {
                plate.step(&mut other, &mut spare).unwrap();
            }
            scale = worse(scale, state.G().translation.norm() * first.norm());
        }
        let drift = (state.spatial_momentum().0 - first).norm() / scale;
        assert!(drift < 1e-14, "step {h:e}: {drift:e}");
        let drift = (other.spatial_momentum().0 - first).norm() / scale;
        assert!(drift < 1e-14, "in space, step {h:e}: {drift:e}");
    }
}

/// The final position of a heavy body after a fixed time with `steps` steps.
fn sledge(steps: usize) -> (Matrix3<f64>, SVector<f64, 3>) {
    let model = Sledge::new(SledgeParameters {
        J: second_moments(),
        m: 2.0,
        a: Vector2::new(0.5, -0.2),
        w: Vector2::new(0.3, 1.1),
    })
    .unwrap();
    let (motion, momentum) = start();
    let initial = SledgeInitial {
        G: motion,
        body_momentum: BodyPlaneImpulse(momentum),
    };
    let (mut state, mut work) = model.start(initial, 2.0 / steps as f64).unwrap();
    for _ in 0..steps {
        model.step(&mut state, &mut work).unwrap();
    }
    (state.G().matrix(), state.spatial_momentum().0)
}

#[test]
fn the_order_is_two() {
    let (fine, finely) = sledge(6400);
    let errors = [50, 100, 200].map(|steps| {
        let (found, momentum) = sledge(steps);
        ((found - fine).norm(), (momentum - finely).norm())
    });
    for pair in errors.windows(2) {
        let orders = [pair[0].0 / pair[1].0, pair[0].1 / pair[1].1].map(f64::log2);
        assert!(
            orders.iter().all(|order| (order - 2.0).abs() < 0.05),
            "{orders:?}"
        );
    }
}

#[test]
fn what_is_no_motion_of_the_plane_is_refused() {
    let mut matrix = PlaneMotion::new(0.3, Vector2::new(1.0, 2.0)).matrix();
    assert_eq!(PlaneMotion::from_matrix(&matrix).unwrap().matrix(), matrix);
    matrix.m31 = 1e-3;
    let said = PlaneMotion::from_matrix(&matrix).unwrap_err().to_string();
    assert!(
        said.contains("the last row is not (0, ..., 0, 1)"),
        "{said}"
    );
    matrix = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, 1.0));
    let said = PlaneMotion::from_matrix(&matrix).unwrap_err().to_string();
    assert!(said.contains("upper left block"), "{said}");
}
