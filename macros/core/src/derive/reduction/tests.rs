//! Quantities that the reduction finds, and configurations that remain. Takes unreduced statements; compares
//! definitions, constraints and the remaining letters.

use crate::derive::Derivation;
use crate::expr;
use crate::pipeline::derive_source;
use crate::print::{Format, Style, expression};

fn derive(text: &str) -> Derivation {
    derive_source(text).unwrap_or_else(|e| panic!("{e}"))
}

/// Names and constraints of the quantities found.
fn found(d: &Derivation) -> Vec<String> {
    let s = &d.letters.symbols;
    let show = |e| expression(e, s, &Style::new("k"), Format::Text);
    let list = d.spec.advected.iter().filter(|a| a.found);
    list.map(|a| {
        let definition = a.definition.as_ref().map(show).unwrap_or_default();
        let name = &s.get(a.quantity).name;
        format!("{name} = {definition}; {}", show(&a.update))
    })
    .collect()
}

fn top(side: &str, terms: &str) -> String {
    format!(
        "model Top {{
            param J, S: Sym<3>; param K: Mat<3>; param g, z: Vec<3>;
            group Λ: SO<3> velocity Ω;
            constraint next(Λ) = {side};
            lagrangian = -tr(J*Λ^T*next(Λ))/h - h*({terms});
        }}"
    )
}

#[test]
fn parameters_absorb_the_configuration_on_either_side() {
    let d = derive(&top("Λ*Ω", "dot(z, Λ*g)"));
    assert_eq!(found(&d), ["z_body = Λ_kᵀ z; Ω_kᵀ z_{body,k}"]);
    let d = derive(&top("Ω*Λ", "dot(z, Λ*g)"));
    assert_eq!(
        found(&d),
        [
            "J_space = Λ_k J Λ_kᵀ; Ω_k J_{space,k} Ω_kᵀ",
            "g_space = Λ_k g; Ω_k g_{space,k}"
        ]
    );
    let d = derive(&top(
        "Λ*Ω",
        "tr(S*Λ*J*Λ^T) + tr(K*Λ) + log(1 + dot(E3, Λ*g)^2)",
    ));
    assert_eq!(
        found(&d),
        [
            "S_body = Λ_kᵀ S Λ_k; Ω_kᵀ S_{body,k} Ω_k",
            "K_body = K Λ_k; K_{body,k} Ω_k",
            "E3_body = Λ_kᵀ E₃; Ω_kᵀ E_{3,body,k}"
        ]
    );
}

/// Whether the configuration itself occurs in the reduced action.
fn stands(d: &Derivation, element: &str) -> bool {
    let s = &d.letters.symbols;
    let letters = expr::letters(&d.action.total);
    letters.iter().any(|l| s.get(l.symbol).name == element)
}

#[test]
fn a_term_that_nothing_absorbs_stands_as_it_was_stated() {
    let cases = [
        ("dot(z, Λ*g) + tr(Λ)", 1, true),
        ("tr(Λ*Λ*J) + dot(z, Λ*g)", 1, true),
        ("tr(Λ*J*Λ*S)", 1, false),
    ];
    for (terms, carried, left) in cases {
        let d = derive(&top("Λ*Ω", terms));
        assert_eq!(stands(&d, "Λ"), left, "{terms}");
        assert!(found(&d).len() >= carried, "{terms}: {:?}", found(&d));
        assert_eq!(d.bracket.holds_elements, left, "{terms}");
    }
}

#[test]
fn three_bodies_have_two_relative_attitudes() {
    let d = derive(
        "model Three {
            param J: Sym<3>; param d: Vec<3>;
            group A: SO<3> velocity a; group B: SO<3> velocity b; group C: SO<3> velocity c;
            constraint next(A) = A*a; constraint next(B) = B*b; constraint next(C) = C*c;
            lagrangian = -(tr(J*A^T*next(A)) + tr(J*B^T*next(B)) + tr(J*C^T*next(C)))/h
                - h*dot(A*d, B*d) - h*dot(B*d, C*d) - h*dot(C*d, A*d);
        }",
    );
    assert_eq!(found(&d).len(), 2, "{:?}", found(&d));
    assert_eq!(d.integrability.rank(), Some((15, 14)));
}

#[test]
fn reduced_statements_are_left_as_they_are() {
    let d = derive(
        "model Top {
            param J: Sym<3>; param g, z: Vec<3>;
            group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω;
            lagrangian = -tr(J*Ω)/h - h*dot(z, Λ*g);
        }",
    );
    assert!(d.spec.reduction.is_none() && found(&d).is_empty());
}

/// The unit quaternion body, with further terms in its action.
fn quaternion(update: &str, terms: &str) -> String {
    format!(
        "model Quaternion {{
            param I: Diag<3>; param c: Real; param g, z: Vec<3>; param K: Mat<4>; param S: Sym<3>;
            group q: SU<2> velocity W;
            constraint next(q) = {update};
            let w = im(q^T*next(q));
            lagrangian = -(4*c/h)*re(q^T*next(q)) + (2/h)*dot(w, (I - c*Id)*w){terms};
        }}"
    )
}

/// A body with mass, with further terms in its action.
fn motion(update: &str, terms: &str) -> String {
    format!(
        "model Motion {{
            param J, M: Sym<3>; param b, Z: Vec<4>; param z, g: Vec<3>; param K: Mat<4>; param A: Mat<3>;
            group G: SE<3> velocity V;
            constraint next(G) = {update};
            let v = pos(G^-1*next(G));
            lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + dot(v, M*v)/(2*h){terms};
        }}"
    )
}

fn lagrangian(d: &Derivation) -> String {
    let style = Style::new("k");
    expression(&d.spec.lagrangian, &d.letters.symbols, &style, Format::Text)
}

#[test]
fn the_quaternion_body_is_reduced_on_both_sides() {
    let d = derive(&quaternion("q*W", " - h*dot(z, rot(q)*g)"));
    // The form of the statement is kept, with the velocity in place of `q^T*next(q)`.
    assert_eq!(
        lagrangian(&d),
        "-4 c re(W_k)/h + 2 im(W_k)·((I - c Id) im(W_k))/h - h g·z_{body,k}"
    );
    let carried = "z_body = rot(q_k)ᵀ z; rot(W_k)ᵀ z_{body,k}";
    assert_eq!(found(&d), [carried]);
    // The same weight as a product of quaternions.
    let products = quaternion("q*W", " + h*re(q*quat(g)*q^T*quat(z))");
    assert_eq!(found(&derive(&products)), [carried]);
    let d = derive(&quaternion("W*q", " - h*tr(K*q)"));
    assert_eq!(
        found(&d),
        [
            "I_space = rot(q_k) I rot(q_k)ᵀ; rot(W_k) I_{space,k} rot(W_k)ᵀ",
            "K_space = q_k K; W_k K_{space,k}"
        ]
    );
}

#[test]
fn bodies_with_mass_are_reduced_on_both_sides() {
    let cases = [
        ("", vec![]),
        (
            " - h*dot(b, G^T*Z)",
            vec!["Z_body = G_kᵀ Z; V_kᵀ Z_{body,k}"],
        ),
        // A plane contains its normal, so one quantity gives both the height and the vertical.
        (
            " - h*dot(z, rot(G)*g) - h*dot(z, pos(G))",
            vec!["z_body = G_kᵀ [z; 0]; V_kᵀ z_{body,k}"],
        ),
        (
            " - h*dot(z, rot(G)*g)",
            vec!["z_body = rot(G_k)ᵀ z; rot(V_k)ᵀ z_{body,k}"],
        ),
        (
            " - h*dot(pos(G), pos(G))",
            vec!["metric_G = G_kᵀ [Id, 0; 0, 0] G_k; V_kᵀ metric_{G,k} V_k"],
        ),
        (
            " - h*dot(rot(G)^T*pos(G), g)",
            vec!["E4_body = G_k⁻¹ E₄; V_k⁻¹ E_{4,body,k}"],
        ),
    ];
    for (terms, expected) in cases {
        let d = derive(&motion("G*V", terms));
        assert_eq!(found(&d), expected, "{terms}");
        let kinetic = "-tr(J rot(V_k))/h + (pos(V_k)·(M pos(V_k)))/(2 h)";
        assert!(lagrangian(&d).starts_with(kinetic), "{}", lagrangian(&d));
    }
    let d = derive(&motion("V*G", " - h*dot(z, pos(G))"));
    assert_eq!(
        found(&d),
        [
            "J_space = rot(G_k) J rot(G_k)ᵀ; rot(V_k) J_{space,k} rot(V_k)ᵀ",
            "E4_space = G_k E₄; V_k E_{4,space,k}",
            "M_space = rot(G_k) M rot(G_k)ᵀ; rot(V_k) M_{space,k} rot(V_k)ᵀ"
        ]
    );
}

#[test]
fn terms_of_quaternions_and_motions_that_nothing_absorbs_stand() {
    let cases = [
        (quaternion("q*W", " - h*re(q)"), "q"),
        (quaternion("q*W", " - h*tr(rot(q))"), "q"),
        (quaternion("q*W", " + dot(im(q), im(next(q)))"), "q"),
        (motion("G*V", " - h*tr(rot(G))"), "G"),
        (motion("G*V", " - h*tr(G)"), "G"),
        (motion("V*G", " - h*dot(b, G^T*b)*tr(rot(G))"), "G"),
    ];
    for (text, element) in cases {
        let d = derive(&text);
        assert!(stands(&d, element), "{text}");
    }
}

fn coupled(group: &str, kinetic: &str, coupling: &str, side: fn(&str) -> String) -> String {
    let bodies = ["A", "B", "C"].map(|g| {
        format!(
            "group {g}: {group} velocity v{g}; constraint next({g}) = {};",
            side(g)
        )
    });
    let kinetic = ["A", "B", "C"].map(|g| kinetic.replace('g', g)).join(" + ");
    format!(
        "model Coupled {{ param J, M: Sym<3>; param d, e: Vec<3>; {} lagrangian = {kinetic} - h*({coupling}); }}",
        bodies.join(" ")
    )
}

#[test]
fn several_bodies_are_carried_relative_to_one_another() {
    let body: fn(&str) -> String = |g| format!("{g}*v{g}");
    let space: fn(&str) -> String = |g| format!("v{g}*{g}");
    let spin = "dot(im(g^T*next(g)), J*im(g^T*next(g)))/h";
    let joints = "dot(rot(A)*d, rot(B)*e) + dot(rot(B)*d, rot(C)*e) + dot(rot(C)*d, rot(A)*e)";
    let d = derive(&coupled("SU<2>", spin, joints, body));
    assert_eq!(
        found(&d),
        [
            "relative_A_B = A_kᵀ B_k; vA_kᵀ relative_{A,B,k} vB_k",
            "relative_B_C = B_kᵀ C_k; vB_kᵀ relative_{B,C,k} vC_k"
        ]
    );
    let drift =
        "(dot(pos(next(g)) - pos(g), pos(next(g)) - pos(g)) - tr(J*rot(g)^T*rot(next(g))))/h";
    let springs = "dot(pos(A) - pos(B), pos(A) - pos(B)) + dot(rot(B)*d, pos(C) - pos(B))";
    let d = derive(&coupled("SE<3>", drift, springs, body));
    assert_eq!(
        found(&d),
        [
            "relative_A_B = A_k⁻¹ B_k; vA_k⁻¹ relative_{A,B,k} vB_k",
            "relative_B_C = B_k⁻¹ C_k; vB_k⁻¹ relative_{B,C,k} vC_k"
        ]
    );
    // A force from space on one body has no relative form; it adds planes and points.
    let held = format!("{springs} + dot(d, pos(A))");
    let d = derive(&coupled("SE<3>", drift, &held, body));
    assert_eq!(found(&d).len(), 3, "{:?}", found(&d));
    let d = derive(&coupled("SU<2>", "tr(g^T*next(g))/h", "re(A*B^T)", space));
    assert_eq!(
        found(&d),
        ["relative_A_B = A_k B_kᵀ; vA_k relative_{A,B,k} vB_kᵀ"]
    );
}

#[test]
fn a_number_that_stands_linearly_is_divided_for() {
    let how = |kinetic: &str| {
        let d = derive(&format!(
            "model Pendulum {{ param m, g: Real; field q: Real; let v = next(q) - q;
             lagrangian = {kinetic}/(2*h) + h*m*g*cos(q); }}"
        ));
        d.how_solved()
    };
    assert!(how("m*v^2").contains("one division"), "{}", how("m*v^2"));
    let quartic = how("(m*v^2 + v^4/h^2)");
    assert!(!quartic.contains("division"), "{quartic}");
}

/// Terms over the step size stay on the edge of their statement, even if terms cancel when they are multiplied out.
#[test]
fn terms_of_an_edge_are_not_divided_between_nodes() {
    let reduced = |kinetic: &str| {
        let text = format!(
            "model Body {{ group R: SO<3> velocity W; field e: Vec<3>; constraint next(R) = W*R;
             let D = diag(exp(dot(e, E1))*E1 + exp(dot(e, E2))*E2 + exp(dot(e, E3))*E3); let V = diag(next(e) - e);
             lagrangian = 2*tr((Id - W)*D^2)/h + {kinetic}; }}"
        );
        let d = crate::derive_source(&text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert!(d.action.nodal.is_zero(), "{kinetic}: {:?}", d.action.nodal);
        d.limit.err()
    };
    for kinetic in [
        "tr(V*V)/h",
        "tr(D^2*V^2)/(2*h)",
        "tr((D^2 + next(D)^2)*V^2)/(4*h)",
        "tr(D*V*V*next(D))/(2*h)",
    ] {
        assert_eq!(reduced(kinetic), None, "{kinetic}");
    }
}
