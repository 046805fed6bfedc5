//! What the reduction finds and what it refuses. Takes unreduced statements; compares definitions,
//! constraints and messages.

use crate::derive::Derivation;
use crate::pipeline::derive_source;
use crate::print::{Format, Style, expression};

fn derive(text: &str) -> Derivation {
    derive_source(text).unwrap_or_else(|e| panic!("{e}"))
}

/// Names and constraints of the quantities that were found.
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

#[test]
fn a_term_that_nothing_absorbs_is_named() {
    let cases = [
        ("dot(z, Λ*g) + tr(Λ)", "tr(Λ_k)", 29),
        ("tr(Λ*Λ*J) + dot(z, Λ*g)", "tr(J Λ_k²)", 15),
        ("tr(Λ*J*Λ*S)", "", 0),
    ];
    for (terms, left, _) in cases {
        let refused = derive_source(&top("Λ*Ω", terms));
        match (refused, left) {
            (Ok(_), "") => {}
            (Err(e), left) if !left.is_empty() => {
                let text = e.to_string();
                assert!(text.contains("is not invariant"), "{text}");
                assert!(text.contains(&format!("it leaves {left},")), "{text}");
                assert_eq!(text.matches("not invariant").count(), 1, "{text}");
            }
            (other, _) => panic!("{terms}: {:?}", other.map(|d| found(&d))),
        }
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
    assert_eq!(d.integrability.rank, Some((15, 14)));
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
