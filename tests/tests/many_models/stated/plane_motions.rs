//! Steppers on SE(2). The action is stationary at every node of a run, on both sides, with potentials and a term linear in the
//! velocity. Momenta are conserved for any step size, the order is two, and a free body rotates uniformly and moves along a
//! straight line.

use super::text_model::{Motion, TextModel, given};
use clebsch::PlaneMotion;
use clebsch::nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use clebsch_oracle::oracle::action::plane::{PlaneSum, plane_twists};
use clebsch_oracle::oracle::action::{Side, stationarity};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;

/// Terms of the oracle in the body frame: second moments about its origin, a potential, and a term linear in the
/// velocity.
const BODY_SUM: &str = "model BodySum {
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
}";

/// The same terms on the spatial side.
const SPACE_SUM: &str = "model SpaceSum {
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
}";

/// A body in the plane whose weight has a lever arm, stated by positions.
const SLEDGE: &str = "model Sledge {
    param J: Sym<2>;                    // second moments about the body's origin
    param m: Real;
    param a, w: Vec<2>;                 // arm of the weight, the weight
    group G: SE<2> velocity V;
    constraint next(G) = G*V;
    let y = pos(next(G)) - pos(G);
    lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) - h*dot(w, pos(G) + rot(G)*a);
}";

/// A free body: its origin is its centre of mass.
const DISC: &str = "model Disc {
    param J: Sym<2>;
    param m: Real;
    group G: SE<2> velocity V;
    constraint next(G) = G*V;
    let y = pos(next(G)) - pos(G);
    lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h);
}";

/// A free body by its second moments about an origin that is not its centre of mass, in space.
const PLATE: &str = "model Plate {
    group G: SE<2> velocity V;
    advected S: Sym<3>;
    constraint next(G) = V*G;
    constraint next(S) = V*S*V^T;
    lagrangian = tr((V - Id)*S*(V - Id)^T)/(2*h);
}";

/// Steps of the runs that vary the action.
const STEPS: usize = 200;

/// The largest derivative of the action at a node, relative to its terms.
fn worst_of(action: &PlaneSum, nodes: &[[Square<f64, 3>; 1]]) -> f64 {
    let along = nodes.windows(3).map(|w| {
        let found = stationarity(action, &[w[0], w[1], w[2]], &plane_twists());
        let largest = found.derivative.iter().fold(0.0, |m, x| worse(m, x.abs()));
        largest / found.scale
    });
    along.fold(0.0, worse)
}

/// The nodes of a run from a random start; `momentum` is the name of the momentum.
fn run_of(
    (text, momentum): (&str, &str),
    action: &PlaneSum,
    source: &mut Source,
) -> Vec<[Square<f64, 3>; 1]> {
    let [a5, a14, a15, a19] = action.weights;
    let mut given = given! {
        a5: a5, a14: a14, a15: a15, a19: a19, A: action.general, K: action.three, Q: action.moments,
        u: action.lever, z: action.vertical, P0: action.line,
        G: PlaneMotion::new(source.between(-3.0, 3.0), Vector2::from(source.vector())),
    };
    given.push((momentum.to_owned(), source.vector::<3>().to_vec()));
    let mut motion = TextModel::read(text).start(action.h, &given).unwrap();
    let mut nodes = vec![[motion.square("G")]];
    for _ in 0..STEPS {
        motion.steps(1);
        nodes.push([motion.square("G")]);
    }
    nodes
}

#[test]
fn the_action_is_stationary_at_every_node() {
    let mut source = Source::seeded(81);
    for _ in 0..10 {
        let body = PlaneSum::random(&mut source, Side::Body, 0.05);
        let nodes = run_of((BODY_SUM, "body_momentum"), &body, &mut source);
        let found = worst_of(&body, &nodes);
        assert!(found < 1e-12, "body: {found:e}");
        let space = PlaneSum::random(&mut source, Side::Space, 0.05);
        let nodes = run_of((SPACE_SUM, "spatial_momentum"), &space, &mut source);
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

fn place() -> PlaneMotion {
    PlaneMotion::new(0.3, Vector2::new(1.5, -0.5))
}

const MOMENTUM: [f64; 3] = [0.8, 0.6, -1.1];

fn disc(h: f64) -> Motion {
    let given = given! { J: second_moments(), m: 2.0, G: place(), body_momentum: MOMENTUM };
    TextModel::read(DISC).start(h, &given).unwrap()
}

/// Rotation and position of a body.
fn parts(motion: &Motion) -> (Matrix2<f64>, Vector2<f64>) {
    let g = motion.matrix::<3, 3>("G");
    let turn = g.fixed_view::<2, 2>(0, 0).into_owned();
    (turn, Vector2::new(g[(0, 2)], g[(1, 2)]))
}

#[test]
fn a_free_body_turns_uniformly_and_goes_straight() {
    let [moment, x, y] = MOMENTUM;
    let start = place();
    let linear = start.rotation.matrix() * Vector2::new(x, y);
    let mut errors = Vec::new();
    for h in [0.1, 0.05, 0.025] {
        let mut motion = disc(h);
        let steps = (10.0_f64 / h).round() as usize;
        motion.steps(steps);
        let (turned, at) = parts(&motion);
        let n = steps as f64;
        let place = start.translation + linear * (n * h / 2.0);
        let gap = (at - place).norm() / place.norm();
        assert!(gap < 1e-13, "straight: {gap:e}");
        // A step rotates by the angle with sine h L / tr J, to rounding; the continuous motion rotates by h L / tr J.
        let turn = |angle: f64| PlaneMotion::new(0.3 + angle, place).rotation.matrix();
        let own = n * (h * moment / second_moments().trace()).asin();
        let gap = (turned - turn(own)).norm();
        assert!(gap < 1e-12, "uniform: {gap:e}");
        let exact = turn(n * h * moment / second_moments().trace());
        errors.push((turned - exact).norm());
    }
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "order {order}");
    }
}

#[test]
fn momenta_of_free_bodies_keep_for_any_step() {
    // A mass of two with its centre at body coordinates (0.2, -0.1), in the spatial frame.
    let arm = Vector3::new(0.2, -0.1, 1.0);
    let mut own: Matrix3<f64> = 2.0 * arm * arm.transpose();
    own[(0, 0)] += 0.7;
    own[(1, 1)] += 0.4;
    let g = place().matrix();
    let moments = g * own * g.transpose();
    let moments = (moments + moments.transpose()) / 2.0;
    for h in (1..=8).map(|n| 10.0_f64.powi(-n)) {
        let mut disc = disc(h);
        let first = disc.vector::<3>("spatial_momentum");
        let given = given! { G: place(), spatial_momentum: first, S: moments };
        let mut plate = TextModel::read(PLATE).start(h, &given).unwrap();
        let mut scale = first.norm();
        for _ in 0..1000 {
            disc.steps(1);
            scale = worse(scale, parts(&disc).1.norm() * first.norm());
        }
        plate.steps(100);
        for (frame, motion) in [("body", &disc), ("space", &plate)] {
            let drift = (motion.vector("spatial_momentum") - first).norm() / scale;
            assert!(drift < 1e-14, "{frame}, step {h:e}: {drift:e}");
        }
    }
}

/// The final position and momentum of a heavy body after a fixed time with `steps` steps.
fn sledge(steps: usize) -> (Matrix3<f64>, Vector3<f64>) {
    let given = given! {
        J: second_moments(), m: 2.0, a: [0.5, -0.2], w: [0.3, 1.1], G: place(), body_momentum: MOMENTUM,
    };
    let mut motion = TextModel::read(SLEDGE)
        .start(2.0 / steps as f64, &given)
        .unwrap();
    motion.steps(steps);
    (motion.matrix("G"), motion.vector("spatial_momentum"))
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
