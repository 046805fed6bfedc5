//! Self-adjoint actions, and one-sided variants of them, on every group, stated in the body and in space.

use super::Reversal;
use crate::derive::warnings::Topic;
use crate::pipeline::derive_source;

/// Parameters and group, the kinetic term, and a potential of the configuration `G`; the tests take it at either end.
const GROUPS: [(&str, &str, &str); 6] = [
    (
        "param J: Sym<3>; param z, g: Vec<3>; group G: SO<3> velocity V;",
        "-tr(J*G^T*next(G))/h",
        "dot(z, G*g)",
    ),
    (
        "param J: Sym<4>; param z, g: Vec<4>; group G: SO<4> velocity V;",
        "-tr(J*G^T*next(G))/h",
        "dot(z, G*g)",
    ),
    (
        "param J: Sym<3>; param z, g: Vec<3>; group G: SU<2> velocity V;",
        "-tr(J*rot(G)^T*rot(next(G)))/h",
        "dot(z, rot(G)*g)",
    ),
    (
        "param J: Sym<3>; param z, g: Vec<3>; group G: GL<3> velocity V;",
        "tr((next(G) - G)*J*(next(G) - G)^T)/(2*h)",
        "dot(z, G*g)",
    ),
    (
        "param J: Sym<3>; param z: Vec<3>; param m: Real; group G: SE<3> velocity V;",
        "-tr(J*rot(G)^T*rot(next(G)))/h \
         + m*dot(pos(next(G)) - pos(G), pos(next(G)) - pos(G))/(2*h)",
        "dot(z, pos(G))",
    ),
    (
        // A point of the body away from its origin.
        "param J: Sym<3>; param a, z: Vec<3>; group G: SE<3> velocity V;",
        "-tr(J*rot(G)^T*rot(next(G)))/h + dot(pos(next(G)) + rot(next(G))*a - pos(G) - rot(G)*a, \
         pos(next(G)) + rot(next(G))*a - pos(G) - rot(G)*a)/(2*h)",
        "dot(z, pos(G) + rot(G)*a)",
    ),
];

/// Whether the step is symmetric, and whether clebsch warns that it is of first order.
fn found(model: &str) -> (bool, bool) {
    match derive_source(model) {
        Ok(d) => {
            assert_eq!(d.reversible, d.reversal.is_symmetric());
            let mut topics = d.warnings.iter().map(|w| w.topic);
            (d.reversible, topics.any(|t| t == Topic::FirstOrder))
        }
        Err(e) => panic!("{model}\n{e}"),
    }
}

#[test]
fn every_group_on_either_side() {
    for (declared, kinetic, potential) in GROUPS {
        let at_end = potential.replace('G', "next(G)");
        for update in ["G*V", "V*G"] {
            let model = |lagrangian: &str| {
                format!(
                    "model M {{ {declared} constraint next(G) = {update}; lagrangian = {lagrangian}; }}"
                )
            };
            let alike = model(&format!("{kinetic} - h*{potential}"));
            assert_eq!(found(&alike), (true, false), "{alike}");
            let both = model(&format!("{kinetic} - h*({potential})*({at_end})"));
            assert_eq!(found(&both), (true, false), "{both}");
            let sided = model(&format!("{kinetic} - h*({potential})*({at_end})^2"));
            assert_eq!(found(&sided), (false, true), "{sided}");
            let even = model(&format!(
                "{kinetic} - h*{potential} - h^2*({potential})*({at_end})"
            ));
            assert_eq!(found(&even), (false, true), "{even}");
            let difference = model(&format!("{kinetic} - h*({potential}) + h*({at_end}) "));
            assert!(!found(&difference).1, "{difference}");
        }
    }
}

#[test]
fn bodies_on_both_sides() {
    let bodies = |coupling: &str| {
        format!(
            "model M {{ param J, K: Sym<3>; param m, s: Real; param z: Vec<3>;
                group A: SE<3> velocity V; group B: SU<2> velocity W;
                constraint next(A) = V*A; constraint next(B) = B*W;
                lagrangian = -tr(J*rot(A)^T*rot(next(A)))/h - tr(K*rot(B)^T*rot(next(B)))/h
                    + m*dot(pos(next(A)) - pos(A), pos(next(A)) - pos(A))/(2*h) - {coupling}; }}"
        )
    };
    let alike = bodies("h*s*dot(pos(A), z)*dot(z, rot(B)*E1)");
    assert_eq!(found(&alike), (true, false), "{alike}");
    let sided = bodies("h*s*dot(pos(A), z)^2*dot(z, rot(next(B))*E1)");
    assert_eq!(found(&sided), (false, true), "{sided}");
}

#[test]
fn a_carried_point_has_a_weight_by_its_definition_only() {
    // Without a definition, `p` is initial data, and its last component may differ from that of `b`.
    let point = |declared: &str| {
        format!(
            "model M {{ param J: Sym<3>; param b: Vec<4>; param c: Vec<4>; group G: SE<3> velocity V;
                advected p: Vec<4>{declared}; constraint next(G) = G*V; constraint next(p) = V^-1*p;
                lagrangian = -tr(J*rot(V))/h + dot(pos(V), pos(V))/(2*h)
                    - h*dot(c, p)*dot(c, next(p))*(1 + dot(c, next(p))*(p[4] - b[4])); }}"
        )
    };
    assert!(!found(&point("")).0);
    assert!(found(&point(" = G^-1*b")).0);
    let of = |text: &str| derive_source(text).map(|d| d.reversal);
    assert!(matches!(of(&point("")), Ok(Reversal::Broken(_))));
}
