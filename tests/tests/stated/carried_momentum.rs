//! The stepper advances the momentum from node to node, on every side and for every group. Invariants hold to rounding for step
//! sizes from a tenth to 1e-6 and below. Covers spatial pairs and single bodies, maps of GL(3), and bodies whose tensor is constant
//! on the other side.

use clebsch::integrate::Stepper;
use clebsch::nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use clebsch::{
    BodyImpulse, BodyMomentum, Linear, RigidMotion, Rotation, SpatialMomentum,
    SpatialMomentumMatrix, UnitQuaternion,
};

clebsch::model! {
    /// Two bodies with a spherical joint, stated in space.
    model PairInSpace {
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
    }
}

clebsch::model! {
    /// The same bodies in the body frame.
    model PairInBodies {
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
    }
}

clebsch::model! {
    /// The same bodies stated by their attitudes; the second body also has a spring.
    model PairUnreduced {
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
    }
}

clebsch::model! {
    /// An elastic body, its deformation stated in space.
    model ElasticInSpace {
        param s: Real;
        group Q: GL<3> velocity V;
        advected I: Sym<3>;
        advected B: Sym<3>;
        constraint next(Q) = V*Q;
        constraint next(I) = V*I*V^T;
        constraint next(B) = V*B*V^T;
        lagrangian = tr((V - Id)*I*(V - Id)^T)/(2*h) - h*s/2*tr(B) + h*s/2*log(det(B));
    }
}

clebsch::model! {
    /// A body thrown, stated in space.
    model Thrown {
        param J: Sym<3>;
        param m, g: Real;
        param z: Vec<3>;
        group G: SE<3> velocity V;
        constraint next(G) = V*G;
        let x = pos(next(G)) - pos(G);
        lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(x, x)/(2*h) - h*m*g*dot(z, pos(G));
    }
}

clebsch::model! {
    /// A tensor that is constant in space, with a spatial velocity: the body momentum is conserved.
    model ConstantInSpace {
        param J: Sym<3>;
        group A: SO<3> velocity a;
        constraint next(A) = a*A;
        lagrangian = -tr(J*a)/h;
    }
}

clebsch::model! {
    /// The same motion in the body frame, where the tensor is advected.
    model CarriedByBody {
        group A: SO<3> velocity a;
        advected J: Sym<3>;
        constraint next(A) = A*a;
        constraint next(J) = a^T*J*a;
        lagrangian = -tr(J*a)/h;
    }
}

clebsch::model! {
    /// A body with a quaternion and a body with a rotation, whose angular velocities are coupled in space.
    model MixedPair {
        param J, S: Sym<3>;
        param e: Real;
        group q: SU<2> velocity w;
        group R: SO<3> velocity o;
        constraint next(q) = w*q;
        constraint next(R) = o*R;
        let W = q^T*next(q);
        let O = R^T*next(R);
        lagrangian = (2/h)*dot(im(W), S*im(W)) - tr(J*O)/h + e*dot(rot(q)*vee(rot(W)), R*vee(O))/h;
    }
}

const STEPS: u64 = 2000;

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
fn keeps<M: Stepper, const R: usize, const C: usize>(
    model: &M,
    mut state: M::State,
    mut work: M::Workspace,
    h: f64,
    conserved: impl Fn(&M::State) -> SMatrix<f64, R, C>,
) {
    let start = conserved(&state);
    for _ in 0..STEPS {
        model.advance(&mut state, &mut work).unwrap();
        let off = largest(&(conserved(&state) - start));
        assert!(off <= EXACT * start.norm(), "h = {h:e}: {off:e}");
    }
}

fn tensor() -> Matrix3<f64> {
    Matrix3::new(1.0, 0.1, 0.0, 0.1, 1.5, 0.2, 0.0, 0.2, 2.0)
}

const ARMS: [Vector3<f64>; 2] = [Vector3::new(0.3, 0.1, 0.7), Vector3::new(0.2, -0.5, 0.3)];

const MOMENTA: [Vector3<f64>; 2] = [Vector3::new(0.5, 0.3, 1.0), Vector3::new(-0.4, 0.7, 0.9)];

fn pair_in_space(j: Matrix3<f64>) -> (PairInSpace, PairInSpaceInitial) {
    let model = PairInSpace::new(PairInSpaceParameters { eps: 0.4 }).unwrap();
    let initial = PairInSpaceInitial {
        A: Rotation::identity(),
        B: Rotation::identity(),
        spatial_momentum_A: SpatialMomentum(MOMENTA[0]),
        spatial_momentum_B: SpatialMomentum(MOMENTA[1]),
        J1: j,
        J2: j * 0.7,
        d1: ARMS[0],
        d2: ARMS[1],
    };
    (model, initial)
}

#[test]
fn the_total_momentum_of_a_pair_in_space() {
    for h in SIZES {
        let (model, initial) = pair_in_space(tensor());
        let (state, work) = model.start(initial, h).unwrap();
        let total = |s: &PairInSpaceState| s.spatial_momentum_A().0 + s.spatial_momentum_B().0;
        keeps(&model, state, work, h, total);
    }
}

#[test]
fn the_total_momentum_of_a_pair_stated_by_its_attitudes() {
    for h in SIZES {
        let model = PairUnreduced::new(PairUnreducedParameters {
            J1: tensor(),
            J2: tensor() * 0.7,
            d1: ARMS[0],
            d2: ARMS[1],
            eps: 0.4,
            s: 0.8,
        })
        .unwrap();
        let initial = PairUnreducedInitial {
            A: Rotation::identity(),
            B: Rotation::identity(),
            spatial_momentum_A: SpatialMomentum(MOMENTA[0]),
            spatial_momentum_B: SpatialMomentum(MOMENTA[1]),
        };
        let (state, work) = model.start(initial, h).unwrap();
        let total = |s: &PairUnreducedState| s.spatial_momentum_A().0 + s.spatial_momentum_B().0;
        keeps(&model, state, work, h, total);
    }
}

/// Each body loses exactly the numbers that the other gains, because the axes rotate with both ends of an edge.
#[test]
fn the_total_momentum_of_bodies_of_two_groups() {
    for h in SIZES {
        let model = MixedPair::new(MixedPairParameters {
            J: tensor(),
            S: Matrix3::from_diagonal(&Vector3::new(1.2, 2.3, 3.1)),
            e: 0.2,
        })
        .unwrap();
        let initial = MixedPairInitial {
            q: UnitQuaternion::identity(),
            R: Rotation::identity(),
            spatial_momentum_q: SpatialMomentum(MOMENTA[0]),
            spatial_momentum_R: SpatialMomentum(MOMENTA[1]),
        };
        let (state, work) = model.start(initial, h).unwrap();
        let total = |s: &MixedPairState| s.spatial_momentum_q().0 + s.spatial_momentum_R().0;
        keeps(&model, state, work, h, total);
    }
}

#[test]
fn the_pair_moves_as_it_is_stated_from_its_bodies() {
    let h = 0.05;
    let (model, initial) = pair_in_space(tensor());
    let (mut state, mut work) = model.start(initial, h).unwrap();
    let bodies = PairInBodies::new(PairInBodiesParameters {
        J1: tensor(),
        J2: tensor() * 0.7,
        d1: ARMS[0],
        d2: ARMS[1],
        eps: 0.4,
    })
    .unwrap();
    let initial = PairInBodiesInitial {
        A: Rotation::identity(),
        B: Rotation::identity(),
        body_momentum_A: BodyMomentum(MOMENTA[0]),
        body_momentum_B: BodyMomentum(MOMENTA[1]),
    };
    let (mut other, mut scratch) = bodies.start(initial, h).unwrap();
    for _ in 0..100 {
        model.step(&mut state, &mut work).unwrap();
        bodies.step(&mut other, &mut scratch).unwrap();
    }
    let off = largest(&(state.A().matrix() - other.A().matrix()))
        .max(largest(&(state.B().matrix() - other.B().matrix())))
        .max(largest(
            &(state.spatial_momentum_A().0 - other.spatial_momentum_A().0),
        ));
    // Rounding error of a hundred steps, which the two motions may amplify tenfold over five time units.
    assert!(off < 1e-12, "{off:e}");
}

#[test]
fn the_scheme_in_space_is_of_second_order() {
    let end = |steps: u32| {
        let (model, initial) = pair_in_space(tensor());
        let (mut state, mut work) = model.start(initial, 1.0 / f64::from(steps)).unwrap();
        for _ in 0..steps {
            model.step(&mut state, &mut work).unwrap();
        }
        state.A().matrix()
    };
    let [a, b, c] = [40, 80, 160].map(end);
    let ratio = (a - b).norm() / (b - c).norm();
    assert!((3.8..4.2).contains(&ratio), "{ratio}");
}

#[test]
fn the_angular_momentum_of_an_elastic_body() {
    for h in [1e-1, 1e-2, 1e-3, 1e-4, 1e-6] {
        let model = ElasticInSpace::new(ElasticInSpaceParameters { s: 0.4 }).unwrap();
        let momentum = Matrix3::new(0.1, 0.3, -0.2, 0.5, 0.2, 0.3, 0.1, -0.4, 0.2);
        let initial = ElasticInSpaceInitial {
            Q: Linear::identity(),
            spatial_momentum: SpatialMomentumMatrix(momentum),
            I: tensor(),
            B: Matrix3::identity(),
        };
        let (state, work) = model.start(initial, h).unwrap();
        let turning = |s: &ElasticInSpaceState| {
            let m = s.spatial_momentum().0;
            m - m.transpose()
        };
        keeps(&model, state, work, h, turning);
    }
}

/// A thrown body with this inertia, mass and first moment, and its initial position.
fn thrown(
    j: Vector3<f64>,
    m: f64,
    momentum: [f64; 6],
    at: Vector3<f64>,
) -> (Thrown, ThrownInitial) {
    let parameters = ThrownParameters {
        J: Matrix3::from_diagonal(&j),
        m,
        g: 9.81,
        z: Vector3::z(),
    };
    let motion = RigidMotion {
        rotation: Rotation::identity(),
        translation: at,
    };
    let body = BodyImpulse(SVector::<f64, 6>::from(momentum));
    let initial = ThrownInitial {
        G: motion,
        spatial_momentum: body.to_space(&motion),
    };
    (Thrown::new(parameters).unwrap(), initial)
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
    for (longest, j, m, momentum, at) in bodies {
        let (j, at) = (Vector3::from(j), Vector3::from(at));
        for (h, steps) in [(0.05, longest), (1e-3, STEPS), (1e-6, STEPS), (1e-8, STEPS)] {
            let (model, initial) = thrown(j, m, momentum, at);
            let (mut state, mut work) = model.start(initial, h).unwrap();
            let energy = model.energy(&state);
            let start = state.spatial_momentum().0;
            for k in 1..=steps {
                model.step(&mut state, &mut work).unwrap();
                let p = state.spatial_momentum().0;
                let linear = p.fixed_rows::<3>(3).norm();
                // The momentum about the fixed origin, plus the potential.
                let carried = (1.0 + state.G().translation.norm())
                    * (linear + p.fixed_rows::<3>(0).norm())
                    / m.min(j.min())
                    + m * 9.81 * state.G().translation.norm();
                // Each step adds at most one rounding error, in the worst case always with the same sign.
                let rounding = k as f64 * f64::EPSILON * carried;
                let off = (model.energy(&state) - energy).abs();
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
    for h in SIZES {
        let momentum = Vector3::new(0.5, 0.3, 1.0);
        let model = ConstantInSpace::new(ConstantInSpaceParameters { J: tensor() }).unwrap();
        let initial = ConstantInSpaceInitial {
            A: Rotation::identity(),
            spatial_momentum: SpatialMomentum(momentum),
        };
        let (mut state, mut work) = model.start(initial, h).unwrap();
        let other = CarriedByBody::new(CarriedByBodyParameters {
            scalar: std::marker::PhantomData,
        })
        .unwrap();
        let initial = CarriedByBodyInitial {
            A: Rotation::identity(),
            body_momentum: BodyMomentum(momentum),
            J: tensor(),
        };
        let (mut seen, mut scratch) = other.start(initial, h).unwrap();
        for _ in 0..STEPS {
            model.step(&mut state, &mut work).unwrap();
            other.step(&mut seen, &mut scratch).unwrap();
            for off in
                [state.body_momentum().0, seen.body_momentum().0].map(|m| largest(&(m - momentum)))
            {
                assert!(off <= EXACT * momentum.norm(), "h = {h:e}: {off:e}");
            }
        }
    }
}
