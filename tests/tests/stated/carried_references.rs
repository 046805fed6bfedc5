//! Advected quantities without a definition, started from attitudes other than the identity. The state stores their value pulled
//! back to the identity, and computes body values from it. Covers vectors, symmetric tensors, directions in the frames of moving
//! bodies, and relative orientations of two bodies, against the same models with definitions.

use clebsch::nalgebra::{Matrix3, Matrix4, Vector3, Vector4, Vector6};
use clebsch::{BodyImpulse, BodyMomentum, RigidMotion, Rotation};
use clebsch_oracle::physics::measure::worse;

clebsch::model! {
    /// A body in a uniform field and in a field with a gradient, both given in space.
    model FieldsDefined {
        param J: Sym<3>;
        param K: Sym<3>;
        param g: Vec<3>;
        param z: Vec<3>;
        param F: Sym<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        advected S: Sym<3> = Λ^T*F*Λ;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        constraint next(S) = Ω^T*S*Ω;
        lagrangian = -tr(J*Ω)/h - h*dot(g, Γ) - h*tr(K*S);
    }
}

clebsch::model! {
    /// The same fields, given in the body frame at node 0.
    model FieldsGiven {
        param J: Sym<3>;
        param K: Sym<3>;
        param g: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3>;
        advected S: Sym<3>;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        constraint next(S) = Ω^T*S*Ω;
        lagrangian = -tr(J*Ω)/h - h*dot(g, Γ) - h*tr(K*S);
    }
}

clebsch::model! {
    /// Two bodies with a coupling towards a common orientation, relative to either body.
    model PairDefined {
        param J1, J2: Sym<3>;
        param C: Mat<3>;
        group A: SO<3> velocity U;
        group B: SO<3> velocity W;
        advected R: Mat<3> = A^T*B;
        constraint next(A) = A*U;
        constraint next(B) = B*W;
        constraint next(R) = U^T*R*W;
        lagrangian = -tr(J1*U)/h - tr(J2*W)/h - h*tr(C*R);
    }
}

clebsch::model! {
    /// The same, with the initial orientation of one body relative to the other.
    model PairGiven {
        param J1, J2: Sym<3>;
        param C: Mat<3>;
        group A: SO<3> velocity U;
        group B: SO<3> velocity W;
        advected R: Mat<3>;
        constraint next(A) = A*U;
        constraint next(B) = B*W;
        constraint next(R) = U^T*R*W;
        lagrangian = -tr(J1*U)/h - tr(J2*W)/h - h*tr(C*R);
    }
}

clebsch::model! {
    /// A body with weight in a fluid at rest, with the plane of height 0 given in space.
    model SinkingDefined {
        param J, M: Sym<3>;
        param b, Z: Vec<4>;
        group G: SE<3> velocity V;
        advected P: Vec<4> = G^T*Z;
        constraint next(G) = G*V;
        constraint next(P) = V^T*P;
        let u = (pos(V) - pos(V^-1))/2;
        lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h) - h*dot(b, P);
    }
}

clebsch::model! {
    /// The same, with the plane given in the body frame at node 0.
    model SinkingGiven {
        param J, M: Sym<3>;
        param b: Vec<4>;
        group G: SE<3> velocity V;
        advected P: Vec<4>;
        constraint next(G) = G*V;
        constraint next(P) = V^T*P;
        let u = (pos(V) - pos(V^-1))/2;
        lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h) - h*dot(b, P);
    }
}

const H: f64 = 0.05;
const STEPS: usize = 100;

/// Rounding error of a value of order one that is pulled back and pushed forward, amplified by a hundred steps of a motion that is
/// not yet chaotic.
const ROUNDING: f64 = 1e-12;

/// Rounding error of a single pull-back and push-forward.
const ONCE: f64 = 1e-15 * 8.0;

fn largest<'a>(difference: impl IntoIterator<Item = &'a f64>) -> f64 {
    difference.into_iter().fold(0.0, |m, x| worse(m, x.abs()))
}

fn poinsot() -> Matrix3<f64> {
    Matrix3::new(0.9, 0.1, -0.05, 0.1, 1.2, 0.15, -0.05, 0.15, 0.7)
}

fn attitudes() -> [Rotation; 3] {
    [[0.3, -0.2, 0.5], [-1.1, 0.4, 0.8], [0.2, 2.3, -0.6]].map(|v| Rotation::exp(&v.into()))
}

#[test]
fn fields_seen_from_the_body() {
    let (g, z) = (Vector3::new(0.1, -0.2, 0.6), Vector3::new(0.0, 0.6, 0.8));
    let field = Matrix3::new(0.4, 0.1, 0.2, 0.1, -0.3, 0.05, 0.2, 0.05, 0.7);
    let k = Matrix3::new(0.2, 0.0, 0.1, 0.0, 0.5, 0.0, 0.1, 0.0, 0.3);
    let told = FieldsDefined::new(FieldsDefinedParameters {
        J: poinsot(),
        K: k,
        g,
        z,
        F: field,
    })
    .unwrap();
    let given = FieldsGiven::new(FieldsGivenParameters {
        J: poinsot(),
        K: k,
        g,
    })
    .unwrap();
    for attitude in attitudes() {
        let r = attitude.matrix();
        let momentum = BodyMomentum(Vector3::new(0.2, -0.4, 0.9));
        let initial = FieldsDefinedInitial {
            Λ: attitude,
            body_momentum: momentum,
        };
        let (mut one, mut work_one) = told.start(initial, H).unwrap();
        let seen = r.tr_mul(&field) * r;
        let initial = FieldsGivenInitial {
            Λ: attitude,
            body_momentum: momentum,
            Γ: r.tr_mul(&z),
            // Exactly symmetric.
            S: (seen + seen.transpose()) / 2.0,
        };
        let (mut two, mut work_two) = given.start(initial, H).unwrap();
        // The accessor returns the initial value.
        assert!(largest(&(given.Γ(&two) - initial.Γ)) < ONCE);
        assert!(largest(&(given.S(&two) - initial.S)) < ONCE);
        for node in 1..=STEPS {
            told.step(&mut one, &mut work_one).unwrap();
            given.step(&mut two, &mut work_two).unwrap();
            let apart = [
                largest(&(one.Λ().matrix() - two.Λ().matrix())),
                largest(&(one.body_momentum().0 - two.body_momentum().0)),
                largest(&(told.Γ(&one) - given.Γ(&two))),
                largest(&(told.S(&one) - given.S(&two))),
                // Constant in space.
                largest(&(two.Λ().matrix() * given.Γ(&two) - z)),
            ];
            let worst = apart.into_iter().fold(0.0, worse);
            assert!(worst < ROUNDING, "node {node}: {apart:?}");
        }
    }
}

#[test]
fn orientations_of_two_bodies() {
    let [first, second, third] = attitudes();
    let c = Matrix3::new(0.3, 0.1, 0.0, -0.2, 0.4, 0.1, 0.05, 0.0, 0.2);
    let other = Matrix3::from_diagonal(&Vector3::new(1.1, 0.8, 0.9));
    let told = PairDefined::new(PairDefinedParameters {
        J1: poinsot(),
        J2: other,
        C: c,
    })
    .unwrap();
    let given = PairGiven::new(PairGivenParameters {
        J1: poinsot(),
        J2: other,
        C: c,
    })
    .unwrap();
    for (a, b) in [(first, second), (second, third), (third, third)] {
        let momenta = [
            BodyMomentum(Vector3::new(0.2, -0.4, 0.9)),
            BodyMomentum(Vector3::new(-0.6, 0.1, 0.3)),
        ];
        let initial = PairDefinedInitial {
            A: a,
            body_momentum_A: momenta[0],
            B: b,
            body_momentum_B: momenta[1],
        };
        let (mut one, mut work_one) = told.start(initial, H).unwrap();
        let initial = PairGivenInitial {
            A: a,
            body_momentum_A: momenta[0],
            B: b,
            body_momentum_B: momenta[1],
            R: a.matrix().tr_mul(&b.matrix()),
        };
        let (mut two, mut work_two) = given.start(initial, H).unwrap();
        assert!(largest(&(given.R(&two) - initial.R)) < ONCE);
        for node in 1..=STEPS {
            told.step(&mut one, &mut work_one).unwrap();
            given.step(&mut two, &mut work_two).unwrap();
            let apart = [
                largest(&(one.A().matrix() - two.A().matrix())),
                largest(&(one.B().matrix() - two.B().matrix())),
                largest(&(told.R(&one) - given.R(&two))),
            ];
            let worst = apart.into_iter().fold(0.0, worse);
            assert!(worst < ROUNDING, "node {node}: {apart:?}");
        }
    }
}

#[test]
fn a_plane_seen_from_a_moving_body() {
    let (b, plane) = (
        Vector4::new(0.1, 0.0, -0.2, 0.3),
        Vector4::new(0.0, 0.6, 0.8, 0.4),
    );
    let added = Matrix3::from_diagonal(&Vector3::new(1.5, 2.0, 3.0));
    let told = SinkingDefined::new(SinkingDefinedParameters {
        J: poinsot(),
        M: added,
        b,
        Z: plane,
    })
    .unwrap();
    let given = SinkingGiven::new(SinkingGivenParameters {
        J: poinsot(),
        M: added,
        b,
    })
    .unwrap();
    for attitude in attitudes() {
        let mut matrix = Matrix4::identity();
        matrix
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&attitude.matrix());
        matrix[(0, 3)] = 0.5;
        matrix[(2, 3)] = -0.25;
        let motion = RigidMotion::from_matrix(&matrix).unwrap();
        let impulse = BodyImpulse(Vector6::new(0.2, -0.1, 0.4, 0.3, 0.2, -0.2));
        let initial = SinkingDefinedInitial {
            G: motion,
            body_momentum: impulse,
        };
        let (mut one, mut work_one) = told.start(initial, H).unwrap();
        let initial = SinkingGivenInitial {
            G: motion,
            body_momentum: impulse,
            P: motion.matrix().tr_mul(&plane),
        };
        let (mut two, mut work_two) = given.start(initial, H).unwrap();
        assert!(largest(&(given.P(&two) - initial.P)) < ONCE);
        for node in 1..=STEPS {
            told.step(&mut one, &mut work_one).unwrap();
            given.step(&mut two, &mut work_two).unwrap();
            let apart = [
                largest(&(one.G().matrix() - two.G().matrix())),
                largest(&(told.P(&one) - given.P(&two))),
            ];
            let worst = apart.into_iter().fold(0.0, worse);
            assert!(worst < ROUNDING, "node {node}: {apart:?}");
        }
    }
}
