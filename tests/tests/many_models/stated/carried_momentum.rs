//! The stepper advances the momentum from node to node, on every side and for every group. Invariants hold to rounding for step
//! sizes from a tenth to 1e-6 and below. Covers spatial pairs and single bodies, maps of GL(3), and bodies whose tensor is constant
//! on the other side.

use super::text_model::{Given, Motion, TextModel, given};
use clebsch::nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use clebsch::{BodyImpulse, RigidMotion, Rotation, UnitQuaternion};

/// Two bodies with a spherical joint, stated in space.
const PAIR_IN_SPACE: &str = "model PairInSpace {
    param eps: Real;
    group A: SO<3> velocity a;
    group B: SO<3> velocity b;
    advected J1: Sym<3>;
    advected J2: Sym<3>;
    advected d1: Vec<3>;
    advected d2: Vec<3>;
    constraint next(A) = a*A;
    constraint next(B) = b*B;
    constraint next(J1) = a*J1*a^T;
    constraint next(J2) = b*J2*b^T;
    constraint next(d1) = a*d1;
    constraint next(d2) = b*d2;
    lagrangian = -(tr(a*J1) + tr(b*J2) + eps*dot((a - Id)*d1, (b - Id)*d2))/h;
}";

/// The same bodies in the body frame.
const PAIR_IN_BODIES: &str = "model PairInBodies {
    param J1, J2: Sym<3>;
    param d1, d2: Vec<3>;
    param eps: Real;
    group A: SO<3> velocity a;
    group B: SO<3> velocity b;
    advected R: SO<3> = A^T*B;
    constraint next(A) = A*a;
    constraint next(B) = B*b;
    constraint next(R) = a^T*R*b;
    lagrangian = -(tr(J1*a) + tr(J2*b) + eps*dot((a - Id)*d1, R*(b - Id)*d2))/h;
}";

/// The same bodies stated by their attitudes; the second body also has a spring.
const PAIR_UNREDUCED: &str = "model PairUnreduced {
    param J1, J2: Sym<3>;
    param d1, d2: Vec<3>;
    param eps, s: Real;
    group A: SO<3> velocity a;
    group B: SO<3> velocity b;
    constraint next(A) = a*A;
    constraint next(B) = b*B;
    let x = (next(A) - A)*d1;
    let y = (next(B) - B)*d2;
    lagrangian = -(tr(J1*A^T*next(A)) + tr(J2*B^T*next(B)) + eps*dot(x, y))/h - h*s*dot(A*d1, B*d2);
}";

/// An elastic body, its deformation stated in space.
pub(crate) const ELASTIC_IN_SPACE: &str = "model ElasticInSpace {
    param s: Real;
    group Q: GL<3> velocity V;
    advected I: Sym<3>;
    advected B: Sym<3>;
    constraint next(Q) = V*Q;
    constraint next(I) = V*I*V^T;
    constraint next(B) = V*B*V^T;
    lagrangian = tr((V - Id)*I*(V - Id)^T)/(2*h) - h*s/2*tr(B) + h*s/2*log(det(B));
}";

/// A body thrown, stated in space.
const THROWN: &str = "model Thrown {
    param J: Sym<3>;
    param m, g: Real;
    param z: Vec<3>;
    group G: SE<3> velocity V;
    constraint next(G) = V*G;
    let x = pos(next(G)) - pos(G);
    lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(x, x)/(2*h) - h*m*g*dot(z, pos(G));
}";

/// A tensor that is constant in space, with a spatial velocity: the body momentum is conserved.
const CONSTANT_IN_SPACE: &str = "model ConstantInSpace {
    param J: Sym<3>;
    group A: SO<3> velocity a;
    constraint next(A) = a*A;
    lagrangian = -tr(J*a)/h;
}";

/// The same motion in the body frame, where the tensor is advected.
const CARRIED_BY_BODY: &str = "model CarriedByBody {
    group A: SO<3> velocity a;
    advected J: Sym<3>;
    constraint next(A) = A*a;
    constraint next(J) = a^T*J*a;
    lagrangian = -tr(J*a)/h;
}";

/// A body with a quaternion and a body with a rotation, whose angular velocities are coupled in space.
const MIXED_PAIR: &str = "model MixedPair {
    param J, S: Sym<3>;
    param e: Real;
    group q: SU<2> velocity w;
    group R: SO<3> velocity o;
    constraint next(q) = w*q;
    constraint next(R) = o*R;
    let W = q^T*next(q);
    let O = R^T*next(R);
    lagrangian = (2/h)*dot(im(W), S*im(W)) - tr(J*O)/h + e*dot(rot(q)*vee(rot(W)), R*vee(O))/h;
}";

const STEPS: usize = 2000;

const SIZES: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8];

/// Two thousand sums with half a unit of rounding each add up to 13 units at random; the margin is a factor of eight.
const EXACT: f64 = 100.0 * f64::EPSILON;

fn largest<const R: usize, const C: usize>(a: &SMatrix<f64, R, C>) -> f64 {
    let mut largest = 0.0;
    for x in a {
        // NaN counts as the largest.
        let within = x.abs() <= largest;
        if !within {
            largest = x.abs();
        }
    }
    largest
}

/// Checks that all steps conserve the invariants to rounding.
fn keeps<const R: usize, const C: usize>(
    (text, given): (&str, &Given),
    h: f64,
    conserved: impl Fn(&Motion) -> SMatrix<f64, R, C>,
) {
    let mut motion = TextModel::read(text).start(h, given).unwrap();
    let start = conserved(&motion);
    for _ in 0..STEPS {
        motion.steps(1);
        let off = largest(&(conserved(&motion) - start));
        assert!(off <= EXACT * start.norm(), "h = {h:e}: {off:e}");
    }
}

fn tensor() -> Matrix3<f64> {
    Matrix3::new(1.0, 0.1, 0.0, 0.1, 1.5, 0.2, 0.0, 0.2, 2.0)
}

fn one() -> Matrix3<f64> {
    Matrix3::identity()
}

const ARMS: [[f64; 3]; 2] = [[0.3, 0.1, 0.7], [0.2, -0.5, 0.3]];

const MOMENTA: [[f64; 3]; 2] = [[0.5, 0.3, 1.0], [-0.4, 0.7, 0.9]];

fn pair_in_space() -> Given {
    given! {
        eps: 0.4, A: one(), B: one(), spatial_momentum_A: MOMENTA[0], spatial_momentum_B: MOMENTA[1],
        J1: tensor(), J2: tensor() * 0.7, d1: ARMS[0], d2: ARMS[1],
    }
}

/// The sum of two momenta in space.
fn total(motion: &Motion, bodies: [&str; 2]) -> Vector3<f64> {
    let [a, b] = bodies.map(|body| motion.vector(&format!("spatial_momentum_{body}")));
    a + b
}

#[test]
fn the_total_momentum_of_a_pair_in_space() {
    for h in SIZES {
        keeps((PAIR_IN_SPACE, &pair_in_space()), h, |m| {
            total(m, ["A", "B"])
        });
    }
}

#[test]
fn the_total_momentum_of_a_pair_stated_by_its_attitudes() {
    let given = given! {
        J1: tensor(), J2: tensor() * 0.7, d1: ARMS[0], d2: ARMS[1], eps: 0.4, s: 0.8,
        A: one(), B: one(), spatial_momentum_A: MOMENTA[0], spatial_momentum_B: MOMENTA[1],
    };
    for h in SIZES {
        keeps((PAIR_UNREDUCED, &given), h, |m| total(m, ["A", "B"]));
    }
}

/// Each body loses exactly the numbers that the other gains, because the axes rotate with both ends of an edge.
#[test]
fn the_total_momentum_of_bodies_of_two_groups() {
    let given = given! {
        J: tensor(), S: Matrix3::from_diagonal(&Vector3::new(1.2, 2.3, 3.1)), e: 0.2,
        q: UnitQuaternion::identity(), R: one(),
        spatial_momentum_q: MOMENTA[0], spatial_momentum_R: MOMENTA[1],
    };
    for h in SIZES {
        keeps((MIXED_PAIR, &given), h, |m| total(m, ["q", "R"]));
    }
}

#[test]
fn the_pair_moves_as_it_is_stated_from_its_bodies() {
    let h = 0.05;
    let mut space = TextModel::read(PAIR_IN_SPACE)
        .start(h, &pair_in_space())
        .unwrap();
    let given = given! {
        J1: tensor(), J2: tensor() * 0.7, d1: ARMS[0], d2: ARMS[1], eps: 0.4,
        A: one(), B: one(), body_momentum_A: MOMENTA[0], body_momentum_B: MOMENTA[1],
    };
    let mut bodies = TextModel::read(PAIR_IN_BODIES).start(h, &given).unwrap();
    space.steps(100);
    bodies.steps(100);
    for name in ["A", "B", "spatial_momentum_A"] {
        let both = space.numbers(name).into_iter().zip(bodies.numbers(name));
        for (x, y) in both {
            // Rounding error of a hundred steps, which the two motions may amplify tenfold over five time units.
            assert!((x - y).abs() < 1e-12, "{name}: {x} {y}");
        }
    }
}

#[test]
fn the_scheme_in_space_is_of_second_order() {
    let end = |steps: u32| {
        let h = 1.0 / f64::from(steps);
        let mut motion = TextModel::read(PAIR_IN_SPACE)
            .start(h, &pair_in_space())
            .unwrap();
        motion.steps(steps as usize);
        motion.matrix::<3, 3>("A")
    };
    let [a, b, c] = [40, 80, 160].map(end);
    let ratio = (a - b).norm() / (b - c).norm();
    assert!((3.8..4.2).contains(&ratio), "{ratio}");
}

#[test]
fn the_angular_momentum_of_an_elastic_body() {
    let momentum = Matrix3::new(0.1, 0.3, -0.2, 0.5, 0.2, 0.3, 0.1, -0.4, 0.2);
    let given = given! { s: 0.4, Q: one(), spatial_momentum: momentum, I: tensor(), B: one() };
    for h in [1e-1, 1e-2, 1e-3, 1e-4, 1e-6] {
        keeps((ELASTIC_IN_SPACE, &given), h, |motion| {
            let m = motion.matrix::<3, 3>("spatial_momentum");
            m - m.transpose()
        });
    }
}

/// A thrown body with this inertia, mass and momentum in the body frame, and its initial position.
fn thrown(j: [f64; 3], m: f64, momentum: [f64; 6], at: [f64; 3]) -> Given {
    let place = RigidMotion {
        rotation: Rotation::identity(),
        translation: Vector3::from(at),
    };
    let impulse = BodyImpulse(SVector::<f64, 6>::from(momentum)).to_space(&place);
    given! {
        J: Matrix3::from_diagonal(&Vector3::from(j)), m: m, g: 9.81, z: [0.0, 0.0, 1.0],
        G: place, spatial_momentum: impulse.0,
    }
}

#[test]
fn free_fall_keeps_energy_to_the_rounding_of_what_is_carried() {
    // Far from the origin, light bodies are solved less accurately; during a hundred seconds they fall far.
    let bodies = [
        (
            5000,
            [0.5, 0.7, 1.1],
            1.3,
            [0.3, 0.5, -0.4, 1.0, 0.5, 2.0],
            [1.0, 2.0, 3.0],
        ),
        (
            STEPS,
            [0.05, 0.02, 0.04],
            1.0,
            [0.1, -0.05, 0.02, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
        ),
        (
            STEPS,
            [2.0, 1.0, 3.0],
            5.0,
            [1.0, 1.0, 1.0, 10.0, -3.0, 40.0],
            [-10.0, 0.0, 5.0],
        ),
    ];
    let model = TextModel::read(THROWN);
    for (longest, j, m, momentum, at) in bodies {
        for (h, steps) in [(0.05, longest), (1e-3, STEPS), (1e-6, STEPS), (1e-8, STEPS)] {
            let mut motion = model.start(h, &thrown(j, m, momentum, at)).unwrap();
            let energy = motion.energy();
            let start = motion.vector::<6>("spatial_momentum");
            for k in 1..=steps {
                motion.steps(1);
                let p = motion.vector::<6>("spatial_momentum");
                let place = motion.matrix::<4, 4>("G").fixed_view::<3, 1>(0, 3).norm();
                let linear = p.fixed_rows::<3>(3).norm();
                // The momentum about the fixed origin, plus the potential.
                let carried = (1.0 + place) * (linear + p.fixed_rows::<3>(0).norm())
                    / j.into_iter().fold(m, f64::min)
                    + m * 9.81 * place;
                // Each step adds at most one rounding error, in the worst case always with the same sign.
                let rounding = k as f64 * f64::EPSILON * carried;
                let off = (motion.energy() - energy).abs();
                assert!(
                    off <= rounding,
                    "h = {h:e}, node {k}: {off:e}, rounding {rounding:e}"
                );
                // The angular momentum about the vertical, and the horizontal linear momentum.
                let about = [p[2] - start[2], p[3] - start[3], p[4] - start[4]];
                for off in about {
                    assert!(
                        off.abs() <= EXACT * start.norm(),
                        "h = {h:e}, node {k}: {off:e}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_body_momentum_where_the_tensor_is_constant_in_space() {
    let in_space = given! { J: tensor(), A: one(), spatial_momentum: MOMENTA[0] };
    let by_body = given! { J: tensor(), A: one(), body_momentum: MOMENTA[0] };
    let momentum = Vector3::from(MOMENTA[0]);
    for h in SIZES {
        for (text, given) in [(CONSTANT_IN_SPACE, &in_space), (CARRIED_BY_BODY, &by_body)] {
            let mut motion = TextModel::read(text).start(h, given).unwrap();
            for _ in 0..STEPS {
                motion.steps(1);
                let off = largest(&(motion.vector("body_momentum") - momentum));
                assert!(off <= EXACT * momentum.norm(), "h = {h:e}: {off:e}");
            }
        }
    }
}
