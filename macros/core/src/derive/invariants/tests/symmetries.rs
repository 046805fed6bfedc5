//! Symmetries that move several configurations together, from space and in the bodies, and symmetries that change the
//! action by a total difference. Each test has a statement that breaks the symmetry.

use super::{Family, derive};

/// Names of the Noether momenta.
fn momenta(text: &str) -> Vec<String> {
    let d = derive(text);
    let own = d.invariants.iter().filter(|v| v.family == Family::Noether);
    own.map(|v| v.name.clone()).collect()
}

/// Compares the momenta of a statement with `whole`, and with `left` after `word` is replaced by `broken`.
fn compare(text: &str, word: &str, broken: &str, whole: &[&str], left: &[&str]) {
    assert!(text.contains(word));
    assert_eq!(momenta(text), whole, "{text}");
    let text = text.replacen(word, broken, 1);
    assert_eq!(momenta(&text), left, "{text}");
}

#[test]
fn quaternions_and_rotations_share_the_vertical() {
    compare(
        "model Pair {
            param I, J: Sym<3>; param a, b, y, z, d, e: Vec<3>; param w: Real;
            group q: SU<2> velocity W; group Λ: SO<3> velocity Ω;
            constraint next(q) = q*W; constraint next(Λ) = Λ*Ω;
            lagrangian = (2/h)*dot(im(W), I*im(W)) - tr(J*Ω)/h
                - h*dot(a, rot(q)^T*z) - h*dot(b, Λ^T*z) - h*w*dot(rot(q)*d, Λ*e);
        }",
        "Λ^T*z",
        "Λ^T*y",
        &["total_momentum_z"],
        &[],
    );
}

/// A rigid motion in gravity and a rotation, coupled by two axes, with further terms.
fn motion_and_rotation(more: &str) -> String {
    format!(
        "model Pair {{
            param J, K: Sym<3>; param m, g, k: Real; param a, d, y, z: Vec<3>;
            group G: SE<3> velocity V; group Λ: SO<3> velocity Ω;
            constraint next(G) = G*V; constraint next(Λ) = Λ*Ω;
            let x = pos(next(G)) - pos(G);
            lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(x, x)/(2*h) - tr(K*Ω)/h
                - h*m*g*dot(z, pos(G)) - h*k*dot(rot(G)*a, Λ*d){more};
        }}"
    )
}

#[test]
fn rigid_motions_and_rotations_share_the_vertical() {
    // A rotation about its own origin does not change the height of the body, so the sum of both spins is conserved.
    compare(
        &motion_and_rotation(" - h*k*dot(z, pos(G) + rot(G)*d) - h*k*dot(z, Λ*a)"),
        "dot(z, Λ*a)",
        "dot(y, Λ*a)",
        &[
            "spatial_momentum_G_linear_across_z",
            "total_momentum_angular_z",
            "joint_momentum_G_angular_z",
        ],
        &[
            "spatial_momentum_G_linear_across_z",
            "joint_momentum_G_angular_z",
        ],
    );
    assert_eq!(
        momenta(&motion_and_rotation("")),
        [
            "spatial_momentum_G_linear_across_z",
            "total_momentum_angular_z",
            "joint_momentum_angular"
        ]
    );
}

#[test]
fn quaternions_and_rigid_motions_on_a_spring() {
    compare(
        "model Pair {
            param I, J: Sym<3>; param m, g, k: Real; param a, d, y, z: Vec<3>;
            group q: SU<2> velocity W; group G: SE<3> velocity V;
            constraint next(q) = q*W; constraint next(G) = G*V;
            let x = pos(next(G)) - pos(G);
            let s = pos(G) + rot(G)*a - rot(q)*d;
            lagrangian = (2/h)*dot(im(W), I*im(W)) - tr(J*rot(G)^T*rot(next(G)))/h + m*dot(x, x)/(2*h)
                - h*m*g*dot(z, pos(G)) - h*k*dot(z, rot(q)*a) - h*k/2*dot(s, s);
        }",
        "dot(z, rot(q)*a)",
        "dot(y, rot(q)*a)",
        &["total_momentum_angular_z"],
        &[],
    );
}

#[test]
fn affine_bodies_and_rotations_share_the_vertical() {
    compare(
        "model Pair {
            param I0, J: Sym<3>; param a, b, y, z: Vec<3>; param k: Real;
            group Q: GL<3> velocity G; group Λ: SO<3> velocity Ω;
            constraint next(Q) = Q*G; constraint next(Λ) = Λ*Ω;
            let D = next(Q) - Q;
            lagrangian = tr(D*I0*D^T)/(2*h) - tr(J*Ω)/h - h*k*dot(Q*a, Λ*b) - h*dot(z, Q*b) - h*dot(z, Λ*a);
        }",
        "dot(z, Λ*a)",
        "dot(y, Λ*a)",
        &["total_momentum_angular_z"],
        &[],
    );
}

#[test]
fn isotropic_bodies_keep_the_sum_of_their_body_momenta() {
    compare(
        "model Pair {
            param c, d: Real; param J: Sym<3>; param A: Mat<3>;
            group P: SO<3> velocity U; group Q: SO<3> velocity V;
            constraint next(P) = P*U; constraint next(Q) = Q*V;
            lagrangian = -(c*tr(U) + d*tr(V))/h - h*tr(A*P*Q^T);
        }",
        "d*tr(V)",
        "tr(J*V)",
        &["total_body_momentum"],
        &[],
    );
    compare(
        "model Three {
            param b, c, d: Real; param J: Sym<3>; param A, B: Mat<3>;
            group P: SO<3> velocity U; group Q: SO<3> velocity V; group R: SO<3> velocity W;
            constraint next(P) = P*U; constraint next(Q) = Q*V; constraint next(R) = R*W;
            lagrangian = -(b*tr(U) + c*tr(V) + d*tr(W))/h - h*tr(A*P*Q^T) - h*tr(B*Q*R^T);
        }",
        "d*tr(W)",
        "tr(J*W)",
        &["total_body_momentum"],
        &[],
    );
    // The same for a body and a quaternion, one of them stated in space.
    compare(
        "model Mixed {
            param c, d: Real; param J: Sym<3>; param A: Mat<3>;
            group q: SU<2> velocity W; group Λ: SO<3> velocity ω;
            constraint next(q) = q*W; constraint next(Λ) = ω*Λ;
            lagrangian = -4*c*re(W)/h - d*tr(ω)/h - h*tr(A*rot(q)*Λ^T);
        }",
        "-4*c*re(W)/h",
        "(2/h)*dot(im(W), J*im(W))",
        &["total_body_momentum"],
        &[],
    );
}

#[test]
fn what_moves_space_and_body_is_told_as_joint() {
    let d = derive(
        "model Angle {
            param c, k: Real; group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω;
            lagrangian = -c*tr(Ω)/h + h*k*tr(Λ);
        }",
    );
    let v = d.invariants.iter().find(|v| v.name == "joint_momentum");
    let reason = v.map_or("", |v| &v.reason);
    assert!(
        reason.ends_with("joint motions of space and bodies"),
        "{reason}"
    );
}

#[test]
fn space_and_body_turn_together() {
    // A potential that depends on the angle of a rotation only.
    compare(
        "model Angle {
            param c, k: Real; param K: Sym<3>;
            group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω;
            lagrangian = -c*tr(Ω)/h + h*k*tr(Λ);
        }",
        "k*tr(Λ)",
        "tr(K*Λ)",
        &["joint_momentum"],
        &[],
    );
    // The body frame of the first is the space frame of the second.
    compare(
        "model Chain {
            param c, k: Real; param J: Sym<3>; param A: Mat<3>;
            group P: SO<3> velocity U; group Q: SO<3> velocity V;
            constraint next(P) = P*U; constraint next(Q) = Q*V;
            lagrangian = -(c*tr(U) + tr(J*V))/h - h*tr(A*P*Q);
        }",
        "c*tr(U)",
        "tr(J*U)",
        &["joint_momentum"],
        &[],
    );
    // About an axis of space in one, and an axis of the body in the other.
    compare(
        "model Axes {
            param J: Sym<3>; param k: Real; param z: Vec<3>; param a: Vec<3>;
            assume J*hat(E3) == hat(E3)*J;
            group P: SO<3> velocity U; constraint next(P) = P*U;
            lagrangian = -tr(J*U)/h - h*k*tr(P) - h*k*dot(P*E3, E3);
        }",
        "tr(P)",
        "dot(P*E1, E1)",
        &["joint_momentum_E3"],
        &[],
    );
    // Wheels, one of which rotates twice as fast.
    compare(
        "model Gear {
            param a, b: Real; param K: Sym<2>;
            group P: SO<2> velocity U; group Q: SO<2> velocity V;
            constraint next(P) = P*U; constraint next(Q) = Q*V;
            lagrangian = -(a*tr(U) + b*tr(V))/h - h*tr(K*P*P*Q^T);
        }",
        "P*P*Q^T",
        "P*P",
        &["joint_momentum"],
        &["spatial_momentum_Q"],
    );
}

#[test]
fn symmetries_up_to_a_total_difference() {
    // A charge in a uniform field, with the potential that is symmetric about the origin.
    let charge = "model Charge {
            param J: Sym<3>; param m: Real; param B, a: Vec<3>;
            group G: SE<3> velocity V; constraint next(G) = G*V;
            let x = pos(next(G)) - pos(G);
            lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(x, x)/(2*h)
                + dot(B, cross(pos(G), pos(next(G))))/2;
        }";
    compare(
        charge,
        "/2;",
        "/2 - h*dot(rot(G)*a, pos(G));",
        &["spatial_momentum_linear", "spin"],
        &[],
    );
    let d = derive(charge);
    let v = d
        .invariants
        .iter()
        .find(|v| v.name == "spatial_momentum_linear");
    assert!(v.is_some_and(|v| v.reason.contains("total difference")));
    // With a potential that is not symmetric, in uniform gravity: translations across the vertical remain.
    compare(
        "model Landau {
            param J: Sym<3>; param m, f: Real; param a, u, v, z: Vec<3>;
            group G: SE<3> velocity V; constraint next(G) = G*V;
            let x = pos(next(G)) - pos(G);
            let middle = (pos(next(G)) + pos(G))/2;
            lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(x, x)/(2*h)
                + m*f*dot(u, middle)*dot(v, x) - h*dot(z, pos(G) + rot(G)*a);
        }",
        "dot(z, pos(G) + rot(G)*a)",
        "dot(pos(G), pos(G) + rot(G)*a)",
        &["spatial_momentum_linear_across_z", "spin_z"],
        &[],
    );
}

#[test]
fn cyclic_coordinates() {
    // A body in uniform gravity rotates freely about its centre of mass.
    compare(
        "model Thrown {
            param J: Sym<3>; param m, g: Real; param a, z: Vec<3>;
            group G: SE<3> velocity V; constraint next(G) = G*V;
            let x = pos(next(G)) - pos(G);
            lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(x, x)/(2*h) - h*m*g*dot(z, pos(G));
        }",
        "dot(z, pos(G))",
        "dot(z, pos(G) + rot(G)*a)",
        &[
            "spatial_momentum_linear_across_z",
            "spatial_momentum_angular_z",
            "spin",
        ],
        &[
            "spatial_momentum_linear_across_z",
            "spatial_momentum_angular_z",
            "spin_z",
        ],
    );
    // Entries of a matrix that the potential does not contain.
    compare(
        "model Affine {
            param I0: Sym<3>; param a, b: Vec<3>;
            group Q: GL<3> velocity G; constraint next(Q) = Q*G;
            let D = next(Q) - Q;
            lagrangian = tr(D*I0*D^T)/(2*h) - h*dot(a, Q*b)^2;
        }",
        "dot(a, Q*b)^2",
        "dot(Q*b, Q*b)",
        &[
            "spatial_momentum_angular_a",
            "coordinate_momentum_columns_across_a",
            "coordinate_momentum_rows_across_b",
        ],
        &[
            "spatial_momentum_skew_identity",
            "coordinate_momentum_rows_across_b",
        ],
    );
    // The whole matrix of a free map.
    assert_eq!(
        momenta(
            "model Free {
                param I0: Sym<3>; group Q: GL<3> velocity G; constraint next(Q) = Q*G;
                let D = next(Q) - Q; lagrangian = tr(D*I0*D^T)/(2*h);
            }"
        ),
        [
            "spatial_momentum_skew_identity",
            "momentum_skew_I0_inverse_right",
            "coordinate_momentum"
        ]
    );
    // A rotor that spins about its axis, mounted on another body.
    compare(
        "model Rotor {
            param J, K: Sym<3>; param w: Real; param b, y, z: Vec<3>;
            assume K*hat(E3) == hat(E3)*K;
            group A: SO<3> velocity U; group B: SO<3> velocity V;
            constraint next(A) = A*U; constraint next(B) = B*V;
            lagrangian = -(tr(J*U) + tr(K*V))/h - h*w*dot(A*b, B*E3) - h*dot(z, A*b);
        }",
        "B*E3",
        "B*E1",
        &["total_momentum_z", "momentum_B_E3"],
        &["total_momentum_z"],
    );
}

#[test]
fn about_a_place_that_a_parameter_is() {
    compare(
        "model Held {
            param J: Sym<3>; param m, s: Real; param o, p, a: Vec<3>;
            group G: SE<3> velocity V; constraint next(G) = G*V;
            let x = pos(next(G)) - pos(G);
            let y = pos(G) + rot(G)*a - o;
            let w = pos(G) - o;
            lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(x, x)/(2*h) - h*s/2*dot(y, y) - h*s*dot(w, w);
        }",
        "let w = pos(G) - o",
        "let w = pos(G) - p",
        &["spatial_momentum_angular_about_o"],
        // Rotations about the line through both points.
        &["joint_momentum_linear_across_o_p_angular_o_p"],
    );
}

#[test]
fn wide_bodies_share_an_axis() {
    // Rotations in several planes in two bodies, with one fixed axis.
    compare(
        "model Wide {
            param C, D: Sym<4>; param z, a: Vec<4>;
            group P: SO<4> velocity U; group Q: SO<4> velocity V;
            constraint next(P) = P*U; constraint next(Q) = Q*V;
            lagrangian = -(tr(C*U) + tr(D*V))/h - h*dot(z, P*a) - h*dot(z, Q*a) - h*dot(P*a, Q*a);
        }",
        "dot(z, Q*a)",
        "tr(D*Q)",
        &["total_momentum_z"],
        &[],
    );
}

#[test]
fn a_fall_in_the_plane_keeps_the_momentum_across_the_vertical() {
    let names = momenta(
        "model Fall { param m: Real; param g: Vec<2>; field X: Vec<2>;
         lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + h*m*dot(g, X); }",
    );
    assert_eq!(names, ["momentum_across_g"]);
}
