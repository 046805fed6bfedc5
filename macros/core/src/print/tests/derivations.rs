//! Printed derivations of whole models: checks for the correct formulas, and for the absence of earlier wrong ones.

use crate::Derivation;
use crate::derive_source;
use crate::document::{Citations, Place, Work, printed, printed_telling};
use crate::print::Format;

const FREE: &str = "param J: Sym<3>; group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω;
    lagrangian = -tr(J*Ω)/h;";

const TOP: &str = "param J: Sym<3>; param gU, z: Vec<3>;
    group Λ: SO<3> velocity Ω; advected Γ: Vec<3> = Λ^T*z;
    constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ;";

const SPATIAL: &str = "group Λ: SO<3> velocity ω; advected J: Sym<3>;
    constraint next(Λ) = ω*Λ; constraint next(J) = ω*J*ω^T; lagrangian = -tr(ω*J)/h;";

const COUPLED: &str = "param J1, J2: Sym<3>; param d1, d2: Vec<3>; param eps: Real;
    group Λ1: SO<3> velocity Ω1; group Λ2: SO<3> velocity Ω2;
    advected R: SO<3> = Λ1^T*Λ2;
    constraint next(Λ1) = Λ1*Ω1; constraint next(Λ2) = Λ2*Ω2; constraint next(R) = Ω1^T*R*Ω2;
    lagrangian = -(tr(J1*Ω1) + tr(J2*Ω2) + eps*dot((Ω1 - Id)*d1, R*(Ω2 - Id)*d2))/h;";

const ELLIPSOID: &str = "param C0, I0: Sym<3>; param c, d: Real;
    group Q: GL<3> velocity G; advected C: Sym<3> = Q^T*C0*Q;
    constraint next(Q) = Q*G; constraint next(C) = G^T*C*G;
    lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*(c*det(C) - (d/2)*log(det(C)));";

fn derived(statements: &str) -> Derivation {
    let text = format!("model Tested {{ {statements} }}");
    derive_source(&text).unwrap_or_else(|errors| panic!("{errors}"))
}

fn text(statements: &str) -> String {
    printed(&derived(statements), Format::Text)
}

#[track_caller]
fn holds(text: &str, wanted: &[&str], unwanted: &[&str]) {
    // Paragraphs may break between any words.
    let flat: String = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for w in wanted {
        assert!(flat.contains(w), "missing: {w}\n{text}");
    }
    for w in unwanted {
        assert!(!flat.contains(w), "found: {w}\n{text}");
    }
}

#[test]
fn gradients_have_the_structure_of_their_letter() {
    holds(
        &text(SPATIAL),
        &["V_{J,k} - sym(ω_k)/h - ω_kᵀ V_{J,k+1} ω_k = 0"],
        &["- ω_kᵀ/h"],
    );
    let skew = "param A: Mat<3>; group Λ: SO<3> velocity ω; advected B: Skew<3>;
        constraint next(Λ) = ω*Λ; constraint next(B) = ω*B*ω^T;
        lagrangian = -tr(ω)/h - h*tr(A*B);";
    holds(&text(skew), &["h skew(A)"], &["- h Aᵀ", "+ h Aᵀ"]);
    // A diagonal quantity that does not change under rotations.
    let diagonal = "param A: Mat<3>; group Λ: SO<3> velocity Ω; advected D: Diag<3>;
        constraint next(Λ) = Λ*Ω; constraint next(D) = D;
        lagrangian = -tr(D*Ω)/h - h*tr(A*D);";
    holds(&text(diagonal), &["diag(Ω_k)/h", "h diag(A)"], &[]);
}

#[test]
fn the_gradient_of_a_determinant_is_its_adjugate() {
    let text = text(ELLIPSOID);
    holds(
        &text,
        &["h c adj(C_k)", "½ h d C_k⁻¹", "h c det(C_k) Id"],
        &["tr(C_k) C_k", "tr(C_k)²", "sym(C_k⁻¹)"],
    );
}

#[test]
fn momentum_maps_bear_their_side() {
    holds(
        &text(SPATIAL),
        &["J_k^L = skew(P_k Λ_kᵀ)", "left translation"],
        &["J_k^R"],
    );
    holds(
        &text(FREE),
        &["J_k^R = skew(Λ_kᵀ P_k)", "right translation"],
        &["J_k^L"],
    );
    // On the other side, the coadjoint action uses the inverse.
    holds(
        &text(SPATIAL),
        &["Ad*_{ω_k} M_k = M_{k-1} + ∇_{J_k} ℓ_k ◇ J_k"],
        &[],
    );
    holds(&text(FREE), &["M_k = Ad*_{Ω_{k-1}} M_{k-1}"], &[]);
}

#[test]
fn like_terms_are_collected() {
    holds(
        &text(SPATIAL),
        &["- 2 V_{J,k+1} ω_k J_k"],
        &["ω_k J_k - V_{J,k+1}"],
    );
    holds(
        &text(ELLIPSOID),
        &["C_k (G_k - Id) I₀/h"],
        &["I₀/(2 h) + C_k"],
    );
    let scaled = format!("{TOP} scale -h; lagrangian = tr(Ω*J) + h^2*dot(gU, Γ);");
    holds(
        &text(&scaled),
        &["ℓ = -tr(Ω_k J)/h - h gU·Γ_k"],
        &["h²/(2 h)", "h² gU·Γ_k/"],
    );
    // A term subtracted from the momentum does not need brackets.
    holds(&text(COUPLED), &["N₁ = μ_{1,k} + eps"], &["μ_{1,k} - (eps"]);
}

/// A table that cites every equation of an uncoupled body.
const CITED: Citations = Citations {
    work: Some(Work {
        named: "lecture",
        key: "lecture1",
        entry: "",
        item: "",
    }),
    statement: "These are the tops of a lecture; momenta there are $-h$ times these.",
    places: &[
        (Place::Reconstruction("Λ"), "(1)"),
        (Place::Rule("Γ"), "(2)"),
        (Place::Action, "(3) times $-1/h$"),
        (Place::ClebschAction, "(4)"),
        (Place::Relation("Λ"), "(5)"),
        (Place::Relation("Γ"), "(6)"),
        (Place::Relation("Ω"), "(7)"),
        (Place::Lifted, "(8)"),
        (Place::Momentum, "(9)"),
        (Place::AtStart, "(10)"),
        (Place::AtEnd, "(11)"),
        (Place::Balance, "(12)"),
        (Place::Riccati, "(13)"),
        (Place::Continuous, "(14)"),
        (Place::Rule("J"), "(15)"),
    ],
};

#[test]
fn what_is_cited_is_the_table_of_the_model() {
    let top = derived(&format!("{TOP} lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ);"));
    let cited = printed_telling(&top, Format::Text, 100, CITED, None);
    let all: Vec<String> = (1..=14).map(|i| format!("[lecture ({i})")).collect();
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    holds(&cited, &all, &["[lecture (15)"]);
    holds(
        &cited,
        &[
            "These are the tops of a lecture; momenta there are -h times these.",
            "Λ_{k+1} = Λ_k Ω_k [lecture (1)]",
            "[lecture (3) times -1/h]",
            "[lecture (5)] Variation of Λ.",
        ],
        &[],
    );
    // Without a table there are no citations, whatever the model.
    for statements in [FREE, SPATIAL, COUPLED, ELLIPSOID] {
        holds(&text(statements), &[], &["thesis", "system of section"]);
    }
}

#[test]
fn the_conserved_momentum_of_a_body_is_the_spatial_one() {
    holds(
        &text(FREE),
        &["spatial momentum: Λ_k μ_k"],
        &["spatial momentum: μ_k"],
    );
    holds(&text(SPATIAL), &["spatial momentum: m_k"], &["Λ_k m_k"]);
}

#[test]
fn letters_that_the_model_bears_are_left_to_it() {
    let body = |letter: &str| {
        format!(
            "param {letter}: Mat<4>; group Λ: SO<4> velocity Ω; constraint next(Λ) = Λ*Ω;
             lagrangian = -tr({letter}^T*Ω)/h;"
        )
    };
    holds(&text(&body("C")), &["Ω_k Cᵀ - C Ω_kᵀ = h μ_k"], &["C = C"]);
    // A model with parameters called A and S.
    let taken = "param A, S: Sym<3>; group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω;
        lagrangian = -tr((A + S)*Ω)/h;";
    holds(&text(taken), &["C = A + S", "S₁² + S₁ A₁"], &["S² + S A"]);
    let scaled = format!("{TOP} scale -h; lagrangian = tr(Ω*J) + h^2*dot(gU, Γ);");
    holds(
        &text(&scaled),
        &[
            "ℓ^{typed} = tr(Ω_k J) + h² gU·Γ_k = -h ℓ",
            "so that the discrete Lagrangian is",
        ],
        &[],
    );
}

#[test]
fn no_node_is_left_in_the_limit() {
    for model in [FREE, SPATIAL, COUPLED, ELLIPSOID] {
        let text = text(model);
        let (_, limit) = text.split_once("Limit of small steps").unwrap();
        let (limit, _) = limit.split_once("Certificate").unwrap();
        let equations = limit.lines().filter(|l| l.starts_with("  ("));
        assert!(equations.clone().count() >= 4, "{limit}");
        for line in equations {
            assert!(!line.contains("_k") && !line.contains(",k"), "{line}");
        }
    }
    let top = text(&format!("{TOP} lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ);"));
    holds(
        &top,
        &[
            "dμ/dt = ad*_ζ μ + ∇_Γ L ◇ Γ = μ × ζ + Γ × gU",
            "dΓ/dt = Γ × ζ",
            "μ = ∇_ζ L = tr(J) ζ - J ζ",
        ],
        &["Γ_k × ζ"],
    );
}

#[test]
fn diamond_and_coadjoint_action_are_defined() {
    holds(
        &text(SPATIAL),
        &[
            "Ad*_g M = gᵀ M g⁻ᵀ",
            "⟨v ◇ a, ξ⟩ = ⟨v, ξ(a)⟩",
            "V_{J,k} ◇ J_k = 2 V_{J,k} J_k - 2 J_k V_{J,k}",
        ],
        &[],
    );
    holds(&text(FREE), &["Ad*_g M = gᵀ M g⁻ᵀ"], &["◇"]);
}

#[test]
fn multipliers_of_general_matrices_have_no_weight() {
    holds(
        &text(ELLIPSOID),
        &[
            "P_k - P_{k+1} G_kᵀ = 0",
            "J_k^R = Q_kᵀ P_k + V_{C,k} ◇ C_k",
            "V_{C,k} ◇ C_k = 2 C_k V_{C,k}",
        ],
        &["½ P_k", "½ Q_k"],
    );
    holds(&text(FREE), &["½ P_k - ½ P_{k+1} Ω_kᵀ = 0"], &[]);
}

#[test]
fn the_solution_is_that_of_the_model() {
    holds(
        &text(FREE),
        &[
            "Ω_k J - J Ω_kᵀ = h hat(μ_k)",
            "S² + S A - A S - A² - J² = 0",
            "H = [[A, Id], [A² + J², A]]",
            "positive real part",
            "for singular J",
            "the root of one quartic for the whole trajectory",
        ],
        &["No stepper"],
    );
    holds(
        &text(COUPLED),
        &["It is coupled: N₁ contains Ω_{2,k}."],
        &["no approximation is involved"],
    );
    holds(
        &text(ELLIPSOID),
        &["There is no Riccati form for G_k"],
        &["quartic"],
    );
    // The text mentions a stepper only if one is emitted.
    let many = "param J: Sym<3>;
        group A: SO<3> velocity a; group B: SO<3> velocity b; group C: SO<3> velocity c;
        group D: SO<3> velocity d;
        constraint next(A) = A*a; constraint next(B) = B*b; constraint next(C) = C*c;
        constraint next(D) = D*d;
        lagrangian = -(tr(J*a) + tr(J*b) + tr(J*c) + tr(J*d))/h;";
    for model in [FREE, SPATIAL, COUPLED, ELLIPSOID, many] {
        let d = derived(model);
        let none = crate::emit::refusal(&d).is_some();
        let text = printed(&d, Format::Text);
        assert_eq!(text.contains("No stepper is emitted"), none, "{text}");
        assert_eq!(text.contains("The stepper"), !none, "{text}");
    }
}
