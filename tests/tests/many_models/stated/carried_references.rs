//! Advected quantities without a definition, started from attitudes other than the identity. The state stores their value pulled
//! back to the identity, and computes body values from it. Covers vectors, symmetric tensors, directions in the frames of moving
//! bodies, and relative orientations of two bodies, against the same models with definitions.

use super::text_model::{Given, Motion, TextModel, given};
use clebsch::nalgebra::{Matrix3, Matrix4, Vector3, Vector4};
use clebsch::{RigidMotion, Rotation};
use clebsch_oracle::physics::measure::worse;

/// A body in a uniform field and in a field with a gradient, both given in space.
const FIELDS_DEFINED: &str = "model FieldsDefined {
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
}";

/// The same fields, given in the body frame at node 0.
const FIELDS_GIVEN: &str = "model FieldsGiven {
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
}";

/// Two bodies with a coupling towards a common orientation, relative to either body.
const PAIR_DEFINED: &str = "model PairDefined {
    param J1, J2: Sym<3>;
    param C: Mat<3>;
    group A: SO<3> velocity U;
    group B: SO<3> velocity W;
    advected R: Mat<3> = A^T*B;
    constraint next(A) = A*U;
    constraint next(B) = B*W;
    constraint next(R) = U^T*R*W;
    lagrangian = -tr(J1*U)/h - tr(J2*W)/h - h*tr(C*R);
}";

/// The same, with the initial orientation of one body relative to the other.
const PAIR_GIVEN: &str = "model PairGiven {
    param J1, J2: Sym<3>;
    param C: Mat<3>;
    group A: SO<3> velocity U;
    group B: SO<3> velocity W;
    advected R: Mat<3>;
    constraint next(A) = A*U;
    constraint next(B) = B*W;
    constraint next(R) = U^T*R*W;
    lagrangian = -tr(J1*U)/h - tr(J2*W)/h - h*tr(C*R);
}";

/// A body with weight in a fluid at rest, with the plane of height 0 given in space.
const SINKING_DEFINED: &str = "model SinkingDefined {
    param J, M: Sym<3>;
    param b, Z: Vec<4>;
    group G: SE<3> velocity V;
    advected P: Vec<4> = G^T*Z;
    constraint next(G) = G*V;
    constraint next(P) = V^T*P;
    let u = (pos(V) - pos(V^-1))/2;
    lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h) - h*dot(b, P);
}";

/// The same, with the plane given in the body frame at node 0.
const SINKING_GIVEN: &str = "model SinkingGiven {
    param J, M: Sym<3>;
    param b: Vec<4>;
    group G: SE<3> velocity V;
    advected P: Vec<4>;
    constraint next(G) = G*V;
    constraint next(P) = V^T*P;
    let u = (pos(V) - pos(V^-1))/2;
    lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h) - h*dot(b, P);
}";

const H: f64 = 0.05;
const STEPS: usize = 100;

/// Rounding error of a value of order one that is pulled back and pushed forward, amplified by a hundred steps of a motion that is
/// not yet chaotic.
const ROUNDING: f64 = 1e-12;

/// Rounding error of a single pull-back and push-forward.
const ONCE: f64 = 1e-15 * 8.0;

/// The largest difference of the values of these names.
fn apart(one: &Motion, two: &Motion, names: &[&str]) -> f64 {
    let pairs = names
        .iter()
        .flat_map(|name| one.numbers(name).into_iter().zip(two.numbers(name)));
    pairs.fold(0.0, |m, (x, y)| worse(m, (x - y).abs()))
}

/// Runs a model with definitions beside the same model without; `also` is another deviation of the second motion.
fn agree(
    [defined, carried]: [&str; 2],
    [one, two]: [&Given; 2],
    names: &[&str],
    also: impl Fn(&Motion) -> f64,
) {
    let mut one = TextModel::read(defined).start(H, one).unwrap();
    let start = two;
    let mut two = TextModel::read(carried).start(H, two).unwrap();
    // The accessor returns the initial value.
    for (name, value) in start {
        if names.contains(&name.as_str()) {
            let pairs = two.numbers(name).into_iter().zip(value);
            let off = pairs.fold(0.0, |m, (x, y)| worse(m, (x - y).abs()));
            assert!(off < ONCE, "{name}: {off:e}");
        }
    }
    for node in 1..=STEPS {
        one.steps(1);
        two.steps(1);
        let worst = worse(apart(&one, &two, names), also(&two));
        assert!(worst < ROUNDING, "node {node}: {worst:e}");
    }
}

fn poinsot() -> Matrix3<f64> {
    Matrix3::new(0.9, 0.1, -0.05, 0.1, 1.2, 0.15, -0.05, 0.15, 0.7)
}

fn attitudes() -> [Rotation; 3] {
    [[0.3, -0.2, 0.5], [-1.1, 0.4, 0.8], [0.2, 2.3, -0.6]].map(|v| Rotation::exp(&v.into()))
}

/// Both lists.
fn with(one: &Given, other: Given) -> Given {
    [one.clone(), other].concat()
}

#[test]
fn fields_seen_from_the_body() {
    let z = Vector3::new(0.0, 0.6, 0.8);
    let field = Matrix3::new(0.4, 0.1, 0.2, 0.1, -0.3, 0.05, 0.2, 0.05, 0.7);
    for attitude in attitudes() {
        let r = attitude.matrix();
        let common = given! {
            J: poinsot(), K: Matrix3::new(0.2, 0.0, 0.1, 0.0, 0.5, 0.0, 0.1, 0.0, 0.3),
            g: [0.1, -0.2, 0.6], Λ: attitude, body_momentum: [0.2, -0.4, 0.9],
        };
        let seen = r.tr_mul(&field) * r;
        // Exactly symmetric.
        let seen = (seen + seen.transpose()) / 2.0;
        agree(
            [FIELDS_DEFINED, FIELDS_GIVEN],
            [
                &with(&common, given! { z: z, F: field }),
                &with(&common, given! { Γ: r.tr_mul(&z), S: seen }),
            ],
            &["Λ", "body_momentum", "Γ", "S"],
            // Constant in space.
            |two| {
                (two.matrix::<3, 3>("Λ") * two.vector::<3>("Γ") - z)
                    .iter()
                    .fold(0.0, |m, x| worse(m, x.abs()))
            },
        );
    }
}

#[test]
fn orientations_of_two_bodies() {
    let [first, second, third] = attitudes();
    for (a, b) in [(first, second), (second, third), (third, third)] {
        let defined = given! {
            J1: poinsot(), J2: Matrix3::from_diagonal(&Vector3::new(1.1, 0.8, 0.9)),
            C: Matrix3::new(0.3, 0.1, 0.0, -0.2, 0.4, 0.1, 0.05, 0.0, 0.2),
            A: a, body_momentum_A: [0.2, -0.4, 0.9], B: b, body_momentum_B: [-0.6, 0.1, 0.3],
        };
        let carried = with(&defined, given! { R: a.matrix().tr_mul(&b.matrix()) });
        agree(
            [PAIR_DEFINED, PAIR_GIVEN],
            [&defined, &carried],
            &["A", "B", "R"],
            |_| 0.0,
        );
    }
}

#[test]
fn a_plane_seen_from_a_moving_body() {
    let plane = Vector4::new(0.0, 0.6, 0.8, 0.4);
    for attitude in attitudes() {
        let mut matrix = Matrix4::identity();
        matrix
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&attitude.matrix());
        matrix[(0, 3)] = 0.5;
        matrix[(2, 3)] = -0.25;
        let motion = RigidMotion::from_matrix(&matrix).unwrap();
        let common = given! {
            J: poinsot(), M: Matrix3::from_diagonal(&Vector3::new(1.5, 2.0, 3.0)), b: [0.1, 0.0, -0.2, 0.3],
            G: motion, body_momentum: [0.2, -0.1, 0.4, 0.3, 0.2, -0.2],
        };
        agree(
            [SINKING_DEFINED, SINKING_GIVEN],
            [
                &with(&common, given! { Z: plane }),
                &with(&common, given! { P: motion.matrix().tr_mul(&plane) }),
            ],
            &["G", "P"],
            |_| 0.0,
        );
    }
}
